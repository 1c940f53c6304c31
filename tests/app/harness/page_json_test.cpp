#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/harness/answer.h"
#include "app/harness/report.h"
#include "report_results.h"

// The document of a page, from which its script draws.
namespace trimtab::harness {
namespace {

using nlohmann::json;
using test_results::results;

double numberOf(const json& value) {
  if (value.is_number()) return value.get<double>();
  const std::string text = value.get<std::string>();
  return text == "inf" ? HUGE_VAL : text == "-inf" ? -HUGE_VAL : std::nan(text.c_str());
}

void expectSame(const json& value, double expected, const std::string& what) {
  const double number = numberOf(value);
  if (std::isnan(expected))
    EXPECT_TRUE(std::isnan(number)) << what;
  else
    EXPECT_EQ(number, expected) << what;
}

TEST(PageJson, isThatOfTheResultsWithMore) {
  const test::ScratchDir dir;
  const Results r = results({2, 12, {"a", "b"}});
  const std::string text = pageJson(r, dir.path());
  const auto back = parseResults(text, "page");
  ASSERT_TRUE(back) << toString(back.findings());
  EXPECT_EQ(toJson(*back), toJson(r));
  json more = json::parse(text), whole = json::parse(toJson(r));
  whole.erase("units");
  for (const auto& [key, value] : whole.items()) EXPECT_EQ(more.at(key), value) << key;
}

TEST(PageJson, summarisesEachQuantityOfEachUnit) {
  const test::ScratchDir dir;
  const Results r = results({3, 120});
  const json page = json::parse(pageJson(r, dir.path()));
  ASSERT_EQ(page.at("quantities").size(), quantities().size());
  for (std::size_t u = 0; u < r.units.size(); ++u)
    for (const json& described : page.at("quantities")) {
      const std::string key = described.at("key");
      const Quantity& q = *quantityOf(key);
      EXPECT_EQ(described.at("label"), q.label);
      EXPECT_EQ(described.at("unit"), q.unit);
      const Summary s = summarise(r.units[u], q);
      const json& numbers = page.at("units")[u].at("numbers").at(key);
      expectSame(numbers.at("median"), s.median, key);
      expectSame(numbers.at("mean"), s.mean, key);
      expectSame(numbers.at("p95"), s.p95, key);
      expectSame(numbers.at("p99"), s.p99, key);
      expectSame(numbers.at("worst"), s.worst, key);
    }
}

TEST(PageJson, countsAFrameWithoutAStageAsNothingInTheBarsOnly) {
  const test::ScratchDir dir;
  const json page =
      json::parse(pageJson(results({1, 60, {"f"}, {"none", "view_frustum", "proposed"}}), dir.path()));
  const auto numbers = [&](std::size_t unit, const char* key) {
    return page.at("units")[unit].at("numbers").at(key);
  };
  EXPECT_EQ(numberOf(numbers(0, "page_ms").at("median")), 2.5);
  EXPECT_EQ(numberOf(numbers(0, "page_ms").at("median_of_all")), 0) << "most frames do not page";
  EXPECT_TRUE(std::isnan(numberOf(numbers(0, "occlusion_ms").at("median_of_all")))) << "no frame ran it";
}

TEST(PageJson, saysVerdictsAndDifferencesInWords) {
  const test::ScratchDir dir;
  Results r = results({2, 100});
  const UnitName a = r.units[0].name, b = r.units[1].name;
  r.comparisons = {
      {a, b, {0.5, 0.45, 0.6, 60}}, {a, b, {1.5, 1.2, 1.7, 60}}, {a, b, {1.1, 0.9, 1.2, 60}}, {a, b, {}}};
  const json page = json::parse(pageJson(r, dir.path()));
  const std::string expected[] = {"less", "more", "none", "unknown"};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(page.at("comparisons")[i].at("frame_time").at("difference"), expected[i]);
  std::size_t u = 0;
  for (const Answer& answer : answersOf(r))
    for (std::size_t row = 0; row < answer.rows.size(); ++row)
      EXPECT_EQ(page.at("units")[u++].at("verdict"), verdictText(answer, row));
}

TEST(PageJson, keepsPicturesOfTheSameContentOnce) {
  const test::ScratchDir dir;
  const Results r = results({2, 10, {"f"}});
  test_results::writePictures(dir.path(), r, 32, 18);
  const json page = json::parse(pageJson(r, dir.path()));
  // All references are alike. Of each preset, two cases share their images, and ours is like the difference.
  EXPECT_EQ(page.at("pictures").size(), 3u);
  const json &none = page.at("units")[0].at("worst")[0], &frustum = page.at("units")[1].at("worst")[0];
  EXPECT_EQ(none.at("pictures"), frustum.at("pictures"));
  for (const json& picture : page.at("pictures")) EXPECT_EQ(picture.at("problem"), "");
}

TEST(PageJson, ofNothingIsADocumentToo) {
  const json page = json::parse(pageJson(Results{}, {}));
  for (const char* list : {"units", "answers", "fronts", "pictures", "comparisons"})
    EXPECT_TRUE(page.at(list).empty()) << list;
}

}  // namespace
}  // namespace trimtab::harness
