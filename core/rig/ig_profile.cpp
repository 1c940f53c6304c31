#include "trimtab/rig/ig_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/json_text.h"
#include "trimtab/units/finding_list.h"
#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

constexpr std::string_view kFormat = "trimtab-ig-profile";
constexpr std::array<std::string_view, 3> kLoads{"triangles", "objects", "time"};
constexpr std::string_view kError = "screen_space_error", kLodScale = "lod_scale";

std::string leverKeys() {
  std::string keys;
  for (const FrameLeverRow& row : kFrameLeverRows) keys += (keys.empty() ? "" : ", ") + std::string(row.key);
  return keys;
}

/// Reads the members of one profile, and keeps what is wrong with them.
class Reader {
 public:
  Reader(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  Result<IgProfile> read() {
    bool isProfile = false, hasVersion = false;
    for (const json::Member& m : json::members(text_, text_)) {
      if (m.key == "format")
        isProfile = json::readString(m.value) == kFormat;
      else if (m.key == "version")
        number(m, "", 1, 1), hasVersion = true;
      else if (m.key == "name")
        profile_.name = string(m, "");
      else if (m.key == "load")
        readLoad(m);
      else if (m.key == "settle_images")
        profile_.settleImages = static_cast<int>(number(m, "", 0, 1000));
      else if (m.key == "levers")
        readLevers(m);
      else
        say(Severity::warning, m, "", "format, version, name, load, settle_images, levers", m.key);
    }
    if (!isProfile)
      return Finding{Severity::error, where_, "format", '"' + std::string(kFormat) + '"', "another file"};
    if (!hasVersion) findings_.add({Severity::error, where_, "version", "1", "none"});
    if (profile_.name.empty())
      findings_.add(
          {Severity::error, where_, "name", "a name, by which a fit knows its image generator", "none"});
    if (profile_.levers.empty() && !findings_.hasError())
      findings_.add({Severity::error, where_, "levers", "at least one of " + leverKeys(), "none"});
    if (findings_.hasError()) return findings_.all(where_);
    std::ranges::sort(profile_.levers, {}, &IgLever::row);
    return {std::move(profile_), findings_.all(where_)};
  }

 private:
  void say(Severity severity, const json::Member& at, const std::string& under, std::string expected,
           std::string found) {
    findings_.add(
        {severity, json::place(where_, text_, at.at), under + at.key, std::move(expected), std::move(found)});
  }
  std::string string(const json::Member& m, const std::string& under) {
    const auto text = json::readString(m.value);
    if (!text) say(Severity::error, m, under, "a text in quotes", std::string(m.value.substr(0, 40)));
    return text.value_or("");
  }
  double number(const json::Member& m, const std::string& under, double low, double high) {
    const std::optional<double> value = readNumber(m.value);
    if (value && *value >= low && *value <= high) return *value;
    const bool bounded = std::isfinite(low) && std::isfinite(high);
    say(Severity::error, m, under,
        bounded ? "a number from " + numberText(low) + " to " + numberText(high) : "a finite number",
        std::string(m.value.substr(0, 40)));
    return low;
  }
  bool flag(const json::Member& m, const std::string& under) {
    if (m.value != "true" && m.value != "false")
      say(Severity::error, m, under, "true or false", std::string(m.value.substr(0, 40)));
    return m.value == "true";
  }
  void readLoad(const json::Member& m) {
    const auto name = json::readString(m.value);
    const auto at = std::ranges::find(kLoads, name.value_or(""));
    if (at == kLoads.end())
      return say(Severity::error, m, "", "\"triangles\", \"objects\" or \"time\"",
                 std::string(m.value.substr(0, 40)));
    profile_.load = static_cast<IgLoad>(at - kLoads.begin());
  }
  void readLevers(const json::Member& levers) {
    for (const json::Member& m : json::members(levers.value, text_)) {
      const auto row = std::ranges::find(kFrameLeverRows, m.key, &FrameLeverRow::key);
      if (row == kFrameLeverRows.end())
        say(Severity::error, m, "levers.", "one of " + leverKeys(), m.key);
      else if (profile_.find(m.key) != nullptr)
        say(Severity::error, m, "levers.", "each lever once", "it again");
      else
        readLever(m, static_cast<std::size_t>(row - kFrameLeverRows.begin()));
    }
  }
  void readLever(const json::Member& lever, std::size_t row) {
    const std::string under = "levers." + lever.key + '.';
    constexpr double kMost = 1e9;
    IgLever l{row, lever.key, std::string(kFrameLeverRows[row].unit)};
    std::optional<double> from, to, neutral;
    for (const json::Member& m : json::members(lever.value, text_)) {
      if (m.key == "key")
        l.ownKey = string(m, under);
      else if (m.key == "unit")
        l.ownUnit = string(m, under);
      else if (m.key == "factor")
        l.factor = number(m, under, 1e-9, kMost);
      else if (m.key == "inverse")
        l.inverse = flag(m, under);
      else if (m.key == "from")
        from = number(m, under, -kMost, kMost);
      else if (m.key == "to")
        to = number(m, under, -kMost, kMost);
      else if (m.key == "neutral")
        neutral = number(m, under, -kMost, kMost);
      else
        say(Severity::warning, m, under, "key, unit, factor, inverse, from, to, neutral", m.key);
    }
    const auto wrong = [&](std::string expected, std::string found) {
      say(Severity::error, lever, "levers.", std::move(expected), std::move(found));
    };
    if (!from || !to || !neutral) return wrong("from, to and neutral", "not all of them");
    l.own = {*from, *to}, l.ownNeutral = *neutral;
    if (!(*from < *to)) return wrong("from below to", numberText(*from) + " and " + numberText(*to));
    if (!(*neutral >= *from && *neutral <= *to))
      return wrong("a neutral value from " + numberText(*from) + " to " + numberText(*to),
                   numberText(*neutral));
    // Errors and scales are felt by ratios: nothing is so many times 0.
    if ((lever.key == kError || lever.key == kLodScale) && !(*from > 0))
      return wrong("from above 0", numberText(*from));
    if (l.inverse && !(*from > 0)) return wrong("from above 0, because it is inverse", numberText(*from));
    profile_.levers.push_back(std::move(l));
  }

  std::string_view text_;
  const std::string& where_;
  IgProfile profile_;
  FindingList findings_;
};

}  // namespace

