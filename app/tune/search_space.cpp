#include "search_space.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "trimtab/preset/policy_lines.h"
#include "trimtab/preset/table.h"
#include "trimtab/units/number.h"

namespace trimtab::tune {
namespace {

/// What a text of `--free` says.
struct Wanted {
  std::string key;  ///< "lod.scale", or "lod." for a group
  bool group = false;
  std::optional<Range> ends;
};

Finding refused(const std::string& key, std::string expected, std::string found) {
  return {Severity::error, "--free", key, std::move(expected), std::move(found)};
}

std::optional<double> numberIn(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

Result<Wanted> parse(const std::string& text) {
  Wanted wanted;
  const std::size_t equals = text.find('=');
  wanted.key = text.substr(0, equals);
  if (wanted.key.ends_with(".*")) {
    wanted.group = true;
    wanted.key.pop_back();
  }
  if (equals == std::string::npos) return wanted;
  const std::string_view ends = std::string_view(text).substr(equals + 1);
  const std::size_t dots = ends.find("..");
  const auto low = numberIn(ends.substr(0, dots));
  const auto high = dots == std::string::npos ? std::nullopt : numberIn(ends.substr(dots + 2));
  if (wanted.group || !low || !high || !(*low < *high))
    return refused(wanted.key, "KEY, GROUP.* or KEY=LOW..HIGH with LOW below HIGH", text);
  wanted.ends = Range{*low, *high};
  return wanted;
}

/// Makes the axes of one row of the table.
class AxesOf {
 public:
  AxesOf(const ParameterRow& row, const Movable& start, std::vector<Axis>& axes)
      : row_(row), start_(start), axes_(axes) {}

  /// `ends` replaces the usual range of what the row counts: the value, or the x of points.
  Findings add(const std::optional<Range>& ends) {
    if (ends && (ends->low < row_.hard.low || ends->high > row_.hard.high))
      return {refused(std::string(row_.key),
                      "ends within " + numberText(row_.hard.low) + " to " + numberText(row_.hard.high),
                      numberText(ends->low) + ".." + numberText(ends->high))};
    const std::size_t first = axes_.size();
    const Range range = ends.value_or(row_.usual);
    switch (row_.kind) {
      case Kind::scalar:
        add(
            "", range, row_.logarithmic, row_.whole,
            [key = &row_](const Movable& m) { return std::get<double>(key->get(m.parameters)); },
            [key = &row_](Movable& m, double v) { key->set(m.parameters, v); });
        break;
      case Kind::flag:
        add(
            "", {0, 1}, false, true,
            [key = &row_](const Movable& m) { return std::get<bool>(key->get(m.parameters)) ? 1.0 : 0.0; },
            [key = &row_](Movable& m, double v) { key->set(m.parameters, v > 0.5); });
        break;
      case Kind::choice:
        add(
            "", {0, static_cast<double>(row_.choices.size() - 1)}, false, true,
            [key = &row_](const Movable& m) {
              return static_cast<double>(std::get<ChoiceIndex>(key->get(m.parameters)).index);
            },
            [key = &row_](Movable& m, double v) {
              key->set(m.parameters, ChoiceIndex{static_cast<std::size_t>(v)});
            });
        break;
      case Kind::curve:
        addCurve(range);
        break;
      case Kind::bands:
        addBands();
        break;
      case Kind::lines:
        row_.key == "policy.terms" ? addTerms() : addRules();
        break;
    }
    return checked(first, ends.has_value());
  }

 private:
  template <class Get, class Set>
  void add(const std::string& part, Range range, bool logarithmic, bool whole, Get get, Set set) {
    axes_.push_back({std::string(row_.key) + part, range.low, range.high, logarithmic && range.low > 0, whole,
                     std::move(get), std::move(set)});
  }

  void addCurve(Range range) {
    const std::size_t points = std::get<CurvePoints>(row_.get(start_.parameters)).size;
    for (std::size_t i = 0; i < points; ++i) {
      const auto coordinate = [&](const char* name, Range ends, double CurvePoint::*of) {
        add(
            " point " + std::to_string(i + 1) + name, ends, false, false,
            [row = &row_, i, of](const Movable& m) {
              return std::get<CurvePoints>(row->get(m.parameters)).point[i].*of;
            },
            [row = &row_, i, of](Movable& m, double v) {
              CurvePoints curve = std::get<CurvePoints>(row->get(m.parameters));
              curve.point[i].*of = v;
              row->set(m.parameters, curve);
            });
      };
      coordinate(" x", range, &CurvePoint::x);
      coordinate(" y", {0, 1}, &CurvePoint::y);
    }
  }

  void addBands() {
    const BandList bands = std::get<BandList>(row_.get(start_.parameters));
    for (std::size_t i = 0; i < bands.size; ++i)
      add(
          " band " + std::to_string(i + 1) + " from", {0.01, BandList::kTop - 0.01}, false, false,
          [row = &row_, i](const Movable& m) {
            return std::get<BandList>(row->get(m.parameters)).band[i].low;
          },
          [row = &row_, i](Movable& m, double v) {
            BandList moved = std::get<BandList>(row->get(m.parameters));
            moved.band[i].low = v;
            row->set(m.parameters, moved);
          });
  }

  /// A number of a term may go to an eighth or to eightfold, and one that is not positive by a quarter of
  /// what its signal ranges over: the signal's range itself is far wider than any flight.
  static Range around(double number, Range signal) {
    constexpr double kTimes = 8, kPart = 0.25;
    if (number > 0 && signal.low >= 0)
      return {std::max(number / kTimes, signal.low), std::min(number * kTimes, signal.high)};
    const double way = kPart * (signal.high - signal.low);
    return {std::max(number - way, signal.low), std::min(number + way, signal.high)};
  }

  void addTerms() {
    for (std::size_t t = 0; t < start_.policy.terms.size(); ++t) {
      const PolicyTerm& term = start_.policy.terms[t];
      const bool oneSlope = term.shape == TermShape::gaussian || term.shape == TermShape::bell ||
                            term.shape == TermShape::sigmoid;
      for (std::size_t i = 0; i < term.numbers.size(); ++i) {
        const double number = term.numbers[i];
        if (!std::isfinite(number)) continue;
        const bool isMembership = term.shape == TermShape::points && i % 2 == 1;
        // Slopes and widths are of no signal's unit, and have a sign that stays.
        const Range range = isMembership          ? Range{0, 1}
                            : !oneSlope || i == 0 ? around(number, rowOf(term.signal).range)
                            : number > 0          ? Range{number / 8, number * 8}
                                                  : Range{number * 8, number / 8};
        if (!(range.low < range.high)) continue;
        add(
            ' ' + std::string(rowOf(term.signal).key) + ' ' + term.name + ' ' + std::to_string(i + 1), range,
            !isMembership && number > 0, false,
            [t, i](const Movable& m) { return m.policy.terms[t].numbers[i]; },
            [t, i](Movable& m, double v) { m.policy.terms[t].numbers[i] = v; });
      }
    }
  }

  void addRules() {
    for (std::size_t r = 0; r < start_.policy.rules.size(); ++r) {
      const PolicyRule& rule = start_.policy.rules[r];
      if (!rule.enabled) continue;
      const std::string name = ' ' + std::to_string(r + 1) + ' ';
      for (std::size_t s = 0; s < rule.settings.size(); ++s) {
        const LeverRow& lever = rowOf(rule.settings[s].lever);
        add(
            name + std::string(lever.key), lever.usual, lever.logarithmic, false,
            [r, s](const Movable& m) { return m.policy.rules[r].settings[s].value; },
            [r, s](Movable& m, double v) { m.policy.rules[r].settings[s].value = v; });
      }
      add(
          name + "weight", {0, 1}, false, false, [r](const Movable& m) { return m.policy.rules[r].weight; },
          [r](Movable& m, double v) { m.policy.rules[r].weight = v; });
    }
  }

  /// Widens usual ranges to where the preset is; ends that somebody gave are refused instead.
  Findings checked(std::size_t first, bool given) {
    for (std::size_t i = first; i < axes_.size(); ++i) {
      Axis& axis = axes_[i];
      const double at = axis.get(start_);
      if (given && (at < axis.low || at > axis.high))
        return {refused(axis.name, "ends that hold where the preset is, " + numberText(at),
                        numberText(axis.low) + ".." + numberText(axis.high))};
      axis.low = std::min(axis.low, at);
      axis.high = std::max(axis.high, at);
      if (!(axis.low > 0)) axis.logarithmic = false;
    }
    return {};
  }

  const ParameterRow& row_;
  const Movable& start_;
  std::vector<Axis>& axes_;
};

/// Puts the numbers of a term in the order that its shape asks for.
void putInOrder(PolicyTerm& term) {
  if (term.shape == TermShape::triangle || term.shape == TermShape::trapezoid)
    std::sort(term.numbers.begin(), term.numbers.end());
  if (term.shape != TermShape::points) return;
  std::vector<double> x;
  for (std::size_t i = 0; i + 1 < term.numbers.size(); i += 2) x.push_back(term.numbers[i]);
  std::sort(x.begin(), x.end());
  for (std::size_t i = 0; i < x.size(); ++i) term.numbers[2 * i] = x[i];
}

void putInOrder(const ParameterRow& row, TuningParameters& parameters) {
  if (row.kind == Kind::curve) {
    CurvePoints curve = std::get<CurvePoints>(row.get(parameters));
    std::vector<double> x;
    for (const CurvePoint& point : curve.span()) x.push_back(point.x);
    std::sort(x.begin(), x.end());
    for (std::size_t i = 0; i < curve.size; ++i) {
      // Two points may share an x, a third may not.
      if (i > 1 && x[i] <= x[i - 2]) x[i] = std::nextafter(x[i - 2], std::numeric_limits<double>::max());
      curve.point[i].x = x[i];
    }
    row.set(parameters, curve);
  }
  if (row.kind == Kind::bands) {
    BandList bands = std::get<BandList>(row.get(parameters));
    std::vector<double> low;
    for (const Band& band : bands.span()) low.push_back(band.low);
    std::sort(low.begin(), low.end());
    // Bands are wider than twice the hysteresis, the first is farther above 0, and all have room below the
    // top.
    const double hysteresis = parameters.scheme.hysteresis.value() + 1e-6, gap = 2 * hysteresis;
    for (std::size_t i = 0; i < bands.size; ++i) {
      const double least = i > 0 ? low[i - 1] + gap : hysteresis;
      const double above = gap * static_cast<double>(bands.size - i);
      low[i] = std::clamp(low[i], least, std::max(BandList::kTop - above, least));
      bands.band[i].low = low[i];
    }
    row.set(parameters, bands);
  }
}

/// Says what no search can move: what was agreed with a host, what an image is, what is text.
bool isMovable(const ParameterRow& row) {
  const std::string_view group = row.key.substr(0, row.key.find('.'));
  if (row.key == "objects.light_px") return false;
  for (const char* fixed : {"view", "terrain", "symbology", "host", "measure"})
    if (group == fixed) return false;
  return true;
}

double fromPlace(const Axis& axis, double place) {
  const double at = std::clamp(std::isnan(place) ? 0.0 : place, 0.0, 1.0);
  if (axis.whole) {
    const double steps = std::floor(axis.high - axis.low) + 1;
    return axis.low + std::min(std::floor(at * steps), steps - 1);
  }
  // The ends are exact.
  if (at == 0) return axis.low;
  if (at == 1) return axis.high;
  return axis.logarithmic ? axis.low * std::pow(axis.high / axis.low, at)
                          : std::lerp(axis.low, axis.high, at);
}

double toPlace(const Axis& axis, double value) {
  if (!(axis.low < axis.high)) return 0;
  const double at = std::clamp(value, axis.low, axis.high);
  if (axis.whole) return (at - axis.low + 0.5) / (std::floor(axis.high - axis.low) + 1);
  return axis.logarithmic ? std::log(at / axis.low) / std::log(axis.high / axis.low)
                          : (at - axis.low) / (axis.high - axis.low);
}

}  // namespace

Result<SearchSpace> SearchSpace::make(const TuningParameters& start, const std::vector<std::string>& free) {
  SearchSpace space;
  space.start_.parameters = start;
  const Result<Policy> policy = policyOf(start.policy);
  if (!policy) return policy.findings();
  space.start_.policy = *policy;
  Findings findings;
  for (const std::string& text : free) {
    const Result<Wanted> wanted = parse(text);
    if (!wanted) {
      findings.insert(findings.end(), wanted.findings().begin(), wanted.findings().end());
      continue;
    }
    bool known = false, movable = false;
    for (const ParameterRow& row : parameterRows()) {
      if (wanted->group ? !row.key.starts_with(wanted->key) : row.key != wanted->key) continue;
      known = true;
      if (!isMovable(row)) continue;
      movable = true;
      Findings of = AxesOf(row, space.start_, space.axes_).add(wanted->ends);
      findings.insert(findings.end(), of.begin(), of.end());
      if (row.kind == Kind::curve || row.kind == Kind::bands) space.ordered_.push_back(&row);
      space.movesPolicy_ = space.movesPolicy_ || row.kind == Kind::lines;
    }
    if (!known)
      findings.push_back(refused(wanted->key, "a key of `preset reference`, or GROUP.*", text));
    else if (!movable)
      findings.push_back(refused(wanted->key, "a parameter that trades time for error",
                                 "what says what is drawn, for whom or from where"));
  }
  std::sort(space.axes_.begin(), space.axes_.end(),
            [](const Axis& a, const Axis& b) { return a.name < b.name; });
  for (std::size_t i = 1; i < space.axes_.size(); ++i)
    if (space.axes_[i].name == space.axes_[i - 1].name)
      findings.push_back(refused(space.axes_[i].name, "each parameter once", "it twice"));
  if (findings.empty() && space.axes_.empty())
    findings.push_back(refused("", "at least one parameter that may move", "none"));
  if (!findings.empty()) return findings;
  space.startPlace_ = space.placeOf(start);
  return space;
}

std::vector<double> SearchSpace::placeOf(const TuningParameters& parameters) const {
  Movable there{parameters, {}};
  if (const Result<Policy> policy = policyOf(parameters.policy)) there.policy = *policy;
  bool alike = there.policy.terms.size() == start_.policy.terms.size() &&
               there.policy.rules.size() == start_.policy.rules.size();
  for (std::size_t i = 0; alike && i < there.policy.terms.size(); ++i)
    alike = there.policy.terms[i].numbers.size() == start_.policy.terms[i].numbers.size();
  for (std::size_t i = 0; alike && i < there.policy.rules.size(); ++i)
    alike = there.policy.rules[i].settings.size() == start_.policy.rules[i].settings.size();
  if (!alike) there.policy = start_.policy;
  std::vector<double> place;
  for (const Axis& axis : axes_) place.push_back(toPlace(axis, axis.get(there)));
  return place;
}

TuningParameters SearchSpace::at(std::span<const double> place) const {
  Movable moved = start_;
  // Where a place has not moved, the start's own number stays to the bit.
  for (std::size_t i = 0; i < axes_.size() && i < place.size(); ++i)
    if (place[i] != startPlace_[i]) axes_[i].set(moved, fromPlace(axes_[i], place[i]));
  for (const ParameterRow* row : ordered_) putInOrder(*row, moved.parameters);
  if (movesPolicy_) {
    for (PolicyTerm& term : moved.policy.terms) putInOrder(term);
    moved.parameters.policy = policyLines(moved.policy, moved.parameters.policy);
  }
  return moved.parameters;
}

}  // namespace trimtab::tune
