// SPDX-License-Identifier: GPL-3.0-or-later
#include <QApplication>
#include <QDir>
#include <QElapsedTimer>
#include <QFontDatabase>
#include <QMouseEvent>
#include <QStyleFactory>
#include <QTabWidget>
#include <QThread>
#include <QTimer>
#include <array>
#include <clocale>
#include <cstdio>
#include <ctime>

#include "live_flight.h"
#include "tests/views/dark_palette.h"
#include "tests/views/policy/policy_flight.h"
#include "views/controls/parameter_table.h"
#include "views/editors/band_scale.h"
#include "views/editors/bands_editor.h"
#include "views/editors/curve_plot.h"
#include "views/editors/membership_editor.h"
#include "views/panels/decision_panel.h"
#include "views/panels/plots_panel.h"
#include "views/plots/surface_plot.h"
#include "views/plots/time_plot.h"
#include "views/policy/policy_panel.h"
#include "views/policy/signals_list.h"
#include "views/policy/term_plot.h"

// Draws every dock with live data into PNG files, for a person to look at: views_gallery DIR [dark].
namespace {

using namespace trimtab;
using namespace trimtab::views;

void settle(int ms = 120) {
  QElapsedTimer timer;
  timer.start();
  while (timer.elapsed() < ms) QCoreApplication::processEvents(QEventLoop::AllEvents, 10);
}

void hover(QWidget& widget, QPointF at) {
  QMouseEvent event(QEvent::MouseMove, at, widget.mapToGlobal(at), Qt::NoButton, Qt::NoButton,
                    Qt::NoModifier);
  QApplication::sendEvent(&widget, &event);
}

double cpuSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// What the docks cost the main thread, all in sight and fed at 60 Hz, then left alone, then edited.
void measure(Draft& draft, test::LiveFlight& flight) {
  MembershipEditor memberships(draft);
  BandsEditor bands(draft);
  DecisionPanel decision(draft);
  PlotsPanel plots(draft);
  ParameterTable parameters(draft);
  const std::array<QWidget*, 5> all{&memberships, &bands, &decision, &plots, &parameters};
  for (QWidget* widget : all) {
    widget->resize(520, 560);
    widget->show();
  }
  for (int i = 0; i < 3600; ++i) plots.showFrame(flight.next(draft.active()));
  settle(500);
  QElapsedTimer timer;
  timer.start();
  double cpu = cpuSeconds();
  int frames = 0;
  while (timer.elapsed() < 5000) {
    const LiveFrame frame = flight.next(draft.active());
    memberships.showFrame(frame);
    bands.showFrame(frame);
    decision.showFrame(frame);
    plots.showFrame(frame);
    ++frames;
    while (timer.elapsed() < frames * 1000 / 60) {
      QCoreApplication::processEvents();
      QThread::msleep(1);
    }
  }
  std::printf("live at %.1f Hz: %.1f %% of a core\n", frames / 5.0, 20 * (cpuSeconds() - cpu));
  settle(300);
  cpu = cpuSeconds();
  QTimer::singleShot(3000, qApp, &QCoreApplication::quit);
  QCoreApplication::exec();
  std::printf("idle: %.2f %% of a core\n", 100 * (cpuSeconds() - cpu) / 3);
  cpu = cpuSeconds();
  const MergeToken token = draft.newToken();
  for (int i = 0; i < 200; ++i) {
    draft.setValue("lod.scale", 1 + 0.01 * i, token);
    QCoreApplication::processEvents();
  }
  std::printf("an edit: %.2f ms\n", 1000 * (cpuSeconds() - cpu) / 200);
  draft.resetAll();
}

void shoot(QWidget& widget, const QSize& size, const QString& file);

/// The dock Plots with its details: values, one frame explained, signals; and with marks.
void shootPlots(PlotsPanel& plots, Draft& draft, test::LiveFlight& flight, const QDir& dir) {
  plots.setCursors(true);
  settle(700);
  shoot(plots, {1280, 300}, dir.filePath(QStringLiteral("plots_values.png")));
  shoot(plots, {680, 700}, dir.filePath(QStringLiteral("plots_cursors.png")));
  plots.setCursors(false);
  LiveFrame slow = flight.next(draft.active());
  slow.cost.draw += 743 - slow.cost.total;
  slow.cost.total = 743;
  plots.showFrame(slow);
  const double now = plots.buffer().time(plots.buffer().end() - 1);
  for (int i = 0; i < 600; ++i) plots.showFrame(flight.next(draft.active()));
  plots.mark(PlotMarks::Kind::host_silent, true, now - 30);
  plots.mark(PlotMarks::Kind::host_silent, false, now - 15);
  plots.mark(PlotMarks::Kind::recording, true, now - 10);
  plots.plot().refresh(true);
  plots.chooseSpike(1);
  shoot(plots, {1280, 420}, dir.filePath(QStringLiteral("plots_frame.png")));
  plots.plot().addSignal(1, Trace::altitude_ft);
  plots.plot().addLane({{Trace::tiles_drawn, Trace::tiles_hidden, Trace::tiles_outside}});
  shoot(plots, {640, 640}, dir.filePath(QStringLiteral("plots_signals.png")));
  plots.savePicture(dir.filePath(QStringLiteral("plots_saved.svg")));
  plots.plot().setLanes(standardLanes());
}

void shoot(QWidget& widget, const QSize& size, const QString& file) {
  widget.resize(size);
  widget.show();
  settle();
  widget.grab().save(file);
  std::printf("%s\n", qPrintable(file));
}

/// The Policy dock: empty, with forty rules on every page, and small.
void shootPolicy(const QDir& dir) {
  Draft draft;
  PolicyPanel panel(draft);
  shoot(panel, {572, 520}, dir.filePath(QStringLiteral("policy_empty.png")));
  test::setLargePolicy(draft);
  panel.parts().signalsList->choose(Signal::speed);
  panel.parts().plot->selectTerm(13, 1);
  test::PolicyFlight flight;
  const auto fly = [&](int frames) {
    for (int i = 0; i < frames; ++i) {
      panel.showFrame(flight.next(draft.active()));
      settle(2);
    }
  };
  fly(900);
  for (int tab = 0; tab < panel.parts().tabs->count(); ++tab) {
    panel.parts().tabs->setCurrentIndex(tab);
    fly(10);
    settle(500);
    shoot(panel, {572, 720}, dir.filePath(QStringLiteral("policy_%1.png").arg(tab)));
  }
  panel.parts().tabs->setCurrentIndex(1);
  shoot(panel, {460, 380}, dir.filePath(QStringLiteral("narrow_policy.png")));
  draft.setText("policy.terms", "above_ground low = ramp 2000 1000 | speed fast = ramp 400 400");
  shoot(panel, {572, 720}, dir.filePath(QStringLiteral("policy_broken.png")));
}

}  // namespace

