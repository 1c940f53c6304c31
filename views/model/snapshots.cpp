// SPDX-License-Identifier: GPL-3.0-or-later
#include "snapshots.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trimtab::views {

Snapshots::Snapshots(Draft& draft, QObject* parent) : QObject(parent), draft_(draft) {
  connect(&draft_, &Draft::findingsChanged, this, &Snapshots::follow);
  connect(&draft_, &Draft::referencesChanged, this, &Snapshots::changed);
}

QString Snapshots::title(int slot) const {
  const QString letter(QChar('A' + slot));
  return name(slot).isEmpty() ? letter : tr("%1, %2").arg(letter, name(slot));
}

void Snapshots::rename(int slot, const QString& name) {
  if (at(slot).name == name) return;
  at(slot).name = name;
  if (slot == pinned_) pinAgain();
  emit changed();
}

void Snapshots::keep(int slot) {
  at(slot).values = draft_.parameters();
  if (slot == pinned_) pinAgain();
  begin(slot);
}

void Snapshots::switchTo(int slot) {
  if (!isKept(slot)) return keep(slot);
  {
    // What the draft announces meanwhile is the switch itself.
    switching_ = true;
    draft_.takeParameters(*at(slot).values, tr("Switch to Snapshot %1").arg(title(slot)));
    switching_ = false;
  }
  begin(slot);
}

void Snapshots::forget(int slot) {
  at(slot) = Slot{};
  if (slot == pinned_) togglePinned(slot);
  if (slot == active_) active_ = -1;
  emit changed();
}

void Snapshots::restore(int slot, const QString& name, const TuningParameters& values) {
  forget(slot);
  at(slot).name = name;
  at(slot).values = values;
  emit changed();
}

void Snapshots::begin(int slot) {
  at(slot).frameMs.clear();
  at(slot).error.clear();
  at(slot).images = 0;
  active_ = slot;
  emit changed();
}

void Snapshots::togglePinned(int slot) {
  if (!isKept(slot) || slot == pinned_) {
    pinned_ = -1;
    return draft_.unpin();
  }
  pinned_ = slot;
  pinAgain();
}

void Snapshots::pinAgain() {
  draft_.pin(tr("snapshot %1").arg(title(pinned_)), *at(pinned_).values);
}

/// After an edit, or an undo, the draft is no longer the snapshot: what is measured then is not its own.
void Snapshots::follow() {
  if (switching_ || active_ < 0) return;
  const TuningParameters& values = *at(active_).values;
  if (std::ranges::all_of(parameterRows(), [&](const ParameterRow& row) {
        return row.get(values) == row.get(draft_.parameters());
      }))
    return;
  active_ = -1;
  emit changed();
}

int Snapshots::differingFromFile(int slot) const {
  if (!isKept(slot)) return 0;
  const TuningParameters &values = *at(slot).values, &file = *draft_.reference(Reference::file);
  return static_cast<int>(std::ranges::count_if(
      parameterRows(), [&](const ParameterRow& row) { return row.get(values) != row.get(file); }));
}

void Snapshots::showFrame(const LiveFrame& frame) {
  if (active_ < 0 || !frame.newImage || !frame.counts || !std::isfinite(frame.cost.total)) return;
  at(active_).frameMs.add(frame.cost.total);
  ++at(active_).images;
  emit measured();
}

void Snapshots::addError(double flip) {
  if (active_ < 0) return;
  at(active_).error.add(flip);
  emit measured();
}

}  // namespace trimtab::views
