#include "trimtab/policy/rule_mapping.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

/// "speed*0.514+3": the sign of the offset is not one of an exponent, nor the scale's own.
std::size_t offsetIn(std::string_view text) {
  for (std::size_t i = text.find('*') + 1; i < text.size(); ++i) {
    const char before = i == 0 ? '*' : text[i - 1];
    if ((text[i] == '+' || text[i] == '-') && before != '*' && before != 'e' && before != 'E') return i;
  }
  return text.size();
}

std::string withoutBlanks(std::string_view text) {
  std::string left(text);
  std::erase_if(left, [](char c) { return c == ' ' || c == '\t'; });
  return left;
}

std::optional<RuleVariable> variableIn(std::string_view part) {
  const std::size_t equals = part.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  RuleVariable made{std::string(trimmed(part.substr(0, equals))), "", 1, 0};
  const std::string value = withoutBlanks(part.substr(equals + 1));
  const std::size_t offset = offsetIn(value), star = std::min(value.find('*'), offset);
  made.key = value.substr(0, star);
  const auto read = [](std::string_view text, double& number) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto found = readNumber(text);
    number = found.value_or(number);
    return found && std::isfinite(*found);
  };
  if (star < offset && !read(std::string_view(value).substr(star + 1, offset - star - 1), made.scale))
    return std::nullopt;
  if (offset < value.size() && !read(std::string_view(value).substr(offset), made.offset))
    return std::nullopt;
  if (made.variable.empty() || made.key.empty() || made.scale == 0) return std::nullopt;
  return made;
}

}  // namespace

Result<std::vector<RuleVariable>> readRuleMapping(std::string_view text, const std::string& where) {
  std::vector<RuleVariable> mapping;
  Findings findings;
  while (!text.empty()) {
    const std::string_view part = trimmed(text.substr(0, text.find(',')));
    text.remove_prefix(std::min(text.size(), text.find(',') == text.npos ? text.size() : text.find(',') + 1));
    if (auto variable = variableIn(part))
      mapping.push_back(std::move(*variable));
    else
      findings.push_back({Severity::error, where, "", "VARIABLE=KEY*SCALE+OFFSET with a scale that is not 0",
                          part.empty() ? "nothing" : std::string(part.substr(0, 80))});
  }
  if (!findings.empty()) return findings;
  return mapping;
}

}  // namespace trimtab
