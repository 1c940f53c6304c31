// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QFrame>
#include <functional>
#include <optional>

#include "views/model/budget_minute.h"
#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

namespace trimtab::views {

/// One line that always says how the budget is kept: the share of the last minute's images that were over
/// it, the stage that takes longest, and the lever that would help most. It changes at most once a second,
/// and costs nothing while nothing is drawn. A click opens the knob of the lever that it names.
class BudgetStrip : public QFrame {
  Q_OBJECT

 public:
  /// Returns what images of such a load cost on this machine, as far as it is known.
  using Costs = std::function<CostCoefficients(const FrameLoad&)>;

  explicit BudgetStrip(Draft& draft, QWidget* parent = nullptr);

  void setCosts(Costs costs) { costs_ = std::move(costs); }
  /// Counts a frame whose image was drawn. `imageMpx` are the millions of pixels of the image.
  void showFrame(const LiveFrame& frame, double imageMpx);
  const QString& text() const { return text_; }
  const BudgetMinute& minute() const { return minute_; }

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 signals:
  /// The knob of the lever that is named is wanted: a parameter's key.
  void knobAsked(const QString& key);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;

 private:
  void refresh();

  Draft& draft_;
  Costs costs_;
  BudgetMinute minute_;
  FrameLoad load_;
  std::optional<FrameLevers> drawn_;
  std::optional<Lever> named_;
  QString text_;
  bool over_ = false;
  Throttle throttle_;
};

}  // namespace trimtab::views