double IgLever::toOwn(double ours) const {
  if (std::isnan(ours)) return ownNeutral;
  return std::clamp(inverse ? factor / ours : factor * ours, own.low, own.high);
}

double IgLever::toOurs(double ownValue) const {
  return inverse ? factor / ownValue : ownValue / factor;
}

Range IgLever::ours() const {
  return inverse ? Range{toOurs(own.high), toOurs(own.low)} : Range{toOurs(own.low), toOurs(own.high)};
}

bool operator==(const IgLever& a, const IgLever& b) {
  return a.row == b.row && a.ownKey == b.ownKey && a.ownUnit == b.ownUnit && a.factor == b.factor &&
         a.inverse == b.inverse && a.own.low == b.own.low && a.own.high == b.own.high &&
         a.ownNeutral == b.ownNeutral;
}

const IgLever* IgProfile::find(std::string_view key) const {
  const auto at = std::ranges::find_if(levers, [&](const IgLever& l) { return l.names().key == key; });
  return at == levers.end() ? nullptr : &*at;
}

const IgLever* IgProfile::errorLever() const {
  const IgLever* own = find(kError);
  return own != nullptr ? own : find(kLodScale);
}

Result<IgProfile> parseIgProfile(std::string_view text, const std::string& where) {
  text = withoutByteOrderMark(text);
  if (const auto syntax = json::checkSyntax(text, where); !syntax) return syntax.findings();
  return Reader(text, where).read();
}

Result<IgProfile> loadIgProfile(const std::filesystem::path& file) {
  const Result<std::string> text = readWhole(file);
  if (!text) return text.findings();
  return parseIgProfile(*text, file.string());
}

double ownValue(const IgProfile& profile, const IgLever& lever, const LeverChain& chain) {
  double ours = valueOf(chain.drawn, lever.names());
  if (lever.names().key == kLodScale && profile.find(kError) == nullptr)
    ours *= chain.drawn.errorPx / chain.preset.errorPx;
  return lever.toOwn(ours);
}

double loadOf(const IgProfile& profile, double triangles, double objects, double workMs) {
  constexpr double kMicrosecondsPerMs = 1000;
  switch (profile.load) {
    case IgLoad::triangles:
      return triangles;
    case IgLoad::objects:
      return objects;
    case IgLoad::time:
      return std::isfinite(workMs) ? workMs * kMicrosecondsPerMs : 0;
  }
  return 0;
}

}  // namespace trimtab
