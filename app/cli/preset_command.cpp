#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "settings.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/units/labelled.h"

namespace trimtab::cli {

namespace {

using Json = nlohmann::ordered_json;

struct PresetOptions {
  std::vector<std::string> files, settings;
  std::string left, right, output, format;
  Provenance provenance;
  bool json = false;
};

void printJson(const Json& document) {
  std::cout << document.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

Json toJson(const Findings& findings) {
  Json list = Json::array();
  for (const Finding& f : findings)
    list.push_back({{"severity", label(f.severity)},
                    {"where", f.where},
                    {"key", f.key},
                    {"expected", f.expected},
                    {"found", f.found}});
  return list;
}

int check(const PresetOptions& options) {
  bool good = true;
  Json files = Json::array();
  for (const std::string& file : options.files) {
    const Findings findings = loadPreset(file).findings();
    const bool fileIsGood = !hasError(findings);
    good = good && fileIsGood;
    if (options.json) {
      files.push_back({{"file", file}, {"ok", fileIsGood}, {"findings", toJson(findings)}});
      continue;
    }
    report(findings);
    std::cout << file << (fileIsGood ? ": good\n" : ": refused\n");
  }
  if (options.json) printJson({{"ok", good}, {"files", files}});
  return good ? kDone : kRefused;
}

/// Uses --format, else the file's ending, else JSON, and warns if the ending says something else.
ExportFormat exportFormat(const PresetOptions& options) {
  const std::string ending =
      options.output == "-" ? "" : std::filesystem::path(options.output).extension().string();
  const bool known = ending == ".json" || ending == ".xml" || ending == ".ini";
  const std::string format = !options.format.empty() ? options.format : known ? ending.substr(1) : "json";
  if (!ending.empty() && ending != '.' + format)
    report({{Severity::warning, options.output, "",
             "the ending ." + format +
                 (options.format.empty() ? ", or .xml or .ini, or --format" : ", as --format says"),
             ending + "; written as " + format}});
  return format == "xml" ? ExportFormat::xml : format == "ini" ? ExportFormat::ini : ExportFormat::json;
}

int exportPreset(PresetOptions options) {
  auto preset = loadPreset(options.left);
  if (!preset) {
    report(preset.findings());
    return kRefused;
  }
  TuningParameters parameters = preset->parameters;
  if (const Findings refused = applySettings(options.settings, parameters); !refused.empty()) {
    report(refused);
    return kRefused;
  }
  Findings notes = preset.findings();
  // Ranges and rules are asked again below, of what --set has made of the file.
  std::erase_if(notes,
                [](const Finding& f) { return findRow(f.key) != nullptr && f.severity != Severity::note; });
  report(notes);
  const auto validated = validate(parameters);
  for (Finding f : validated.findings()) {
    f.where = options.left;
    report({f});
  }
  if (!validated) return kRefused;
  const Provenance now = provenanceNow();
  options.provenance.created = now.created, options.provenance.program = now.program;
  if (const std::string note = machineNote(**validated); !note.empty()) {
    report({{Severity::note, options.left, "culling.occlusion",
             "a method by name, as --set culling.occlusion=horizon, to do alike on every machine", "auto"}});
    std::string& comment = options.provenance.comment;
    comment += (comment.empty() ? "" : " ") + note;
  }
  const std::string name =
      preset->name.empty() ? std::filesystem::path(options.left).stem().string() : preset->name;
  return writeOut(options.output, exportText(*validated, name, options.provenance, exportFormat(options)));
}

int diff(const PresetOptions& options) {
  const auto left = loadPreset(options.left), right = loadPreset(options.right);
  if (!left || !right) {
    report(left.findings());
    report(right.findings());
    return kRefused;
  }
  const auto found = differences(left->parameters, right->parameters);
  if (options.json) {
    Json list = Json::array();
    for (const Difference& d : found) list.push_back({{"key", d.key}, {"left", d.left}, {"right", d.right}});
    printJson({{"left", options.left}, {"right", options.right}, {"differences", list}});
    return kDone;
  }
  for (const Difference& d : found) std::cout << d.key << ": " << d.left << " -> " << d.right << '\n';
  return kDone;
}

}  // namespace

void addPreset(CLI::App& app, int& exitCode) {
  const auto options = std::make_shared<PresetOptions>();
  CLI::App* const preset = app.add_subcommand("preset", "Check, export, compare and exchange presets");
  preset->require_subcommand(1);

  CLI::App* const checking = preset->add_subcommand(
      "check", "Say everything that is wrong with preset files; exports must be whole");
  checking->add_option("files", options->files, "Preset files, exports, or names of shipped presets")
      ->required();
  checking->add_flag("--json", options->json, "One JSON document on standard output");
  checking->callback([&exitCode, options] { exitCode = check(*options); });

  CLI::App* const exporting =
      preset->add_subcommand("export", "Write every parameter, with provenance and checksum");
  exporting->add_option("file", options->left, "Preset file or the name of a shipped preset")->required();
  exporting
      ->add_option("--format", options->format,
                   "json, xml (FlightGear property list) or ini; by the file's ending where it is not given")
      ->check(CLI::IsMember({"json", "xml", "ini"}));
  exporting->add_option("-o,--output", options->output, "File to write; - for standard output")->required();
  exporting->add_option("--set", options->settings, "key=value, applied before the export; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  exporting->add_option("--author", options->provenance.author, "Provenance: who");
  exporting->add_option("--terrain", options->provenance.terrain, "Provenance: terrain it was tuned on");
  exporting->add_option("--comment", options->provenance.comment, "Provenance: anything else");
  exporting->callback([&exitCode, options] { exitCode = exportPreset(*options); });

  CLI::App* const comparing =
      preset->add_subcommand("diff", "List the parameters that differ, as key: left -> right");
  comparing->add_option("left", options->left)->required();
  comparing->add_option("right", options->right)->required();
  comparing->add_flag("--json", options->json, "One JSON document on standard output");
  comparing->callback([&exitCode, options] { exitCode = diff(*options); });

  addFuzzy(*preset, exitCode);

  for (const auto& [name, what, text] :
       {std::tuple{"schema", "Print the JSON schema of preset files", &presetSchema},
        std::tuple{"reference", "Print the reference page of all parameters (Markdown)",
                   &parameterReference}}) {
    CLI::App* const page = preset->add_subcommand(name, what);
    page->add_option("-o,--output", options->output, "File to write instead of standard output");
    page->callback([&exitCode, options, text = text] { exitCode = writeOut(options->output, text()); });
  }
}

}  // namespace trimtab::cli
