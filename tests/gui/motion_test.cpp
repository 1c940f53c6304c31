// SPDX-License-Identifier: GPL-3.0-or-later
#include <QComboBox>
#include <QDockWidget>
#include <QLineEdit>
#include <QListWidget>
#include <QMessageBox>
#include <QMouseEvent>
#include <QPushButton>
#include <QScrollArea>
#include <QTableWidget>
#include <cmath>
#include <cstdlib>
#include <map>
#include <vector>

#include "app/link/link.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/window/workspaces.h"
#include "gui_support.h"
#include "trimtab/host/head_log.h"
#include "trimtab/motion/head_motion.h"
#include "views/controls/bar_list.h"
#include "views/panels/budget_panel.h"
#include "views/panels/frame_page.h"
#include "views/panels/motion_panel.h"
#include "views/panels/plots_panel.h"
#include "views/plots/budget_plot.h"
#include "views/plots/motion_plot.h"
#include "views/plots/time_plot.h"

namespace trimtab::test {
namespace {

using views::MotionPanel;

class Motion : public Bench {
 protected:
  MotionPanel& panel() { return *w().findChild<MotionPanel*>(); }
  bool saw(const QString& text) {
    for (int i = 0; i < panel().reasons().count(); ++i)
      if (panel().reasons().item(i)->text().contains(text)) return true;
    return false;
  }
  /// Saves a screenshot to look at if TRIMTAB_SHOTS names a folder.
  void shoot(const char* name) {
    const char* folder = std::getenv("TRIMTAB_SHOTS");
    if (folder == nullptr) return;
    w().grab().save(QStringLiteral("%1/%2.png").arg(QLatin1String(folder), QLatin1String(name)));
    panel().grab().save(QStringLiteral("%1/%2-dock.png").arg(QLatin1String(folder), QLatin1String(name)));
  }

