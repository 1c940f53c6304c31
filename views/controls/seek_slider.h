// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QMouseEvent>
#include <QSlider>
#include <QStyle>

namespace trimtab::views {

/// A horizontal slider whose handle jumps to where a person clicks, as that of a player of films does.
class SeekSlider : public QSlider {
 public:
  explicit SeekSlider(QWidget* parent = nullptr) : QSlider(Qt::Horizontal, parent) {}

 protected:
  void mousePressEvent(QMouseEvent* event) override {
    const int handle = style()->pixelMetric(QStyle::PM_SliderLength, nullptr, this);
    if (event->button() == Qt::LeftButton)
      setSliderPosition(QStyle::sliderValueFromPosition(
          minimum(), maximum(), qRound(event->position().x()) - handle / 2, width() - handle));
    QSlider::mousePressEvent(event);
  }
};

}  // namespace trimtab::views
