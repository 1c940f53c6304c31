#include "sweep.h"

#include <algorithm>

namespace trimtab::harness {
namespace {

constexpr std::string_view kOption = "--sweep";

/// A preset's name taken apart: its base, and the parameters and values after it.
struct SweptName {
  std::string base;
  std::vector<std::pair<std::string, std::string>> settings;
};

SweptName takeApart(const std::string& name) {
  SweptName parts{name, {}};
  while (true) {
    const std::size_t blank = parts.base.rfind(' ');
    const std::size_t equals = blank == std::string::npos ? blank : parts.base.find('=', blank);
    if (equals == std::string::npos) break;
    parts.settings.insert(parts.settings.begin(),
                          {parts.base.substr(blank + 1, equals - blank - 1), parts.base.substr(equals + 1)});
    parts.base.resize(blank);
  }
  return parts;
}

std::size_t placeOf(const std::vector<std::string>& values, const std::string& value) {
  return static_cast<std::size_t>(std::find(values.begin(), values.end(), value) - values.begin());
}

bool sameKeys(const Sweep& sweep, const SweptName& name) {
  return std::equal(sweep.axes.begin(), sweep.axes.end(), name.settings.begin(), name.settings.end(),
                    [](const SweepAxis& axis, const auto& setting) { return axis.key == setting.first; });
}

}  // namespace

Result<SweepAxis> parseAxis(std::string_view text) {
  const auto refuse = [&](const char* expected) {
    return Finding{Severity::error, std::string(kOption), "", expected, std::string(text)};
  };
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string_view::npos) return refuse("KEY=VALUE,VALUE,...");
  SweepAxis axis{std::string(text.substr(0, equals)), {}};
  for (std::size_t at = equals + 1; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    std::string value(text.substr(at, end - at));
    if (value.empty() || value.find(' ') != std::string::npos) return refuse("values without blanks");
    if (placeOf(axis.values, value) < axis.values.size()) return refuse("each value once");
    axis.values.push_back(std::move(value));
    at = end + 1;
  }
  if (axis.values.size() > kMostValues) return refuse("at most 64 values");
  return axis;
}

std::vector<Settings> combinations(const std::vector<SweepAxis>& axes) {
  std::vector<Settings> all{{}};
  for (const SweepAxis& axis : axes) {
    std::vector<Settings> longer;
    for (const Settings& settings : all)
      for (const std::string& value : axis.values) {
        longer.push_back(settings);
        longer.back().push_back(axis.key + '=' + value);
      }
    all = std::move(longer);
  }
  return all;
}

std::string sweptName(const std::string& base, const Settings& settings) {
  std::string name = base;
  for (const std::string& setting : settings) name += ' ' + setting;
  return name;
}

std::vector<Sweep> sweepsOf(const Answer& answer) {
  std::vector<Sweep> sweeps;
  const auto sweepOf = [&](const SweptName& name, const std::string& method) {
    return std::find_if(sweeps.begin(), sweeps.end(), [&](const Sweep& sweep) {
      return sweep.base == name.base && sweep.method == method && sameKeys(sweep, name);
    });
  };
  for (const AnswerRow& row : answer.rows) {
    const SweptName name = takeApart(row.name.preset);
    if (name.settings.empty() || name.settings.size() > kMostAxes) continue;
    auto sweep = sweepOf(name, row.name.method);
    if (sweep == sweeps.end()) {
      sweep = sweeps.insert(sweeps.end(), {name.base, row.name.method, {}, {}});
      for (const auto& setting : name.settings) sweep->axes.push_back({setting.first, {}});
    }
    for (std::size_t i = 0; i < name.settings.size(); ++i) {
      std::vector<std::string>& values = sweep->axes[i].values;
      if (placeOf(values, name.settings[i].second) == values.size())
        values.push_back(name.settings[i].second);
    }
  }
  for (Sweep& sweep : sweeps) {
    const std::size_t across = sweep.axes.size() > 1 ? sweep.axes[1].values.size() : 1;
    sweep.rows.assign(sweep.axes[0].values.size() * across, Sweep::kNotMeasured);
  }
  for (std::size_t i = 0; i < answer.rows.size(); ++i) {
    const SweptName name = takeApart(answer.rows[i].name.preset);
    const auto sweep = sweepOf(name, answer.rows[i].name.method);
    if (name.settings.empty() || sweep == sweeps.end()) continue;
    std::size_t at = placeOf(sweep->axes[0].values, name.settings[0].second);
    if (sweep->axes.size() > 1)
      at = at * sweep->axes[1].values.size() + placeOf(sweep->axes[1].values, name.settings[1].second);
    sweep->rows[at] = i;
  }
  return sweeps;
}

}  // namespace trimtab::harness
