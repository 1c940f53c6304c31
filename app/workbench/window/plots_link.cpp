// SPDX-License-Identifier: GPL-3.0-or-later
#include "plots_link.h"

#include <QDockWidget>
#include <array>

#include "app/link/link.h"
#include "app/workbench/controllers/controllers.h"
#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/error_dock.h"
#include "app/workbench/jobs/feed.h"
#include "panels.h"
#include "views/panels/budget_panel.h"
#include "views/panels/culling_panel.h"
#include "views/panels/motion_panel.h"
#include "views/panels/plots_panel.h"
#include "views/plots/budget_plot.h"
#include "views/plots/motion_plot.h"
#include "views/plots/time_plot.h"

namespace trimtab::workbench {

void connectPlots(const Panels& panels, const Controllers& controllers, Feed& feed) {
  using Mark = views::PlotMarks::Kind;
  views::PlotsPanel* const plots = panels.plots;
  const FrameController* const frames = controllers.frame.get();
  const auto markSilence = [plots, frames, &feed] {
    const bool silent =
        feed.source() == Feed::Source::host && feed.session().linkState(link::now()) == LinkState::silent;
    plots->mark(Mark::host_silent, silent, frames->clock());
  };
  QObject::connect(&feed, &Feed::linkChanged, plots, markSilence);
  QObject::connect(&feed, &Feed::sourceChanged, plots, markSilence);
  QObject::connect(
      controllers.trace.get(), &TraceController::recordingChanged, plots,
      [plots, frames](bool recording) { plots->mark(Mark::recording, recording, frames->clock()); });
  QObject::connect(controllers.trace.get(), &TraceController::recordingChanged, panels.budget,
                   &views::BudgetPanel::setRecording);
  views::TimePlot* const stages = panels.culling->stages();
  const std::array<views::ClockPlot*, 4> all{&plots->plot(), stages, &panels.budget->plot(),
                                             &panels.motion->plot()};
  for (views::ClockPlot* from : all)
    for (views::ClockPlot* to : all)
      if (from != to) QObject::connect(from, &views::ClockPlot::tracked, to, &views::ClockPlot::showTracker);
  QDockWidget* const dock = dockOf(*plots);
  const auto measure = [plots, dock, errors = &controllers.errors->dock()] {
    errors->setWatched(plots, isInFront(*dock) && plots->plot().shows(views::Trace::flip));
  };
  QObject::connect(dock, &QDockWidget::visibilityChanged, plots, measure);
  QObject::connect(&plots->plot(), &views::TimePlot::lanesChanged, plots, measure);
  const auto explain = [plots](std::uint64_t frame) {
    raiseDock(*plots);
    plots->chooseFrame(frame);
  };
  QObject::connect(stages, &views::TimePlot::frameClicked, plots, explain);
  for (views::ClockPlot* other : {all[2], all[3]})
    QObject::connect(other, &views::ClockPlot::timeClicked, plots, [plots, explain](double time) {
      if (const auto frame = plots->plot().frameAt(time)) explain(*frame);
    });
  QObject::connect(plots, &views::PlotsPanel::frameChosen, &feed, [&feed](double time) {
    const FlightPlayback& flight = feed.playback();
    if (feed.source() != Feed::Source::flight || flight.playing() || !flight.loaded()) return;
    const double position = time - flight.flight().states.front().time;
    if (position >= 0 && position <= flight.duration()) feed.seekHere(position);
  });
}

}  // namespace trimtab::workbench
