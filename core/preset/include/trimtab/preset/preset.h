#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/preset/table.h"

/// Preset files: what an engineer edits (differences from a base), and exports (complete, with provenance and
/// checksum).
namespace trimtab {

/// A preset being edited. Keys this version does not know are kept as JSON text and written back.
struct Preset {
  std::string name;
  std::string base;  ///< a shipped preset's name or a file beside this one; empty: the defaults
  std::string description;
  TuningParameters parameters;
  std::map<std::string, std::string> unknown;         ///< parameter key -> its JSON text
  std::map<std::string, std::string> unknownMembers;  ///< the same for members beside "parameters"
  std::filesystem::path folder;  ///< where a base that is a file is looked up; empty: the working folder
};

/// Who made an export, when, with what.
struct Provenance {
  std::string author, created, program, terrain, comment;  ///< created: ISO 8601 UTC
};

enum class ExportFormat { json, xml, ini };

/// Names of the presets that ship: "default", "as-published", "as-printed". They are compiled in.
std::vector<std::string_view> shippedPresets();

/// Reads an edited preset (JSON) or an export (JSON, PropertyList XML or INI), told apart by content, or a
/// shipped preset by its name. Findings name file, line, key, expected and found. An export whose checksum
/// does not hold is refused, as is one with a document type, deep nesting or an encoding other than UTF-8.
Result<Preset> loadPreset(const std::string& nameOrFile);
Result<Preset> parsePreset(std::string_view text, const std::string& where);

/// What the preset starts from: its base's parameters, or the defaults.
Result<TuningParameters> baseParameters(const Preset& preset);
/// JSON with only the differences from the base, in the table's order.
Result<std::string> presetText(const Preset& preset);
/// Every parameter resolved, provenance and checksum over every byte but its own value.
std::string exportText(const ValidatedParameters& parameters, const std::string& name,
                       const Provenance& provenance, ExportFormat format);
/// Where differences lie, key by key, as text in the table's order.
struct Difference {
  std::string key, left, right;
};
std::vector<Difference> differences(const TuningParameters& left, const TuningParameters& right);

/// The published JSON schema of preset files, and the reference page (Markdown), from the table.
std::string presetSchema();
std::string parameterReference();

/// Writes beside the target and renames: the old file or the new one, never half of either.
Result<Done> writeAtomically(const std::filesystem::path& file, std::string_view bytes);

}  // namespace trimtab
