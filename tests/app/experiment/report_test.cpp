#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/experiment/published.h"
#include "app/experiment/report.h"
#include "tests/support.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::experiment {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Cells of a CSV without quotes; lines that begin with # are comments.
std::vector<std::vector<std::string>> readCsv(const std::filesystem::path& file) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream text(test::readFile(file));
  for (std::string line; std::getline(text, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> cells(1);
    for (const char c : line)
      if (c == ',')
        cells.emplace_back();
      else if (c != '\r')
        cells.back() += c;
    rows.push_back(cells);
  }
  return rows;
}

void expectSame(const Table& table, const char* file) {
  const auto rows = readCsv(test::sharedDir() / "published" / file);
  ASSERT_EQ(rows.size(), table.rows.size() + 1) << file;
  EXPECT_EQ(rows[0], table.columns) << file;
  for (std::size_t r = 0; r < table.rows.size(); ++r)
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const std::string& cell = rows[r + 1][c];
      const double number = table.number(r, table.columns[c]);
      if (std::isfinite(number))
        EXPECT_EQ(number, std::stod(cell)) << file << " row " << r << ' ' << table.columns[c];
      else
        EXPECT_EQ(table.text(r, table.columns[c]), cell) << file << " row " << r;
    }
}

TEST(PublishedRows, areThoseOfTheDocuments) {
  TRIMTAB_NEEDS_SHARED("published");
  expectSame(publishedCulling(), "culling_comparison.csv");
  expectSame(publishedHeadMotion(), "head_motion.csv");
  expectSame(publishedWeather(), "weather_frame_rate.csv");
  expectSame(publishedStaticLod(), "static_lod.csv");
}

Report anyReport() {
  Report report{"any", "nowhere", "machine", {{"a", "b"}, {{1.5, "x, \"y\""}, {kNan, Cell()}}},
                {},    {"note"},  {}};
  report.measured = {{"a"}, {{1e-12}, {123456789.0}}};
  report.plots = {{"plot", "<Title> & more", "x (m)", "y (ms)", {}, {{"one", {0, 1, 2}, {1, kNan, 3}}}},
                  {"bars", "Bars", "x", "y", {"p", "q"}, {{"one", {}, {1, 2}}, {"two", {}, {kNan, 4}}}}};
  return report;
}

TEST(Report, readsBackFromItsJson) {
  const Report report = anyReport();
  const auto back = parseReport(toJson(report), "here");
  ASSERT_TRUE(back) << toString(back.findings());
  EXPECT_EQ(back->name, "any");
  EXPECT_EQ(back->published.columns, report.published.columns);
  EXPECT_EQ(back->published.number(0, "a"), 1.5);
  EXPECT_TRUE(std::isnan(back->published.number(1, "a")));
  EXPECT_EQ(back->published.text(0, "b"), "x, \"y\"");
  EXPECT_EQ(back->measured.number(0, "a"), 1e-12);
  ASSERT_EQ(back->plots.size(), 2u);
  EXPECT_EQ(back->plots[1].categories, report.plots[1].categories);
  EXPECT_TRUE(std::isnan(back->plots[0].series[0].y[1]));
}

TEST(Report, refusesWhatIsNoReport) {
  for (const char* text : {"", "{", "[]", "{\"experiment\":1}", "{\"experiment\":\"a\"}"}) {
    const auto report = parseReport(text, "here");
    ASSERT_FALSE(report) << text;
    EXPECT_EQ(report.findings()[0].where, "here");
  }
}

TEST(Report, csvKeepsCommasAndQuotesInsideACell) {
  EXPECT_EQ(toCsv(anyReport().published), "a,b\n1.5,\"x, \"\"y\"\"\"\n-,\n");
}

TEST(Plot, namesAxesAndSeriesAndDrawsNothingThatIsNoNumber) {
  for (const Plot& plot : anyReport().plots) {
    const std::string svg = toSvg(plot);
    EXPECT_THAT(svg, HasSubstr(plot.xLabel));
    EXPECT_THAT(svg, HasSubstr(plot.yLabel));
    for (const Series& series : plot.series) EXPECT_THAT(svg, HasSubstr(">" + series.name + "<"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
  }
  EXPECT_THAT(toSvg(anyReport().plots[0]), HasSubstr("&lt;Title&gt; &amp; more"));
}

TEST(Plot, survivesNoDataAndOneValue) {
  EXPECT_THAT(toSvg({"f", "t", "x", "y", {}, {}}), HasSubstr("</svg>"));
  const std::string one = toSvg({"f", "t", "x", "y", {}, {{"s", {5}, {5}}}});
  EXPECT_THAT(one, Not(HasSubstr("nan")));
  EXPECT_THAT(toSvg({"f", "t", "x", "y", {"only"}, {{"s", {}, {0}}}}), Not(HasSubstr("nan")));
}

TEST(Report, aFolderThatCannotBeMadeIsAFinding) {
  const test::ScratchDir dir;
  test::writeFile(dir / "file", "x");
  const auto written = writeReport((dir / "file") / "folder", anyReport());
  ASSERT_FALSE(written);
  EXPECT_THAT(written.findings()[0].where, HasSubstr("folder"));
}

}  // namespace
}  // namespace trimtab::experiment
