// SPDX-License-Identifier: GPL-3.0-or-later
#include <QAction>
#include <QDockWidget>
#include <QMenu>
#include <QMenuBar>
#include <QTabWidget>
#include <cmath>
#include <cstdlib>

#include "gui_support.h"
#include "tests/views/policy/policy_flight.h"
#include "trimtab/host/flight.h"
#include "views/policy/levers_view.h"
#include "views/policy/policy_panel.h"
#include "views/policy/signals_list.h"
#include "views/policy/term_plot.h"

namespace trimtab::test {
namespace {

class PolicyDock : public Bench {
 protected:
  views::PolicyPanel& panel() { return *w().panels().policy; }
  const views::PolicyPanel::Parts& parts() { return panel().parts(); }
  double lever(Lever which) { return session().decision().policy[which]; }
  double requestedErrorPx() { return w().controllers().frame->shown()->lod.screenSpaceError.value(); }
  void setPolicy(std::initializer_list<std::string> terms, std::initializer_list<std::string> rules) {
    test::setPolicy(w().draft(), terms, rules);
    ASSERT_FALSE(w().draft().isBroken()) << toString(w().draft().findings());
  }
  /// Saves a screenshot to look at if TRIMTAB_SHOTS names a folder.
  void shoot(const QString& name) {
    const char* folder = std::getenv("TRIMTAB_SHOTS");
    if (folder == nullptr) return;
    QTest::qWait(500);
    w().grab().save(QStringLiteral("%1/%2.png").arg(QLatin1String(folder), name));
    panel().grab().save(QStringLiteral("%1/%2-dock.png").arg(QLatin1String(folder), name));
  }
};

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
    plot.select(term, -1);
    const views::TermHandle at = plot.handles().at(handle);
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

TEST_F(PolicyDock, menusLeadToImportAndExport) {
  int found = 0;
  for (const QMenu* menu : w().menuBar()->findChildren<QMenu*>())
    for (const QAction* action : menu->actions())
      found += action->text().remove(QLatin1Char('&')).endsWith(QStringLiteral("port policy..."));
  EXPECT_EQ(found, 2);
}

TEST_F(PolicyDock, isLegibleAtEverySize) {
  test::setLargePolicy(w().draft());
  ASSERT_FALSE(w().draft().isBroken());
  w().dock(QStringLiteral("policy"))->raise();
  parts().signalsList->choose(Signal::speed);
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  const double climb = climbsThrough(*readFlight(sampleFlight()), 3000);
  for (const QSize size : {QSize(1280, 720), QSize(1920, 1080)}) {
    w().resize(size);
    for (int i = 0; i < 40; ++i) {
      w().feed().seekHere(climb + 0.25 * i);
      QTest::qWait(20);
    }
    for (int tab = 0; tab < parts().tabs->count(); ++tab) {
      parts().tabs->setCurrentIndex(tab);
      shoot(QStringLiteral("policy-%1-%2").arg(size.width()).arg(tab));
    }
    EXPECT_GE(parts().plot->width(), parts().plot->minimumSizeHint().width());
    EXPECT_GE(parts().plot->height(), parts().plot->minimumSizeHint().height());
  }
}

}  // namespace
}  // namespace trimtab::test
