#include <gmock/gmock.h>

#include <cmath>

#include "app/harness/report.h"
#include "report_results.h"
#include "tests/app/page_script.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::harness {
namespace {

using test::allText;
using test_results::results;
using ::testing::HasSubstr;
using ::testing::Not;

struct Page {
  std::string file;   ///< as it is written
  std::string shown;  ///< what its script makes of it
  pugi::xml_document document;

  pugi::xml_node section(const std::string& id) const {
    return document.select_node(("//section[@id='" + id + "']").c_str()).node();
  }
};
Page pageOf(const Results& results, const std::filesystem::path& folder) {
  Page page{htmlReport(results, folder), {}, {}};
  page.shown = test::PageScript(page.file).shown();
  page.document = test::parsedPage(page.shown);
  return page;
}

/// The cells of a table by row, each as (head, value): the number it sorts by, or else its text.
struct Cell {
  std::string head, text;
  double value = kNan;
};
std::vector<std::vector<Cell>> cellsOf(const pugi::xml_node& table) {
  std::vector<std::string> heads;
  for (const auto& head : table.select_nodes("./thead/tr/th")) heads.push_back(head.node().child_value());
  std::vector<std::vector<Cell>> rows;
  for (const auto& row : table.select_nodes("./tbody/tr")) {
    rows.emplace_back();
    for (const pugi::xml_node cell : row.node().children("td")) {
      const std::string value = cell.attribute("data-v").value();
      rows.back().push_back(
          {heads.at(rows.back().size()), cell.child_value(), value.empty() ? kNan : std::stod(value)});
    }
  }
  return rows;
}
double valueOf(const std::vector<Cell>& row, std::string_view head) {
  for (const Cell& cell : row)
    if (cell.head == head) return cell.value;
  ADD_FAILURE() << "no column " << head;
  return kNan;
}
pugi::xml_node tableOf(const Page& page, const char* section, std::size_t index = 0) {
  const auto tables = page.section(section).select_nodes(".//table");
  EXPECT_GT(tables.size(), index) << section;
  return tables.size() > index ? tables[index].node() : pugi::xml_node();
}

std::string decoded(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0, have = 0;
  for (const char c : base64) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    have += 6;
    if (have >= 8) bytes += static_cast<char>(bits >> (have -= 8) & 255);
  }
  return bytes;
}
int bigEndian(const std::string& bytes, std::size_t at) {
  int value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value * 256 + static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

TEST(HtmlReport, holdsEveryNumberOfTheSummary) {
  const test::ScratchDir dir;
  const Results r = results({3, 120});
  const Page page = pageOf(r, dir.path());
  const auto times = cellsOf(tableOf(page, "summary", 0)), errors = cellsOf(tableOf(page, "summary", 1));
  ASSERT_EQ(times.size(), r.units.size());
  ASSERT_EQ(errors.size(), r.units.size());
  for (std::size_t u = 0; u < r.units.size(); ++u) {
    const Unit& unit = r.units[u];
    EXPECT_EQ(times[u][0].text, unit.name.flight);
    EXPECT_EQ(times[u][1].text, unit.name.preset);
    const Summary ms = summarise(unit, *quantityOf("frame_ms"));
    EXPECT_EQ(valueOf(times[u], "median"), ms.median);
    EXPECT_EQ(valueOf(times[u], "p95"), ms.p95);
    EXPECT_EQ(valueOf(times[u], "p99"), ms.p99);
    for (const Quantity& q : quantities()) {
      const Summary s = summarise(unit, q);
      if (q.kind == Quantity::Kind::count) {
        EXPECT_EQ(valueOf(times[u], q.label), s.median) << q.key;
      }
      if (q.kind == Quantity::Kind::error && !q.whole) {
        EXPECT_EQ(valueOf(errors[u], q.label), std::isinf(s.mean) ? s.median : s.mean) << q.key;
      }
    }
  }
}

TEST(HtmlReport, stagesThatWereNotRunAreBlank) {
  const test::ScratchDir dir;
  const Page page = pageOf(results({}), dir.path());
  const auto rows = cellsOf(tableOf(page, "stages"));
  EXPECT_TRUE(std::isnan(valueOf(rows[0], "occlusion"))) << "case none";
  EXPECT_EQ(valueOf(rows[2], "occlusion"), 1.1) << "case proposed";
  EXPECT_THAT(allText(page.section("stages")),
              HasSubstr("These were not run, or cannot be measured on this machine: gpu"));
}

TEST(HtmlReport, wronglyCulledPixelsAreLoud) {
  const test::ScratchDir dir;
  Results r = results({});
  EXPECT_TRUE(
      pageOf(r, dir.path()).document.select_nodes("//*[contains(@class,'bad') or @class='alarm']").empty());
  r.units[4].frames[10].error.wronglyCulledPixels = 12;
  r.units[4].frames[11].error.wronglyCulledPixels = 1;
  const Page page = pageOf(r, dir.path());
  EXPECT_EQ(valueOf(cellsOf(tableOf(page, "summary", 1))[4], "wrongly culled pixels"), 13);
  EXPECT_EQ(page.document.select_nodes("//td[contains(@class,'bad')]").size(), 1u);
  EXPECT_THAT(allText(page.document.select_node("//p[@class='alarm']").node()),
              HasSubstr("13 in 2 of 1080 frames (as-published \xc2\xb7 view frustum)"));
}

TEST(HtmlReport, refersToNothingOutsideItself) {
  const test::ScratchDir dir;
  const Results r = results({2, 10, {"f"}});
  test_results::writePictures(dir.path(), r, 64, 36);
  const Page page = pageOf(r, dir.path());
  for (const char* reference :
       {"http://", "https://", "url(", "@import", "<link", "<iframe", " src=", "fetch("})
    EXPECT_THAT(page.file, Not(HasSubstr(reference)));
  for (const auto& found : page.document.select_nodes("//@src | //@href")) {
    const std::string target = found.attribute().value();
    EXPECT_TRUE(target.starts_with("data:") || target.starts_with("#")) << target.substr(0, 60);
  }
  EXPECT_THAT(page.file, HasSubstr("default-src 'none'"));
  EXPECT_TRUE(page.document.select_nodes("//link | //iframe | //object | //script").empty());
  for (const auto& found : page.document.select_nodes("//nav/a"))
    EXPECT_TRUE(page.section(std::string(found.node().attribute("href").value()).substr(1)));
}

TEST(HtmlReport, picturesDecodeToTheirSizeAndAreScaledDown) {
  const test::ScratchDir dir;
  const Results r = results({2, 10, {"f"}, {"none"}});
  for (const int width : {320, 1600}) {
    test_results::writePictures(dir.path(), r, width, width * 9 / 16);
    const Page page = pageOf(r, dir.path());
    const auto pictures = page.document.select_nodes("//img");
    EXPECT_EQ(pictures.size(), 6u);
    for (const auto& found : pictures) {
      const std::string src = found.node().attribute("src").value(), start = "data:image/png;base64,";
      ASSERT_TRUE(src.starts_with(start));
      const std::string png = decoded(src.substr(start.size()));
      EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
      EXPECT_EQ(bigEndian(png, 16), std::min(width, 640));
      EXPECT_EQ(bigEndian(png, 20), std::min(width, 640) * 9 / 16);
      EXPECT_EQ(found.node().attribute("width").as_int(), std::min(width, 640));
      test::writeFile(dir / "again.png", png);
      const auto picture = scene::readPng(dir / "again.png");
      ASSERT_TRUE(picture);
      // The gradient's ends: red grows to the right, green upward.
      EXPECT_LT(picture->rgba[0], 4);
      EXPECT_LT(picture->rgba[1], 4);
      EXPECT_GT(picture->rgba[picture->rgba.size() - 4], 250);
      EXPECT_GT(picture->rgba[picture->rgba.size() - 3], 245);
    }
  }
}

TEST(HtmlReport, worstFramesComeWorstFirstAndTwinsOnce) {
  const test::ScratchDir dir;
  Results r = results({3, 20, {"f"}});
  test_results::writePictures(dir.path(), r, 32, 18);
  const Page page = pageOf(r, dir.path());
  const auto articles = page.section("worst").select_nodes(".//article");
  ASSERT_EQ(articles.size(), 3u) << "cases whose pictures are the same stand together";
  const std::vector<std::string> order{"as-printed", "as-published", "default"};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string text = allText(articles[i].node());
    EXPECT_THAT(text, HasSubstr(order[i] + " \xc2\xb7 none, " + order[i] + " \xc2\xb7 view frustum"));
    EXPECT_THAT(text, HasSubstr("largest FLIP"));
    EXPECT_THAT(text, HasSubstr("140 s"));
  }
}

