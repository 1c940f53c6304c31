#include "trimtab/units/result.h"

#include <algorithm>

namespace trimtab {

bool hasError(const Findings& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.severity == Severity::error; });
}

std::string toString(const Finding& f) {
  std::string text = f.where;
  const auto append = [&text](const std::string& part, const char* lead) {
    if (part.empty()) return;
    if (!text.empty()) text += lead;
    text += part;
  };
  append(f.key, ": ");
  if (!f.expected.empty()) append("expected " + f.expected, ": ");
  if (!f.found.empty()) append("found " + f.found, f.expected.empty() ? ": " : ", ");
  return text;
}

std::string toString(const Findings& findings) {
  std::string text;
  for (const Finding& f : findings) {
    if (!text.empty()) text += '\n';
    text += toString(f);
  }
  return text;
}

}  // namespace trimtab
