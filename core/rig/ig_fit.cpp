#include "trimtab/rig/ig_fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/json_text.h"
#include "trimtab/units/finding_list.h"
#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

constexpr std::string_view kFormat = "trimtab-ig-fit";

/// Calls `visit(key, number)` for each number of a ratio, in the order of the file.
template <class Ratio, class Visit>
void forEachNumber(Ratio& ratio, const Visit& visit) {
  visit("median", ratio.median), visit("low", ratio.low), visit("high", ratio.high);
}

/// JSON has no number for what is unknown or unlimited.
std::string number(double value) {
  return std::isfinite(value) ? numberText(value) : "null";
}

std::string ratioText(const PairedRatio& ratio) {
  std::string text = "{";
  forEachNumber(ratio, [&](const char* key, double value) {
    text += (text.size() > 1 ? ", \"" : "\"") + std::string(key) + "\": " + number(value);
  });
  return text + '}';
}

/// Reads a text that checkSyntax() passed, and keeps what is wrong with it.
class Reader {
 public:
  Reader(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  Result<IgFit> read() {
    std::map<std::string, double, std::less<>> cost;
    bool isFit = false;
    for (const json::Member& m : json::members(text_, text_)) {
      if (m.key == "format")
        isFit = json::readString(m.value) == kFormat;
      else if (m.key == "ig")
        fit_.ig = json::readString(m.value).value_or("");
      else if (m.key == "views")
        fit_.views = static_cast<std::size_t>(std::min(count(m), 1e9));
      else if (m.key == "time_ms")
        fit_.timeMs = count(m);
      else if (m.key == "load_low")
        fit_.loadLow = count(m);
      else if (m.key == "load_high")
        fit_.loadHigh = count(m);
      else if (m.key == "neutral_px")
        fit_.neutralPx = value(m.value);
      else if (m.key == "shape")
        readShape(m);
      else if (m.key == "points")
        for (const std::string_view point : json::elements(m.value)) readPoint(m, point);
      else if (m.key == "cost")
        for (const json::Member& c : json::members(m.value, text_)) cost[c.key] = value(c.value);
    }
    if (!isFit)
      return Finding{Severity::error, where_, "format", '"' + std::string(kFormat) + '"', "another file"};
    readCost(cost);
    if (fit_.loadHigh < fit_.loadLow)
      findings_.add({Severity::error, where_, "load_high", "at least load_low", number(fit_.loadHigh)});
    if (findings_.hasError()) return findings_.all(where_);
    return fit_;
  }

 private:
  static double value(std::string_view text) {
    return readNumber(text).value_or(std::numeric_limits<double>::quiet_NaN());
  }
  void refuse(const json::Member& m, std::string expected, std::string_view found) {
    findings_.add({Severity::error, json::place(where_, text_, m.at), m.key, std::move(expected),
                   std::string(found.substr(0, 40))});
  }
  double count(const json::Member& m) {
    const double number = value(m.value);
    if (std::isfinite(number) && number >= 0) return number;
    refuse(m, "a number of 0 or more", m.value);
    return 0;
  }
  /// Reads all numbers before it checks one, because what one may be depends on others.
  void readCost(const std::map<std::string, double, std::less<>>& cost) {
    CostModel::State::forEachNumber(fit_.cost, [&](const std::string& key, double& n, double, double) {
      const auto at = cost.find(key);
      n = at != cost.end() ? at->second : std::numeric_limits<double>::quiet_NaN();
    });
    CostModel::State::forEachNumber(fit_.cost,
                                    [&](const std::string& key, double n, double low, double high) {
                                      if (!(n >= low && n <= high))
                                        findings_.add({Severity::error, where_, "cost." + key,
                                                       numberText(low, 6) + ".." + numberText(high, 6),
                                                       cost.contains(key) ? number(n) : "nothing"});
                                    });
  }
  void readShape(const json::Member& m) {
    const std::vector<std::string_view> parts = json::elements(m.value);
    bool good = parts.size() == fit_.shape.size();
    for (std::size_t i = 0; good && i < parts.size(); ++i) {
      fit_.shape[i] = value(parts[i]);
      good = fit_.shape[i] > 0 && fit_.shape[i] <= 1;
    }
    if (!good) refuse(m, std::to_string(fit_.shape.size()) + " numbers above 0, at most 1", m.value);
  }
  void readPoint(const json::Member& points, std::string_view text) {
    LeverPoint p;
    std::optional<std::size_t> row;
    for (const json::Member& m : json::members(text, text_)) {
      if (m.key == "lever") {
        const auto at =
            std::ranges::find(kFrameLeverRows, json::readString(m.value).value_or(""), &FrameLeverRow::key);
        if (at != kFrameLeverRows.end()) row = static_cast<std::size_t>(at - kFrameLeverRows.begin());
      } else if (m.key == "value") {
        p.value = value(m.value);
      } else if (m.key == "flip") {
        p.flip = value(m.value);
      } else if (m.key == "shift_px") {
        p.shiftPx = value(m.value);
      } else if (m.key == "time" || m.key == "load") {
        PairedRatio& ratio = m.key == "time" ? p.time : p.load;
        for (const json::Member& r : json::members(m.value, text_))
          forEachNumber(ratio, [&](const char* key, double& n) {
            if (r.key == key) n = value(r.value);
          });
        if (std::isnan(ratio.high)) ratio.high = std::numeric_limits<double>::infinity();
      }
    }
    if (!row) return refuse(points, "\"lever\" with the key of a lever", text);
    p.row = *row;
    fit_.points.push_back(p);
  }

  std::string_view text_;
  const std::string& where_;
  IgFit fit_;
  FindingList findings_;
};

}  // namespace

