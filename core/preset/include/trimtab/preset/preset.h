#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/preset/table.h"

/// Reads and writes preset files: presets that an engineer edits (differences from a base), and exports
/// (complete, with provenance and checksum).
namespace trimtab {

/// A preset that is edited. Keys that this version does not know are kept as JSON text and written back.
struct Preset {
  std::string name;
  std::string base;  ///< a shipped preset's name or a file beside this one; if empty, the defaults
  std::string description;
  TuningParameters parameters;
  std::map<std::string, std::string> unknown;         ///< parameter key -> its JSON text
  std::map<std::string, std::string> unknownMembers;  ///< the same for members beside "parameters"
  std::filesystem::path folder;  ///< where the file of a base is looked up; if empty, the working folder
};

/// Says who made an export, when and with what.
struct Provenance {
  std::string author, created, program, terrain, comment;  ///< created: ISO 8601 UTC
};

enum class ExportFormat { json, xml, ini };

/// Returns what an export should report of parameters whose effect depends on the machine, as one sentence;
/// empty if there is nothing. `culling.occlusion` = auto is one: each machine measures whether the horizon is
/// worth its cost.
std::string machineNote(const TuningParameters& parameters);

/// Returns the names of the presets that ship, which are compiled in: "default", "as-published",
/// "as-printed" and those with a policy.
std::vector<std::string_view> shippedPresets();

/// Reads a preset (JSON) or an export (JSON, PropertyList XML or INI), told apart by content, or a shipped
/// preset by its name. Findings name file, line, key, expected and found; of each severity there are the
/// first ones and the number of the others. An export whose checksum does not hold is refused (checkSeal()
/// says what editors may add), as is one with a document type, deep nesting or an encoding other than UTF-8.
/// A broken rule between parameters is an error among the findings, but the preset is returned, so that it
/// can be edited: validate() is what decides whether it runs.
Result<Preset> loadPreset(const std::string& nameOrFile);
Result<Preset> parsePreset(std::string_view text, const std::string& where);

/// Returns the parameters that a preset starts from: those of its base, or the defaults.
Result<TuningParameters> baseParameters(const Preset& preset);
/// Returns the preset as JSON with only the differences from its base, in the table's order.
Result<std::string> presetText(const Preset& preset);
/// Returns an export: every parameter, the provenance, and a checksum over every byte but its own value.
std::string exportText(const ValidatedParameters& parameters, const std::string& name,
                       const Provenance& provenance, ExportFormat format);
/// One parameter that differs, with both values as text.
struct Difference {
  std::string key, left, right;
};
std::vector<Difference> differences(const TuningParameters& left, const TuningParameters& right);

/// Return the JSON schema of preset files and the reference page (Markdown), made from the table.
std::string presetSchema();
std::string parameterReference();
/// Returns authors and title of a document, `A` to `E`, which sources of parameters cite; empty for another
/// letter.
std::string_view documentOf(char letter);

/// Writes a file: there is the old one or the new one, never half of either. Refuses a pipe that nobody
/// reads. The findings of success name what others left there under the name of an unfinished file.
Result<Done> writeAtomically(const std::filesystem::path& file, std::string_view bytes);

}  // namespace trimtab
