// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth_map_inset.h"

#include <QPainter>

#include "views/model/theme.h"

namespace trimtab::views {

DepthMapInset::DepthMapInset(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setAccessibleName(tr("Depth map of the last frame"));
}

void DepthMapInset::setImage(const QImage& image, const QString& caption) {
  image_ = image;
  text_ = caption;
  setAccessibleDescription(caption);
  update();
}

void DepthMapInset::setReason(const QString& why) {
  if (image_.isNull() && text_ == why) return;
  image_ = {};
  text_ = why;
  setAccessibleDescription(why);
  update();
}

void DepthMapInset::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const QColor base = palette().color(QPalette::Base), ink = palette().color(QPalette::Text);
  painter.fillRect(rect(), base);
  if (image_.isNull()) {
    painter.setPen(quietColour(palette()));
    painter.drawText(rect().adjusted(8, 8, -8, -8), Qt::AlignCenter | Qt::TextWordWrap, text_);
  } else {
    const int line = fontMetrics().height() + 6;
    const QRect space = rect().adjusted(0, 0, 0, -line);
    const QSize size = image_.size().scaled(space.size(), Qt::KeepAspectRatio);
    const QRect place(QPoint(space.center().x() - size.width() / 2, space.top()), size);
    painter.setRenderHint(QPainter::SmoothPixmapTransform, size.width() < image_.width());
    painter.drawImage(place, image_);
    painter.setPen(ink);
    painter.drawText(rect().adjusted(4, rect().height() - line, -4, 0), Qt::AlignCenter,
                     fontMetrics().elidedText(text_, Qt::ElideRight, width() - 8));
  }
  painter.setPen(blend(base, ink, 0.3));
  painter.drawRect(rect().adjusted(0, 0, -1, -1));
}

}  // namespace trimtab::views
