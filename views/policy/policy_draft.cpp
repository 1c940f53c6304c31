// SPDX-License-Identifier: GPL-3.0-or-later
#include "policy_draft.h"

#include <algorithm>
#include <array>
#include <span>

#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/condition_terms.h"
#include "trimtab/preset/policy_lines.h"
#include "views/model/keys.h"

namespace trimtab::views {
namespace {

std::string termLine(const PolicyTerm& term) {
  return policyLines({{}, {term}, {}}).terms.line.front();
}
std::string ruleLine(const PolicyRule& rule) {
  return policyLines({{}, {}, {rule}}).rules.line.front();
}

}  // namespace

bool isSound(const PolicyTerm& term) {
  Policy policy;
  policy.terms = {term};
  policy.terms.front().name = "term";
  return compile(policy, "").ok();
}

QString sentences(const Findings& findings) {
  constexpr std::size_t kMost = 2;
  QStringList said;
  for (const Finding& f : std::span(findings).first(std::min(kMost, findings.size())))
    said << QObject::tr("Expected %1; found %2.")
                .arg(QString::fromStdString(f.expected), QString::fromStdString(f.found));
  if (findings.size() > kMost) said << QObject::tr("%1 more.").arg(findings.size() - kMost);
  return said.join(QLatin1Char(' '));
}

PolicyDraft::PolicyDraft(Draft& draft, QObject* parent) : QObject(parent), draft_(draft) {
  readTerms();
  readRules();
  connect(&draft_, &Draft::valueChanged, this, [this](const QString& key) {
    const std::string name = key.toStdString();
    if (name == key::kPolicyTerms) {
      readTerms();
      emit termsChanged();
    } else if (name == key::kPolicyRules) {
      readRules();
      emit rulesChanged();
    }
  });
}

TextLines PolicyDraft::lines(std::string_view key) const {
  return std::get<TextLines>(draft_.value(key));
}

void PolicyDraft::readTerms() {
  std::vector<TermLine> read;
  for (const std::string& text : lines(key::kPolicyTerms).line) {
    // A drag changes one line of many.
    if (read.size() < terms_.size() && terms_[read.size()].text == text) {
      read.push_back(terms_[read.size()]);
      continue;
    }
    PolicyParameters one;
    one.terms.line = {text};
    const auto policy = policyOf(one);
    TermLine line;
    line.text = text;
    if (policy) line.term = policy->terms.front();
    line.sound = line.term && isSound(*line.term);
    read.push_back(std::move(line));
  }
  terms_ = std::move(read);
}

void PolicyDraft::readRules() {
  std::vector<RuleLine> read;
  for (const std::string& text : lines(key::kPolicyRules).line) {
    if (read.size() < rules_.size() && rules_[read.size()].text == text) {
      read.push_back(rules_[read.size()]);
      continue;
    }
    PolicyParameters one;
    one.rules.line = {text};
    const auto policy = policyOf(one);
    read.push_back({text, policy ? std::optional(policy->rules.front()) : std::nullopt});
  }
  rules_ = std::move(read);
}

Policy PolicyDraft::policy() const {
  Policy policy;
  policy.norm = draft_.parameters().policy.norm;
  for (const TermLine& line : terms_)
    if (line.term) policy.terms.push_back(*line.term);
  for (const RuleLine& line : rules_)
    if (line.rule) policy.rules.push_back(*line.rule);
  return policy;
}

std::vector<std::size_t> PolicyDraft::termsOf(Signal signal) const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < terms_.size(); ++i)
    if (terms_[i].term && terms_[i].term->signal == signal) found.push_back(i);
  return found;
}

bool PolicyDraft::uses(Signal signal) const {
  return std::ranges::any_of(rules_, [signal](const RuleLine& line) {
    if (!line.rule || !line.rule->enabled || !(line.rule->weight > 0)) return false;
    const auto used = termsIn(line.rule->condition);
    return std::ranges::any_of(used, [signal](const TermUse& use) { return use.signal == signal; });
  });
}

std::string PolicyDraft::freeName(Signal signal, const std::string& wanted) const {
  const auto taken = [&](const std::string& name) {
    return std::ranges::any_of(terms_, [&](const TermLine& line) {
      return line.term && line.term->signal == signal && line.term->name == name;
    });
  };
  std::string name = wanted;
  for (int number = 2; taken(name); ++number) name = wanted + "_" + std::to_string(number);
  return name;
}

Findings PolicyDraft::check(const PolicyTerm& term, std::optional<std::size_t> line) const {
  Policy policy;
  for (std::size_t i = 0; i < terms_.size(); ++i)
    if (i != line && terms_[i].term) policy.terms.push_back(*terms_[i].term);
  policy.terms.push_back(term);
  const std::string own = "terms." + std::string(rowOf(term.signal).key) + "." + term.name.substr(0, 40);
  Findings findings = compile(policy, "").findings();
  std::erase_if(findings, [&](const Finding& f) { return f.key != own && f.key != "terms"; });
  return findings;
}

