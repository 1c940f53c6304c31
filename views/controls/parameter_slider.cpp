// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameter_slider.h"

#include <QKeyEvent>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "choice_box.h"
#include "parameter_of.h"
#include "views/model/rounded.h"
#include "views/model/theme.h"

namespace trimtab::views {

namespace {
constexpr int kPositions = 1000;
}

ParameterSlider::ParameterSlider(Draft& draft, std::string_view key, QWidget* parent)
    : QSlider(Qt::Horizontal, parent), draft_(draft), row_(findRow(key)) {
  Q_ASSERT(row_ && row_->kind == Kind::scalar);
  setRange(0, kPositions);
  setPageStep(kPositions / 10);
  const double steps = (row_->usual.high - row_->usual.low) / row_->step;
  setSingleStep(row_->logarithmic
                    ? 10
                    : std::clamp(static_cast<int>(std::ceil(kPositions / steps)), 1, kPositions / 10));
  setFocusPolicy(Qt::StrongFocus);
  setMinimumWidth(40);
  setAccessibleName(tr("%1, slider").arg(fromView(row_->label)));
  markParameter(*this, row_->key);
  setToolTip(helpText(*row_));
  read();
  connect(&draft_, &Draft::valueChanged, this, [this](const QString& changed) {
    if (changed.toStdString() == row_->key) read();
  });
  connect(this, &QSlider::sliderPressed, this, [this] { token_ = draft_.newToken(); });
  connect(this, &QSlider::sliderReleased, this, [this] {
    token_ = 0;
    read();
  });
  connect(this, &QSlider::valueChanged, this, &ParameterSlider::write);
}

double ParameterSlider::toValue(int position) const {
  const double part = static_cast<double>(position) / kPositions;
  const auto [low, high] = row_->usual;
  double value;
  if (row_->logarithmic && low > 0) {
    value = low * std::pow(high / low, part);
    // Two to three digits are as fine as a slider can be.
    value = roundedTo(value, roundStep(value / 50));
  } else {
    value = roundedTo(low + (high - low) * part, row_->step);
  }
  if (row_->whole) value = std::round(value);
  return std::clamp(value, low, high);
}

int ParameterSlider::toPosition(double value) const {
  const auto [low, high] = row_->usual;
  const double part = row_->logarithmic && low > 0
                          ? std::log(std::max(value, low) / low) / std::log(high / low)
                          : (value - low) / (high - low);
  return static_cast<int>(std::lround(std::clamp(part, 0.0, 1.0) * kPositions));
}

void ParameterSlider::read() {
  if (isSliderDown()) return;
  const QSignalBlocker quiet(this);
  setValue(toPosition(std::get<double>(draft_.value(row_->key))));
}

void ParameterSlider::write(int position) {
  // Keys and clicks beside the handle make one step of the undo stack until the key is released.
  if (token_ == 0) token_ = draft_.newToken();
  draft_.setValue(row_->key, toValue(position), token_);
  if (!isSliderDown() && !hasFocus()) token_ = 0;
}

void ParameterSlider::keyReleaseEvent(QKeyEvent* event) {
  if (!event->isAutoRepeat() && !isSliderDown()) token_ = 0;
  QSlider::keyReleaseEvent(event);
}

void ParameterSlider::mouseReleaseEvent(QMouseEvent* event) {
  QSlider::mouseReleaseEvent(event);
  token_ = 0;
}

void ParameterSlider::wheelEvent(QWheelEvent* event) {
  if (hasFocus())
    QSlider::wheelEvent(event);
  else
    event->ignore();
}

}  // namespace trimtab::views
