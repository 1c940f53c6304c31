// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QSlider>

#include "views/model/draft.h"

namespace trimtab::views {

/// A slider over a row's usual range, exponential if the row says so. A drag is one undo step.
class ParameterSlider : public QSlider {
  Q_OBJECT
 public:
  ParameterSlider(Draft& draft, std::string_view key, QWidget* parent = nullptr);

 protected:
  void wheelEvent(QWheelEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;

 private:
  double toValue(int position) const;
  int toPosition(double value) const;
  void read();
  void write(int position);

  Draft& draft_;
  const ParameterRow* row_;
  MergeToken token_ = 0;
};

}  // namespace trimtab::views
