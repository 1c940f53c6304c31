// SPDX-License-Identifier: GPL-3.0-or-later
#include <QCheckBox>
#include <QDockWidget>
#include <QPushButton>
#include <QUndoStack>

#include <algorithm>
#include <cmath>

#include "app/workbench/viewport/symbology_editor.h"
#include "gui_support.h"
#include "views/panels/symbology_panel.h"

namespace trimtab::test {
namespace {

class SymbologyDock : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    if (HasFatalFailure()) return;
    panel = w().panels().symbology;
    workbench::raiseDock(*panel);
    w().draft().setValue("symbology.enabled", true);
    panel->placeButton().click();
    ASSERT_TRUE(waitFor([&] { return box(Symbol::altitude).isValid(); }));
  }
  workbench::SymbologyEditor& editor() { return w().controllers().symbology->editor(); }
  QRectF box(Symbol symbol) { return editor().boxOf(static_cast<int>(symbol)); }
  double value(const char* key) { return std::get<double>(w().draft().value(key)); }
  void drag(QPoint from, QPoint to) {
    QTest::mousePress(&w().viewport(), Qt::LeftButton, {}, from);
    for (int i = 1; i <= 5; ++i) {
      const QPointF at = QPointF(from) + QPointF(to - from) * (i / 5.0);
      QMouseEvent move(QEvent::MouseMove, at, w().viewport().mapToGlobal(at), Qt::NoButton, Qt::LeftButton,
                       {});
      QCoreApplication::sendEvent(&w().viewport(), &move);
    }
    QTest::mouseRelease(&w().viewport(), Qt::LeftButton, {}, to);
  }

  views::SymbologyPanel* panel = nullptr;
};

TEST_F(SymbologyDock, movesASymbolByDraggingItAsOneUndoStep) {
  const QRectF before = box(Symbol::altitude);
  const double x = value("symbology.altitude.x"), y = value("symbology.altitude.y");
  const int steps = w().draft().undoStack().count();
  const Attitude looked = w().viewport().camera().attitude();
  const QPoint from = before.center().toPoint(), to = from + QPoint(-60, 40);
  drag(from, to);
  EXPECT_EQ(w().draft().undoStack().count(), steps + 1);
  EXPECT_EQ(w().draft().undoStack().undoText(), "Move Altitude");
  // Places are fractions of the image, which fills the viewport.
  EXPECT_NEAR(value("symbology.altitude.x"), x - 120.0 / w().viewport().width(), 0.002);
  EXPECT_NEAR(value("symbology.altitude.y"), y - 80.0 / w().viewport().height(), 0.002);
  EXPECT_EQ(w().viewport().camera().attitude(), looked) << "the camera is not turned by it";
  // The image follows.
  ASSERT_TRUE(
      waitFor([&] { return std::abs(box(Symbol::altitude).center().x() - (before.center().x() - 60)) < 2; }));
  EXPECT_NEAR(box(Symbol::altitude).center().y(), before.center().y() + 40, 2);
  w().draft().undoStack().undo();
  EXPECT_EQ(value("symbology.altitude.x"), x);
  EXPECT_EQ(value("symbology.altitude.y"), y);
}

TEST_F(SymbologyDock, resizesTheChosenSymbolByItsCorner) {
  const QRectF before = box(Symbol::airspeed);
  QTest::mouseClick(&w().viewport(), Qt::LeftButton, {}, before.center().toPoint());
  ASSERT_EQ(editor().selected(), static_cast<int>(Symbol::airspeed));
  const int steps = w().draft().undoStack().count();
  const QPointF out = before.center() + (before.bottomRight() - before.center()) * 1.5;
  drag(before.bottomRight().toPoint(), out.toPoint());
  EXPECT_NEAR(value("symbology.airspeed.size"), 1.5, 0.05);
  EXPECT_EQ(w().draft().undoStack().count(), steps + 1);
}

TEST_F(SymbologyDock, movesTheChosenSymbolByArrowKeysUntilEscape) {
  editor().select(static_cast<int>(Symbol::heading_tape));
  EXPECT_TRUE(panel->showBox(static_cast<int>(Symbol::heading_tape)).font().bold());
  const double x = value("symbology.heading_tape.x"), y = value("symbology.heading_tape.y");
  QTest::keyClick(&w().viewport(), Qt::Key_Right);
  EXPECT_GT(value("symbology.heading_tape.x"), x);
  const double once = value("symbology.heading_tape.x") - x;
  QTest::keyClick(&w().viewport(), Qt::Key_Left, Qt::ShiftModifier);
  EXPECT_NEAR(value("symbology.heading_tape.x"), x - 9 * once, 0.0056)
      << "places are rounded to a thousandth";
  QTest::keyClick(&w().viewport(), Qt::Key_Down);
  EXPECT_LT(value("symbology.heading_tape.y"), y);
  QTest::keyClick(&w().viewport(), Qt::Key_Escape);
  EXPECT_FALSE(editor().active());
  EXPECT_FALSE(panel->placeButton().isChecked());
  // The mouse moves the camera again.
  const Attitude looked = w().viewport().camera().attitude();
  const QPoint middle = w().viewport().rect().center();
  drag(middle, middle + QPoint(30, 0));
  EXPECT_NE(w().viewport().camera().attitude(), looked);
}

TEST_F(SymbologyDock, makesNothingAnewAtRest) {
  panel->placeButton().click();
  ASSERT_TRUE(settle());
  const auto before = last().counters.symbologyRedraws;
  EXPECT_GT(before, 0u);
  for (int i = 0; i < 5; ++i) {
    const auto painted = paints();
    w().viewport().invalidate();
    ASSERT_TRUE(waitFor([&] { return paints() > painted; }));
  }
  EXPECT_EQ(last().counters.symbologyRedraws, before);
  panel->showBox(static_cast<int>(Symbol::airspeed)).click();
  ASSERT_TRUE(waitFor([&] { return last().counters.symbologyRedraws == before + 1; }));
}

}  // namespace
}  // namespace trimtab::test
