// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QElapsedTimer>
#include <QTimer>
#include <QWidget>
#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "draw_thread.h"
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
/// and what each costs. Each preset decides for itself, along the states that were shown while the window was
/// open. The images are drawn on the measuring thread, and only while the window is visible.
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

  SplitView(DrawThread& thread, views::Draft& draft, Source source, QWidget* parent = nullptr);

  void setTerrain(std::shared_ptr<const terrain::Database> terrain);
  /// Call this after the viewport has painted.
  void painted();
  /// `name` is a shipped preset, a file, `kDraft` or `kReference`. Returns false if it cannot be read.
  bool choose(Side side, const QString& name);
  static const QString kDraft, kReference;

  /// Whether the window shows the current frame with the current presets.
  bool upToDate() const { return !changed_ && !busy_; }
  bool busy() const { return busy_; }
  const QLabel& status() const { return *status_; }
  std::uint64_t comparisons() const { return comparisons_; }
  const HeatMap& heatMap() const { return *heat_; }
  SplitPicture& pictures() { return *pictures_; }
  QTableWidget& numbers() { return *numbers_; }

 signals:
  void compared();
  void refused(const QString& what, const trimtab::Findings& findings);

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  struct Chosen {
    QString name, label;
    std::optional<ValidatedParameters> parameters;  ///< nothing: this side is the reference
    std::unique_ptr<Session> session;
    std::deque<FrameRequest> recent;  ///< requests of the images shown, newest last; a blur mixes them
  };
  struct Work;

  QComboBox* makeChoice(Side side, const QString& name);
  void askFile(Side side);
  void addFileChoice(const QString& file);
  void restart(Side side);
  void follow();
  void wake();
  void compare();
  FrameRequest requestOf(Session& side) const;
  void sayMissing(const Findings& missing);
  void showWork(const Work& work);
  void fill(const Work& work);

  DrawThread& thread_;
  views::Draft& draft_;
  Source source_;
  std::shared_ptr<const terrain::Database> terrain_;
  std::array<Chosen, 2> sides_;
  std::optional<Frame> last_;
  QTimer timer_;
  QElapsedTimer sinceLast_;
  int gapMs_ = 0;  ///< from the start of one comparison to the start of the next
  int shrink_ = 1;
  bool changed_ = false, busy_ = false;
  std::uint64_t comparisons_ = 0, generation_ = 0;  ///< a result of an earlier generation is dropped

  std::array<QComboBox*, 2> choices_;
  QComboBox* form_;
  SplitPicture* pictures_;
  HeatMap* heat_;
  QTableWidget* numbers_;
  QLabel* status_;
};

}  // namespace trimtab::workbench
