// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>
#include <array>
#include <optional>

#include "trimtab/measure/statistics.h"
#include "views/model/draft.h"
#include "views/model/live.h"

namespace trimtab::views {

/// Three snapshots of the draft, A, B and C, to switch between while the image is live, with what the images
/// have cost and how wrong they were since the switch. A switch is one undo step of the draft. Snapshots stay
/// when another preset is loaded; sessions keep them from one run to the next.
class Snapshots : public QObject {
  Q_OBJECT
 public:
  static constexpr int kCount = 3;

  explicit Snapshots(Draft& draft, QObject* parent = nullptr);

  bool isKept(int slot) const { return values(slot) != nullptr; }
  /// Returns the values of the slot; null if it is empty.
  const TuningParameters* values(int slot) const { return at(slot).values ? &*at(slot).values : nullptr; }
  /// Returns its letter, and the name that the person gave it: "A" or "A, far cut".
  QString title(int slot) const;
  const QString& name(int slot) const { return at(slot).name; }
  void rename(int slot, const QString& name);

  /// Makes the slot hold the draft's values. Its statistics begin again.
  void keep(int slot);
  /// Gives the draft the values of the slot. An empty slot keeps the draft's values instead.
  void switchTo(int slot);
  void forget(int slot);
  /// Fills a slot as it was in an earlier run. The draft stays as it is.
  void restore(int slot, const QString& name, const TuningParameters& values);
  /// Returns the slot whose values the draft has since the last switch or keep(); -1 once it was edited.
  int active() const { return active_; }
  /// Returns the slot that is the draft's pinned reference; -1 if none is.
  int pinned() const { return pinned_; }
  /// Pins the slot, in place of any other; the pinned one is unpinned.
  void togglePinned(int slot);
  /// Returns how many parameters of the slot differ from the file.
  int differingFromFile(int slot) const;

  void showFrame(const LiveFrame& frame);
  /// Adds an error (mean FLIP) that was measured of a live image.
  void addError(double flip);
  /// Return what the images since the switch had: NaN if none was measured.
  double medianMs(int slot) const { return at(slot).frameMs.median(); }
  double medianError(int slot) const { return at(slot).error.median(); }
  std::size_t images(int slot) const { return at(slot).images; }

 signals:
  void changed();   ///< a slot's values or name, which one is active, or what is pinned
  void measured();  ///< statistics of the active slot

 private:
  struct Slot {
    QString name;
    std::optional<TuningParameters> values;
    SampleWindow frameMs{kWindow}, error{kWindow};
    std::size_t images = 0;
  };
  /// Older samples are dropped, so that a median follows the flight.
  static constexpr std::size_t kWindow = 600;

  const Slot& at(int slot) const { return slots_[static_cast<std::size_t>(slot)]; }
  Slot& at(int slot) { return slots_[static_cast<std::size_t>(slot)]; }
  void begin(int slot);
  void follow();
  void pinAgain();

  Draft& draft_;
  std::array<Slot, kCount> slots_;
  int active_ = -1, pinned_ = -1;
  bool switching_ = false;
};

}  // namespace trimtab::views