int main(int argc, char** argv) {
  QApplication app(argc, argv);
  std::setlocale(LC_NUMERIC, "C");
  if (argc < 2) return 2;
  app.setStyle(QStyleFactory::create(QStringLiteral("Fusion")));
  if (argc > 2) app.setPalette(test::darkPalette());
  const QDir dir(QString::fromLocal8Bit(argv[1]));
  dir.mkpath(QStringLiteral("."));
  shootPolicy(dir);

  Draft draft;
  test::LiveFlight flight(14);
  MembershipEditor memberships(draft);
  for (int i = 0; i < 60; ++i) memberships.showFrame(flight.next(draft.active()));
  memberships.altitude().plot().select(1);
  memberships.resize(480, 560);
  memberships.show();
  settle();
  hover(memberships.altitude().plot(), memberships.altitude().plot().pixelOf({6500, 0.5}));
  memberships.altitude().plot().setFocus();
  shoot(memberships, {480, 560}, dir.filePath(QStringLiteral("memberships.png")));
  draft.setValue("fuzzy.altitude.reading", ChoiceIndex{2});
  draft.setValue("fuzzy.pitch.reading", ChoiceIndex{1});
  shoot(memberships, {640, 560}, dir.filePath(QStringLiteral("memberships_as_printed.png")));

  BandsEditor bands(draft);
  for (int i = 0; i < 60; ++i) bands.showFrame(flight.next(draft.active()));
  bands.scale().select(1);
  shoot(bands, {480, 560}, dir.filePath(QStringLiteral("bands.png")));
  draft.setValue("fuzzy.hysteresis", 0.3);
  shoot(bands, {480, 560}, dir.filePath(QStringLiteral("bands_broken.png")));
  draft.resetAll();

  measure(draft, flight);
  shoot(memberships, {300, 480}, dir.filePath(QStringLiteral("narrow_memberships.png")));
  draft.setValue("fuzzy.hysteresis", 0.05);
  shoot(bands, {300, 480}, dir.filePath(QStringLiteral("narrow_bands.png")));

  ParameterTable parameters(draft);
  draft.setValue("fuzzy.hysteresis", 0.3);
  draft.setValue("lod.scale", 30.0);
  shoot(parameters, {520, 760}, dir.filePath(QStringLiteral("parameters.png")));
  shoot(parameters, {340, 560}, dir.filePath(QStringLiteral("narrow_parameters.png")));
  draft.resetAll();

  SurfacePlot surface(draft);
  for (int i = 0; i < 6000; ++i) {
    const LiveFrame frame = flight.next(draft.active());
    surface.showFrame(frame);
  }
  for (std::size_t combination = 0; combination < 2; ++combination) {
    draft.setValue("fuzzy.combination", ChoiceIndex{combination});
    hover(surface, {200, 150});
    shoot(surface, {560, 420},
          dir.filePath(combination == 0 ? QStringLiteral("surface_sum.png")
                                        : QStringLiteral("surface_twice_minimum.png")));
  }
  draft.resetAll();

  DecisionPanel decision(draft);
  for (int i = 0; i < 6000; ++i) decision.showFrame(flight.next(draft.active()));
  shoot(decision, {300, 420}, dir.filePath(QStringLiteral("narrow_decision.png")));
  shoot(decision, {520, 520}, dir.filePath(QStringLiteral("decision.png")));

  PlotsPanel plots(draft);
  for (int i = 0; i < 60 * 90; ++i) plots.showFrame(flight.next(draft.active()));
  shoot(plots, {300, 400}, dir.filePath(QStringLiteral("narrow_plots.png")));
  shoot(plots, {980, 300}, dir.filePath(QStringLiteral("wide_plots.png")));
  hover(plots.plot(), {200, 100});
  shoot(plots, {680, 520}, dir.filePath(QStringLiteral("plots.png")));
  shootPlots(plots, draft, flight, dir);
  for (int i = 0; i < 60 * 3500; ++i) plots.showFrame(flight.next(draft.active()));
  for (const double span : {60.0, 600.0, 3600.0}) {
    plots.plot().setSpan(span);
    settle();
    QElapsedTimer timer;
    timer.start();
    for (int i = 0; i < 20; ++i) {
      plots.showFrame(flight.next(draft.active()));
      plots.plot().refresh(true);
      plots.plot().replot();
    }
    std::printf("%g s shown: %.2f ms a refresh\n", span, static_cast<double>(timer.nsecsElapsed()) / 20e6);
  }
  shoot(plots, {680, 520}, dir.filePath(QStringLiteral("plots_hour.png")));
  return 0;
}
