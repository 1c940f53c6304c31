#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "commands.h"
#include "settings.h"
#include "trimtab/policy/policy_file.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/policy_lines.h"
#include "trimtab/preset/preset.h"

namespace trimtab::cli {

namespace {

struct FuzzyOptions {
  std::string preset = "default", file, output, format, map;
  std::vector<std::string> settings;
  bool acceptDifference = false;
};

Result<std::string> policyText(const TuningParameters& parameters, const std::string& name,
                               RuleFormat format) {
  const auto policy = policyOf(parameters.policy);
  if (!policy) return policy.findings();
  if (policy->rules.empty())
    return Finding{Severity::error, name, "policy.rules", "at least one rule", "none"};
  return policyFileText(*policy, name, format);
}

Result<TuningParameters> readPolicy(std::string_view text, const FuzzyOptions& options, RuleFormat format,
                                    const TuningParameters& onto) {
  auto mapping = readRuleMapping(options.map, "--map");
  if (!mapping) return mapping.findings();
  const auto policy =
      readPolicyFile(text, options.file, format, {std::move(*mapping), options.acceptDifference});
  if (!policy) return policy.findings();
  TuningParameters parameters = onto;
  parameters.policy = policyLines(*policy);
  parameters.policy.enabled = true;
  return {std::move(parameters), policy.findings()};
}
/// Returns the format of --format, else of the file's ending.
std::optional<RuleFormat> formatOf(const FuzzyOptions& options, const std::string& file) {
  if (!options.format.empty()) return options.format == "fis" ? RuleFormat::matlab : RuleFormat::fuzzylite;
  const auto format = ruleFormatOf(file);
  if (!format)
    report({{Severity::error, file, "", "a name that ends in .fll or .fis, or --format", "another"}});
  return format;
}

int exportPolicy(const FuzzyOptions& options) {
  const auto format = formatOf(options, options.output);
  if (!format) return kUsage;
  const auto parameters = parametersFor(options.preset, options.settings);
  if (!parameters) return kRefused;
  const auto preset = loadPreset(options.preset);
  const auto text = policyText(**parameters, preset ? preset->name : std::string(), *format);
  report(text.findings());
  return text ? writeOut(options.output, *text) : kRefused;
}

int importPolicy(const FuzzyOptions& options) {
  const auto format = formatOf(options, options.file);
  if (!format) return kUsage;
  const auto base = loadPreset(options.preset);
  const auto text = readWhole(options.file);
  report(base.findings());
  report(text.findings());
  if (!base || !text) return kRefused;
  const auto read = readPolicy(*text, options, *format, base->parameters);
  report(read.findings());
  if (!read) return kRefused;
  Preset preset;
  preset.name = std::filesystem::path(options.file).stem().string();
  const auto shipped = shippedPresets();
  const bool isShipped = std::find(shipped.begin(), shipped.end(), options.preset) != shipped.end();
  preset.base = isShipped ? options.preset : std::filesystem::absolute(options.preset).string();
  preset.parameters = *read;
  const auto written = presetText(preset);
  report(written.findings());
  return written ? writeOut(options.output, *written) : kRefused;
}

}  // namespace

void addFuzzy(CLI::App& preset, int& exitCode) {
  const auto options = std::make_shared<FuzzyOptions>();
  CLI::App* const fuzzy = preset.add_subcommand(
      "policy",
      "Exchange the policy with fuzzy-logic tools (.fll, .fis): each signal that has terms is an input, each "
      "lever that a rule sets an output; the preset of an import has its policy switched on");
  fuzzy->require_subcommand(1);
  const auto formatOption = [options](CLI::App* command) {
    command->add_option("--format", options->format, "fll or fis, where the file's ending does not say it")
        ->check(CLI::IsMember({"fll", "fis"}));
  };

  CLI::App* const exporting =
      fuzzy->add_subcommand("export", "Write them as FuzzyLite Language (.fll) or MATLAB FIS text (.fis)");
  exporting->add_option("preset", options->preset, "Preset file or the name of a shipped preset")->required();
  exporting->add_option("-o,--output", options->output, "File to write; - for standard output")->required();
  exporting->add_option("--set", options->settings, "key=value, applied before; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  formatOption(exporting);
  exporting->callback([&exitCode, options] { exitCode = exportPolicy(*options); });

  CLI::App* const importing =
      fuzzy->add_subcommand("import", "Make a preset of them; everything else from --base");
  importing->add_option("file", options->file, "File to read: .fll or .fis")->required();
  importing->add_option("--base", options->preset, "Preset file or the name of a shipped preset")
      ->default_str("default");
  importing->add_option("-o,--output", options->output, "Preset to write; - for standard output")->required();
  importing->add_option(
      "--map", options->map,
      "Which signal each input is and which lever each output, where their names do not say "
      "it: \"Speed=speed*0.514,Out=lod_scale\". VARIABLE=KEY*SCALE+OFFSET converts units; in "
      "names, _ stands for a comma");
  importing->add_flag(
      "--accept-difference", options->acceptDifference,
      "Keep the rules of a file of planes or of Mamdani's kind even where the policy differs from it by more "
      "than 5 % of an output's range; otherwise a table replaces them there");
  formatOption(importing);
  importing->callback([&exitCode, options] { exitCode = importPolicy(*options); });
}

}  // namespace trimtab::cli
