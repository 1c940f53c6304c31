#include "trimtab/policy/policy_review.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "policy_samples.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/condition_terms.h"
#include "trimtab/units/number.h"

namespace trimtab {
namespace {

constexpr double kFires = 0.01, kFiresStrongly = 0.6, kFarApart = 0.5;
/// Memberships and firings that all samples together compute: about five milliseconds.
constexpr std::size_t kWork = 250'000;
constexpr std::size_t kMostPlaces = 4096, kFewestPlaces = 256, kMostPairs = 4000, kMostFights = 12;
constexpr std::size_t kRegionTries = 16, kRegionStarts = 4;

std::size_t placesFor(std::size_t terms, std::size_t rules, std::size_t times) {
  return std::clamp(kWork / ((terms + rules + 4) * times), kFewestPlaces / std::min<std::size_t>(times, 8),
                    kMostPlaces);
}

std::string withUnit(double value, std::string_view unit) {
  return numberText(value, 4) + (unit.empty() ? "" : " ") + std::string(unit);
}

bool isActive(const PolicyRule& rule) {
  return rule.enabled && rule.weight > 0;
}

std::uint32_t bitOf(Signal signal) {
  return 1u << static_cast<unsigned>(signal);
}

std::string ruleKey(std::size_t rule) {
  return "rules." + std::to_string(rule + 1);
}

/// Returns the largest difference of two values of a lever, in parts of its usual range.
double apart(const LeverRow& row, double a, double b) {
  if (row.logarithmic) return std::abs(std::log(a / b)) / std::log(row.usual.high / row.usual.low);
  return std::abs(a - b) / (row.usual.high - row.usual.low);
}

class Review {
 public:
  Review(const Policy& policy, const CompiledPolicy& compiled) : policy_(policy), compiled_(compiled) {
    for (std::size_t r = 0; r < policy.rules.size(); ++r)
      if (isActive(policy.rules[r])) active_.push_back(r);
    for (const SignalRow& row : kSignalRows)
      if (compiled.asks(row.signal)) asked_ |= bitOf(row.signal);
  }

  Findings run() {
    unusedTerms();
    rulesWithoutWeight();
    rulesThatNeverFire();
    collectPairs();
    const PolicySamples samples(policy_, asked_);
    lookAround(samples);
    reportFights(samples);
    reportRegion(samples);
    restingLevers();
    return std::move(findings_);
  }

 private:
  struct Pair {
    std::size_t first, second;
    Lever lever;
    double firstValue, secondValue;
    double strength = 0;  ///< the smaller firing of the two where that is greatest
    std::uint64_t place = 0;
  };

  void add(Severity severity, std::string key, std::string expected, std::string found) {
    findings_.push_back({severity, "", std::move(key), std::move(expected), std::move(found)});
  }

  void unusedTerms() {
    for (const PolicyTerm& term : policy_.terms) {
      bool inActive = false, inAny = false;
      for (const PolicyRule& rule : policy_.rules)
        for (const TermUse& use : termsIn(rule.condition)) {
          const bool hit = use.signal == term.signal && use.term == term.name;
          inAny = inAny || hit;
          inActive = inActive || (hit && isActive(rule));
        }
      if (!inActive)
        add(Severity::warning, "terms." + std::string(rowOf(term.signal).key) + "." + term.name,
            "a rule that asks for the term",
            inAny ? "only rules that are switched off or have no weight" : "none");
    }
  }

  /// A rule of weight 0 looks like one that works.
  void rulesWithoutWeight() {
    for (std::size_t r = 0; r < policy_.rules.size(); ++r)
      if (policy_.rules[r].enabled && !(policy_.rules[r].weight > 0))
        add(Severity::warning, ruleKey(r), "a weight above 0, or a rule that is switched off", "weight 0");
  }