  const ScratchDir dir_;
  const QString file_ = QString::fromStdString((dir_ / "trace.csv").string());
};

TEST_F(Motion, aSweepUnderTheFreeCameraFillsStacksLowersAndRaises) {
  workbench::raiseDock(panel());
  panel().sweepEdit().setText(QStringLiteral("180deg/1s/2s"));
  panel().sourceBox().setCurrentIndex(MotionPanel::sweep);
  emit panel().sourceBox().activated(MotionPanel::sweep);
  ASSERT_TRUE(waitFor([this] { return session().decision().motion.lodScale == 4; }));
  EXPECT_TRUE(waitFor([this] { return panel().stateText().startsWith(QLatin1String("Fast")); }));
  shoot("motion-sweep");
  EXPECT_TRUE(waitFor([this] { return session().decision().motion.lodScale == 1; }));
  EXPECT_TRUE(waitFor([this] { return saw(QStringLiteral("slow for more than 5 frames")); }));
  EXPECT_TRUE(saw(QStringLiteral("fast for 10 frames (")));
  EXPECT_TRUE(saw(QStringLiteral(" deg/s against 60.0): detail lowered, LOD scale 2, blur for 400 ms")));
  shoot("motion-rest");

  panel().sourceBox().setCurrentIndex(MotionPanel::none);
  emit panel().sourceBox().activated(MotionPanel::none);
  EXPECT_FALSE(session().input().state.head);
  EXPECT_TRUE(settle()) << "at rest nothing is painted";
}

TEST_F(Motion, anEditLeavesTheRateOfTheHeadInEveryFrame) {
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  w().feed().useHeadLog(*parseSweep("sweep:120/1s/0.2"));
  w().panels().flight->play();
  std::map<double, std::vector<double>> rates;  // of the frames that a state is shown in, by its time
  std::size_t fast = 0;
  QObject ends;
  QObject::connect(w().controllers().frame.get(), &workbench::FrameController::frameShown, &ends,
                   [&](const views::LiveFrame& frame) {
                     rates[frame.input.state.time].push_back(frame.decision.motion.rateDegPerS);
                     fast += frame.decision.motion.rateDegPerS > 100;
                   });
  // As a slider does it: many values, each for some packets.
  const views::MergeToken drag = w().draft().newToken();
  int edits = 0;
  EXPECT_TRUE(waitFor([&] {
    w().draft().setValue("lod.screen_space_error_px", 1 + 0.1 * (++edits % 20), drag);
    return edits > 200 && fast > 100;
  }));
  std::size_t shownTwice = 0;
  for (const auto& [time, all] : rates) {
    shownTwice += all.size() > 1;
    for (const double rate : all) ASSERT_EQ(rate, all.front()) << "at " << time << " s";
  }
  EXPECT_GT(shownTwice, 10u) << "or no frame was shown after an edit";
}

TEST_F(Motion, aSweepIsRecordedAndFlownAgainWithItsLineOfSight) {
  auto& budget = *w().findChild<views::BudgetPanel*>();
  workbench::raiseDock(panel());
  panel().sweepEdit().setText(QStringLiteral("180deg/1s/2s"));
  panel().sourceBox().setCurrentIndex(MotionPanel::sweep);
  emit panel().sourceBox().activated(MotionPanel::sweep);
  ASSERT_TRUE(w().controllers().trace->start(file_));
  const std::uint64_t before = paints();
  ASSERT_TRUE(waitFor([&] { return session().decision().motion.lodScale == 4 && paints() > before + 4; }));
  w().controllers().trace->stop();
  panel().sourceBox().setCurrentIndex(MotionPanel::none);
  emit panel().sourceBox().activated(MotionPanel::none);
  ASSERT_FALSE(session().input().state.head);
  w().dock(QStringLiteral("budget"))->raise();
  ASSERT_TRUE(waitFor([&] { return budget.replayButton().isEnabled(); }));
  budget.replayButton().click();
  EXPECT_TRUE(waitFor([this] {
    const auto& head = session().input().state.head;
    return head && std::abs(head->heading.value()) > 20;
  }));
  EXPECT_TRUE(waitFor([&] { return budget.comparisonText().contains(QLatin1String("Flown again")); }));
  shoot("budget-flown-again");
}

TEST_F(Motion, theDockBudgetSaysWhatHeldTheFrameAndWhatEachLeverGave) {
  auto& budget = *w().findChild<views::BudgetPanel*>();
  w().resize(1280, 720);
  w().workspaces().show(1);
  w().workspaces().reset();
  w().dock(QStringLiteral("budget"))->raise();
  panel().sweepEdit().setText(QStringLiteral("180deg/1s/2s"));
  panel().sourceBox().setCurrentIndex(MotionPanel::sweep);
  emit panel().sourceBox().activated(MotionPanel::sweep);
  const auto flies = [&](std::uint64_t images) {
    const std::uint64_t from = paints();
    return waitFor([&, from] { return paints() >= from + images; });
  };
  ASSERT_TRUE(flies(60));
  const double ms = w().controllers().frame->lastCost().total;
  ASSERT_TRUE(
      w().draft()
          .setText("measure.budget_ms", QString::number(std::max(0.6 * ms, 0.2), 'f', 1).toStdString())
          .empty());
  ASSERT_TRUE(w().controllers().trace->start(file_));
  ASSERT_TRUE(flies(100));
  w().controllers().trace->stop();
  budget.modeChoice().setCurrentText(QStringLiteral("with the budget held"));
  budget.replayButton().click();
  EXPECT_TRUE(w().draft().parameters().hold.enabled);
  const auto gave = [&](int row) { return QLocale().toDouble(budget.levers().item(row, 3)->text()); };
  EXPECT_TRUE(waitFor([&] { return gave(0) + gave(4) > 0; })) << budget.stateText().toStdString();
  EXPECT_TRUE(waitFor([&] { return budget.residualsText().contains(QLatin1String("Three images")); }));
  EXPECT_GT(budget.reasons().count(), 0);
  QTest::qWait(1000);
  shoot("budget-held");
  if (const char* folder = std::getenv("TRIMTAB_SHOTS"))
    budget.grab().save(QStringLiteral("%1/budget-held-panel.png").arg(QLatin1String(folder)));
}

TEST_F(Motion, plotsOnTheClockOfTheFramesShareThePointerAndExplainAFrame) {
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  auto* const plots = w().findChild<views::PlotsPanel*>();
  views::ClockPlot* const others[] = {&w().findChild<views::BudgetPanel*>()->plot(),
                                      &w().findChild<views::MotionPanel*>()->plot()};
  for (views::ClockPlot* plot : others) {
    workbench::raiseDock(*plot);
    for (QWidget* each = plot->parentWidget(); each != nullptr; each = each->parentWidget())
      if (auto* area = qobject_cast<QScrollArea*>(each)) area->ensureWidgetVisible(plot);
    w().controllers().flight->flightDock().play();
    const std::uint64_t before = plots->buffer().end();
    ASSERT_TRUE(waitFor([&] { return plots->buffer().end() > before + 20; }));
    w().controllers().flight->flightDock().pause();
    ASSERT_TRUE(settle());
    ASSERT_FALSE(plot->visibleRegion().isEmpty());
    const std::uint64_t frame = plots->buffer().end() - 10;
    const double time = plots->buffer().time(frame);
    QTest::qWait(300);  // the plot is drawn some times a second
    const QPoint at(int(std::lround(plot->xAxis->coordToPixel(time))), plot->xAxis->axisRect()->center().y());
    QTest::mouseMove(plot, at);
    const double secondsPerPx = plot->xAxis->range().size() / plot->xAxis->axisRect()->width();
    for (const views::ClockPlot* each :
         {static_cast<views::ClockPlot*>(&plots->plot()), others[0], others[1]}) {
      ASSERT_TRUE(waitFor([&] { return each->tracker().has_value(); }, 5000))
          << each->accessibleName().toStdString();
      EXPECT_NEAR(*each->tracker(), time, secondsPerPx);
    }
    QTest::mouseClick(plot, Qt::LeftButton, {}, at);
    const std::optional<std::uint64_t> explained = plots->findChild<views::FramePage*>()->frame();
    ASSERT_TRUE(explained);
    EXPECT_NEAR(plots->buffer().time(*explained), time, secondsPerPx + 0.2);
    EXPECT_FALSE(plots->visibleRegion().isEmpty()) << "the dock with the explanation is in front";
    QTest::mouseMove(plot, QPoint(1, 1));
    EXPECT_TRUE(waitFor([&] { return !plots->plot().tracker(); }, 5000))
        << "beside the axes there is no time";
  }
}

TEST_F(Motion, thePointerOverThePictureIsTheLineOfSight) {
  emit panel().sourceAsked(MotionPanel::pointer);
  EXPECT_EQ(panel().source(), MotionPanel::pointer);
  workbench::Viewport& view = w().viewport();
  // Events are sent directly, because a person may hold the screen's own pointer.
  const auto moveTo = [&view](int x) {
    const QPointF at(x, view.height() / 2);
    QMouseEvent event(QEvent::MouseMove, at, view.mapToGlobal(at), Qt::NoButton, Qt::NoButton,
                      Qt::NoModifier);
    QCoreApplication::sendEvent(&view, &event);
  };
  EXPECT_TRUE(view.hasMouseTracking());
  // From edge to edge in half a second, as fast as events come; again where the machine was too busy to draw
  // meanwhile.
  const auto lowered = [this] { return saw(QStringLiteral("detail lowered")); };
  for (int sweep = 0; sweep < 20 && !lowered(); ++sweep) {
    const double start = link::now();
    for (double t = 0; t < 0.5; t = link::now() - start) {
      const double across = sweep % 2 == 0 ? t / 0.5 : 1 - t / 0.5;
      moveTo(static_cast<int>(across * (view.width() - 1)));
      QTest::qWait(10);
    }
  }
  EXPECT_TRUE(lowered());
  moveTo(view.width() - 1);
  EXPECT_TRUE(waitFor([this] { return session().decision().motion.lodScale == 1; })) << "and is restored";
  ASSERT_TRUE(session().input().state.head);
  // On a busy machine the docks, and so the view, may have got their size meanwhile.
  EXPECT_TRUE(waitFor([&] {
    moveTo(view.width() - 1);
    return std::abs(session().input().state.head->heading.value() - 90) < 1;
  })) << session().input().state.head->heading.value();
  EXPECT_TRUE(settle()) << "the pointer rests: nothing is painted";
}

TEST_F(Motion, aLogBeginsWithTheFlight) {
  ScratchDir dir;
  std::string text = "time_s,head_heading_deg,head_pitch_deg\n";
  for (int i = 0; i < 6000; ++i) text += std::to_string(i * 0.1) + "," + std::to_string(i * 0.5) + ",0\n";
  writeFile(dir / "head.csv", text);
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  w().feed().seekHere(30);
  ASSERT_TRUE(w().controllers().head->open(QString::fromStdString((dir / "head.csv").string())));
  EXPECT_EQ(panel().source(), MotionPanel::log);
  w().feed().playHere();
  ASSERT_TRUE(waitFor([this] { return w().feed().playback().position() > 30.3; }));
  w().feed().pauseHere();
  const AircraftState& state = session().input().state;
  EXPECT_NEAR(state.head->heading.value(),
              std::remainder((state.time - w().feed().playback().flight().beginS()) * 5, 360), 1e-6);
}

TEST_F(Motion, rowsThatCannotBeUsedAreLeftOutWhereOneAgrees) {
  ScratchDir dir;
  std::string text = "time_s,head_heading_deg,head_pitch_deg\n";
  for (int i = 0; i < 100; ++i)
    text += std::to_string(i * 0.1) + "," + std::to_string(i) + (i >= 50 && i < 55 ? ",95\n" : ",0\n");
  writeFile(dir / "head.csv", text);
  const QString file = QString::fromStdString((dir / "head.csv").string());
  const auto question = [this] { return w().findChild<QMessageBox*>(QStringLiteral("badRows")); };

  EXPECT_FALSE(w().controllers().head->open(file));
  EXPECT_EQ(panel().source(), MotionPanel::host);
  ASSERT_NE(question(), nullptr);
  EXPECT_EQ(question()->text(), QStringLiteral("5 rows of head.csv cannot be used."));
  const QString rows = question()->informativeText();
  EXPECT_TRUE(
      rows.contains(QStringLiteral("head.csv:52: head_pitch_deg: expected a pitch of -90 to 90 deg")));
  EXPECT_FALSE((rows + w().messages().text()).contains(QStringLiteral("--"))) << rows.toStdString();
  question()->button(QMessageBox::Cancel)->click();
  ASSERT_TRUE(waitFor([&] { return question() == nullptr; }));
  EXPECT_EQ(panel().source(), MotionPanel::host);

  EXPECT_FALSE(w().controllers().head->open(file));
  ASSERT_NE(question(), nullptr);
  for (QAbstractButton* button : question()->buttons())
    if (button->text().remove(QLatin1Char('&')) == QStringLiteral("Leave 5 rows out")) {
      button->click();
      break;
    }
  EXPECT_EQ(panel().source(), MotionPanel::log);
  EXPECT_EQ(session().head().log().samples.size(), 95u);
  EXPECT_TRUE(w().messages().text().contains(QStringLiteral("5 bad rows of 100: they are left out")));
}

TEST_F(Motion, aBadLogChangesNothingAndIsExplained) {
  EXPECT_FALSE(w().controllers().head->open(QStringLiteral("sweep:fast")));
  EXPECT_EQ(panel().source(), MotionPanel::host);
  EXPECT_TRUE(w().messages().text().contains(QStringLiteral("sweep:DEGREES/SECONDS")));
  EXPECT_EQ(w().findChild<QMessageBox*>(QStringLiteral("badRows")), nullptr)
      << "there are no rows to leave out";
}

}  // namespace
}  // namespace trimtab::test
