#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/experiment/page.h"
#include "app/experiment/published.h"
#include "app/experiment/report.h"
#include "tests/support.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::experiment {
namespace {

using ::testing::HasSubstr;

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

TEST(Report, saysTablesAndPlotsInItsJson) {
  const auto json = nlohmann::ordered_json::parse(toJson(anyReport()));
  EXPECT_EQ(json.at("experiment"), "any");
  EXPECT_EQ(json.at("published")[0].at("a"), 1.5);
  EXPECT_EQ(json.at("published")[0].at("b"), "x, \"y\"");
  EXPECT_TRUE(json.at("published")[1].at("a").is_null()) << "NaN";
  EXPECT_EQ(json.at("measured")[0].at("a"), 1e-12);
  ASSERT_EQ(json.at("plots").size(), 2u);
  EXPECT_EQ(json.at("plots")[0].at("x_label"), "x (m)");
  EXPECT_TRUE(json.at("plots")[0].at("series")[0].at("y")[1].is_null());
  EXPECT_EQ(json.at("plots")[1].at("categories").size(), 2u);
  EXPECT_EQ(json.at("plots")[1].at("series")[1].at("name"), "two");
}

TEST(Report, keepsIntervalsAndScalesOfItsPlots) {
  Report report = anyReport();
  report.plots[0].logX = true;
  report.plots[1].rows = true;
  Series& series = report.plots[1].series[0];
  series.draw = Series::Draw::joined;
  series.xLow = {-kInfinity, 0.5};
  series.xHigh = {kInfinity, kNan};
  const auto plots = nlohmann::json::parse(toJson(report)).at("plots");
  EXPECT_EQ(plots[0].at("log_x"), true);
  EXPECT_EQ(plots[0].at("log_y"), false);
  EXPECT_EQ(plots[1].at("rows"), true);
  EXPECT_EQ(plots[1].at("series")[0].at("draw"), "joined");
  EXPECT_EQ(plots[1].at("series")[0].at("x_low"), nlohmann::json({"-inf", 0.5}));
  EXPECT_EQ(plots[1].at("series")[0].at("x_high"), nlohmann::json({"inf", nullptr}));
}

TEST(Report, writesItsJsonItsPageAndItsTables) {
  const test::ScratchDir dir;
  const Report report = anyReport();
  ASSERT_TRUE(writeReport(dir.path(), report));
  EXPECT_EQ(test::readFile(dir / "any.json"), toJson(report));
  EXPECT_EQ(test::readFile(dir / "any.html"), pageWith(toJson(report)));
  EXPECT_EQ(test::readFile(dir / "any-published.csv"), toCsv(report.published));
  EXPECT_EQ(test::readFile(dir / "any-measured.csv"), toCsv(report.measured));
}

TEST(Report, csvKeepsCommasAndQuotesInsideACell) {
  EXPECT_EQ(toCsv(anyReport().published), "a,b\n1.5,\"x, \"\"y\"\"\"\n-,\n");
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
