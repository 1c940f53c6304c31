#include "trimtab/preset/preset.h"

#include <algorithm>
#include <set>

#include "migration.h"
#include "preset_text.h"
#include "shipped.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/json_text.h"
#include "trimtab/preset/rules.h"
#include "trimtab/preset/sealed.h"
#include "trimtab/units/finding_list.h"
#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {

namespace {

constexpr int kLongestBaseChain = 8;

Result<Preset> load(const std::string& nameOrFile, const std::filesystem::path& folder, int depth);

/// Insertions, deletions and replacements between two keys.
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t corner = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, corner + (a[i - 1] != b[j - 1])});
      corner = above;
    }
  }
  return row[b.size()];
}

std::string expectedKey(std::string_view unknown) {
  constexpr std::size_t kTypingError = 4, kLongestKey = 80;
  std::string_view nearest;
  std::size_t best = kTypingError;
  if (unknown.size() <= kLongestKey)
    for (const ParameterRow& row : parameterRows())
      if (const std::size_t distance = editDistance(unknown, row.key); distance < best)
        best = distance, nearest = row.key;
  return "a parameter of this version" + (nearest.empty() ? "" : " (" + std::string(nearest) + "?)");
}

Result<PresetText> readJsonPreset(std::string_view text, const std::string& where) {
  if (const auto syntax = json::checkSyntax(text, where); !syntax) return syntax.findings();
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  const std::string_view top = text.substr(begin);
  if (!json::isObject(top))
    return Finding{Severity::error, json::place(where, text, begin), "", "an object",
                   std::string(top.substr(0, 20))};
  PresetText file;
  json::Places places(where, text);
  for (const json::Member& member : json::members(top, text)) {
    file.members.push_back({member.key, std::string(member.value), places.at(member.at)});
    if (member.key != "parameters") continue;
    for (const json::Member& parameter : json::members(member.value, text))
      file.parameters.push_back({parameter.key, std::string(parameter.value), places.at(parameter.at)});
  }
  return file;
}

/// One reading of one file: what was found so far, and where.
class Reader {
 public:
  Reader(std::string_view text, std::string where, std::filesystem::path folder, int depth)
      : whole_(text), text_(withoutByteOrderMark(text)), where_(std::move(where)), depth_(depth) {
    preset_.folder = std::move(folder);
  }

  Result<Preset> read() {
    if (isUtf16(whole_))
      return Finding{Severity::error, where_, "", "text in UTF-8", "UTF-16; save it again as UTF-8"};
    const bool isXml = looksLikeXml(text_), isIni = looksLikeIni(text_);
    isJson_ = !isXml && !isIni;
    Result<PresetText> file = isXml   ? readXmlExport(text_, where_)
                              : isIni ? readIniExport(text_, where_)
                                      : readJsonPreset(text_, where_);
    if (!file) return file.findings();
    for (const RawParameter& member : file->members)
      if (const auto [at, isNew] = top_.emplace(member.key, member); !isNew)
        refuse(member.where, member.key, "each member once", "it a second time");
    if (findings_.hasError() || !readFormat()) return findings_.all(where_);
    if (isExport_ && !sealHolds()) return findings_.all(where_);
    const int version = readVersion();
    if (version == 0) return findings_.all(where_);
    readTexts();
    readBase();
    readParameters(version, std::move(file.value().parameters));
    if (findings_.hasError()) return findings_.all(where_);
    for (Finding& f : ruleFindings(preset_.parameters)) addPlaced(std::move(f));
    return {std::move(preset_), findings_.all(where_)};
  }

 private:
  void refuse(std::string where, std::string key, std::string expected, std::string found) {
    findings_.add({Severity::error, std::move(where), std::move(key), std::move(expected), std::move(found)});
  }
  /// Refuses a member, or what should be there.
  void refuseMember(const std::string& key, std::string expected) {
    const RawParameter* const found = member(key);
    refuse(found ? found->where : json::place(where_, text_, 0), key, std::move(expected),
           found ? found->value.substr(0, 80) : "none");
  }
  void addPlaced(Finding f) {
    const auto at = places_.find(f.key);
    f.where = at == places_.end() ? where_ : at->second;
    findings_.add(std::move(f));
  }
  const RawParameter* member(const std::string& key) const {
    const auto at = top_.find(key);
    return at == top_.end() ? nullptr : &at->second;
  }

