// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QEvent>
#include <QFrame>
#include <QLayout>
#include <QScrollArea>
#include <QString>

namespace trimtab::views {

/// A place without a frame that scrolls what may ask for more room than a small screen has.
///
/// Qt's own gives contents the height that they need at any width, which is one line for a text that wraps:
/// the rest of the text would be cut off. This one asks for the height at its width.
class ScrollPlace : public QScrollArea {
 protected:
  void resizeEvent(QResizeEvent* event) override {
    QScrollArea::resizeEvent(event);
    fitHeight();
  }
  bool eventFilter(QObject* watched, QEvent* event) override {
    const bool done = QScrollArea::eventFilter(watched, event);
    if (watched == widget() && event->type() == QEvent::LayoutRequest) fitHeight();
    return done;
  }

 private:
  void fitHeight() {
    QLayout* const layout = widget() != nullptr ? widget()->layout() : nullptr;
    if (layout != nullptr && layout->hasHeightForWidth())
      widget()->setMinimumHeight(layout->totalMinimumHeightForWidth(viewport()->width()));
  }
};

/// Returns a place that scrolls `content`. Screen readers say its name.
inline QScrollArea* scrollable(QWidget* content, const QString& name) {
  auto* area = new ScrollPlace;
  area->setFrameShape(QFrame::NoFrame);
  area->setWidgetResizable(true);
  area->setWidget(content);
  area->setAccessibleName(name);
  return area;
}

}  // namespace trimtab::views