TEST(HtmlReport, absentPicturesAndPathsThatLeadAwayAreTold) {
  const test::ScratchDir dir;
  test::writeFile(dir / "text.png", "no picture");
  test::writeFile(dir.path().parent_path() / "outside.png", "x");
  Results r = results({1, 4, {"f"}, {"none"}});
  r.units[0].worst = {{0, "a", "gone.png", "text.png", ""},
                      {1, "b", "../outside.png", "/etc/hostname", "x/../../y.png"},
                      {99, "beyond the frames", "", "", ""}};
  const Page page = pageOf(r, dir.path());
  EXPECT_TRUE(page.document.select_nodes("//img").empty());
  EXPECT_EQ(page.document.select_nodes("//p[@class='absent']").size(), 6u);
  EXPECT_THAT(page.shown, HasSubstr("gone.png: it cannot be read"));
  EXPECT_THAT(page.shown, HasSubstr("../outside.png: it is no file of this folder"));
  std::filesystem::remove(dir.path().parent_path() / "outside.png");
}

TEST(HtmlReport, noNameEndsItsElementOrBecomesMarkup) {
  const test::ScratchDir dir;
  const std::string hostile =
      "</script><script>alert('x')</script><!-- <img src=x onerror=alert(1)> &amp; \" \x01\xff \xe2\x80\xa8";
  Results r = results({2, 4, {hostile}, {hostile, "b"}});
  r.terrain = r.machine = r.version = hostile;
  r.notes = {hostile};
  for (Unit& unit : r.units) {
    unit.name.preset = hostile + unit.name.preset;
    unit.worst[0].why = unit.worst[0].reference = hostile;
    unit.skips[0].name = hostile;
  }
  for (Comparison& c : r.comparisons) c.b.preset = hostile;
  const Page page = pageOf(r, dir.path()), plain = pageOf(results({2, 4, {"f"}, {"a", "b"}}), dir.path());
  const auto count = [](const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
  };
  for (const char* tag : {"<script", "</script", "<!--", "<img"})
    EXPECT_EQ(count(page.file, tag), count(plain.file, tag)) << tag;
  EXPECT_EQ(count(page.file, "\xe2\x80\xa8"), 0u) << "a separator of lines";
  EXPECT_TRUE(page.document.select_nodes("//script | //img").empty());
  const std::string title = allText(page.document.select_node("//h1").node());
  EXPECT_THAT(title,
              HasSubstr("</script><script>alert('x')</script><!-- <img src=x onerror=alert(1)> &amp; \""));
  EXPECT_THAT(title, HasSubstr("\xef\xbf\xbd\xef\xbf\xbd")) << "what is no character or no UTF-8";
}