std::string fitText(const IgFit& fit) {
  std::string text =
      "{\n  \"format\": \"" + std::string(kFormat) + "\",\n  \"ig\": " + json::stringText(fit.ig) +
      ",\n  \"views\": " + std::to_string(fit.views) + ",\n  \"time_ms\": " + number(fit.timeMs) +
      ",\n  \"load_low\": " + number(fit.loadLow) + ",\n  \"load_high\": " + number(fit.loadHigh) +
      ",\n  \"neutral_px\": " + number(fit.neutralPx) + ",\n  \"shape\": [";
  for (std::size_t i = 0; i < fit.shape.size(); ++i) text += (i > 0 ? ", " : "") + number(fit.shape[i]);
  text += "],\n  \"points\": [";
  for (const LeverPoint& p : fit.points)
    text += std::string(&p == fit.points.data() ? "" : ",") + "\n    {\"lever\": \"" +
            std::string(kFrameLeverRows[p.row].key) + "\", \"value\": " + number(p.value) +
            ", \"time\": " + ratioText(p.time) + ", \"load\": " + ratioText(p.load) +
            ", \"flip\": " + number(p.flip) + ", \"shift_px\": " + number(p.shiftPx) + '}';
  text += "\n  ],\n  \"cost\": {";
  bool first = true;
  CostModel::State::forEachNumber(fit.cost, [&](const std::string& key, double n, double, double) {
    text += std::string(first ? "" : ",") + "\n    \"" + key + "\": " + number(n);
    first = false;
  });
  return text + "\n  }\n}\n";
}

Result<IgFit> parseIgFit(std::string_view text, const std::string& where) {
  text = withoutByteOrderMark(text);
  if (const auto syntax = json::checkSyntax(text, where); !syntax) return syntax.findings();
  return Reader(text, where).read();
}

Result<IgFit> loadIgFit(const std::filesystem::path& file) {
  const Result<std::string> text = readWhole(file);
  if (!text) return text.findings();
  return parseIgFit(*text, file.string());
}

Result<Done> checkFit(const IgFit& fit, const IgProfile& profile, const std::string& where) {
  if (fit.ig != profile.name)
    return Finding{Severity::error, where, "ig", "a fit of \"" + profile.name + '"',
                   "one of \"" + fit.ig + '"'};
  if (fit.views >= kFewestFitViews) return Done{};
  return Finding{Severity::error, where, "views",
                 "at least " + std::to_string(kFewestFitViews) + " views: fly a longer flight",
                 std::to_string(fit.views)};
}

std::string report(const IgFit& fit, const IgProfile& profile) {
  const auto interval = [](const PairedRatio& r) {
    return numberText(r.median, 3) + " (" + numberText(r.low, 3) + " to " + numberText(r.high, 3) + ')';
  };
  std::string text = profile.name + ": " + std::to_string(fit.views) +
                     " views; with every lever neutral an image takes " + numberText(fit.timeMs, 3) +
                     " ms and has a load of " + numberText(fit.loadLow, 3) + " to " +
                     numberText(fit.loadHigh, 3) + " (5th to 95th percentile).\n";
  for (const LeverPoint& p : fit.points) {
    const auto lever = std::ranges::find(profile.levers, p.row, &IgLever::row);
    if (lever == profile.levers.end()) continue;
    text += lever->ownKey + ' ' + numberText(lever->toOwn(p.value), 3) + (lever->ownUnit.empty() ? "" : " ") +
            lever->ownUnit + ": time " + interval(p.time) + ", load " + interval(p.load);
    if (std::isfinite(p.flip)) text += ", FLIP " + numberText(p.flip, 2);
    if (std::isfinite(p.shiftPx)) text += ", moved by " + numberText(p.shiftPx, 2) + " px";
    text += '\n';
  }
  if (std::isfinite(fit.neutralPx) && profile.errorLever() != nullptr)
    text += profile.errorLever()->ownKey + ' ' + numberText(profile.errorLever()->ownNeutral) +
            " stands for an error of " + numberText(fit.neutralPx, 2) + " px.\n";
  return text;
}

}  // namespace trimtab
