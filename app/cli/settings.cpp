#include "settings.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>

#include "commands.h"
#include "trimtab/preset/preset.h"
#include "trimtab/terrain/bake/bake.h"

namespace trimtab::cli {
Findings applySettings(const std::vector<std::string>& settings, TuningParameters& parameters) {
  Findings findings;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    const ParameterRow* row = findRow(std::string_view(setting).substr(0, equals));
    if (equals == std::string::npos || !row) {
      findings.push_back(
          {Severity::error, "--set", "", "key=value with a key of `preset reference`", setting});
      continue;
    }
    const Result<ParameterValue> value = parseValue(*row, std::string_view(setting).substr(equals + 1));
    if (value)
      row->set(parameters, *value);
    else
      for (Finding finding : value.findings()) {
        finding.where = "--set";
        findings.push_back(finding);
      }
  }
  return findings;
}

Provenance provenanceNow() {
  std::time_t now = std::time(nullptr);
  if (const char* const fixed = std::getenv("SOURCE_DATE_EPOCH"))
    now = static_cast<std::time_t>(std::atoll(fixed));
  std::tm utc{};
  char text[sizeof "-2147483648-12-31T23:59:59Z"] = "";
  if (!gmtime_r(&now, &utc) || std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc) == 0)
    *text = '\0';
  return {
      .author = {}, .created = text, .program = "trimtab-cli " TRIMTAB_VERSION, .terrain = {}, .comment = {}};
}

namespace {

std::optional<harness::Plan::Part> parsePart(const std::string& text) {
  unsigned number = 0, count = 0;
  char after = 0;
  if (std::sscanf(text.c_str(), "%9u/%9u%c", &number, &count, &after) != 2 || number < 1 || number > count ||
      count > terrain::kMostBakeParts)
    return std::nullopt;
  return harness::Plan::Part{number - 1, count};
}

}  // namespace

void PartOptions::add(CLI::App& command) {
  CLI::Option* share =
      command
          .add_option("--part", part,
                      "I/N: does only the I-th of N shares of the work, or of its next step, for several "
                      "processes, or machines that share its folder")
          ->check([](const std::string& text) {
            return parsePart(text) ? std::string()
                                   : "I/N with I from 1 to N and N at most " +
                                         std::to_string(terrain::kMostBakeParts) + ", not " + text;
          });
  command
      .add_flag("--join", join,
                "Joins what parts did and does no part's work; names what is missing, with exit status 3")
      ->excludes(share);
}

std::optional<harness::Plan::Part> PartOptions::read() const {
  return join ? harness::Plan::Part{1, 1} : parsePart(part);
}

int PartOptions::incomplete(const std::vector<std::string>& notes) const {
  for (const std::string& note : notes) std::cout << note << '\n';
  if (!std::cout.flush()) return kRefused;
  return join ? kIncomplete : kDone;
}

std::optional<ValidatedParameters> parametersFor(const std::string& name,
                                                 const std::vector<std::string>& settings) {
  const Result<Preset> preset = loadPreset(name);
  if (!preset) {
    report(preset.findings());
    return std::nullopt;
  }
  TuningParameters parameters = preset->parameters;
  if (const Findings findings = applySettings(settings, parameters); !findings.empty()) {
    report(findings);
    return std::nullopt;
  }
  const Result<ValidatedParameters> valid = validate(parameters);
  report(valid.findings());
  if (!valid) return std::nullopt;
  return *valid;
}

}  // namespace trimtab::cli
