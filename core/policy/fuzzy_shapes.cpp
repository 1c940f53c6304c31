#include "fuzzy_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "trimtab/units/number.h"

namespace trimtab::fuzzy_system {
namespace {

constexpr std::array<std::string_view, kTermShapes.size()> kSystemNames{
    "Discrete", "Triangle", "Trapezoid", "Ramp", "Gaussian", "Bell", "Sigmoid"};

using Numbers = std::vector<double>;

/// Rises from 0 at a to 1 at b as two parabolas.
double rise(double x, double a, double b) {
  if (x >= b) return 1;
  if (x <= a) return 0;
  const double part = (x - a) / (b - a);
  return part < 0.5 ? 2 * part * part : 1 - 2 * (1 - part) * (1 - part);
}

/// Falls from 1 at a to 0 at b; at a step the later side counts, as in a term of points.
double fall(double x, double a, double b) {
  return 1 - rise(x, a, b);
}

double bellCurve(double x, double deviation, double mean) {
  return std::exp(-0.5 * (x - mean) / deviation * (x - mean) / deviation);
}

double sigmoid(double x, double slope, double middle) {
  return 1 / (1 + std::exp(-slope * (x - middle)));
}

/// One of MATLAB's other shapes: its function, and the stretches in which it changes.
struct Curve {
  std::string_view name;
  std::size_t count;
  const char* numbers;  ///< what they are
  bool (*good)(const Numbers&);
  double (*at)(const Numbers&, double x);
  std::vector<std::pair<double, double>> (*stretches)(const Numbers&);
};

/// A Gaussian is below 5e-5 there, and a sigmoid within 1e-5 of its ends.
constexpr double kDeviations = 4.5, kSlopes = 12;

std::vector<std::pair<double, double>> betweenSigmoids(const Numbers& n) {
  const double first = kSlopes / std::abs(n[0]), second = kSlopes / std::abs(n[2]);
  return {{std::min(n[1] - first, n[3] - second), std::max(n[1] + first, n[3] + second)}};
}

constexpr auto kSlopesAreSet = [](const Numbers& n) { return n[0] != 0 && n[2] != 0; };
constexpr const char* kSigmoidNumbers = "four numbers: slope, middle, slope, middle";

const Curve kCurves[] = {
    {"smf", 2, "two numbers that rise: where it is 0, where it is 1",
     [](const Numbers& n) { return n[0] <= n[1]; },
     [](const Numbers& n, double x) { return rise(x, n[0], n[1]); },
     [](const Numbers& n) { return std::vector{std::pair(n[0], n[1])}; }},
    {"zmf", 2, "two numbers that rise: where it is 1, where it is 0",
     [](const Numbers& n) { return n[0] <= n[1]; },
     [](const Numbers& n, double x) { return fall(x, n[0], n[1]); },
     [](const Numbers& n) { return std::vector{std::pair(n[0], n[1])}; }},
    {"pimf", 4, "four numbers that rise: left foot, left top, right top, right foot",
     [](const Numbers& n) { return std::is_sorted(n.begin(), n.end()) && n[0] < n[3]; },
     [](const Numbers& n, double x) { return rise(x, n[0], n[1]) * fall(x, n[2], n[3]); },
     [](const Numbers& n) {
       return std::vector{std::pair(n[0], n[1]), std::pair(n[2], n[3])};
     }},
    {"gauss2mf", 4, "four numbers: deviation above 0, left top, deviation above 0, right top",
     [](const Numbers& n) { return n[0] > 0 && n[2] > 0 && n[1] <= n[3]; },
     [](const Numbers& n, double x) {
       return (x < n[1] ? bellCurve(x, n[0], n[1]) : 1) * (x > n[3] ? bellCurve(x, n[2], n[3]) : 1);
     },
     [](const Numbers& n) {
       return std::vector{std::pair(n[1] - kDeviations * n[0], n[1]),
                          std::pair(n[3], n[3] + kDeviations * n[2])};
     }},
    {"dsigmf", 4, kSigmoidNumbers, kSlopesAreSet,
     [](const Numbers& n, double x) {
       return std::min(std::abs(sigmoid(x, n[0], n[1]) - sigmoid(x, n[2], n[3])), 1.0);
     },
     betweenSigmoids},
    {"psigmf", 4, kSigmoidNumbers, kSlopesAreSet,
     [](const Numbers& n, double x) { return sigmoid(x, n[0], n[1]) * sigmoid(x, n[2], n[3]); },
     betweenSigmoids}};

const Curve* curveOf(const Term& term) {
  for (const Curve& curve : kCurves)
    if (curve.name == term.shape) return &curve;
  return nullptr;
}

/// Adds points over one stretch, as dense as the square root of the curvature, which spreads the error
/// evenly.
void addStretch(const Curve& curve, const Numbers& numbers, std::pair<double, double> stretch,
                std::size_t pieces, CurvePoints& made) {
  constexpr int kSteps = 8192;
  const auto [low, high] = stretch;
  const auto at = [&](double x) { return curve.at(numbers, x); };
  if (!(low < high)) {  // a step
    const double near = std::max(1.0, std::abs(low)) * 1e-9;
    made.xy.insert(made.xy.end(), {low, at(low - near), low, at(low + near)});
    return;
  }
  const auto x = [&](int i) { return std::lerp(low, high, static_cast<double>(i) / kSteps); };
  std::vector<double> bend(kSteps + 1, 0);
  for (int i = 1; i <= kSteps; ++i) {
    const double second = i == kSteps ? 0 : at(x(i - 1)) - 2 * at(x(i)) + at(x(i + 1));
    bend[static_cast<std::size_t>(i)] =
        bend[static_cast<std::size_t>(i) - 1] + std::sqrt(std::abs(second)) + 1e-7;
  }
  std::size_t step = 0;
  double left = low, leftY = at(low);
  made.xy.insert(made.xy.end(), {left, leftY});
  for (std::size_t piece = 1; piece <= pieces; ++piece) {
    const double wanted = bend.back() * static_cast<double>(piece) / static_cast<double>(pieces);
    const std::size_t from = step;
    while (step < kSteps && bend[step] < wanted) ++step;
    if (piece == pieces) step = kSteps;
    if (step == from) continue;
    const double right = x(static_cast<int>(step)), rightY = at(right);
    for (std::size_t i = from; i <= step; ++i) {
      const double inside = x(static_cast<int>(i));
      const double line = std::lerp(leftY, rightY, (inside - left) / (right - left));
      made.difference = std::max(made.difference, std::abs(line - at(inside)));
    }
    left = right, leftY = rightY;
    made.xy.insert(made.xy.end(), {left, leftY});
  }
}

}  // namespace

std::optional<TermShape> policyShapeOf(const Term& term) {
  const auto at = std::find(kSystemNames.begin(), kSystemNames.end(), term.shape);
  if (at == kSystemNames.end()) return std::nullopt;
  return static_cast<TermShape>(at - kSystemNames.begin());
}

std::string_view systemNameOf(TermShape shape) {
  return kSystemNames[static_cast<std::size_t>(shape)];
}

std::optional<TermFlaw> membershipFlaw(const Term& term) {
  const Curve* const curve = curveOf(term);
  if (!curve) {
    const auto shape = policyShapeOf(term);
    if (!shape) return TermFlaw{"a shape that a policy has", term.shape};
    return flawOf({Signal::altitude, term.name, *shape, term.numbers});
  }
  if (term.numbers.size() != curve->count)
    return TermFlaw{curve->numbers, std::to_string(term.numbers.size()) + " numbers"};
  std::string found;
  for (const double number : term.numbers) {
    if (!(std::abs(number) <= 1e12)) return TermFlaw{"numbers from -1e12 to 1e12", numberText(number)};
    found += (found.empty() ? "" : " ") + numberText(number);
  }
  if (!curve->good(term.numbers)) return TermFlaw{curve->numbers, found};
  return std::nullopt;
}

double membershipIn(const Term& term, double x) {
  if (const Curve* const curve = curveOf(term)) return curve->at(term.numbers, x);
  return membershipAt(*policyShapeOf(term), term.numbers, x);
}

CurvePoints pointsOf(const Term& term) {
  const Curve& curve = *curveOf(term);
  const auto stretches = curve.stretches(term.numbers);
  const std::size_t pieces = kMostTermNumbers / 2 / stretches.size() - 1;
  CurvePoints made;
  for (const auto& stretch : stretches) addStretch(curve, term.numbers, stretch, pieces, made);
  // Two stretches that meet have a point in common, and beyond the ends the curve goes on.
  for (std::size_t i = 0; i + 3 < made.xy.size(); i += 2)
    if (made.xy[i] == made.xy[i + 2] && made.xy[i + 1] == made.xy[i + 3])
      made.xy.erase(made.xy.begin() + static_cast<std::ptrdiff_t>(i),
                    made.xy.begin() + static_cast<std::ptrdiff_t>(i + 2));
  return made;
}

}  // namespace trimtab::fuzzy_system
