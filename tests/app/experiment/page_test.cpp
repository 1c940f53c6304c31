#include "app/experiment/page.h"

#include <gmock/gmock.h>

#include <cmath>

#include "app/experiment/report.h"
#include "tests/app/page_script.h"
#include "tests/support.h"
#include "trimtab/units/not_finite.h"

// What the script of resources/report.html draws, and the page of an experiment.
namespace trimtab::experiment {
namespace {

using test::allText;
using ::testing::HasSubstr;
using ::testing::Not;

std::string valueOf(const std::string& expression) {
  static test::PageScript script(pageWith("{}"));
  return script.valueOf(expression);
}
std::string svgOf(const std::string& plot) {
  return valueOf("svgOf({" + plot + "})");
}
pugi::xml_document drawn(const std::string& plot) {
  return test::parsedPage(svgOf(plot));
}

struct Rectangle {
  double x, y, width, height;
};
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
    xs.push_back(std::stod(std::string(node.node().attribute("transform").value()).substr(10)));
  return xs;
}

constexpr const char* kScatter =
    "legend: false, x_label: 'error', y_label: 'time (ms)', series: [{name: 's', draw: 'points', ";

TEST(Scatter, labelsLieOverNoOtherLabelAndStayInThePlot) {
  for (const std::size_t count : {1u, 5u, 12u, 30u}) {
    std::string x, y, labels;
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = static_cast<double>(i) * 2.4;
      x += std::to_string(1 + 0.3 * std::cos(angle)) + ',';
      y += std::to_string(10 + 3 * std::sin(angle)) + ',';
      labels += "'preset " + std::to_string(i) + "',";
    }
    const auto document = drawn(kScatter + ("x: [" + x + "], y: [" + y + "], labels: [" + labels + "]}]"));
    std::vector<Rectangle> boxes;
    for (const auto& node : document.select_nodes("//text[@class='halo']")) {
      const pugi::xml_node text = node.node();
      const double size = 12;
      const std::string width =
          valueOf("widthOf('" + std::string(text.text().get()) + "', " + std::to_string(size) + ")");
      boxes.push_back({text.attribute("x").as_double(), text.attribute("y").as_double() - size * 0.8,
                       std::stod(width), size});
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
  const auto xs =
      marksX(drawn(std::string("log_x: true, ") + kScatter + "x: [0, 0.001, 0.01, 0.1], y: [1, 1, 1, 1]}]"));
  ASSERT_EQ(xs.size(), 4u);
  EXPECT_LT(xs[0], xs[1] - 10);
  EXPECT_NEAR(xs[2] - xs[1], xs[3] - xs[2], 0.2);
  EXPECT_EQ(valueOf("spansDecades([0, 0.001, 0.1])"), "true");
  EXPECT_EQ(valueOf("spansDecades([0, 1, 2, 3, NaN])"), "false");
  EXPECT_EQ(valueOf("spansDecades([])"), "false");
}

TEST(Scatter, whatIsNoNumberIsNoPointAndWhiskersMayBeAbsent) {
  const std::string svg =
      svgOf(kScatter + std::string("x: [1, NaN, 3, Infinity, null], y: [1, 2, 3, 4, 5], "
                                   "y_low: [0.5, 0.5, NaN, 1], y_high: [1.5, Infinity, null, Infinity]}]"));
  EXPECT_EQ(marksX(test::parsedPage(svg)).size(), 2u);
  for (const char* word : {"NaN", "Infinity", "null", "undefined"}) EXPECT_THAT(svg, Not(HasSubstr(word)));
}

TEST(Scatter, oneFarWhiskerDoesNotCrowdThePoints) {
  const auto document =
      drawn(kScatter + std::string("x: [1, 2], y: [10, 12], y_low: [9, 9], y_high: [11, 5000]}]"));
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

TEST(Lines, breakAtWhatIsNoNumber) {
  const auto document = drawn("series: [{name: 's', x: [0, 1, 2, 3], y: [1, null, 3, 4]}]");
  const std::string d = document.select_node("//path[@fill='none']").node().attribute("d").value();
  EXPECT_EQ(std::count(d.begin(), d.end(), 'M'), 2) << d;
  EXPECT_EQ(std::count(d.begin(), d.end(), 'L'), 1) << d;
}

TEST(Bars, areSideBySideWithTheirIntervals) {
  const auto document = drawn(
      "categories: ['p', 'q'], series: [{name: 'one', x: [], y: [1, 2], y_low: [0.5, 1], y_high: [1.5, 3]}, "
      "{name: 'two', x: [], y: [null, 4]}], legend: false");
  const auto bars = barsOf(document);
  ASSERT_EQ(bars.size(), 3u);
  EXPECT_NEAR(bars[1].height / bars[0].height, 2, 0.02);
  EXPECT_GT(bars[2].x, bars[1].x + bars[1].width - 1);
  EXPECT_EQ(document.select_nodes("//path[@opacity]").size(), 2u);
}

constexpr const char* kRows = "rows: true, legend: false, x_label: 'ms', ";

TEST(Rows, barsOfARowStandEndToEndAndInProportion) {
  const auto bars = barsOf(
      drawn(kRows + std::string("categories: ['a', 'b'], series: [{name: 'one', x: [], y: [1, 2]}, "
                                "{name: 'two', x: [], y: [3, null]}, {name: 'three', x: [], y: [4, 5]}]")));
  ASSERT_EQ(bars.size(), 5u);  // row a: 1 3 4, row b: 2 5
  EXPECT_NEAR(bars[1].x, bars[0].x + bars[0].width, 1);
  EXPECT_NEAR(bars[2].x, bars[1].x + bars[1].width, 1);
  EXPECT_NEAR((bars[2].x - bars[1].x) / (bars[1].x - bars[0].x), 3, 0.02);
  EXPECT_NEAR(bars[4].x, bars[3].x + bars[3].width, 1);
  EXPECT_GT(bars[3].y, bars[0].y + bars[0].height);
}

TEST(Rows, aNegativeValueIsABarToTheLeftOfZero) {
  const auto bars = barsOf(
      drawn(kRows + std::string("categories: ['a', 'b'], series: [{name: 'won', x: [], y: [2, -1]}]")));
  ASSERT_EQ(bars.size(), 2u);
  EXPECT_GT(bars[1].width, 0);
  EXPECT_NEAR(bars[1].x + bars[1].width, bars[0].x, 1);
  EXPECT_NEAR(bars[0].width / bars[1].width, 2, 0.03);
}

TEST(Rows, anIntervalWithoutEndRunsToTheEdge) {
  for (const char* ends : {"-Infinity], x_high: [Infinity]", "'-inf'], x_high: ['inf']"}) {
    const std::string svg = svgOf(kRows +
                                  std::string("log_x: true, categories: ['a'], series: [{name: 'r', draw: "
                                              "'points', x: [], y: [1.1], x_low: [") +
                                  ends + "}], guides: [{axis: 'x', at: 1, label: 'equal'}]");
    EXPECT_THAT(svg, Not(HasSubstr("nfinity")));
    EXPECT_EQ(test::parsedPage(svg).select_nodes("//path[@class='k0']").size(), 2u) << ends;
  }
}

TEST(Rows, stripesTellTheSeventhColourFromTheFirst) {
  std::string series;
  for (int i = 0; i < 7; ++i) series += "{name: 's', x: [], y: [5]},";
  const auto document = drawn(kRows + ("categories: ['a'], series: [" + series + "]"));
  EXPECT_EQ(document.select_nodes("//path[@stroke='white']").size(), 1u);
}

TEST(Plots, everyTextMakesWellFormedXml) {
  for (const char* text : {"<a> & \\\"b\\\" 'c'", "\\u0001\\u0002", "gr\xc3\xbc\xc3\x9f \xf0\x9f\x9b\xa9",
                           "nul\\u0000l", "</svg><script>", ""}) {
    const std::string t = '"' + std::string(text) + '"';
    const std::string plot =
        "title: " + t + ", x_label: " + t + ", y_label: " + t + ", keys: [{name: " + t +
        ", look: 1, shape: 2}], series: [{name: 's', draw: 'points', x: [1, 2], y: [1, 2], labels: [" + t +
        ',' + t + "], hints: [" + t + ',' + t + "]}]";
    EXPECT_TRUE(drawn(plot).select_nodes("//script").empty());
    drawn(plot + ", rows: true, categories: [" + t + ", " + t + "+'\\n'+" + t + "]");
  }
  EXPECT_EQ(valueOf("escaped('a<b')"), "a&lt;b");
  EXPECT_EQ(valueOf("escaped('\\u00fc')"), "\xc3\xbc");
  EXPECT_EQ(valueOf("escaped('\\u0001')"), "\xef\xbf\xbd");
}

TEST(Plots, surviveNoDataAndOneValue) {
  for (const char* plot :
       {"series: []", "series: [], rows: true", "series: [{name: 's', x: [], y: []}]",
        "series: [{name: 's', x: [5], y: [5]}]", "categories: ['only'], series: [{name: 's', x: [], y: [0]}]",
        "rows: true, categories: ['only'], series: [{name: 's', x: [], y: [null]}]",
        "log_x: true, log_y: true, series: [{name: 's', draw: 'joined', x: [0], y: [-1]}]"}) {
    const std::string svg = svgOf(plot);
    EXPECT_THAT(svg, HasSubstr("</svg>")) << plot;
    for (const char* word : {"NaN", "Infinity", "undefined"}) EXPECT_THAT(svg, Not(HasSubstr(word))) << plot;
  }
}

TEST(Plots, longTextKeepsBothEndsAndWholeCharacters) {
  const std::string shorter =
      valueOf("shortened('a-very-long-preset-name-of-somebody-\\u00fc\\u00fc\\u00fc', 100, 13)");
  EXPECT_EQ(shorter.substr(0, 3), "a-v");
  EXPECT_EQ(shorter.substr(shorter.size() - 6), "\xc3\xbc\xc3\xbc\xc3\xbc");
  EXPECT_LE(std::stod(valueOf("widthOf('" + shorter + "', 13)")), 100);
  EXPECT_EQ(valueOf("shortened('short', 100, 13)"), "short");
}

TEST(Numbers, readShort) {
  for (const auto& [call, expected] :
       std::vector<std::pair<const char*, const char*>>{{"tickWords(0)", "0"},
                                                        {"tickWords(0.05)", "0.05"},
                                                        {"tickWords(1500)", "1500"},
                                                        {"tickWords(20000)", "20k"},
                                                        {"tickWords(-1200000)", "-1.2M"},
                                                        {"tickWords(0.00002)", "2e-5"},
                                                        {"rounded(0.0123456)", "0.0123"},
                                                        {"rounded(123.456)", "123.5"},
                                                        {"rounded(-1234567.8)", "-1,234,568"},
                                                        {"rounded(NaN)", ""},
                                                        {"rounded(-Infinity)", "\xe2\x88\x92\xe2\x88\x9e"},
                                                        {"rounded(3e-7)", "3e-7"},
                                                        {"whole(999)", "999"},
                                                        {"whole(54321)", "54,321"},
                                                        {"fixed(-0.00001, 3)", "0"},
                                                        {"milliseconds(0.0001)", "<0.001"},
                                                        {"counted(1, 'frame')", "1 frame"},
                                                        {"enumerated(['a', 'b', 'c'])", "a, b and c"}})
    EXPECT_EQ(valueOf(call), expected) << call;
}

Report anyReport() {
  Report report{
      "any <b>", "nowhere & \"here\"", "machine", {{"a", "b"}, {{1.5, "x"}, {kNan, Cell()}}}, {}, {"note"},
      {}};
  report.measured = {{"a"}, {{1e-12}, {123456789.0}}};
  report.plots = {{"plot", "<Title> & more", "x (m)", "y (ms)", {}, {{"one", {0, 1, 2}, {1, kNan, 3}}}},
                  {"bars", "Bars", "x", "y", {"p", "q"}, {{"one", {}, {1, 2}}, {"two", {}, {kNan, 4}}}}};
  return report;
}

TEST(ExperimentPage, showsTablesNotesAndPlots) {
  const Report report = anyReport();
  const std::string shown = test::PageScript(pageWith(toJson(report))).shown();
  const auto document = test::parsedPage(shown);
  EXPECT_THAT(allText(document.select_node("//h1").node()), HasSubstr("Experiment: any <b>"));
  const std::string text = allText(document);
  for (const char* said :
       {"nowhere & \"here\"", "machine", "note", "Published", "Measured", "1.5", "1e-12", "123456789"})
    EXPECT_THAT(text, HasSubstr(said));
  EXPECT_EQ(document.select_nodes("//table").size(), 2u);
  EXPECT_EQ(document.select_nodes("//svg").size(), 2u);
  for (const Plot& plot : report.plots) {
    EXPECT_THAT(text, HasSubstr(plot.xLabel));
    EXPECT_THAT(text, HasSubstr(plot.yLabel));
    for (const Series& series : plot.series) EXPECT_THAT(shown, HasSubstr(">" + series.name + "<"));
  }
  EXPECT_THAT(shown, HasSubstr("&lt;Title&gt; &amp; more"));
  for (const char* word : {"NaN", "Infinity", "undefined", "null"}) EXPECT_THAT(shown, Not(HasSubstr(word)));
}

TEST(ExperimentPage, saysThatNothingWasMeasured) {
  const Report nothing{"none", "nowhere", "machine", {}, {}, {}, {}};
  EXPECT_THAT(test::PageScript(pageWith(toJson(nothing))).shown(), HasSubstr("Nothing was measured."));
}

TEST(Table, isSortedByNumbersWithBlanksLastAndTheOtherWayTheSecondTime) {
  const std::string sorted = valueOf(R"js((function () {
    var order = [], direction = null;
    var rows = [['10', '10'], [null, ''], ['Infinity', 'all'], ['9', '9']].map(function (cell) {
      return {name: cell[1], cells: [{getAttribute: function () { return cell[0]; }, textContent: cell[1]}]};
    });
    var body = {rows: rows, appendChild: function (row) { order.push(row.name); }};
    var head = {cellIndex: 0, getAttribute: function () { return direction; },
      setAttribute: function (name, value) { direction = value; }, removeAttribute: function () {}};
    head.parentNode = {cells: [head], parentNode: {parentNode: {tBodies: [body]}}};
    sortBy(head);
    sortBy(head);
    return order.join(' ');
  })())js");
  EXPECT_EQ(sorted, "9 10 all  all 10 9 ");
}

TEST(Page, saysWhereTheNumbersAreIfThereIsNoScript) {
  const std::string page = pageWith(toJson(anyReport()));
  const std::size_t from = page.find("<noscript>");
  ASSERT_NE(from, std::string::npos);
  EXPECT_THAT(page.substr(from, page.find("</noscript>") - from), HasSubstr("JSON file beside this page"));
}

TEST(Page, noTextEndsTheElementOfItsJson) {
  const std::string page = pageWith("[\"</script><!--<script>\xe2\x80\xa8\xe2\x80\xa9\xe2\x80\xaa\"]");
  EXPECT_THAT(page,
              HasSubstr(">[\"\\u003c/script>\\u003c!--\\u003cscript>\\u2028\\u2029\xe2\x80\xaa\"]</script>"));
  EXPECT_EQ(test::PageScript(page).valueOf("JSON.parse(held)[0]"),
            "</script><!--<script>\xe2\x80\xa8\xe2\x80\xa9\xe2\x80\xaa");
}

}  // namespace
}  // namespace trimtab::experiment
