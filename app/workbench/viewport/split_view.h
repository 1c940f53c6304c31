// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QElapsedTimer>
#include <QPointer>
#include <QTimer>
#include <QWidget>
#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "app/workbench/jobs/draw_thread.h"
#include "heat_map.h"
#include "split_picture.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/session/session.h"
#include "trimtab/terrain/format/database.h"
#include "views/model/draft.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QTableWidget;

namespace trimtab::workbench {

/// Compares two presets on the frame that the viewport shows: both images, where and how much they differ,
/// and what each costs. Each preset decides for itself, along the states that were shown while it was on. The
/// images are drawn on the measuring thread, and only while a person sees them: in this dock, or over the
/// viewport. While the view moves they may be smaller; once it rests they are as large as the image, and
/// their times are compared, drawn in turns. What an image as large as that drew and took is what the rules
/// of its preset know next, as in flight. The budget is off: both presets are drawn as they ask.
class SplitView : public QWidget {
  Q_OBJECT

 public:
  /// The frame that the viewport shows.
  struct Frame {
    AircraftState state;
    FrameRequest shown;
  };
  using Source = std::function<std::optional<Frame>()>;
  enum Side { left, right };

  SplitView(DrawThread& thread, views::Draft& draft, Source source, QWidget& viewport);
  ~SplitView() override;

  /// Sets whether a person can see the dock. It cannot find out itself, because Qt calls a dock behind other
  /// tabs visible.
  void setSeen(bool seen);
  /// Shows the images over the viewport, where both have its size, instead of in the dock.
  void setOverViewport(bool over);
  bool overViewport() const { return over_; }
  void setForm(SplitPicture::Form form);
  /// Shows one image alone, and the other one at the next call.
  void flicker();
  /// Shows the map of the differences, and the divided image at the next call.
  void toggleDifference();
  /// Symbols are left out unless this is on: they are drawn over both images, and would hide what differs.
  void setSymbols(bool on);
  /// Images that take longer than this to compare are smaller while the view moves, milliseconds.
  void setLongestMs(double ms) { longestMs_ = ms; }

  void setTerrain(std::shared_ptr<const terrain::Database> terrain);
  /// Call this after the viewport has painted.
  void painted();
  /// `name` is a shipped preset, a file, `kDraft` or `kReference`. Returns false if it cannot be read.
  bool choose(Side side, const QString& name);
  static const QString kDraft, kReference;

  /// Whether the current frame is shown with the current presets, at its full size and with its times.
  bool upToDate() const { return !changed_ && !busy_ && shownShrink_ == 1 && timed_; }
  bool busy() const { return busy_; }
  const QLabel& status() const { return *status_; }
  std::uint64_t comparisons() const { return comparisons_; }
  const HeatMap& heatMap() const { return *heat_; }
  SplitPicture& pictures() { return *pictures_; }
  SplitPicture& overlay() { return *overlay_; }
  QTableWidget& numbers() { return *numbers_; }

 signals:
  void compared();
  void busyChanged(bool busy);  ///< both images are being drawn, or are no longer
  void refused(const QString& what, const trimtab::Findings& findings);
  void overViewportChanged(bool over);

 private:
  struct Chosen {
    QString name, label;
    std::optional<ValidatedParameters> parameters;  ///< nothing: this side is the reference
    std::unique_ptr<Session> session;               ///< with the budget off
    std::deque<FrameRequest> recent;  ///< requests of the images shown, newest last; a blur mixes them
  };
  struct Work;

  QComboBox* makeChoice(Side side, const QString& name);
  void askFile(Side side);
  void addFileChoice(const QString& file);
  void arrange();
  void makeNumbers();
  bool active() const { return seen_ || over_; }
  void activityChanged(bool before);
  void restart(Side side);
  bool follow();
  void wake();
  void showAge();
  void compare();
  void giveBack(const Work& work);
  FrameRequest requestOf(Session& side) const;
  void setBusy(bool busy);
  void sayMissing(const Findings& missing);
  void showWork(const Work& work);
  void fill(const Work& work);

  DrawThread& thread_;
  views::Draft& draft_;
  Source source_;
  std::shared_ptr<const terrain::Database> terrain_;
  std::array<Chosen, 2> sides_;
  std::optional<Frame> last_;
  bool moves_ = false;  ///< the last two images were of different states
  int followed_ = 0;    ///< how often rules have followed an image of this state
  QTimer timer_;
  QElapsedTimer sinceLast_;
  int gapMs_ = 0;  ///< from the start of one comparison to the start of the next
  double longestMs_ = 1500;
  int shrink_ = 1;       ///< of images while the view moves: width and height are divided by this
  int shownShrink_ = 0;  ///< of the images that are shown; 0 while there are none
  bool timed_ = false;   ///< those images
  bool changed_ = false, busy_ = false, refining_ = false, seen_ = false, over_ = false, symbols_ = false;
  std::uint64_t comparisons_ = 0, generation_ = 0;  ///< a result of an earlier generation is dropped

  std::array<QComboBox*, 2> choices_;
  QComboBox* form_;
  QCheckBox *symbolsOn_, *overOn_;
  QWidget* inDock_;  ///< the images and the map, while they are not over the viewport
  SplitPicture* pictures_;
  QPointer<SplitPicture> overlay_;  ///< the viewport owns it
  HeatMap* heat_;
  QTableWidget* numbers_;
  QLabel* status_;
};

}  // namespace trimtab::workbench