  bool readFormat() {
    const RawParameter* const format = member("format");
    const auto name = format ? json::readString(format->value) : std::nullopt;
    isExport_ = name == "trimtab-export";
    if (isExport_ || name == "trimtab-preset") return true;
    refuseMember("format", "\"trimtab-preset\" or \"trimtab-export\"");
    return false;
  }

  bool sealHolds() {
    const auto seal = checkSeal(whole_, where_);
    findings_.add(seal.findings());
    if (!seal) return false;
    const RawParameter* const checksum = member("checksum");
    if (checksum && json::readString(checksum->value) == *seal) return true;
    refuseMember("checksum", *seal);
    return false;
  }

  /// Returns 0 if the file's version cannot be read.
  int readVersion() {
    const RawParameter* const version = member("version");
    const auto number = version ? readNumber(version->value) : std::nullopt;
    for (int v = 1; v <= kPresetVersion; ++v)
      if (number == v) return v;
    refuseMember("version", "a format version from 1 to " + std::to_string(kPresetVersion));
    return 0;
  }

  void readTexts() {
    for (const auto& [key, target] : {std::pair<std::string, std::string*>{"name", &preset_.name},
                                      {"description", &preset_.description},
                                      {"base", &preset_.base}})
      if (const RawParameter* const text = member(key)) {
        const auto value = json::readString(text->value);
        if (value)
          *target = *value;
        else
          refuseMember(key, "text");
      }
    for (const auto& [key, value] : top_) {
      static const std::set<std::string> known{"format",      "version",    "name",       "base",
                                               "description", "parameters", "provenance", "checksum"};
      if (!known.contains(key)) preset_.unknownMembers.emplace(key, value.value);
    }
  }

  void readBase() {
    if (isExport_ || preset_.base.empty()) return;
    const std::string& at = member("base")->where;
    if (depth_ >= kLongestBaseChain)
      return refuse(at, "base",
                    "at most " + std::to_string(kLongestBaseChain) + " presets based on each other",
                    "more; does one name itself?");
    const Result<Preset> base = load(preset_.base, preset_.folder, depth_ + 1);
    if (base) {
      preset_.parameters = base->parameters;
      return;
    }
    // Once, not for every link of a chain: the findings below say which file is bad.
    if (depth_ == 0)
      refuse(at, "base", "a shipped preset's name or a preset file",
             "\"" + preset_.base + "\", which cannot be read");
    findings_.add(base.findings());
  }

  void readParameters(int version, std::vector<RawParameter> raw) {
    const RawParameter* const all = member("parameters");
    if (isJson_ && (!all || !json::isObject(all->value))) return refuseMember("parameters", "an object");
    migrate(version, preset_.parameters, raw, findings_);
    if (isExport_) keepFormerBehaviour(raw, where_, findings_);
    for (const RawParameter& parameter : raw) readParameter(parameter);
    for (const ParameterRow& row : parameterRows())
      if (isExport_ && !places_.contains(std::string(row.key)))
        findings_.add({Severity::warning, where_, std::string(row.key), "every parameter in an export",
                       "none; " + toText(row, row.get(preset_.parameters)) + " is used"});
    for (Finding& f : rangeFindings(preset_.parameters)) addPlaced(std::move(f));
  }

  void readParameter(const RawParameter& parameter) {
    if (!places_.emplace(parameter.key, parameter.where).second)
      return refuse(parameter.where, parameter.key, "each parameter once", "it a second time");
    const ParameterRow* const row = findRow(parameter.key);
    if (!row) {
      preset_.unknown.emplace(parameter.key, parameter.value);
      findings_.add(Severity::warning, [&] {
        return Finding{Severity::warning, parameter.where, parameter.key, expectedKey(parameter.key),
                       "an unknown key, kept without effect"};
      });
      return;
    }
    const Result<ParameterValue> value = json::readValue(*row, parameter.value);
    if (value) return row->set(preset_.parameters, *value);
    for (Finding f : value.findings()) {
      f.where = parameter.where;
      f.key = parameter.key;
      findings_.add(std::move(f));
    }
  }