  /// Each rule by itself, over its own signals, where a region is found sooner than among all signals.
  void rulesThatNeverFire() {
    for (const std::size_t r : active_) {
      Policy alone{policy_.norm, {}, {policy_.rules[r]}};
      alone.rules[0].weight = 1;
      std::uint32_t asked = 0;
      for (const TermUse& use : termsIn(policy_.rules[r].condition)) {
        asked |= bitOf(use.signal);
        const auto named = [&](const PolicyTerm& t) { return t.signal == use.signal && t.name == use.term; };
        if (std::none_of(alone.terms.begin(), alone.terms.end(), named))
          alone.terms.push_back(*std::find_if(policy_.terms.begin(), policy_.terms.end(), named));
      }
      const auto compiled = compile(alone, "");
      if (!compiled) continue;
      const PolicySamples samples(alone, asked);
      // Without signals the condition is made of `any` alone, and one place says everything.
      const double most = mostFiring(*compiled, samples, placesFor(alone.terms.size(), 1, active_.size()));
      if (most < kFires)
        add(Severity::warning, ruleKey(r), "a condition that the signals can meet",
            "the rule fires at most " + numberText(most, 2) + " anywhere in their ranges");
    }
  }

  static double mostFiring(const CompiledPolicy& rule, const PolicySamples& samples, std::size_t places) {
    PolicyDecision decision;
    double most = 0;
    PolicySamples::Place best;
    const auto take = [&](const PolicySamples::Place& place) {
      rule.decide(place.values, decision);
      if (decision.firing[0] < most) return;
      most = decision.firing[0];
      best = place;
    };
    for (std::uint64_t i = 0; i < places && most < kFires; ++i) take(samples.at(i));
    // The search begins at the best place along each signal, for conditions that only a narrow region meets.
    for (std::size_t d = 0; d < samples.signals().size() && most < kFires; ++d)
      for (std::size_t cell = 0; cell < samples.cells(d) && most < kFires; ++cell)
        for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
          PolicySamples::Place place = best;
          samples.put(place, d, cell, part);
          take(place);
        }
    return most;
  }

  void collectPairs() {
    for (std::size_t i = 0; i < active_.size(); ++i)
      for (std::size_t j = i + 1; j < active_.size(); ++j)
        for (const LeverSetting& a : policy_.rules[active_[i]].settings)
          for (const LeverSetting& b : policy_.rules[active_[j]].settings)
            if (a.lever == b.lever && apart(rowOf(a.lever), a.value, b.value) >= kFarApart &&
                pairs_.size() < kMostPairs)
              pairs_.push_back({active_[i], active_[j], a.lever, a.value, b.value});
  }

  /// Goes once over all signals and sees which rules fire together, and where none fires.
  void lookAround(const PolicySamples& samples) {
    if (active_.empty()) return;
    PolicyDecision decision;
    places_ = placesFor(policy_.terms.size(), policy_.rules.size() + pairs_.size() / 8, 2);
    if (samples.signals().empty()) places_ = 1;
    for (std::uint64_t i = 0; i < places_; ++i) {
      compiled_.decide(samples.at(i).values, decision);
      if (!firesAny(decision)) uncovered_.push_back(i);
      for (Pair& pair : pairs_) {
        const double both = std::min(conditionOf(decision, pair.first), conditionOf(decision, pair.second));
        if (both <= pair.strength) continue;
        pair.strength = both;
        pair.place = i;
      }
    }
  }

  double conditionOf(const PolicyDecision& decision, std::size_t rule) const {
    return decision.firing[rule] / policy_.rules[rule].weight;
  }
  bool firesAny(const PolicyDecision& decision) const {
    return std::any_of(active_.begin(), active_.end(),
                       [&](std::size_t r) { return conditionOf(decision, r) >= kFires; });
  }

  void reportFights(const PolicySamples& samples) {
    std::erase_if(pairs_, [](const Pair& pair) { return pair.strength < kFiresStrongly; });
    std::stable_sort(pairs_.begin(), pairs_.end(),
                     [](const Pair& a, const Pair& b) { return a.strength > b.strength; });
    if (pairs_.size() > kMostFights) pairs_.resize(kMostFights);
    for (const Pair& pair : pairs_) {
      const LeverRow& row = rowOf(pair.lever);
      std::string where;
      const PolicySamples::Place place = samples.at(pair.place);
      std::uint32_t asked = 0;
      for (const std::size_t r : {pair.first, pair.second})
        for (const TermUse& use : termsIn(policy_.rules[r].condition)) asked |= bitOf(use.signal);
      for (const Signal signal : samples.signals())
        if (asked & bitOf(signal))
          where += (where.empty() ? "" : ", ") + std::string(rowOf(signal).key) + " " +
                   withUnit(place.values[signal], rowOf(signal).unit);
      add(Severity::warning, ruleKey(pair.first),
          "rules that fire together to set " + std::string(row.key) + " alike",
          withUnit(pair.firstValue, row.unit) + " against " + withUnit(pair.secondValue, row.unit) +
              " of rule " + std::to_string(pair.second + 1) + (where.empty() ? "" : " at " + where));
    }
  }

