#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "tests/core/fuzzy/fuzzylite_oracle.h"
#include "tests/core/policy/policy_oracle.h"
#include "tests/core/policy/random_policy.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

constexpr double kTiny = 5e-324;

PolicyTerm termOf(const std::string& shape, const std::string& name = "t") {
  auto read = readShape(shape, "test");
  EXPECT_TRUE(read) << toString(read.findings());
  PolicyTerm term = read ? *read : PolicyTerm{};
  term.signal = Signal::speed;
  term.name = name;
  return term;
}

using Long = long double;

Long flank(Long x, Long zero, Long one) {
  return (x - zero) / (one - zero);
}

/// The formulas of policy.h once more, from their definitions and in long double.
Long twin(const PolicyTerm& term, Long x) {
  const std::vector<double>& n = term.numbers;
  switch (term.shape) {
    case TermShape::points: {
      Long value = n[1];  // of the last point that is not beyond x
      for (std::size_t i = 0; i < n.size(); i += 2) {
        if (x < n[i]) {
          if (i > 0) value += (static_cast<Long>(n[i + 1]) - value) * flank(x, n[i - 2], n[i]);
          break;
        }
        value = n[i + 1];
      }
      return value;
    }
    case TermShape::triangle:
      if (x < n[0] || x > n[2]) return 0;
      return x == n[1] ? 1 : x < n[1] ? flank(x, n[0], n[1]) : flank(x, n[2], n[1]);
    case TermShape::trapezoid:
      if (x >= n[1] && x <= n[2]) return 1;
      if (x < n[0] || x > n[3]) return 0;
      if (x < n[1]) return std::isinf(n[0]) ? 1 : flank(x, n[0], n[1]);
      return std::isinf(n[3]) ? 1 : flank(x, n[3], n[2]);
    case TermShape::ramp:
      return std::min<Long>(1, std::max<Long>(0, flank(x, n[0], n[1])));
    case TermShape::gaussian:
      return std::exp(-((x - n[0]) / n[1]) * ((x - n[0]) / n[1]) / 2);
    case TermShape::bell:
      return 1 / (1 + std::pow(std::abs((x - n[0]) / n[1]), 2 * static_cast<Long>(n[2])));
    case TermShape::sigmoid:
      return 1 / (1 + std::exp(-n[1] * (x - n[0])));
  }
  return -1;
}

TEST(PolicyEdges, haveTheTwinsValueAtEveryCornerBesideItAndFarAway) {
  std::vector<PolicyTerm> terms;
  for (const char* shape : {"points 0 0 0 1 5e-324 1 5e-324 0",
                            "points -1e12 0 1e12 1",
                            "points 1 0.25 1 0.75 2 0.5 2 0 3 1",
                            "points 0 0 1e-300 1 1 0",
                            "points -0 0 0 1",
                            "points 1e11 0 100000000000.00002 1",
                            "triangle 0 5e-324 1",
                            "triangle 0 0 5e-324",
                            "triangle -1e12 -1e12 1e12",
                            "triangle 1 2 2",
                            "trapezoid 0 0 0 1",
                            "trapezoid 0 1 1 1",
                            "trapezoid 5 5 6 6",
                            "trapezoid -inf 3 3 4",
                            "trapezoid 3 4 4 inf",
                            "trapezoid -inf 1 2 inf",
                            "trapezoid -1e12 0 5e-324 1e12",
                            "ramp 0 5e-324",
                            "ramp 5e-324 0",
                            "ramp 1 1.0000000000000002",
                            "ramp -1e12 1e12",
                            "ramp 1e12 -1e12",
                            "ramp 1e-308 1.1e-308",
                            "gaussian 0 1e-320",
                            "gaussian 1e12 1e-12",
                            "gaussian 0 1e12",
                            "gaussian 5 5e-324",
                            "bell 0 1e-320 1",
                            "bell 1e12 1 50",
                            "bell 0 1e12 0.5",
                            "bell 3 0.5 0.5",
                            "sigmoid 0 1e12",
                            "sigmoid 0 -1e12",
                            "sigmoid 1e12 1e-12",
                            "sigmoid 5 5e-324",
                            "sigmoid -3 1e-320"})
    terms.push_back(termOf(shape));
  std::mt19937_64 random(31);
  for (int i = 0; i < 100; ++i)
    for (const PolicyTerm& term : test::randomPolicy(random, {}).terms) terms.push_back(term);
  std::size_t compared = 0;
  for (const PolicyTerm& term : terms) {
    Policy policy;
    policy.terms = {term};
    ASSERT_TRUE(compile(policy, "test")) << shapeText(term);
    std::vector<double> at{0,     -0.0,   kTiny,     -kTiny,     1e-308,  -1e-308, 1,       -1,
                           1e300, -1e300, kInfinity, -kInfinity, DBL_MAX, DBL_MIN, -DBL_MAX};
    for (const double n : term.numbers)
      for (const double x : {n, n + 1, n - 1, n * 0.999, n * 1.001, n / 2})
        for (const double y : {x, std::nextafter(x, kInfinity), std::nextafter(x, -kInfinity)})
          at.push_back(y);
    for (const double x : at) {
      if (std::isnan(x)) continue;
      const double mu = membershipOf(term, x);
      ASSERT_TRUE(mu >= 0 && mu <= 1) << shapeText(term) << " at " << x;
      ASSERT_NEAR(mu, static_cast<double>(twin(term, x)), 2e-14) << shapeText(term) << " at " << x;
      ++compared;
    }
  }
  EXPECT_GT(compared, 50000u);
}

