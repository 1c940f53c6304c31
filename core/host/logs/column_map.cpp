#include "trimtab/host/column_map.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "column_advice.h"
#include "trimtab/host/log_look.h"
#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

constexpr std::string_view kAdvice = "map the column, as ", kOr = " or ";

/// Takes the text up to the next comma that does not stand in quotes.
std::string_view takeAssignment(std::string_view& text) {
  bool quoted = false;
  std::size_t end = 0;
  for (; end < text.size() && (quoted || text[end] != ','); ++end) quoted ^= text[end] == '"';
  const std::string_view assignment = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return trimmed(assignment);
}

bool takeNumber(std::string_view& text, double& number) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || !std::isfinite(number)) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

/// Reads "*3.28084+10", "*2" or "-10"; nothing is a scale of 1.
bool readScale(std::string_view text, ColumnSource& source) {
  double scale = 1, offset = 0;
  if (text.starts_with('*')) {
    text.remove_prefix(1);
    if (!takeNumber(text, scale)) return false;
  }
  if ((text.starts_with('+') || text.starts_with('-')) && !takeNumber(text, offset)) return false;
  if (!text.empty()) return false;
  source.scale = scale;
  source.offset = offset;
  return true;
}

bool readSource(std::string_view text, ColumnSource& source) {
  source.written = text;
  if (text.starts_with('"')) {
    const std::size_t close = text.find('"', 1);
    if (close == std::string_view::npos) return false;
    source.column = text.substr(1, close - 1);
    return !source.column.empty() && readScale(text.substr(close + 1), source);
  }
  // Names may hold the signs themselves: the longest end that is a scale is taken for one.
  for (std::size_t at = 1; at < text.size(); ++at)
    if ((text[at] == '*' || text[at] == '+' || text[at] == '-') && readScale(text.substr(at), source)) {
      source.column = trimmed(text.substr(0, at));
      return true;
    }
  source.column = text;
  return !text.empty();
}

/// Returns where `part` begins in a text, outside quotes.
std::size_t findUnquoted(std::string_view text, std::string_view part) {
  bool quoted = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    quoted ^= text[at] == '"';
    if (!quoted && text.substr(at).starts_with(part)) return at;
  }
  return std::string_view::npos;
}

}  // namespace

std::string columnText(std::string_view name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return c == '_' || c == '.' || c == '#' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
           (c >= 'A' && c <= 'Z');
  });
  if (plain) return std::string(name);
  // A name is found by its letters and digits, too; a quotation mark cannot stand in quotes.
  std::string text = '"' + std::string(name) + '"';
  std::replace(text.begin() + 1, text.end() - 1, '"', '_');
  return text;
}

std::string mapAdvice(std::initializer_list<std::string> maps) {
  std::string text;
  for (const std::string& map : maps)
    if (!map.empty()) text.append(text.empty() ? kAdvice : kOr).append(map);
  return "name the unit, or " + text;
}

std::string columnMapText(const ColumnMap& map) {
  std::string text;
  for (const auto& [quantity, source] : map) {
    text += (text.empty() ? "" : ",") + quantity + '=' + columnText(source.column);
    if (source.scale != 1) text += '*' + numberText(source.scale);
    if (source.offset != 0) text += (source.offset > 0 ? "+" : "") + numberText(source.offset);
  }
  return text;
}

std::vector<std::vector<ColumnMap>> readingsThatFit(const Findings& findings) {
  std::vector<std::vector<ColumnMap>> readings;
  for (const Finding& finding : findings) {
    const std::size_t advice = finding.found.find(kAdvice);
    if (finding.severity != Severity::error || advice == std::string::npos) continue;
    std::vector<ColumnMap>& maps = readings.emplace_back();
    for (std::string_view rest = std::string_view(finding.found).substr(advice + kAdvice.size());
         !rest.empty();) {
      const std::size_t end = findUnquoted(rest, kOr);
      if (const auto map = parseColumnMap(rest.substr(0, end))) maps.push_back(*map);
      rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + kOr.size());
    }
  }
  return readings;
}

Result<ColumnMap> parseColumnMap(std::string_view text) {
  ColumnMap map;
  Findings findings;
  while (!trimmed(text).empty()) {
    const std::string_view assignment = takeAssignment(text);
    const std::size_t equals = assignment.find('=');
    const std::string quantity(trimmed(assignment.substr(0, equals)));
    ColumnSource source;
    const bool good = equals != std::string_view::npos && !quantity.empty() &&
                      readSource(trimmed(assignment.substr(equals + 1)), source);
    if (!good)
      findings.push_back({Severity::error, "columns", quantity,
                          "QUANTITY=COLUMN, with a scale or not, as altitude_ft=Alt*3.28084+10",
                          '"' + std::string(assignment.substr(0, 80)) + '"'});
    else if (!map.emplace(quantity, source).second)
      findings.push_back({Severity::error, "columns", quantity, "each quantity once", "twice"});
  }
  if (!findings.empty()) return findings;
  return map;
}

bool mapMayHelp(const Findings& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.severity == Severity::error && (finding.found.find(kAdvice) != std::string::npos ||
                                                   finding.expected.starts_with("the columns of a "));
  });
}

}  // namespace trimtab
