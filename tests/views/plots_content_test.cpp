// SPDX-License-Identifier: GPL-3.0-or-later
#include <QDropEvent>
#include <QLineEdit>
#include <QListWidget>
#include <QMimeData>
#include <QPushButton>
#include <QSettings>
#include <QTemporaryDir>
#include <QXmlStreamReader>
#include <cmath>

#include "plots_panel_fixture.h"
#include "views/panels/frame_page.h"

// What a person puts into the dock Plots and takes out of it: marks, one frame, signals, pictures.
namespace trimtab::views {
namespace {

using PlotsContent = PlotsPanelTest;

TEST_F(PlotsContent, aSilentHostARecordingAndDecisionsAreMarked) {
  const auto ink = [&] {
    plot().replot(QCustomPlot::rpImmediateRefresh);
    const QImage image = plot().toPixmap().toImage();
    return image;
  };
  using Kind = PlotMarks::Kind;
  const QImage before = ink();
  panel_.mark(Kind::host_silent, true, newest() - 20);
  ASSERT_TRUE(panel_.marks().lasts(Kind::host_silent));
  const QImage silent = ink();
  EXPECT_NE(silent, before);
  panel_.mark(Kind::host_silent, false, newest() - 10);
  EXPECT_NE(ink(), silent) << "it ends where the host is live again";
  const QImage ended = ink();
  panel_.mark(Kind::recording, true, newest() - 5);
  EXPECT_NE(ink(), ended);
  EXPECT_FALSE(panel_.marks().changes().empty()) << "the flight climbs through its bands";
  const PlotMarks::Change& change = panel_.marks().changes().back();
  emit plot().tracked(change.time);
  EXPECT_TRUE(panel_.trackedText().contains(change.text)) << panel_.trackedText().toStdString();
}

TEST_F(PlotsContent, aClickedFrameIsExplainedBesideTheMedian) {
  addSlowFrame(743);
  const std::uint64_t spike = panel_.buffer().end() - 1;
  addFrames(300);
  ASSERT_TRUE(test::eventually([&] { return plot().shown().upper == newest(); }));
  plot().setShown(newest() - 10, newest());
  QTest::mouseClick(&plot(), Qt::LeftButton, {}, plot().pixelOfTime(panel_.buffer().time(spike)).toPoint());
  FramePage& page = panel_.framePage();
  ASSERT_TRUE(page.frame().has_value());
  EXPECT_NEAR(panel_.buffer().time(*page.frame()), panel_.buffer().time(spike), 0.1);
  panel_.chooseFrame(spike);
  EXPECT_TRUE(page.isVisible());
  EXPECT_TRUE(page.title().contains("743 ms")) << page.title().toStdString();
  EXPECT_TRUE(page.title().contains("most in draw"));
  const auto cell = [&](const QString& what, int column) {
    for (int row = 0; row < page.table().rowCount(); ++row)
      if (page.table().item(row, 0)->text() == what) return page.table().item(row, column)->text();
    return QString();
  };
  const auto [from, to] = plot().framesShown();
  const double median = panel_.buffer().statistics(Trace::draw_ms, from, to).median;
  EXPECT_NEAR(QLocale().toDouble(cell("draw (ms)", 2)), median, 0.01);
  EXPECT_NEAR(QLocale().toDouble(cell("draw (ms)", 3).mid(1)),
              panel_.buffer().value(Trace::draw_ms, spike) - median, 0.01);
  for (const char* what :
       {"frame (ms)", "triangles (k)", "nodes drawn", "nodes uploaded", "pages read", "LOD scale"})
    EXPECT_FALSE(cell(QString::fromUtf8(what), 1).isEmpty()) << what;
  EXPECT_FALSE(cell("scheme dynamic", 1).isEmpty());
  ASSERT_GE(page.over().count(), 1);
  EXPECT_TRUE(page.over().item(0)->text().contains("743 ms"));
}

TEST_F(PlotsContent, keysGoFromSpikeToSpike) {
  panel_.clear();
  std::vector<std::uint64_t> spikes;
  for (const double ms : {40.0, 90.0, 60.0}) {
    addFrames(120);
    addSlowFrame(ms);
    spikes.push_back(panel_.buffer().end() - 1);
  }
  addFrames(30);
  plot().refresh(true);
  for (const std::uint64_t expected : spikes) {
    QTest::keyClick(&plot(), Qt::Key_W);
    EXPECT_EQ(panel_.framePage().frame(), expected);
  }
  QTest::keyClick(&plot(), Qt::Key_W);
  EXPECT_EQ(panel_.framePage().frame(), spikes.back()) << "after the last one there is none";
  QTest::keyClick(&plot(), Qt::Key_W, Qt::ShiftModifier);
  EXPECT_EQ(panel_.framePage().frame(), spikes[1]);
}

TEST_F(PlotsContent, aSignalIsFoundByItsWordsAndEnterAddsTheFirst) {
  QListWidget& list = panel_.signalList();
  auto* const search = list.parentWidget()->findChild<QLineEdit*>();
  ASSERT_NE(search, nullptr);
  const auto found = [&] {
    QStringList texts;
    for (int row = 0; row < list.count(); ++row)
      if (!list.item(row)->isHidden()) texts << list.item(row)->text();
    return texts.join(", ").toStdString();
  };
  search->setText("sight line");
  EXPECT_EQ(found(), "line of sight (deg/s), line of sight, filtered (deg/s)");
  search->setText("lod_scale");
  EXPECT_EQ(found(), "LOD scale") << "the name that files have finds it too";
  QTest::keyClick(search, Qt::Key_Return);
  EXPECT_EQ(plot().lanes()[plot().currentLane()].traces.back(), Trace::lod_scale);
  search->setText("no such signal");
  EXPECT_EQ(found(), "");
  EXPECT_EQ(list.currentItem(), nullptr);
  search->clear();
  EXPECT_GT(QString::fromStdString(found()).count(','), 40);
}

TEST_F(PlotsContent, anySignalGoesIntoAnyPlotAndStatisticsFollow) {
  plot().addSignal(1, Trace::altitude_ft);
  EXPECT_EQ(plot().lanes()[1].traces.back(), Trace::altitude_ft);
  plot().addSignal(1, Trace::altitude_ft);
  EXPECT_EQ(plot().lanes()[1].traces.size(), 4u) << "once is enough";
  plot().addLane({{Trace::pages_read}});
  EXPECT_EQ(plot().lanes().size(), 5u);
  QListWidget& list = panel_.signalList();
  ASSERT_EQ(list.count(), static_cast<int>(kCsvTraces));
  for (int row = 0; row < list.count(); ++row)
    if (list.item(row)->text() == "pitch (deg)") emit list.itemActivated(list.item(row));
  EXPECT_EQ(plot().lanes()[4].traces.back(), Trace::pitch_deg) << "into the plot that was made last";
  auto* const add = list.parentWidget()->findChild<QPushButton*>();
  ASSERT_NE(add, nullptr);
  EXPECT_FALSE(add->isEnabled()) << "no signal is selected";
  for (int row = 0; row < list.count(); ++row)
    if (list.item(row)->text() == "roll (deg)") list.setCurrentRow(row);
  add->click();
  EXPECT_EQ(plot().lanes()[4].traces.back(), Trace::roll_deg);
  plot().removeSignal(4, Trace::roll_deg);
  plot().replot(QCustomPlot::rpImmediateRefresh);
  QMimeData dragged;
  dragged.setData(TimePlot::kSignalMime, "speed_kt");
  QDropEvent drop(QPointF(plot().laneRect(0)->rect().center()), Qt::CopyAction, &dragged, Qt::LeftButton, {});
  static_cast<QObject*>(&plot())->event(&drop);
  EXPECT_EQ(plot().lanes()[0].traces.back(), Trace::speed_kt);

  panel_.setCursors(true);
  plot().setShown(130, 150);
  const auto [from, to] = plot().framesShown();
  EXPECT_EQ(to - from, 1201u);
  const TraceBuffer::Statistics all = panel_.buffer().statistics(Trace::altitude_ft, from, to);
  const auto number = [&](int column) { return QLocale().toDouble(readout(rowOf("altitude (ft)"), column)); };
  EXPECT_TRUE(test::eventually([&] { return std::abs(number(5) - all.median) < 0.1; }));
  EXPECT_NEAR(number(4), all.least, 0.1);
  EXPECT_NEAR(number(6), all.p95, 0.1);
  EXPECT_NEAR(number(7), all.largest, 0.1);

  plot().removeSignal(4, Trace::pages_read);
  plot().removeSignal(4, Trace::pitch_deg);
  EXPECT_EQ(plot().lanes().size(), 4u) << "a plot without signals goes";
}

TEST_F(PlotsContent, plotsAreKeptWithTheSettings) {
  QTemporaryDir folder;
  QSettings settings(folder.filePath("s.ini"), QSettings::IniFormat);
  plot().setLanes({{{Trace::gpu_ms, Trace::load}}, {{}, true}});
  panel_.setSpan(300);
  panel_.keepIn(settings);
  PlotsPanel other(draft_);
  other.readFrom(settings);
  EXPECT_EQ(other.plot().lanes(), plot().lanes());
  EXPECT_EQ(other.plot().span(), 300);
  const auto length = [](PlotsPanel& panel, std::size_t least) {
    for (QAction* action : panel.findChildren<QAction*>())
      if (action->isCheckable() && action->data().toULongLong() >= least) return action;
    return static_cast<QAction*>(nullptr);
  };
  QAction* const longest = length(panel_, 2 * panel_.buffer().capacity());
  ASSERT_NE(longest, nullptr);
  longest->trigger();
  EXPECT_NE(panel_.buffer().capacity(), other.buffer().capacity());
  panel_.keepLengthIn(settings);
  other.readLengthFrom(settings);
  EXPECT_EQ(panel_.buffer().capacity(), other.buffer().capacity());
  settings.setValue("plots/lanes", "no_such_signal;;");
  other.readFrom(settings);
  EXPECT_EQ(other.plot().lanes(), plot().lanes()) << "what nobody can read changes nothing";
}

TEST_F(PlotsContent, aPictureIsPngAtTwiceTheSizeOrSvgWithItsTexts) {
  QTemporaryDir folder;
  EXPECT_TRUE(panel_.savePicture(folder.filePath("p.png")).empty());
  EXPECT_EQ(QImage(folder.filePath("p.png")).size(), plot().size() * 2);
  EXPECT_TRUE(panel_.savePicture(folder.filePath("p.svg")).empty());
  QFile file(folder.filePath("p.svg"));
  ASSERT_TRUE(file.open(QIODevice::ReadOnly));
  const QByteArray svg = file.readAll();
  QXmlStreamReader reader(svg);
  while (!reader.atEnd()) reader.readNext();
  EXPECT_FALSE(reader.hasError()) << reader.errorString().toStdString();
  for (const char* part : {"triangles (k)", "Time (s)", "<polyline", "clip-path"})
    EXPECT_TRUE(svg.contains(part)) << part;
  EXPECT_FALSE(panel_.savePicture("/proc/nowhere/p.svg").empty());
}

}  // namespace
}  // namespace trimtab::views
