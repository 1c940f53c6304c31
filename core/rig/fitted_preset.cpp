#include "trimtab/rig/fitted_preset.h"

#include <algorithm>
#include <cmath>

#include "trimtab/hold/arbiter.h"
#include "trimtab/measure/statistics.h"
#include "trimtab/preset/policy_lines.h"
#include "trimtab/rig/limited_preset.h"
#include "trimtab/units/number.h"

namespace trimtab {
namespace {

/// Returns the part of a signal over which a term changes. If a shape has no ends, it is the part between
/// memberships of some 0.1 to 0.9.
Range spanOf(const PolicyTerm& term) {
  Range span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const auto add = [&](double x) {
    if (std::isfinite(x)) span = {std::min(span.low, x), std::max(span.high, x)};
  };
  const auto around = [&](double middle, double half) { add(middle - half), add(middle + half); };
  const std::vector<double>& n = term.numbers;
  switch (term.shape) {
    case TermShape::points:
      for (std::size_t i = 0; i < n.size(); i += 2) add(n[i]);
      break;
    case TermShape::triangle:
    case TermShape::trapezoid:
    case TermShape::ramp:
      std::ranges::for_each(n, add);
      break;
    case TermShape::gaussian:
      around(n[0], 2 * n[1]);
      break;
    case TermShape::bell:
      around(n[0], n[1]);
      break;
    case TermShape::sigmoid:
      around(n[0], 2 / std::abs(n[1]));
      break;
  }
  return span;
}

/// Returns the number with four digits of a span: no fit knows more, and what lies apart stays apart.
double rounded(double x, double span) {
  const double finer = std::ceil(std::log10(std::max(std::abs(x) / span, 1.0)));
  return *readNumber(numberText(x, 4 + static_cast<int>(std::min(finer, 12.0))));
}

/// Moves a term: x goes to `to.low` + (x - `from.low`) * scale.
void moveTerm(PolicyTerm& term, Range from, Range to) {
  const double span = to.high - to.low, scale = span / (from.high - from.low);
  const auto place = [&](double& x) {
    if (std::isfinite(x)) x = rounded(to.low + (x - from.low) * scale, span * 1e-3);
  };
  const auto width = [](double x) { return rounded(x, x); };
  std::vector<double>& n = term.numbers;
  switch (term.shape) {
    case TermShape::points:
      for (std::size_t i = 0; i < n.size(); i += 2) place(n[i]);
      break;
    case TermShape::triangle:
    case TermShape::trapezoid:
    case TermShape::ramp:
      std::ranges::for_each(n, place);
      break;
    case TermShape::gaussian:
    case TermShape::bell:
      place(n[0]), n[1] = width(n[1] * scale);
      break;
    case TermShape::sigmoid:
      place(n[0]), n[1] = width(n[1] / scale);
      break;
  }
}

class Fitter {
 public:
  Fitter(const IgProfile& profile, const IgFit& fit, TuningParameters& preset, const std::string& where)
      : profile_(profile), fit_(fit), preset_(preset), where_(where) {}

  void run() {
    moveTerms();
    const bool byScale = profile_.errorLever() != nullptr && profile_.find("screen_space_error") == nullptr;
    constexpr Range kErrors = rowOf(Lever::screen_space_error).hard;
    if (byScale && std::isfinite(fit_.neutralPx))
      set(preset_.lod.screenSpaceError, std::clamp(fit_.neutralPx, kErrors.low, kErrors.high),
          "lod.screen_space_error_px");
    setLoss(preset_.hold.lossError, "hold.loss_error", profile_.errorLever(), [&](double times) {
      const double px = preset_.lod.screenSpaceError.value();
      return errorLoss(px * times, px);
    });
    setLoss(preset_.hold.lossRenderScale, "hold.loss_render_scale", profile_.find("render_scale"),
            [](double times) { return scaleLoss(times, 1); });
  }
  Findings notes;

 private:
  void note(std::string key, std::string now, std::string before) {
    notes.push_back({Severity::note, where_, std::move(key), std::move(now) + ", fitted to " + profile_.name,
                     std::move(before)});
  }
  template <class Unit>
  void set(Unit& field, double value, const char* key) {
    const double now = rounded(value, value);
    if (field.value() == now) return;
    note(key, numberText(now), numberText(field.value()));
    field = Unit{now};
  }

  void moveTerms() {
    const Result<Policy> read = policyOf(preset_.policy);
    if (!read) return;
    Policy policy = *read;
    Range from{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const PolicyTerm& term : policy.terms)
      if (term.signal == Signal::triangles) {
        const Range span = spanOf(term);
        from = {std::min(from.low, span.low), std::max(from.high, span.high)};
      }
    if (!(from.low < from.high)) return;
    if (!(fit_.loadLow < fit_.loadHigh))
      return note("policy.terms", "the same terms, because the load never changed", "a flight over one view");
    for (PolicyTerm& term : policy.terms) {
      if (term.signal != Signal::triangles) continue;
      const std::string before = shapeText(term);
      moveTerm(term, from, {fit_.loadLow, fit_.loadHigh});
      note("policy.terms.triangles." + term.name, shapeText(term), before);
    }
    preset_.policy = policyLines(policy, preset_.policy);
  }

  /// Sets a loss of the budget to the median of what the points of a lever lost, over the part of it that the
  /// budget gives each. `part` takes how many times as much as neutral a point is.
  template <class Part>
  void setLoss(Ratio& field, const char* key, const IgLever* lever, const Part& part) {
    if (lever == nullptr) return;
    std::vector<double> losses;
    for (const LeverPoint& p : fit_.points)
      if (const double share = part(p.value / lever->neutral());
          p.row == lever->row && share > 0 && std::isfinite(p.flip))
        losses.push_back(p.flip / share);
    if (!losses.empty()) set(field, std::clamp(quantileOf(losses, 0.5), 0.0, 1.0), key);
  }

  const IgProfile& profile_;
  const IgFit& fit_;
  TuningParameters& preset_;
  const std::string& where_;
};

}  // namespace

Result<TuningParameters> fittedTo(const IgProfile& profile, const IgFit& fit, TuningParameters preset,
                                  const std::string& where) {
  if (const auto good = checkFit(fit, profile, where); !good) return good.findings();
  Fitter fitter(profile, fit, preset, where);
  fitter.run();
  Result<TuningParameters> limited = limitedTo(profile, std::move(preset), where);
  fitter.notes.insert(fitter.notes.end(), limited.findings().begin(), limited.findings().end());
  return {std::move(limited).value(), std::move(fitter.notes)};
}

}  // namespace trimtab
