#include "app/harness/results.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <set>

#include "trimtab/units/not_finite.h"

namespace trimtab::harness {
namespace {

/// Any bits at all, so that every kind of number is met.
double anyDouble(std::mt19937_64& random) {
  switch (random() % 8) {
    case 0:
      return kNan;
    case 1:
      return random() % 2 ? kInfinity : -kInfinity;
    case 2:
      return random() % 2 ? -0.0 : 0.0;
    case 3:
      return std::numeric_limits<double>::denorm_min() * static_cast<double>(random() % 100);
    default: {
      const double value = std::bit_cast<double>(random());
      return std::isnan(value) ? kNan : value;
    }
  }
}
bool sameBits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

Results anyResults(unsigned seed) {
  std::mt19937_64 random(seed);
  Results results{"Kansai \"35\"", "a machine, 2 cores", "0.1.0", 640, 360, 3, anyDouble(random), {}, {}, {}};
  results.notes = {"one, two\nthree", ""};
  for (const char* preset : {"default", "as-published", "\xc3\xa9t\xc3\xa9"})
    for (const char* method : {"none", "view_frustum"}) {
      Unit unit;
      unit.name = {"circuit", preset, method};
      unit.framesDecided = random() % 100000;
      for (int i = 0; i < 20; ++i) {
        MeasuredFrame frame;
        frame.row = random() % 10000;
        frame.timeS = anyDouble(random);
        for (const Quantity& quantity : quantities())
          quantity.set(frame, quantity.whole ? static_cast<double>(random() >> 11) : anyDouble(random));
        for (std::size_t r = 0; r < results.repeats; ++r) frame.repeatsMs.push_back(anyDouble(random));
        unit.frames.push_back(frame);
      }
      unit.worst = {{7, "largest FLIP", "a.png", "b.png", "c.png"}};
      unit.skips = {{"blur at rest", 5, 20, anyDouble(random), {anyDouble(random), 0.5, kInfinity, 6}}};
      results.units.push_back(unit);
    }
  results.comparisons = {{results.units[0].name, results.units[1].name, {0.5, 0.25, kInfinity, 60}}};
  return results;
}

TEST(Results, readBackBitForBit) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Results written = anyResults(seed);
    const std::string text = toJson(written);
    const auto read = parseResults(text, "results.json");
    ASSERT_TRUE(read) << toString(read.findings());
    EXPECT_EQ(read->terrain, written.terrain);
    EXPECT_EQ(read->notes, written.notes);
    EXPECT_TRUE(sameBits(read->budgetMs, written.budgetMs));
    ASSERT_EQ(read->units.size(), written.units.size());
    for (std::size_t u = 0; u < written.units.size(); ++u) {
      const Unit &a = written.units[u], &b = read->units[u];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.framesDecided, b.framesDecided);
      ASSERT_EQ(a.frames.size(), b.frames.size());
      for (std::size_t i = 0; i < a.frames.size(); ++i) {
        EXPECT_EQ(a.frames[i].row, b.frames[i].row);
        EXPECT_TRUE(sameBits(a.frames[i].timeS, b.frames[i].timeS));
        for (const Quantity& quantity : quantities())
          ASSERT_TRUE(sameBits(quantity.of(a.frames[i]), quantity.of(b.frames[i])))
              << quantity.key << ' ' << quantity.of(a.frames[i]);
        ASSERT_EQ(a.frames[i].repeatsMs.size(), b.frames[i].repeatsMs.size());
        for (std::size_t r = 0; r < a.frames[i].repeatsMs.size(); ++r)
          EXPECT_TRUE(sameBits(a.frames[i].repeatsMs[r], b.frames[i].repeatsMs[r]));
      }
      EXPECT_EQ(b.worst.at(0).why, "largest FLIP");
      EXPECT_EQ(b.skips.at(0).ratio.high, kInfinity);
      EXPECT_TRUE(sameBits(a.skips[0].savedMs, b.skips[0].savedMs));
    }
    EXPECT_EQ(toJson(*read), text);
  }
}

