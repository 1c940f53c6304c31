// SPDX-License-Identifier: GPL-3.0-or-later
#include "hand.h"
#include "policy_dock.h"

#include <QAction>
#include <cmath>
#include <cstdlib>

#include "tests/views/dark_palette.h"
#include "trimtab/host/flight.h"
#include "views/policy/policy_rules_model.h"
#include "views/policy/rules_page.h"

namespace trimtab::test {
namespace {

TEST_F(PolicyDock, aTermDraggedWhileAFlightPlaysMovesTheLeverAndTheRequest) {
  setPolicy(
      {"altitude low = ramp 5000 4000", "altitude high = ramp 4000 5000"},
      {"if altitude is low then screen_space_error = 2", "if altitude is high then screen_space_error = 8"});
  w().dock(QStringLiteral("policy"))->raise();
  parts().signalsList->choose(Signal::altitude);
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  w().feed().seekHere(climbsThrough(*readFlight(sampleFlight()), 2500));
  w().feed().playHere();
  // Low: the rule for low alone sets the error.
  ASSERT_TRUE(waitFor([&] { return std::abs(lever(Lever::screen_space_error) - 2) < 0.01; }));
  ASSERT_TRUE(waitFor([&] { return std::abs(requestedErrorPx() - 2) < 0.01; }));
  views::TermPlot& plot = *parts().plot;
  ASSERT_TRUE(waitFor([&] { return !plot.visibleRegion().isEmpty(); }));
  // The feet of `low`, then the top of `high`, far below the aircraft, in the air all the while.
  const int steps = w().draft().undoStack().index();
  const auto drag = [&](int term, std::size_t handle, double toFt) {
    plot.selectTerm(term, -1);
    const views::EditPoint at = plot.points().at(handle);
    const QPoint from = plot.pixelOf(at.x, at.y).toPoint(), to = plot.pixelOf(toFt, at.y).toPoint();
    QTest::mousePress(&plot, Qt::LeftButton, Qt::NoModifier, from);
    for (int i = 1; i <= 10; ++i) {
      QTest::mouseMove(&plot, from + (to - from) * i / 10);
      QTest::qWait(20);
    }
    QTest::mouseRelease(&plot, Qt::LeftButton, Qt::NoModifier, to);
  };
  plot.xAxis->setRange(0, 6000);
  drag(1, 0, 500);
  drag(1, 1, 1500);
  EXPECT_EQ(w().draft().undoStack().index(), steps + 2) << "one drag is one step";
  EXPECT_TRUE(waitFor([&] { return std::abs(lever(Lever::screen_space_error) - 5) < 0.05; }))
      << lever(Lever::screen_space_error) << ": both fire fully";
  EXPECT_TRUE(waitFor([&] { return std::abs(requestedErrorPx() - 5) < 0.05; })) << requestedErrorPx();
  parts().tabs->setCurrentIndex(2);
  EXPECT_TRUE(waitFor([&] {
    return parts().levers->lines()[1].contains(QStringLiteral("rule 1 50 %, rule 2 50 %"));
  })) << parts().levers->lines()[1].toStdString();
  w().feed().pauseHere();
  w().draft().undoStack().undo();
  w().draft().undoStack().undo();
  EXPECT_TRUE(waitFor([&] { return std::abs(requestedErrorPx() - 2) < 0.01; })) << "undone";
  EXPECT_TRUE(settle()) << "at rest nothing is painted";
}

TEST_F(PolicyDock, aRuleIsDraggedToAnotherPlaceByTheMouse) {
  const std::vector<std::string> rules{"if altitude is low then screen_space_error = 2",
                                       "if altitude is high then screen_space_error = 8",
                                       "if altitude is high then lod_scale = 2"};
  setPolicy({"altitude low = ramp 5000 4000", "altitude high = ramp 4000 5000"}, rules);
  w().dock(QStringLiteral("policy"))->raise();
  parts().signalsList->choose(Signal::altitude);
  parts().tabs->setCurrentWidget(parts().rules);
  QTableView& table = parts().rules->table();
  ASSERT_TRUE(waitFor([&] { return !table.visibleRegion().isEmpty(); }));
  const int steps = w().draft().undoStack().index();
  const auto rowAt = [&](int row, int fromTopPx) {
    const QRect cell = table.visualRect(table.model()->index(row, views::PolicyRulesModel::kCondition));
    return QPoint(cell.left() + 30, fromTopPx < 0 ? cell.bottom() + fromTopPx : cell.top() + fromTopPx);
  };
  Hand hand(w());
  hand.carry(*table.viewport(), rowAt(0, 8), rowAt(2, -1), "the first rule");
  const auto now = [&] { return w().draft().parameters().policy.rules.line; };
  EXPECT_EQ(now(), (std::vector<std::string>{rules[1], rules[2], rules[0]})) << "below the last one";
  EXPECT_EQ(w().draft().undoStack().index(), steps + 1) << "one drag is one step";
  EXPECT_EQ(table.currentIndex().row(), 2) << "it stays selected";
  hand.carry(*table.viewport(), rowAt(2, 8), rowAt(1, 1), "the last rule");
  EXPECT_EQ(now(), (std::vector<std::string>{rules[1], rules[0], rules[2]})) << "between two others";
  w().draft().undoStack().undo();
  w().draft().undoStack().undo();
  EXPECT_EQ(now(), rules);
}

TEST_F(PolicyDock, menusLeadToImportAndExport) {
  int found = 0;
  for (const QAction* action : commands()) {
    const QString text = action->text().remove(QLatin1Char('&'));
    found += text == QStringLiteral("Import...") || text == QStringLiteral("Export policy...");
  }
  EXPECT_EQ(found, 2);
}

/// Looks at the dock in both sizes and both themes, with every page, and writes a picture of each to the
/// folder that TRIMTAB_SHOTS names.
class PolicyDockLook : public PolicyDock {
 protected:
  void TearDown() override {
    QApplication::setPalette(light_);
    PolicyDock::TearDown();
  }
  void shoot(const QString& name) {
    const char* folder = std::getenv("TRIMTAB_SHOTS");
    if (folder == nullptr) return;
    QTest::qWait(500);
    w().grab().save(QStringLiteral("%1/%2-%3x%4-%5.png")
                        .arg(QLatin1String(folder), theme_)
                        .arg(w().width())
                        .arg(w().height())
                        .arg(name));
  }
  /// Nothing of a page may hide behind the edge of the dock.
  void expectWhole(const QWidget& widget, const char* what) {
    for (const QWidget* around = widget.parentWidget(); around != nullptr; around = around->parentWidget()) {
      const QRect inside(widget.mapTo(around, QPoint(0, 0)), widget.size());
      EXPECT_TRUE(around->rect().contains(inside)) << what << " at " << w().width() << " x " << w().height();
      if (around->isWindow()) break;
    }
  }
  void lookAtAll(const QSize& size) {
    w().resize(size);
    const double climb = climbsThrough(*readFlight(sampleFlight()), 3000);
    for (int i = 0; i < 40; ++i) {
      w().feed().seekHere(climb + 0.25 * i);
      QTest::qWait(20);
    }
    for (int page = 0; page < parts().tabs->count(); ++page) {
      parts().tabs->setCurrentIndex(page);
      QTest::qWait(50);
      shoot(parts().tabs->tabText(page).section(QLatin1Char(' '), 0, 0).toLower());
      expectWhole(*parts().tabs, "the pages");
      if (page == 0 || size.height() >= 1000) {
        expectWhole(*parts().plot, "the plot");
        EXPECT_GE(parts().plot->height(), 100);
      }
      EXPECT_GE(parts().tabs->currentWidget()->height(), 7 * w().fontMetrics().height());
    }
    parts().signalsList->choose(std::nullopt);
    QTest::qWait(50);
    shoot(QStringLiteral("scheme"));
    parts().signalsList->choose(Signal::speed);
  }

  const QPalette light_ = QApplication::palette();
  QString theme_ = QStringLiteral("light");
};

TEST_F(PolicyDockLook, isWholeAtEverySizeAndInBothThemes) {
  test::setLargePolicy(w().draft());
  ASSERT_FALSE(w().draft().isBroken());
  w().dock(QStringLiteral("policy"))->raise();
  parts().signalsList->choose(Signal::speed);
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  for (const QSize size : {QSize(1280, 720), QSize(1920, 1080)}) lookAtAll(size);
  if (std::getenv("TRIMTAB_SHOTS") == nullptr) return;
  theme_ = QStringLiteral("dark");
  QApplication::setPalette(darkPalette());
  for (const QSize size : {QSize(1280, 720), QSize(1920, 1080)}) lookAtAll(size);
}

}  // namespace
}  // namespace trimtab::test
