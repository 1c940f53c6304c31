// SPDX-License-Identifier: GPL-3.0-or-later
#include "heat_map.h"

#include <QPainter>
#include <algorithm>
#include <array>
#include <cmath>

#include "trimtab/views/theme.h"

namespace trimtab::workbench {
namespace {

struct Stop {
  double at;
  int red, green, blue;
};
constexpr std::array<Stop, 6> kStops{{{0.0, 0, 0, 0},
                                      {0.15, 24, 38, 92},
                                      {0.4, 60, 92, 148},
                                      {0.65, 196, 118, 70},
                                      {0.85, 244, 176, 64},
                                      {1.0, 255, 246, 186}}};
constexpr std::array<double, 6> kTicks{0, 0.01, 0.05, 0.2, 0.5, 1};
constexpr int kBarPx = 12, kGapPx = 6, kLegendSteps = 128;

QRgb colourAt(double place) {
  place = std::clamp(place, 0.0, 1.0);
  std::size_t i = 1;
  while (i + 1 < kStops.size() && place > kStops[i].at) ++i;
  const Stop &a = kStops[i - 1], &b = kStops[i];
  const double t = (place - a.at) / (b.at - a.at);
  const auto mix = [t](int from, int to) { return int(std::lround(from + (to - from) * t)); };
  return qRgb(mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue));
}

}  // namespace

QColor heatColour(double error) {
  return QColor::fromRgb(colourAt(std::sqrt(std::max(error, 0.0))));
}

QImage heatImage(std::span<const float> errors, int width, int height) {
  if (width <= 0 || height <= 0 || errors.size() != std::size_t(width) * std::size_t(height)) return {};
  std::array<QRgb, 1024> table;
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = colourAt(double(i) / double(table.size() - 1));
  QImage image(width, height, QImage::Format_RGB32);
  for (int y = 0; y < height; ++y) {
    auto* row = reinterpret_cast<QRgb*>(image.scanLine(height - 1 - y));
    const float* from = errors.data() + std::size_t(y) * std::size_t(width);
    for (int x = 0; x < width; ++x) {
      const float place = std::sqrt(std::clamp(from[x], 0.0f, 1.0f));
      row[x] = table[std::size_t(std::lround(place * float(table.size() - 1)))];
    }
  }
  return image;
}

HeatMap::HeatMap(QWidget* parent) : QWidget(parent) {
  setAccessibleName(tr("Map of differences"));
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void HeatMap::show(const QImage& map, double mean, double largest) {
  map_ = map;
  largest_ = largest;
  setAccessibleDescription(
      map.isNull()
          ? tr("Nothing is compared yet")
          : tr("FLIP, mean %1, largest %2").arg(views::numberText(mean, 4), views::numberText(largest, 3)));
  update();
}

void HeatMap::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  const QFontMetrics metrics(font());
  const int foot = kBarPx + metrics.height() + 3 * kGapPx;
  const QRect area = rect().adjusted(0, 0, 0, -foot);
  const QColor ink = palette().color(QPalette::Text);
  painter.setPen(ink);
  if (map_.isNull()) {
    painter.drawText(area, Qt::AlignCenter | Qt::TextWordWrap, tr("The difference stands here."));
  } else {
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    QRect to({}, map_.size().scaled(area.size(), Qt::KeepAspectRatio));
    to.moveCenter(area.center());
    painter.drawImage(to, map_);
  }
  const QString title = tr("FLIP");
  const int left = metrics.horizontalAdvance(title) + 2 * kGapPx;
  const QRect bar(left, area.bottom() + 1 + kGapPx, std::max(1, width() - left - 4 * kGapPx), kBarPx);
  painter.drawText(QRect(kGapPx, bar.top() - 4, left, kBarPx + 8), Qt::AlignLeft | Qt::AlignVCenter, title);
  for (int i = 0; i < kLegendSteps; ++i) {
    const int from = bar.left() + bar.width() * i / kLegendSteps,
              to = bar.left() + bar.width() * (i + 1) / kLegendSteps;
    painter.fillRect(from, bar.top(), to - from, bar.height(),
                     QColor::fromRgb(colourAt((i + 0.5) / kLegendSteps)));
  }
  painter.drawRect(bar.adjusted(0, 0, -1, -1));
  for (const double tick : kTicks) {
    const int x = bar.left() + int(std::lround((bar.width() - 1) * std::sqrt(tick)));
    painter.drawLine(x, bar.bottom(), x, bar.bottom() + 3);
    painter.drawText(QRect(x - 40, bar.bottom() + 4, 80, metrics.height()), Qt::AlignHCenter | Qt::AlignTop,
                     views::numberText(tick, 2));
  }
}

}  // namespace trimtab::workbench