TEST(PolicyEdges, haveFuzzylitesValueExactlyAtEveryCorner) {
  if (!test::fuzzylitePresent()) GTEST_SKIP() << "needs the fuzzylite program";
  std::mt19937_64 random(32);
  double worst = 0;
  for (const char* shape :
       {"points 100 0 200 0 200 1 300 1 300 0.25 400 0.25", "triangle 100 100 300", "triangle 100 300 300",
        "triangle 100 200 400", "trapezoid 100 100 300 300", "trapezoid -inf 100 100 200",
        "trapezoid 100 200 200 inf", "trapezoid 100 100 200 300", "ramp 100 200", "ramp 200 100",
        "gaussian 100 30", "bell 100 30 2", "bell 100 30 0.5", "sigmoid 100 0.05", "sigmoid 100 -0.05"}) {
    Policy policy;
    policy.terms = {termOf(shape)};
    policy.rules = {{"speed is t", {{Lever::lod_scale, 8}}, 1, true, ""},
                    {"speed is very t", {{Lever::lod_scale, 5}}, 0.5, true, ""},
                    {"speed is any", {{Lever::lod_scale, 1}}, 0.5, true, ""}};
    std::vector<SignalValues> rows;
    for (const double x : {0.0, 50.0, 99.99, 100.0, 100.01, 150.0, 199.99, 200.0, 200.01, 250.0, 300.0,
                           300.01, 399.99, 400.0, 1499.99, 1500.0}) {
      rows.emplace_back();
      rows.back()[Signal::speed] = x;
    }
    for (const RuleFormat format : {RuleFormat::fuzzylite, RuleFormat::matlab})
      worst = std::max(worst, test::differenceFromFuzzylite(policy, format, random, 0, rows));
  }
  EXPECT_LE(worst, 1e-9);
}

TEST(PolicyEdges, beyondASignalsRangeAreThoseOfItsEnd) {
  std::mt19937_64 random(33);
  for (int i = 0; i < 50; ++i) {
    const Policy policy = test::randomPolicy(random, {});
    const auto compiled = compile(policy, "test");
    ASSERT_TRUE(compiled);
    PolicyDecision end, beyond;
    for (const bool high : {false, true}) {
      SignalValues atEnd, far, further;
      for (const SignalRow& row : kSignalRows) {
        atEnd[row.signal] = high ? row.range.high : row.range.low;
        far[row.signal] = high ? DBL_MAX : -DBL_MAX;
        further[row.signal] = high ? kInfinity : -kInfinity;
      }
      compiled->decide(atEnd, end);
      for (const SignalValues& values : {far, further}) {
        compiled->decide(values, beyond);
        EXPECT_EQ(beyond.firing, end.firing);
      }
    }
  }
}

}  // namespace
}  // namespace trimtab