TEST(HtmlReport, whatIsNoNumberIsBlankAndNeverNan) {
  const test::ScratchDir dir;
  Results r = results({2, 6, {"f"}, {"none", "proposed"}});
  for (MeasuredFrame& frame : r.units[1].frames) {
    for (const Quantity& q : quantities())
      if (!q.whole) q.set(frame, kNan);
    frame.timeS = kNan;
  }
  r.units[2].frames[0].error.psnrDb = kInfinity;
  r.units[2].frames[1].error.flip = -kInfinity;
  r.units[3].frames[2].cost.total = kInfinity;
  r.budgetMs = kNan;
  r.comparisons = {{r.units[0].name, r.units[1].name, {kNan, kNan, kNan, 0}},
                   {r.units[0].name, r.units[2].name, {1.2, 0, kInfinity, 3}}};
  const Page page = pageOf(r, dir.path());
  const auto errors = cellsOf(tableOf(page, "summary", 1));
  EXPECT_TRUE(std::isnan(valueOf(errors[1], "FLIP")));
  EXPECT_EQ(valueOf(errors[0], "PSNR"), kInfinity);
  EXPECT_TRUE(std::isfinite(valueOf(errors[2], "PSNR"))) << "one equal picture does not make the rest equal";
  for (const auto& found :
       page.document.select_nodes("//text() | //@title | //@d | //@x | //@y | //@width | //@height | //@x1 | "
                                  "//@y1 | //@x2 | //@y2 | //@cx | //@cy | //@transform | //@viewBox")) {
    const std::string text = found.attribute() ? found.attribute().value() : found.node().value();
    for (const char* word : {"nan", "NaN", "Infinity", "undefined", "null"})
      EXPECT_EQ(text.find(word), std::string::npos) << text;
  }
  EXPECT_THAT(page.shown, HasSubstr("\xe2\x88\x9e"));
  EXPECT_THAT(allText(page.section("ratios")), HasSubstr("too few pairs to tell"));
}

