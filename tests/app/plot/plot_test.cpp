#include "app/plot/plot.h"

#include <gmock/gmock.h>

#include <cmath>
#include <pugixml.hpp>

#include "app/plot/svg.h"
#include "tests/support.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::plot {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

pugi::xml_document parsed(const std::string& svg) {
  pugi::xml_document document;
  const auto result = document.load_string(svg.c_str(), pugi::parse_full);
  EXPECT_TRUE(result) << result.description() << " at " << result.offset;
  return document;
}

struct Rectangle {
  double x, y, width, height;
};
/// Marks of a picture: paths of class "mark" or bars, by the corner of their first move or their rectangle.
std::vector<Rectangle> barsOf(const pugi::xml_document& document) {
  std::vector<Rectangle> bars;
  for (const auto& node : document.select_nodes("//rect[starts-with(@class,'f')]")) {
    const pugi::xml_node bar = node.node();
    bars.push_back({bar.attribute("x").as_double(), bar.attribute("y").as_double(),
                    bar.attribute("width").as_double(), bar.attribute("height").as_double()});
  }
  return bars;
}
std::vector<double> marksX(const pugi::xml_document& document) {
  std::vector<double> xs;
  for (const auto& node : document.select_nodes("//path[starts-with(@class,'mark')]"))
    xs.push_back(std::stod(std::string(node.node().attribute("d").value()).substr(1)));
  return xs;
}

Plot scatter(std::size_t points) {
  Plot plot{"f", "t", "error", "time (ms)", {}, {}};
  Series series{"s", {}, {}, Series::Draw::points};
  for (std::size_t i = 0; i < points; ++i) {
    const double angle = static_cast<double>(i) * 2.4;
    series.x.push_back(1 + 0.3 * std::cos(angle));
    series.y.push_back(10 + 3 * std::sin(angle));
    series.labels.push_back("preset " + std::to_string(i));
  }
  plot.series = {series};
  plot.legend = false;
  return plot;
}

TEST(Scatter, labelsLieOverNoOtherLabelAndNoPoint) {
  for (const std::size_t count : {1u, 5u, 12u, 30u}) {
    const auto document = parsed(toSvg(scatter(count)));
    std::vector<Rectangle> boxes;
    for (const auto& node : document.select_nodes("//text[@class='halo']")) {
      const pugi::xml_node text = node.node();
      const double size = text.attribute("font-size").as_double();
      boxes.push_back({text.attribute("x").as_double(), text.attribute("y").as_double() - size * 0.8,
                       textWidthPx(text.text().get(), size), size});
    }
    EXPECT_EQ(boxes.size(), count);
    for (std::size_t a = 0; a < boxes.size(); ++a)
      for (std::size_t b = a + 1; b < boxes.size(); ++b)
        EXPECT_FALSE(boxes[a].x < boxes[b].x + boxes[b].width && boxes[b].x < boxes[a].x + boxes[a].width &&
                     boxes[a].y < boxes[b].y + boxes[b].height && boxes[b].y < boxes[a].y + boxes[a].height)
            << count << " labels: " << a << " over " << b;
    for (const Rectangle& box : boxes) {
      EXPECT_GE(box.x, 0);
      EXPECT_LE(box.x + box.width, 720);
    }
  }
}

TEST(Scatter, aLogarithmicAxisSpacesDecadesEvenlyAndKeepsZeroApart) {
  Plot plot{"f", "t", "x", "y", {}, {{"s", {0, 0.001, 0.01, 0.1}, {1, 1, 1, 1}, Series::Draw::points}}};
  plot.logX = true;
  plot.legend = false;
  const auto xs = marksX(parsed(toSvg(plot)));
  ASSERT_EQ(xs.size(), 4u);
  EXPECT_LT(xs[0], xs[1] - 10);
  EXPECT_NEAR(xs[2] - xs[1], xs[3] - xs[2], 0.2);
  EXPECT_TRUE(spansDecades({0, 0.001, 0.1}));
  EXPECT_FALSE(spansDecades({0, 1, 2, 3, kNan}));
  EXPECT_FALSE(spansDecades({}));
}