  /// A box of cells, from first to last, in which no sample fires a rule.
  struct Box {
    std::array<std::size_t, kSignals> first{}, last{};
    double volume = 0;
  };

  bool isUncovered(const PolicySamples& samples, const Box& box) {
    for (std::size_t i = 0; i < kRegionTries; ++i) {
      const PolicySamples::Place spread = samples.at(i + 7919);
      PolicySamples::Place place = spread;
      for (std::size_t d = 0; d < samples.signals().size(); ++d) {
        const std::size_t width = box.last[d] - box.first[d] + 1;
        const double part = i == 0   ? 0.5
                            : i == 1 ? 0.02
                            : i == 2 ? 0.98
                                     : 0.1 * static_cast<double>(i % 9 + 1);
        samples.put(place, d, box.first[d] + spread.cell[d] % width, part);
      }
      compiled_.decide(place.values, decision_);
      if (firesAny(decision_)) return false;
    }
    return true;
  }

  /// Grows a box around a place, signal by signal, as far as no rule fires in it.
  Box grown(const PolicySamples& samples, const PolicySamples::Place& from) {
    Box box{from.cell, from.cell, 1};
    for (std::size_t d = 0; d < samples.signals().size(); ++d) {
      for (bool up : {false, true})
        for (;;) {
          if (up ? box.last[d] + 1 >= samples.cells(d) : box.first[d] == 0) break;
          Box larger = box;
          // Only the new cells need a look.
          if (up)
            larger.first[d] = ++larger.last[d];
          else
            larger.last[d] = --larger.first[d];
          if (!isUncovered(samples, larger)) break;
          (up ? box.last[d] : box.first[d]) = larger.first[d];
        }
      box.volume *=
          static_cast<double>(box.last[d] - box.first[d] + 1) / static_cast<double>(samples.cells(d));
    }
    return box;
  }

  void reportRegion(const PolicySamples& samples) {
    if (uncovered_.empty()) return;
    std::optional<Box> largest;
    for (std::size_t i = 0; i < std::min(kRegionStarts, uncovered_.size()); ++i) {
      const auto start = samples.at(uncovered_[i * uncovered_.size() / kRegionStarts % uncovered_.size()]);
      const Box single{start.cell, start.cell, 1};
      const Box box = isUncovered(samples, single) ? grown(samples, start) : Box{};
      if (box.volume > 0 && (!largest || box.volume > largest->volume)) largest = box;
    }
    if (!largest) return;  // only corners of cells
    std::string region;
    for (std::size_t d = 0; d < samples.signals().size(); ++d) {
      if (largest->first[d] == 0 && largest->last[d] + 1 == samples.cells(d)) continue;
      const SignalRow& row = rowOf(samples.signals()[d]);
      region += (region.empty() ? "" : " and ") + std::string(row.key) + " from " +
                numberText(samples.edge(d, largest->first[d]), 4) + " to " +
                withUnit(samples.edge(d, largest->last[d] + 1), row.unit);
    }
    const double share = 100 * static_cast<double>(uncovered_.size()) / static_cast<double>(places_);
    add(Severity::note, "rules", "a rule for every flight, or levers that are meant to rest",
        "no rule fires at " + (region.empty() ? "any value of the signals" : region) + " (" +
            numberText(share, 2) + " % of the samples)");
  }

  void restingLevers() {
    std::string names;
    for (const LeverRow& row : kLeverRows)
      if (!compiled_.moves(row.lever)) names += (names.empty() ? "" : ", ") + std::string(row.key);
    if (!names.empty())
      add(Severity::note, "levers", "rules for each lever that is to follow the flight", "none for " + names);
  }

  const Policy& policy_;
  const CompiledPolicy& compiled_;
  std::vector<std::size_t> active_;
  std::uint32_t asked_ = 0;
  std::vector<Pair> pairs_;
  std::vector<std::uint64_t> uncovered_;
  std::size_t places_ = 0;
  PolicyDecision decision_;
  Findings findings_;
};

}  // namespace

Findings reviewPolicy(const Policy& policy) {
  if (policy.empty()) return {};
  const auto compiled = compile(policy, "");
  return compiled ? Review(policy, *compiled).run() : compiled.findings();
}

}  // namespace trimtab