TEST(HtmlReport, comparisonsSayWhatTheIntervalSays) {
  const test::ScratchDir dir;
  Results r = results({1, 6, {"f"}});
  const UnitName a = r.units[0].name, b = r.units[1].name;
  r.comparisons = {{a, b, {0.5, 0.45, 0.6, 60}}, {a, b, {1.5, 1.2, 1.7, 60}}, {a, b, {1.1, 0.9, 1.2, 60}}};
  const auto rows = cellsOf(tableOf(pageOf(r, dir.path()), "ratios"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].back().text, "50 % faster");
  EXPECT_EQ(rows[1].back().text, "50 % slower");
  EXPECT_EQ(rows[2].back().text, "no difference");
  EXPECT_EQ(valueOf(rows[0], "ratio"), 0.5);
}

TEST(HtmlReport, plotsAlongTheFlightWhatChangesAndNamesWhatDoesNot) {
  const test::ScratchDir dir;
  const Page page = pageOf(results({2, 30, {"f", "g"}}), dir.path());
  const pugi::xml_node flight = page.section("flight");
  for (const char* changes : {"frame time (ms)", "triangles", "FLIP"})
    EXPECT_EQ(flight.select_nodes((std::string("h4[.='") + changes + "']").c_str()).size(), 2u)
        << changes << " of each flight";
  for (const auto& found : flight.select_nodes("div[@class='small']"))
    EXPECT_EQ(found.node().select_nodes("figure").size(), 2u) << "one plot for each preset";
  EXPECT_THAT(allText(flight), HasSubstr("The same in every frame: vertices 400,000"));
  EXPECT_THAT(allText(flight), HasSubstr("largest FLIP, view frustum")) << "the worst frame is marked";
}

TEST(HtmlReport, marksTheBudgetInEachPlotOfTime) {
  const test::ScratchDir dir;
  Results r = results({2, 10, {"f"}});
  const auto marked = [&](const char* section) {
    return pageOf(r, dir.path()).section(section).select_nodes(".//text[.='budget 16.7 ms']").size();
  };
  EXPECT_EQ(marked("pareto"), 3u) << "three errors";
  EXPECT_EQ(marked("stages"), 1u);
  r.budgetMs = kNan;
  EXPECT_EQ(marked("stages"), 0u);
}

TEST(HtmlReport, anySizeOfResultsMakesAPage) {
  const test::ScratchDir dir;
  EXPECT_THAT(allText(pageOf(Results{}, dir.path()).document), HasSubstr("Nothing was measured"));
  EXPECT_GT(pageOf(results({1, 1, {"f"}, {"none"}}), dir.path()).shown.size(), 1000u);
  EXPECT_GT(pageOf(results({2, 0, {"f"}, {"none"}}), dir.path()).shown.size(), 1000u)
      << "units without frames";
  const Page many = pageOf(results({10, 60, {"f"}}), dir.path());
  EXPECT_EQ(cellsOf(tableOf(many, "summary")).size(), 30u);
  EXPECT_LT(many.file.size(), 2'000'000u);
}

/// Middles of the marks of presets and cases, in the order of the units.
std::size_t marksOf(const pugi::xml_node& plot) {
  return plot.select_nodes(".//path[starts-with(@class,'mark')]").size();
}