TEST(Scatter, whatIsNoNumberIsNoPointAndWhiskersMayBeAbsent) {
  Plot plot{"f", "t", "x", "y", {}, {{"s", {1, kNan, 3, kInfinity}, {1, 2, 3, 4}, Series::Draw::joined}}};
  plot.legend = false;
  plot.series[0].yLow = {0.5, 0.5, kNan, 1};
  plot.series[0].yHigh = {1.5, kInfinity, kNan, kInfinity};
  const std::string svg = toSvg(plot);
  EXPECT_EQ(marksX(parsed(svg)).size(), 2u);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(Scatter, oneFarWhiskerDoesNotCrowdThePoints) {
  Plot plot{"f", "t", "x", "y", {}, {{"s", {1, 2}, {10, 12}, Series::Draw::points}}};
  plot.legend = false;
  plot.series[0].yLow = {9, 9};
  plot.series[0].yHigh = {11, 5000};
  const auto document = parsed(toSvg(plot));
  double largest = 0;
  for (const auto& node : document.select_nodes("//text[@text-anchor='end']"))
    largest = std::max(largest, node.node().text().as_double());
  EXPECT_EQ(largest, 20);
  std::vector<std::string> whiskers;
  for (const auto& node : document.select_nodes("//path[@class='k0']"))
    whiskers.push_back(node.node().attribute("d").value());
  ASSERT_EQ(whiskers.size(), 2u);
  EXPECT_EQ(std::count(whiskers[0].begin(), whiskers[0].end(), 'h'), 2) << "both ends";
  EXPECT_EQ(std::count(whiskers[1].begin(), whiskers[1].end(), 'h'), 1) << "it runs out of the plot";
}

TEST(Rows, barsOfARowStandEndToEndAndInProportion) {
  Plot plot{"f", "t",        "ms",
            "",  {"a", "b"}, {{"one", {}, {1, 2}}, {"two", {}, {3, kNan}}, {"three", {}, {4, 5}}}};
  plot.kind = Plot::Kind::rows;
  plot.legend = false;
  const auto bars = barsOf(parsed(toSvg(plot)));
  ASSERT_EQ(bars.size(), 5u);  // row a: 1 3 4, row b: 2 5
  EXPECT_NEAR(bars[1].x, bars[0].x + bars[0].width, 1);
  EXPECT_NEAR(bars[2].x, bars[1].x + bars[1].width, 1);
  EXPECT_NEAR((bars[2].x - bars[1].x) / (bars[1].x - bars[0].x), 3, 0.02);
  EXPECT_NEAR(bars[4].x, bars[3].x + bars[3].width, 1);
  EXPECT_GT(bars[3].y, bars[0].y + bars[0].height);
}

TEST(Rows, aNegativeValueIsABarToTheLeftOfZero) {
  Plot plot{"f", "t", "ms", "", {"a", "b"}, {{"won", {}, {2, -1}}}};
  plot.kind = Plot::Kind::rows;
  plot.legend = false;
  const auto bars = barsOf(parsed(toSvg(plot)));
  ASSERT_EQ(bars.size(), 2u);
  EXPECT_GT(bars[1].width, 0);
  EXPECT_NEAR(bars[1].x + bars[1].width, bars[0].x, 1);
  EXPECT_NEAR(bars[0].width / bars[1].width, 2, 0.03);
}

TEST(Rows, anIntervalWithoutEndRunsToTheEdge) {
  Plot plot{"f", "t", "ratio", "", {"a"}, {{"r", {}, {1.1}, Series::Draw::points}}};
  plot.kind = Plot::Kind::rows;
  plot.logX = true;
  plot.series[0].xLow = {-kInfinity};
  plot.series[0].xHigh = {kInfinity};
  plot.guides = {{Guide::Axis::x, 1, "equal"}};
  const std::string svg = toSvg(plot);
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
  const auto document = parsed(svg);
  EXPECT_EQ(document.select_nodes("//path[@class='k0']").size(), 2u);
}

TEST(Rows, stripesTellTheSeventhColourFromTheFirst) {
  Plot plot{"f", "t", "ms", "", {"a"}, {}};
  plot.kind = Plot::Kind::rows;
  for (int i = 0; i < 7; ++i) plot.series.push_back({"s", {}, {5}});
  plot.legend = false;
  EXPECT_EQ(parsed(toSvg(plot)).select_nodes("//path[@stroke='white']").size(), 1u);
}

TEST(Svg, everyTextMakesWellFormedXml) {
  for (const std::string& text :
       {std::string("<a> & \"b\" 'c'"), std::string("\xff\xfe broken"), std::string("\x01\x02"),
        std::string("cut \xe2\x82"), std::string("\xed\xa0\x80 surrogate"),
        std::string("gr\xc3\xbc\xc3\x9f \xf0\x9f\x9b\xa9"), std::string("nul\0l", 5),
        std::string(300, 'w')}) {
    Plot plot = scatter(2);
    plot.title = plot.xLabel = plot.yLabel = text;
    plot.series[0].labels = plot.series[0].hints = {text, text};
    plot.keys = {{text, 1, 2}};
    plot.legend = true;
    parsed(toSvg(plot));
    parsed(toInlineSvg(plot));
    plot.kind = Plot::Kind::rows;
    plot.categories = {text, text + "\n" + text};
    parsed(toSvg(plot));
  }
  EXPECT_EQ(escaped("a<b"), "a&lt;b");
  EXPECT_EQ(escaped("\xc3\xbc"), "\xc3\xbc");
  EXPECT_EQ(escaped("\x01"), "\xef\xbf\xbd");
}

TEST(Svg, longTextKeepsBothEndsAndWholeCharacters) {
  const std::string text = shortened("a-very-long-preset-name-of-somebody-\xc3\xbc\xc3\xbc\xc3\xbc", 100, 13);
  EXPECT_LE(textWidthPx(text, 13), 100);
  EXPECT_EQ(text.substr(0, 3), "a-v");
  EXPECT_EQ(text.substr(text.size() - 6), "\xc3\xbc\xc3\xbc\xc3\xbc");
  EXPECT_EQ(shortened("short", 100, 13), "short");
  EXPECT_EQ(escaped(text), text);
}

TEST(Svg, ticksReadShort) {
  EXPECT_EQ(tickText(0), "0");
  EXPECT_EQ(tickText(0.05), "0.05");
  EXPECT_EQ(tickText(1500), "1500");
  EXPECT_EQ(tickText(20000), "20k");
  EXPECT_EQ(tickText(-1200000), "-1.2M");
  EXPECT_EQ(tickText(2 * std::pow(10, -5)), "2e-5");
}

TEST(Figure, holdsAllPlotsSideBySideUnderOneLegend) {
  Plot small = scatter(3);
  small.widthPx = 360;
  small.heightPx = 240;
  const auto document = parsed(toSvg("Title", {{"key", 0, 1}}, {small, small, small}, 2));
  EXPECT_STREQ(document.first_child().attribute("viewBox").value(), "0 0 720 542");
  EXPECT_EQ(document.select_nodes("//g[@transform]").size(), 3u);
  EXPECT_EQ(document.select_nodes("//text[.='key']").size(), 1u);
}

}  // namespace
}  // namespace trimtab::plot
