// SPDX-License-Identifier: GPL-3.0-or-later
#include "plots_link.h"

#include "app/link/link.h"
#include "app/workbench/controllers/controllers.h"
#include "app/workbench/docks/dock_of.h"
#include "app/workbench/jobs/feed.h"
#include "panels.h"
#include "views/panels/culling_panel.h"
#include "views/panels/plots_panel.h"
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
  views::TimePlot* const stages = panels.culling->stages();
  QObject::connect(stages, &views::TimePlot::tracked, &plots->plot(), &views::TimePlot::showTracker);
  QObject::connect(&plots->plot(), &views::TimePlot::tracked, stages, &views::TimePlot::showTracker);
  QObject::connect(stages, &views::TimePlot::frameClicked, plots, [plots](std::uint64_t frame) {
    raiseDock(*plots);
    plots->chooseFrame(frame);
  });
  QObject::connect(plots, &views::PlotsPanel::frameChosen, &feed, [&feed](double time) {
    const FlightPlayback& flight = feed.playback();
    if (feed.source() != Feed::Source::flight || flight.playing() || !flight.loaded()) return;
    const double position = time - flight.flight().states.front().time;
    if (position >= 0 && position <= flight.duration()) feed.seekHere(position);
  });
}

}  // namespace trimtab::workbench