TEST(Results, saysEveryOffenceAndWhere) {
  std::string text = toJson(anyResults(1));
  const auto replace = [&text](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  replace("\"width_px\":640", "\"width_px\":-3");
  replace("\"machine\":\"a machine, 2 cores\"", "\"machine\":7");
  replace("\"low\":0.25", "\"low\":\"low\"");
  replace("\"frame\":7", "\"frame\":20");
  replace("\"triangles\"", "\"triangels\"");
  const auto read = parseResults(text, "DIR/results.json");
  ASSERT_FALSE(read);
  std::set<std::string> keys;
  for (const Finding& finding : read.findings()) {
    EXPECT_EQ(finding.where, "DIR/results.json");
    EXPECT_FALSE(finding.expected.empty() || finding.found.empty());
    keys.insert(finding.key);
  }
  EXPECT_EQ(keys, (std::set<std::string>{"width_px", "machine", "comparisons[0].frame_time.low",
                                         "units[0].worst[0].frame", "units[0].columns"}))
      << toString(read.findings());
}

TEST(Results, refusesWhatIsNoResultsAtAll) {
  for (const char* text : {"", "{", "[]", "7", "{}", "{\"format\":\"trimtab-export\"}",
                           "{\"format\":\"trimtab-bench\",\"format_version\":2}",
                           "{\"format\":\"trimtab-bench\",\"format_version\":1,\"units\":[[],{},7]}"})
    EXPECT_FALSE(parseResults(text, "x")) << text;
}

TEST(Results, readsCostsOfAVersionThatHadFewerAsNotMeasured) {
  Results results = anyResults(2);
  results.units.resize(1);
  results.units[0].frames.resize(1);
  results.units[0].worst.clear();
  results.units[0].frames[0].error.flip = 0.25;
  std::string text = toJson(results);
  const std::string name = "\"flip\"";
  text.replace(text.find(name), name.size(), "\"flop\"");
  const auto read = parseResults(text, "x");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_TRUE(std::isnan(read->units[0].frames[0].error.flip));
}

TEST(Quantities, haveKeysOfTheirOwnAndReadWhatTheyWrote) {
  std::set<std::string_view> keys;
  for (const Quantity& quantity : quantities()) {
    EXPECT_TRUE(keys.insert(quantity.key).second) << quantity.key;
    EXPECT_FALSE(quantity.label.empty());
    EXPECT_EQ(quantityOf(quantity.key), &quantity);
    MeasuredFrame frame;
    quantity.set(frame, 17);
    EXPECT_EQ(quantity.of(frame), 17) << quantity.key;
    // Nothing else has moved.
    MeasuredFrame untouched;
    for (const Quantity& other : quantities())
      if (other.key != quantity.key) {
        EXPECT_TRUE(sameBits(other.of(frame), other.of(untouched))) << other.key;
      }
  }
  for (const char* key : {"frame_ms", "draw_ms", "page_ms", "blur_ms", "triangles", "wrongly_culled_px",
                          "geometric_max_px", "psnr_db", "ssim", "flip", "pop", "hidden_drawn_share"})
    EXPECT_NE(quantityOf(key), nullptr) << key;
  EXPECT_EQ(quantityOf("frame"), nullptr);
}

TEST(Summary, takesPercentilesFromTheBadEnd) {
  Unit unit;
  for (int i = 1; i <= 200; ++i) {
    MeasuredFrame frame;
    frame.cost.total = 201 - i;
    frame.error.ssim = i / 200.0;
    frame.error.pop = kNan;
    unit.frames.push_back(frame);
  }
  const Summary time = summarise(unit, *quantityOf("frame_ms"));
  EXPECT_EQ(time.median, 100);
  EXPECT_EQ(time.p95, 190);
  EXPECT_EQ(time.p99, 198);
  EXPECT_EQ(time.worst, 200);
  EXPECT_NEAR(time.mean, 100.5, 1e-9);
  const Summary ssim = summarise(unit, *quantityOf("ssim"));
  EXPECT_EQ(ssim.worst, 1 / 200.0);
  EXPECT_EQ(ssim.p95, 11 / 200.0);
  const Summary pop = summarise(unit, *quantityOf("pop"));
  EXPECT_TRUE(std::isnan(pop.median) && std::isnan(pop.mean) && std::isnan(pop.worst));
}

TEST(Comparison, pairsFramesAndCancelsWhatTheirDrawsShare) {
  std::mt19937_64 random(5);
  std::lognormal_distribution<double> mood(0, 1);
  std::vector<Unit> units;
  for (const char* flight : {"f", "g"})
    for (const char* preset : {"p", "q"})
      for (const char* method : {"none", "view_frustum"})
        units.push_back({{flight, preset, method}, {}, {}, {}, 0, {}});
  // q takes 0.8 of p, view_frustum 0.5 of none, and the machine swings by the factor e from draw to draw.
  for (std::size_t row = 0; row < 12; ++row) {
    for (Unit& unit : units) unit.frames.push_back({row, 0, {}, {}, {}, {}, {}});
    for (int repeat = 0; repeat < 5; ++repeat) {
      const double now = mood(random);
      for (Unit& unit : units)
        unit.frames.back().repeatsMs.push_back(now * (unit.name.preset == "q" ? 0.8 : 1) *
                                               (unit.name.method == "none" ? 1 : 0.5));
    }
  }
  const std::vector<Comparison> comparisons = compareUnits(units);
  // Each flight: q against p in two cases, none against view_frustum in two presets.
  ASSERT_EQ(comparisons.size(), 8u);
  for (const Comparison& c : comparisons) {
    EXPECT_EQ(c.a.flight, c.b.flight);
    const double expected = c.a.preset != c.b.preset ? 0.8 : 2;
    EXPECT_NEAR(c.frameTime.median, expected, 1e-9);
    EXPECT_NEAR(c.frameTime.low, expected, 1e-9);
    EXPECT_NEAR(c.frameTime.high, expected, 1e-9);
    EXPECT_EQ(c.frameTime.pairs, 12u);
    if (c.a.preset == c.b.preset) {
      EXPECT_EQ(c.a.method, "view_frustum");
    }
  }
}

TEST(Csv, hasARowAFrameAndAColumnAQuantity) {
  const Results results = anyResults(3);
  const std::string text = toCsv(results);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 6 * 20);
  const std::string header = text.substr(0, text.find('\n'));
  EXPECT_EQ(static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')), 4 + quantities().size());
  EXPECT_EQ(header.substr(0, 40), "flight,preset,case,row,time_s,frame_ms,d");
  EXPECT_EQ(text.find("nan"), std::string::npos) << "what was not measured is an empty cell";
}

}  // namespace
}  // namespace trimtab::harness
