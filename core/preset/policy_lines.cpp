#include "trimtab/preset/policy_lines.h"
#include "trimtab/units/text.h"

#include <algorithm>

namespace trimtab {
namespace {

constexpr std::string_view kOff = "off ";

std::string inLine(std::size_t index) {
  return " in line " + std::to_string(index + 1);
}

Finding refused(const char* key, std::size_t index, std::string expected, std::string_view found) {
  return {Severity::error, "", key, std::move(expected),
          "\"" + std::string(found.substr(0, 80)) + "\"" + inLine(index)};
}

/// Findings of readers that do not know the key, with it and the line.
void add(Findings& all, const char* key, std::size_t index, const Findings& findings) {
  for (const Finding& f : findings) all.push_back({f.severity, "", key, f.expected, f.found + inLine(index)});
}

void readTerm(std::string_view line, std::size_t index, Policy& policy, Findings& findings) {
  constexpr const char* kKey = "policy.terms";
  const std::size_t equals = line.find('=');
  const std::string_view names = trimmed(line.substr(0, equals));
  const std::size_t blank = names.find(' ');
  if (equals == std::string_view::npos || blank == std::string_view::npos)
    return findings.push_back(refused(kKey, index, "SIGNAL NAME = SHAPE NUMBERS", line));
  const auto signal = signalNamed(names.substr(0, blank));
  if (!signal) {
    std::string keys;
    for (const SignalRow& row : kSignalRows) keys += (keys.empty() ? "" : ", ") + std::string(row.key);
    return findings.push_back(refused(kKey, index, "a signal: " + keys, names.substr(0, blank)));
  }
  auto term = readShape(line.substr(equals + 1), "");
  if (!term) return add(findings, kKey, index, term.findings());
  policy.terms.push_back(std::move(*term));
  policy.terms.back().signal = *signal;
  policy.terms.back().name = trimmed(names.substr(blank));
}

void readRule(std::string_view line, std::size_t index, Policy& policy, Findings& findings) {
  const bool off = line.starts_with(kOff);
  if (off) line.remove_prefix(kOff.size());
  const std::size_t hash = line.find('#');
  auto rule = readPolicyRule(trimmed(line.substr(0, hash)), "");
  if (!rule) return add(findings, "policy.rules", index, rule.findings());
  policy.rules.push_back(std::move(*rule));
  policy.rules.back().enabled = !off;
  if (hash != std::string_view::npos) policy.rules.back().reason = trimmed(line.substr(hash + 1));
}

/// Reasons stay on their line, whatever somebody typed.
std::string oneLine(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = ' ';
  return std::string(trimmed(text));
}

}  // namespace

Result<Policy> policyOf(const PolicyParameters& parameters) {
  Policy policy;
  policy.norm = parameters.norm;
  Findings findings;
  for (std::size_t i = 0; i < parameters.terms.line.size(); ++i)
    readTerm(trimmed(parameters.terms.line[i]), i, policy, findings);
  for (std::size_t i = 0; i < parameters.rules.line.size(); ++i)
    readRule(trimmed(parameters.rules.line[i]), i, policy, findings);
  if (!findings.empty()) return findings;
  return policy;
}

PolicyParameters policyLines(const Policy& policy, PolicyParameters onto) {
  onto.norm = policy.norm;
  onto.terms.line.clear();
  onto.rules.line.clear();
  for (const PolicyTerm& term : policy.terms)
    onto.terms.line.push_back(std::string(rowOf(term.signal).key) + " " + term.name + " = " +
                              shapeText(term));
  for (const PolicyRule& rule : policy.rules) {
    const std::string reason = oneLine(rule.reason);
    onto.rules.line.push_back((rule.enabled ? "" : std::string(kOff)) + ruleText(rule) +
                              (reason.empty() ? "" : " # " + reason));
  }
  return onto;
}

}  // namespace trimtab
