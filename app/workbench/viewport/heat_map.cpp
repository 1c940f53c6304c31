// SPDX-License-Identifier: GPL-3.0-or-later
#include "heat_map.h"

#include <QPainter>
#include <algorithm>
#include <array>
#include <cmath>

#include "app/harness/heat_colour.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

constexpr std::array<double, 6> kTicks{0, 0.01, 0.05, 0.2, 0.5, 1};
constexpr int kBarPx = 12, kGapPx = 6, kLegendSteps = 128;

}  // namespace

QImage heatImage(std::span<const float> errors, int width, int height) {
  if (width <= 0 || height <= 0 || errors.size() != std::size_t(width) * std::size_t(height)) return {};
  const std::vector<std::uint8_t> pixels = harness::heatPixels(errors);
  return QImage(pixels.data(), width, height, width * 4, QImage::Format_RGBX8888)
      .mirrored()
      .convertToFormat(QImage::Format_RGB32);
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
          ? tr("Nothing has been compared yet")
          : tr("FLIP, mean %1, largest %2").arg(views::numberText(mean, 4), views::numberText(largest, 3)));
  update();
}

void HeatMap::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  const QFontMetrics metrics(font());
  const QRect area = rect().adjusted(0, 0, 0, -(kBarPx + metrics.height() + 3 * kGapPx));
  int foot = area.bottom() + 1;  // the legend stands right below the map
  const QColor ink = palette().color(QPalette::Text);
  painter.setPen(ink);
  if (map_.isNull()) {
    painter.drawText(area, Qt::AlignCenter | Qt::TextWordWrap, tr("The difference appears here."));
  } else {
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    QRect to({}, map_.size().scaled(area.size(), Qt::KeepAspectRatio));
    to.moveCenter({area.center().x(), to.center().y()});
    painter.drawImage(to, map_);
    foot = to.bottom() + 1;
  }
  const QString title = tr("FLIP");
  const int left = metrics.horizontalAdvance(title) + 2 * kGapPx;
  const QRect bar(left, foot + kGapPx, std::max(1, width() - left - 4 * kGapPx), kBarPx);
  painter.drawText(QRect(kGapPx, bar.top() - 4, left, kBarPx + 8), Qt::AlignLeft | Qt::AlignVCenter, title);
  for (int i = 0; i < kLegendSteps; ++i) {
    const int from = bar.left() + bar.width() * i / kLegendSteps,
              to = bar.left() + bar.width() * (i + 1) / kLegendSteps;
    const double place = (i + 0.5) / kLegendSteps;
    const auto [red, green, blue] = harness::heatColour(place * place);
    painter.fillRect(from, bar.top(), to - from, bar.height(), QColor(red, green, blue));
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
