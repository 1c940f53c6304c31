// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTableWidget>

#include "application.h"
#include "live_flight.h"
#include "views/panels/plots_panel.h"
#include "views/plots/time_plot.h"

namespace trimtab::views {

/// The dock Plots with a hundred seconds of a made-up flight at 60 frames a second, the last minute of it
/// shown.
class PlotsPanelTest : public testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < 60 * 100; ++i) panel_.showFrame(flight_.next(draft_.active()));
    test::expose(panel_, {640, 640});
    ASSERT_TRUE(test::eventually([&] { return plot().shown().upper == newest(); }));
  }
  TimePlot& plot() { return panel_.plot(); }
  double newest() const { return panel_.buffer().time(panel_.buffer().end() - 1); }
  QString readout(int row, int column) { return panel_.readout().item(row, column)->text(); }
  int rowOf(const QString& signal) {
    for (int row = 0; row < panel_.readout().rowCount(); ++row)
      if (readout(row, 0) == signal) return row;
    ADD_FAILURE() << signal.toStdString();
    return 0;
  }
  void addFrames(int frames) {
    for (int i = 0; i < frames; ++i) panel_.showFrame(flight_.next(draft_.active()));
  }
  /// A frame of `ms`, all of it drawing; a sixtieth of a second after the one before.
  void addSlowFrame(double ms) {
    LiveFrame slow = flight_.next(draft_.active());
    slow.cost.draw += ms - slow.cost.total;
    slow.cost.total = ms;
    panel_.showFrame(slow);
  }

  Draft draft_;
  test::LiveFlight flight_{100};
  PlotsPanel panel_{draft_};
};

}  // namespace trimtab::views
