// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QFrame>
#include <QScrollArea>
#include <QString>

namespace trimtab::views {

/// Returns a place without a frame that scrolls what may ask for more room than a small screen has. Screen
/// readers say its name.
inline QScrollArea* scrollable(QWidget* content, const QString& name) {
  auto* area = new QScrollArea;
  area->setFrameShape(QFrame::NoFrame);
  area->setWidgetResizable(true);
  area->setWidget(content);
  area->setAccessibleName(name);
  return area;
}

}  // namespace trimtab::views
