// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/plots/report_plot.h"

#include <initializer_list>
#include <string>

#include "application.h"
#include "views/plots/motion_plot.h"
#include "views/plots/sweep_plot.h"

namespace trimtab::views {
namespace {

/// Expects every name in the legend of a plot whole and beside its axes.
void expectLegendWhole(QCustomPlot& plot) {
  plot.replot(QCustomPlot::rpImmediateRefresh);
  int names = 0;
  for (int i = 0; i < plot.legend->elementCount(); ++i) {
    auto* item = qobject_cast<QCPPlottableLegendItem*>(plot.legend->elementAt(i));
    if (item == nullptr) continue;  // places of the grid may be empty
    ++names;
    const std::string name = item->plottable()->name().toStdString();
    const QCPLayoutElement& element = *item;
    EXPECT_GE(element.outerRect().width(), element.minimumOuterSizeHint().width()) << name;
    EXPECT_TRUE(plot.rect().contains(item->outerRect())) << name;
    EXPECT_FALSE(item->outerRect().intersects(plot.axisRect()->rect())) << name;
  }
  EXPECT_GT(names, 0);
}

TEST(ReportPlot, barsThatAreShownAgainLeaveNothingBehind) {
  ReportPlot plot;
  for (int i = 0; i < 3; ++i)
    plot.show({"Title", "Preset", "Time (ms)", {"a", "b"}, {{"median", {}, {4, 5}}, {"p95", {}, {6, 9}}}});
  EXPECT_EQ(plot.plottableCount(), 2);
  EXPECT_EQ(plot.findChildren<QCPBarsGroup*>().size(), 1);
}

TEST(ReportPlot, barsHaveTheirIntervalsAndRoomForThem) {
  ReportPlot plot;
  plot.show({"Title",
             "Lever",
             "won (ms)",
             {"a", "b", "c", "d"},
             {{"won", {}, {4, 5, qQNaN(), 1}, {3, qQNaN(), 1, -2}, {12, qQNaN(), 2, 3}}}});
  const auto whiskers = plot.axisRect()->plottables();
  QCPErrorBars* found = nullptr;
  for (QCPAbstractPlottable* plottable : whiskers)
    if (auto* bars = qobject_cast<QCPErrorBars*>(plottable)) found = bars;
  ASSERT_NE(found, nullptr);
  ASSERT_EQ(found->dataCount(), 3) << "a value that is not known has neither bar nor whisker";
  const auto data = found->data();
  EXPECT_EQ(data->at(0).errorMinus, 1);
  EXPECT_EQ(data->at(0).errorPlus, 8);
  EXPECT_EQ(data->at(1).errorMinus, 0) << "a bar whose interval is unknown has none";
  EXPECT_EQ(data->at(2).errorMinus, 3);
  EXPECT_TRUE(plot.yAxis->range().contains(12));
  EXPECT_TRUE(plot.yAxis->range().contains(-2));
  EXPECT_EQ(plot.legend->itemCount(), 1);
}

TEST(ReportPlot, linesBelowZeroAreInsideTheAxis) {
  ReportPlot plot;
  plot.show({"Title", "Distance (m)", "Difference (ms)", {}, {{"a", {0, 1}, {-5, -1}}}});
  EXPECT_TRUE(plot.yAxis->range().contains(-5));
  EXPECT_TRUE(plot.yAxis->range().contains(-1));
  plot.clear();
  const QCPRange empty = plot.yAxis->range();
  plot.clear();
  EXPECT_EQ(plot.yAxis->range(), empty) << "an empty plot keeps its axis";
}

TEST(Legends, areWholeInWideAndNarrowPlots) {
  ReportPlot report;
  report.show({"Title",
               "x",
               "y",
               {},
               {{"median of the frame time", {0, 1}, {1, 2}}, {"p95 of the frame time", {0, 1}, {2, 3}}}});
  SweepPlot sweep;
  sweep.show({"LOD scale", {"1", "2"}, {8, 6}, {0.01, 0.02}, 7, 1});
  MotionPlot motion;
  for (QCustomPlot* plot : std::initializer_list<QCustomPlot*>{&report, &sweep, &motion})
    for (const int widthPx : {800, 320}) {
      test::expose(*plot, {widthPx, 260});
      expectLegendWhole(*plot);
    }
}

}  // namespace
}  // namespace trimtab::views
