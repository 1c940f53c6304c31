#include "condition.h"

#include <algorithm>
#include <cctype>

#include "words.h"

namespace trimtab {
namespace {

using Do = ConditionStep::Kind;

struct Hedge {
  std::string_view word;
  Do kind;
};
constexpr Hedge kHedges[] = {{"not", Do::invert},
                             {"very", Do::very},
                             {"somewhat", Do::somewhat},
                             {"extremely", Do::extremely},
                             {"seldom", Do::seldom}};
constexpr std::size_t kMostWords = 8 * kMostConditionParts;

/// Recursive descent over the words of one condition. Each member returns false after a finding.
class Reader {
 public:
  Reader(std::string_view condition, const std::string& where, const std::string& key)
      : where_(where), key_(key), words_(policyWords(condition)) {}

  Result<std::vector<ConditionStep>> run() {
    if (words_.size() > kMostWords)
      refuse("at most " + std::to_string(kMostWords) + " words", std::to_string(words_.size()));
    else if (readOr(0) && at_ < words_.size())
      refuse("and, or, or the end of the condition", words_[at_]);
    else if (findings_.empty() && steps_.size() > kMostConditionParts)
      refuse("at most " + std::to_string(kMostConditionParts) + " terms, hedges and connectives",
             std::to_string(steps_.size()));
    if (!findings_.empty()) return findings_;
    return std::move(steps_);
  }

 private:
  bool refuse(std::string expected, std::string_view found) {
    findings_.push_back({Severity::error, where_, key_, std::move(expected),
                         found.empty() ? "nothing" : std::string(found.substr(0, 80))});
    return false;
  }
  std::string_view word() const { return at_ < words_.size() ? words_[at_] : std::string_view{}; }
  bool take(std::string_view expected) {
    const bool there = word() == expected;
    at_ += there;
    return there;
  }

  bool readOr(std::size_t depth) {
    if (!readAnd(depth)) return false;
    while (take("or")) {
      if (!readAnd(depth)) return false;
      steps_.push_back({Do::either, {}, {}});
    }
    return true;
  }

  bool readAnd(std::size_t depth) {
    if (!readOne(depth)) return false;
    while (take("and")) {
      if (!readOne(depth)) return false;
      steps_.push_back({Do::both, {}, {}});
    }
    return true;
  }

  bool readOne(std::size_t depth) {
    if (depth > kMostConditionParts) return refuse("less nesting", word());
    if (take("not")) {
      if (!readOne(depth + 1)) return false;
      steps_.push_back({Do::invert, {}, {}});
      return true;
    }
    if (take("(")) return readOr(depth + 1) && (take(")") || refuse(")", word()));
    return readProposition();
  }

  bool readProposition() {
    const auto signal = signalNamed(word());
    if (!signal) {
      std::string keys;
      for (const SignalRow& row : kSignalRows) keys += (keys.empty() ? "" : ", ") + std::string(row.key);
      return refuse("a signal: " + keys, word());
    }
    ++at_;
    if (!take("is")) return refuse("is after the signal", word());
    std::vector<Do> hedges;
    const auto hedge = [this] {
      return std::find_if(std::begin(kHedges), std::end(kHedges),
                          [this](const Hedge& each) { return each.word == word(); });
    };
    for (auto found = hedge(); found != std::end(kHedges); found = hedge()) {
      hedges.push_back(found->kind);
      ++at_;
    }
    if (word() != "any" && !isTermName(word())) return refuse("a term of the signal, or any", word());
    steps_.push_back({Do::proposition, *signal, words_[at_++]});
    // The hedge next to the term is applied first.
    for (auto each = hedges.rbegin(); each != hedges.rend(); ++each) steps_.push_back({*each, {}, {}});
    return true;
  }

  const std::string &where_, &key_;
  std::vector<std::string_view> words_;
  std::size_t at_ = 0;
  std::vector<ConditionStep> steps_;
  Findings findings_;
};

/// A part of a condition and its negation, each without a negated group.
struct Part {
  std::string subject, hedges, term;  ///< of a proposition; a group has no term
  std::string text, negated;          ///< of a group
  bool byAnd = false;                 ///< joins the group; its negation is joined the other way

  std::string inWords(bool invert) const {
    if (term.empty()) return invert ? negated : text;
    return subject + (invert ? " is not " : " is ") + hedges + term;
  }
  /// Puts the text in parentheses if it is in a group that is joined the other way.
  std::string inGroup(bool invert, bool groupByAnd) const {
    const bool apart = term.empty() && (byAnd != invert) != groupByAnd;
    return apart ? "( " + inWords(invert) + " )" : inWords(invert);
  }
};

Part joined(const Part& a, const Part& b, bool byAnd) {
  Part part;
  part.byAnd = byAnd;
  part.text = a.inGroup(false, byAnd) + (byAnd ? " and " : " or ") + b.inGroup(false, byAnd);
  part.negated = a.inGroup(true, !byAnd) + (byAnd ? " or " : " and ") + b.inGroup(true, !byAnd);
  return part;
}

}  // namespace

Result<std::vector<ConditionStep>> readCondition(std::string_view condition, const std::string& where,
                                                 const std::string& key) {
  return Reader(condition, where, key).run();
}

std::string withSingleTermsNegated(std::span<const ConditionStep> steps) {
  std::vector<Part> stack;
  for (const ConditionStep& step : steps) {
    if (step.kind == Do::proposition) {
      Part part;
      part.subject = rowOf(step.signal).key;
      part.term = step.term;
      stack.push_back(std::move(part));
    } else if (step.kind == Do::both || step.kind == Do::either) {
      const Part b = std::move(stack.back());
      stack.pop_back();
      stack.back() = joined(stack.back(), b, step.kind == Do::both);
    } else if (Part& top = stack.back(); top.term.empty()) {
      std::swap(top.text, top.negated);  // only `not` stands before a group
      top.byAnd = !top.byAnd;
    } else {
      for (const Hedge& hedge : kHedges)
        if (hedge.kind == step.kind) top.hedges.insert(0, std::string(hedge.word) + " ");
    }
  }
  return stack.empty() ? std::string() : stack.back().inWords(false);
}

bool isTermName(std::string_view word) {
  constexpr std::string_view kReserved[] = {"if", "then", "with", "and", "or", "is", "any"};
  const auto isWordOfRules = [word](std::string_view each) { return each == word; };
  if (word.empty() || word.size() > 40 ||
      std::any_of(std::begin(kReserved), std::end(kReserved), isWordOfRules))
    return false;
  for (const Hedge& hedge : kHedges)
    if (hedge.word == word) return false;
  return !std::isdigit(static_cast<unsigned char>(word[0])) &&
         std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

}  // namespace trimtab