TEST(ParetoPlot, hasAPointForEachUnitAndTheFrontOfThoseNoneBeats) {
  const test::ScratchDir dir;
  Results r = results({3, 20, {"f"}, {"none", "proposed"}});
  const Page page = pageOf(r, dir.path());
  const pugi::xml_node plot = page.section("pareto").select_node(".//figure/*").node();
  EXPECT_EQ(marksOf(plot), 6u);
  EXPECT_THAT(allText(plot), HasSubstr("FLIP, mean of the frames"));
  EXPECT_THAT(allText(plot), HasSubstr("frame time, median (ms)"));
  EXPECT_THAT(allText(plot), HasSubstr("budget 16.7 ms"));
  const std::string text = allText(page.section("pareto"));
  const auto front = text.substr(text.find("On the front"));
  for (const char* preset : {"default", "as-published", "as-printed"})
    EXPECT_THAT(front, HasSubstr(std::string(preset) + " \xc2\xb7 proposed"));
  EXPECT_THAT(front.substr(0, front.find('.' + std::string(" "))), Not(HasSubstr("none")));

  ASSERT_TRUE(writeReport(r, dir.path()));
  EXPECT_EQ(test::readFile(dir / "report.html"), page.file);
}

TEST(ParetoPlot, ringsTheBest) {
  const test::ScratchDir dir;
  Results r = results({2, 100, {"f"}, {"none", "proposed"}});
  const auto ringed = [&] {
    return pageOf(r, dir.path()).section("pareto").select_nodes(".//figure[1]/svg/circle").size();
  };
  EXPECT_EQ(ringed(), 1u);
  r.budgetMs = 0.1;
  EXPECT_EQ(ringed(), 0u) << "none fits";
}

TEST(ParetoPlot, aPresetIsNotOnTheFrontByNoiseAndSeveralThatDoNotDifferAreOnItTogether) {
  const test::ScratchDir dir;
  Results r = results({1, 60, {"f"}, {"proposed"}});
  Unit& one = r.units.front();
  for (MeasuredFrame& frame : one.frames) frame.error.flip = 0.01;
  // The same again, a little faster in half of the frames and a little slower in the others.
  Unit noise = one, worse = one;
  noise.name.preset = "again";
  worse.name.preset = "worse";
  for (std::size_t i = 0; i < noise.frames.size(); ++i) {
    noise.frames[i].cost.total *= i % 2 ? 1.02 : 0.97;
    worse.frames[i].cost.total *= 1.3;
    // Its mean of FLIP is smaller by what one frame of sixty happens to have.
    if (i == 30) worse.frames[i].error.flip = 0.005;
    for (Unit* unit : {&noise, &worse}) unit->frames[i].repeatsMs = {unit->frames[i].cost.total};
  }
  r.units.insert(r.units.end(), {noise, worse});
  std::string text = allText(pageOf(r, dir.path()).section("pareto"));
  std::string front = text.substr(text.find("On the front"));
  EXPECT_THAT(front, HasSubstr("default \xc2\xb7 proposed"));
  EXPECT_THAT(front, HasSubstr("again \xc2\xb7 proposed"));
  EXPECT_THAT(front, Not(HasSubstr("worse")));
  for (Unit& unit : r.units) unit.frames.resize(5);
  text = allText(pageOf(r, dir.path()).section("pareto"));
  EXPECT_THAT(text, HasSubstr("The frames are too few to say what is on the front."));
}

TEST(HtmlReport, showsADashWithItsReasonForAPercentileOfTooFewFrames) {
  const test::ScratchDir dir;
  const Page page = pageOf(results({1, 60, {"f"}, {"proposed"}}), dir.path());
  const auto times = cellsOf(tableOf(page, "summary", 0));
  ASSERT_EQ(times.size(), 1u);
  EXPECT_GT(valueOf(times[0], "p95"), 0);
  EXPECT_THAT(allText(page.section("summary")), HasSubstr("- (too few frames)")) << "of the p99";
  EXPECT_THAT(allText(pageOf(results({1, 100, {"f"}, {"proposed"}}), dir.path()).section("summary")),
              Not(HasSubstr("too few frames")));
}

TEST(ParetoPlot, aFolderThatIsNotThereIsAFinding) {
  const test::ScratchDir dir;
  EXPECT_FALSE(writeReport(results({1, 2, {"f"}}), dir / "absent"));
}

}  // namespace
}  // namespace trimtab::harness
