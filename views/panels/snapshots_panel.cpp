// SPDX-License-Identifier: GPL-3.0-or-later
#include "snapshots_panel.h"

#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QToolButton>
#include <cmath>

#include "views/model/theme.h"

namespace trimtab::views {
namespace {

/// Results change with the flight; more often than this nobody reads them.
constexpr int kResultsMs = 500;

QToolButton* makeButton(const QString& text, const QString& tip, bool checkable) {
  auto* button = new QToolButton;
  button->setText(text);
  button->setToolTip(tip);
  button->setCheckable(checkable);
  button->setFocusPolicy(Qt::StrongFocus);
  return button;
}

}  // namespace

SnapshotsPanel::SnapshotsPanel(Draft& draft, Snapshots& snapshots, QWidget* parent)
    : QWidget(parent),
      snapshots_(snapshots),
      throttle_(
          this, [this] { refreshResults(); }, kResultsMs) {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(6, 4, 6, 4);
  grid->setColumnStretch(1, 1);
  for (int slot = 0; slot < Snapshots::kCount; ++slot) makeLine(*grid, slot);
  auto* trust = new QLabel(tr(
      "Medians of images that were not drawn in turns: where the flight or the machine changed between two "
      "snapshots, so did their times. Compare draws two presets in turns."));
  trust->setWordWrap(true);
  setInk(*trust, Ink::quiet);
  grid->addWidget(trust, 2 * Snapshots::kCount, 0, 1, 5);
  grid->setRowStretch(2 * Snapshots::kCount + 1, 1);
  connect(&snapshots_, &Snapshots::changed, this, &SnapshotsPanel::refresh);
  connect(&snapshots_, &Snapshots::measured, this, [this] { throttle_.request(); });
  connect(&draft, &Draft::loaded, this, &SnapshotsPanel::refresh);
  refresh();
}

void SnapshotsPanel::makeLine(QGridLayout& grid, int slot) {
  const QString letter = snapshots_.title(slot);
  Line& l = line(slot);
  l.go = makeButton(letter,
                    tr("Switch to snapshot %1 (F%2). An empty one keeps the preset as it is now.")
                        .arg(letter)
                        .arg(kFirstSnapshotKey + slot),
                    true);
  l.keep = makeButton(
      tr("Keep"),
      tr("Keep the preset as it is now as snapshot %1 (Shift+F%2)").arg(letter).arg(kFirstSnapshotKey + slot),
      false);
  l.pin = makeButton(tr("Pin"),
                     tr("Show snapshot %1 behind curves and bands, and compare with it").arg(letter), true);
  l.forget = makeButton(tr("Forget"), tr("Empty snapshot %1").arg(letter), false);
  l.name = new QLineEdit;
  l.name->setPlaceholderText(tr("Name of snapshot %1").arg(letter));
  l.name->setAccessibleName(tr("Name of snapshot %1").arg(letter));
  l.result = new QLabel;
  l.result->setTextInteractionFlags(Qt::TextSelectableByMouse);
  l.result->setAccessibleName(tr("Results of snapshot %1").arg(letter));
  setInk(*l.result, Ink::quiet);
  QFont bold = font();
  bold.setBold(true);
  l.go->setFont(bold);
  for (QToolButton* button : {l.go, l.keep, l.pin, l.forget})
    button->setAccessibleName(button->toolTip().section(QLatin1Char('('), 0, 0).trimmed());
  const int row = 2 * slot;
  grid.addWidget(l.go, row, 0);
  grid.addWidget(l.name, row, 1);
  grid.addWidget(l.keep, row, 2);
  grid.addWidget(l.pin, row, 3);
  grid.addWidget(l.forget, row, 4);
  grid.addWidget(l.result, row + 1, 1, 1, 4);

  connect(l.go, &QToolButton::clicked, this, [this, slot] { snapshots_.switchTo(slot); });
  connect(l.keep, &QToolButton::clicked, this, [this, slot] { snapshots_.keep(slot); });
  connect(l.pin, &QToolButton::clicked, this, [this, slot] { snapshots_.togglePinned(slot); });
  connect(l.forget, &QToolButton::clicked, this, [this, slot] { snapshots_.forget(slot); });
  connect(l.name, &QLineEdit::editingFinished, this,
          [this, slot] { snapshots_.rename(slot, line(slot).name->text().trimmed()); });
}

QString SnapshotsPanel::resultText(int slot) const {
  return lines_[static_cast<std::size_t>(slot)].result->text();
}

void SnapshotsPanel::refresh() {
  for (int slot = 0; slot < Snapshots::kCount; ++slot) {
    Line& l = line(slot);
    const bool kept = snapshots_.isKept(slot);
    l.go->setChecked(slot == snapshots_.active());
    l.pin->setEnabled(kept);
    l.pin->setChecked(slot == snapshots_.pinned());
    l.forget->setEnabled(kept);
    if (!l.name->hasFocus()) l.name->setText(snapshots_.name(slot));
    l.name->setEnabled(kept);
  }
  refreshResults();
}

QString SnapshotsPanel::measuredText(int slot) const {
  const double ms = snapshots_.medianMs(slot), error = snapshots_.medianError(slot);
  if (std::isnan(ms)) return tr("no image yet");
  QString text =
      tr("frame %1 ms over %2 images").arg(ms, 0, 'f', ms < 10 ? 2 : 1).arg(snapshots_.images(slot));
  text += std::isnan(error) ? tr(", error not measured") : tr(", FLIP %1").arg(numberText(error, 4));
  return text;
}

void SnapshotsPanel::refreshResults() {
  for (int slot = 0; slot < Snapshots::kCount; ++slot) {
    QString text = tr("empty: %1 keeps the preset as it is now")
                       .arg(QStringLiteral("F%1").arg(kFirstSnapshotKey + slot));
    if (snapshots_.isKept(slot)) {
      const int differing = snapshots_.differingFromFile(slot);
      text = differing == 0 ? tr("as the file; ") : tr("%1 from the file; ").arg(differing);
      text += measuredText(slot);
    }
    line(slot).result->setText(text);
  }
}

}  // namespace trimtab::views
