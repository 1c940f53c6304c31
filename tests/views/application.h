// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <QApplication>
#include <QTest>
#include <QWidget>
#include <string_view>

#include "views/model/draft.h"

namespace trimtab::test {

/// Shows a widget on the offscreen platform and lets it lay itself out.
inline void expose(QWidget& widget, const QSize& size) {
  widget.resize(size);
  widget.show();
  static_cast<void>(QTest::qWaitForWindowExposed(&widget));
  QCoreApplication::processEvents();
}

inline CurvePoints curveOf(const views::Draft& draft, std::string_view key) {
  return std::get<CurvePoints>(draft.value(key));
}
inline BandList bandsOf(const views::Draft& draft) {
  return std::get<BandList>(draft.value("fuzzy.bands_px"));
}
inline double numberOf(const views::Draft& draft, std::string_view key) {
  return std::get<double>(draft.value(key));
}

/// Whether `holds` comes true while events are processed; patient, because machines are loaded.
template <class Predicate>
bool eventually(Predicate holds) {
  return QTest::qWaitFor(holds, 5000);
}

/// Press, `steps` moves and, unless it is to be held, release.
inline void drag(QWidget& widget, QPointF from, QPointF to, bool release = true, int steps = 8) {
  QTest::mousePress(&widget, Qt::LeftButton, Qt::NoModifier, from.toPoint());
  for (int i = 1; i <= steps; ++i) QTest::mouseMove(&widget, (from + (to - from) * i / steps).toPoint());
  if (release) QTest::mouseRelease(&widget, Qt::LeftButton, Qt::NoModifier, to.toPoint());
}

}  // namespace trimtab::test