  std::string_view whole_, text_;  ///< with and without a byte order mark
  std::string where_;
  int depth_;
  bool isExport_ = false, isJson_ = true;
  std::map<std::string, RawParameter> top_;
  std::map<std::string, std::string> places_;  ///< parameter -> file and line
  Preset preset_;
  FindingList findings_;
};

Result<Preset> load(const std::string& nameOrFile, const std::filesystem::path& folder, int depth) {
  for (const ShippedPreset& shipped : kShippedPresets)
    if (shipped.name == nameOrFile) return Reader(shipped.text, "preset " + nameOrFile, {}, depth).read();
  const std::filesystem::path file = folder / nameOrFile;
  std::error_code ignored;
  if (depth > 0 && !std::filesystem::is_regular_file(file, ignored))
    return Finding{Severity::error, file.string(), "", "a preset file", "none"};
  const Result<std::string> text = readWhole(file);
  if (!text) return text.findings();
  return Reader(*text, file.string(), file.parent_path(), depth).read();
}

}  // namespace

std::vector<std::string_view> shippedPresets() {
  std::vector<std::string_view> names;
  for (const ShippedPreset& shipped : kShippedPresets) names.push_back(shipped.name);
  return names;
}

Result<Preset> loadPreset(const std::string& nameOrFile) {
  return withinMemory(nameOrFile, [&] { return load(nameOrFile, {}, 0); });
}

Result<Preset> parsePreset(std::string_view text, const std::string& where) {
  return Reader(text, where, std::filesystem::path(where).parent_path(), 0).read();
}

Result<TuningParameters> baseParameters(const Preset& preset) {
  if (preset.base.empty()) return TuningParameters{};
  const Result<Preset> base = load(preset.base, preset.folder, 1);
  if (!base) return base.findings();
  return base->parameters;
}

Result<std::string> presetText(const Preset& preset) {
  if (Findings broken = rangeFindings(preset.parameters); hasError(broken)) return broken;
  const Result<TuningParameters> base = baseParameters(preset);
  if (!base) return base.findings();
  std::string text = "{\n  \"format\": \"trimtab-preset\",\n  \"version\": " + std::to_string(kPresetVersion);
  const auto member = [&text](const std::string& key, const std::string& value) {
    text += ",\n  " + json::stringText(key) + ": " + value;
  };
  member("name", json::stringText(preset.name));
  if (!preset.base.empty()) member("base", json::stringText(preset.base));
  if (!preset.description.empty()) member("description", json::stringText(preset.description));
  for (const auto& [key, value] : preset.unknownMembers) member(key, value);
  std::string parameters;
  const auto parameter = [&parameters](std::string_view key, const std::string& value) {
    parameters += (parameters.empty() ? "\n    " : ",\n    ") + json::stringText(key) + ": " + value;
  };
  for (const ParameterRow& row : parameterRows()) {
    // The value is kept as text, because a negative zero differs from zero and has to come back as one.
    std::string value = json::valueText(row, row.get(preset.parameters));
    if (value != json::valueText(row, row.get(*base))) parameter(row.key, value);
  }
  for (const auto& [key, value] : preset.unknown) parameter(key, value);
  member("parameters", parameters.empty() ? "{}" : "{" + parameters + "\n  }");
  return text + "\n}\n";
}

std::vector<Difference> differences(const TuningParameters& left, const TuningParameters& right) {
  std::vector<Difference> found;
  for (const ParameterRow& row : parameterRows()) {
    std::string a = toText(row, row.get(left)), b = toText(row, row.get(right));
    if (a != b) found.push_back({std::string(row.key), std::move(a), std::move(b)});
  }
  return found;
}

}  // namespace trimtab