Findings PolicyDraft::check(const PolicyRule& rule) const {
  Policy policy;
  for (const TermLine& line : terms_)
    if (line.term) policy.terms.push_back(*line.term);
  policy.rules.push_back(rule);
  Findings findings = compile(policy, "").findings();
  std::erase_if(findings, [](const Finding& f) { return !f.key.starts_with("rules"); });
  return findings;
}

void PolicyDraft::putTerm(std::size_t line, const PolicyTerm& term, const QString& undoText,
                          MergeToken token) {
  TextLines changed = lines(key::kPolicyTerms);
  changed.line[line] = termLine(term);
  draft_.setValues(std::array{Draft::KeyValue{key::kPolicyTerms, changed}}, undoText, token);
}

void PolicyDraft::insertTerm(std::size_t line, const PolicyTerm& term, const QString& undoText) {
  TextLines changed = lines(key::kPolicyTerms);
  const bool first = empty();
  changed.line.insert(changed.line.begin() + static_cast<std::ptrdiff_t>(line), termLine(term));
  // The first term of a policy switches it on, so that its signals are derived.
  const std::array values{Draft::KeyValue{key::kPolicyTerms, changed},
                          Draft::KeyValue{key::kPolicyEnabled, first || draft_.parameters().policy.enabled}};
  draft_.setValues(values, undoText);
}

void PolicyDraft::removeTerm(std::size_t line) {
  TextLines changed = lines(key::kPolicyTerms);
  changed.line.erase(changed.line.begin() + static_cast<std::ptrdiff_t>(line));
  draft_.setValues(std::array{Draft::KeyValue{key::kPolicyTerms, changed}}, tr("Remove Term"));
}

void PolicyDraft::renameTerm(std::size_t line, const std::string& name) {
  PolicyTerm term = *terms_[line].term;
  TextLines terms = lines(key::kPolicyTerms), rules = lines(key::kPolicyRules);
  for (std::size_t i = 0; i < rules_.size(); ++i) {
    if (!rules_[i].rule) continue;
    PolicyRule rule = *rules_[i].rule;
    const std::string condition = withTermRenamed(rule.condition, term.signal, term.name, name);
    if (condition == rule.condition) continue;
    rule.condition = condition;
    rules.line[i] = ruleLine(rule);
  }
  term.name = name;
  terms.line[line] = termLine(term);
  const std::array values{Draft::KeyValue{key::kPolicyTerms, terms},
                          Draft::KeyValue{key::kPolicyRules, rules}};
  draft_.setValues(values, tr("Rename Term"));
}

void PolicyDraft::putRule(std::size_t line, const PolicyRule& rule, const QString& undoText,
                          MergeToken token) {
  TextLines changed = lines(key::kPolicyRules);
  changed.line[line] = ruleLine(rule);
  draft_.setValues(std::array{Draft::KeyValue{key::kPolicyRules, changed}}, undoText, token);
}

void PolicyDraft::insertRule(std::size_t line, const PolicyRule& rule, const QString& undoText) {
  TextLines changed = lines(key::kPolicyRules);
  changed.line.insert(changed.line.begin() + static_cast<std::ptrdiff_t>(line), ruleLine(rule));
  draft_.setValues(std::array{Draft::KeyValue{key::kPolicyRules, changed}}, undoText);
}

void PolicyDraft::removeRule(std::size_t line) {
  TextLines changed = lines(key::kPolicyRules);
  changed.line.erase(changed.line.begin() + static_cast<std::ptrdiff_t>(line));
  draft_.setValues(std::array{Draft::KeyValue{key::kPolicyRules, changed}}, tr("Remove Rule"));
}

void PolicyDraft::moveRule(std::size_t from, std::size_t to) {
  TextLines changed = lines(key::kPolicyRules);
  std::string moved = std::move(changed.line[from]);
  changed.line.erase(changed.line.begin() + static_cast<std::ptrdiff_t>(from));
  changed.line.insert(changed.line.begin() + static_cast<std::ptrdiff_t>(to), std::move(moved));
  draft_.setValues(std::array{Draft::KeyValue{key::kPolicyRules, changed}}, tr("Move Rule"));
}

void PolicyDraft::replace(const Policy& policy, const QString& undoText) {
  const PolicyParameters lines = policyLines(policy);
  const std::array values{
      Draft::KeyValue{key::kPolicyEnabled, true},
      Draft::KeyValue{key::kPolicyNorm, ChoiceIndex{static_cast<std::size_t>(policy.norm)}},
      Draft::KeyValue{key::kPolicyTerms, lines.terms}, Draft::KeyValue{key::kPolicyRules, lines.rules}};
  draft_.setValues(values, undoText);
}

}  // namespace trimtab::views
