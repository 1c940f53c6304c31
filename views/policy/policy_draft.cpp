// SPDX-License-Identifier: GPL-3.0-or-later
#include "policy_draft.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/condition_terms.h"
#include "trimtab/preset/policy_lines.h"
#include "views/model/keys.h"

namespace trimtab::views {
namespace {

/// Takes lines of text over. Known lines are not read again, because a drag changes one of many.
template <class Line, class Read>
void take(std::vector<Line>& known, const TextLines& texts, std::optional<Line>& written, Read read) {
  if (written) known.push_back(*std::exchange(written, std::nullopt));
  std::vector<Line> taken;
  for (const std::string& text : texts.line) {
    const auto same = std::ranges::find(known, text, &Line::text);
    taken.push_back(same != known.end() ? *same : read(text));
  }
  known = std::move(taken);
}

PolicyDraft::TermLine readTerm(const std::string& text) {
  PolicyParameters one;
  one.terms.line = {text};
  const auto policy = policyOf(one);
  if (!policy) return {text, std::nullopt, false};
  return {text, policy->terms.front(), isSound(policy->terms.front())};
}

PolicyDraft::RuleLine readRule(const std::string& text) {
  PolicyParameters one;
  one.rules.line = {text};
  const auto policy = policyOf(one);
  return {text, policy ? std::optional(policy->rules.front()) : std::nullopt};
}

auto place(std::vector<std::string>& lines, std::size_t line) {
  return lines.begin() + static_cast<std::ptrdiff_t>(line);
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
  take(terms_, lines(key::kPolicyTerms), writtenTerm_, readTerm);
}

void PolicyDraft::readRules() {
  take(rules_, lines(key::kPolicyRules), writtenRule_, readRule);
}

std::string PolicyDraft::written(const PolicyTerm& term) {
  writtenTerm_ = {policyLines({{}, {term}, {}}).terms.line.front(), term, isSound(term)};
  return writtenTerm_->text;
}

std::string PolicyDraft::written(const PolicyRule& rule) {
  writtenRule_ = {policyLines({{}, {}, {rule}}).rules.line.front(), rule};
  return writtenRule_->text;
}

Policy PolicyDraft::active() const {
  const PolicyParameters& runs = draft_.active()->policy;
  const auto same = [](const std::string& text, const auto& line) { return text == line.text; };
  const bool typed =
      std::ranges::equal(runs.terms.line, terms_, same) && std::ranges::equal(runs.rules.line, rules_, same);
  if (typed) return policy(runs.norm);
  const auto read = policyOf(runs);
  return read ? *read : Policy{};
}

Policy PolicyDraft::policy() const {
  return policy(draft_.parameters().policy.norm);
}

Policy PolicyDraft::policy(PolicyNorm norm) const {
  Policy policy;
  policy.norm = norm;
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

template <class Change>
void PolicyDraft::change(std::string_view key, Change change, const QString& undoText, MergeToken token) {
  TextLines changed = lines(key);
  change(changed.line);
  draft_.setValues(std::array{Draft::KeyValue{key, changed}}, undoText, token);
}

void PolicyDraft::putTerm(std::size_t line, const PolicyTerm& term, const QString& undoText,
                          MergeToken token) {
  change(
      key::kPolicyTerms, [&](auto& lines) { lines[line] = written(term); }, undoText, token);
}

void PolicyDraft::insertTerm(std::size_t line, const PolicyTerm& term, const QString& undoText) {
  TextLines changed = lines(key::kPolicyTerms);
  const bool first = empty();
  changed.line.insert(place(changed.line, line), written(term));
  // The first term of a policy switches it on, so that its signals are derived.
  const std::array values{Draft::KeyValue{key::kPolicyTerms, changed},
                          Draft::KeyValue{key::kPolicyEnabled, first || draft_.parameters().policy.enabled}};
  draft_.setValues(values, undoText);
}

void PolicyDraft::removeTerm(std::size_t line) {
  change(
      key::kPolicyTerms, [&](auto& lines) { lines.erase(place(lines, line)); }, tr("Remove Term"));
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
    rules.line[i] = written(rule);
  }
  term.name = name;
  terms.line[line] = written(term);
  const std::array values{Draft::KeyValue{key::kPolicyTerms, terms},
                          Draft::KeyValue{key::kPolicyRules, rules}};
  draft_.setValues(values, tr("Rename Term"));
}

void PolicyDraft::putRule(std::size_t line, const PolicyRule& rule, const QString& undoText) {
  change(
      key::kPolicyRules, [&](auto& lines) { lines[line] = written(rule); }, undoText);
}

void PolicyDraft::insertRule(std::size_t line, const PolicyRule& rule, const QString& undoText) {
  change(
      key::kPolicyRules, [&](auto& lines) { lines.insert(place(lines, line), written(rule)); }, undoText);
}

void PolicyDraft::removeRule(std::size_t line) {
  change(
      key::kPolicyRules, [&](auto& lines) { lines.erase(place(lines, line)); }, tr("Remove Rule"));
}

void PolicyDraft::moveRule(std::size_t from, std::size_t to) {
  const auto move = [&](auto& lines) {
    std::string moved = std::move(lines[from]);
    lines.erase(place(lines, from));
    lines.insert(place(lines, to), std::move(moved));
  };
  change(key::kPolicyRules, move, tr("Move Rule"));
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
