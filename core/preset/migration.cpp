#include "migration.h"

#include <algorithm>

#include "former_rules.h"
#include "trimtab/preset/json_text.h"
#include "trimtab/units/number.h"

namespace trimtab {

namespace {

void rename(RawParameter& parameter, std::string_view key, FindingList& notes) {
  notes.add({Severity::note, parameter.where, parameter.key, "the key " + std::string(key),
             "its former name, taken as that"});
  parameter.key = key;
}

/// Version 1 is the draft of the format: other names, and hysteresis in degrees of pitch, of which the
/// published line makes 1/60 of membership each. It was never released; its kept file keeps this path in use.
void fromVersion1(const TuningParameters&, std::vector<RawParameter>& parameters, FindingList& notes) {
  for (RawParameter& p : parameters) {
    if (p.key == "culling.method") {
      rename(p, "culling.case", notes);
    } else if (p.key == "lod.error_px") {
      rename(p, "lod.screen_space_error_px", notes);
    } else if (p.key == "fuzzy.hysteresis_deg") {
      rename(p, "fuzzy.hysteresis", notes);
      if (const auto degrees = readNumber(p.value)) p.value = numberText(*degrees / 60);
    }
  }
}

/// A value of a choice that no version reads any more, and what replaces it. Versions up to 3 wrote such
/// values, and a file may still have them: they are replaced whatever the file's version.
struct WithdrawnChoice {
  std::string_view key, value, replacement;
};
constexpr WithdrawnChoice kWithdrawnChoices[] = {{"culling.occlusion", "read_back", "depth_map"},
                                                 {"culling.occlusion", "cpu_map", "horizon"},
                                                 {"culling.occlusion", "horizon_and_map", "horizon"},
                                                 {"terrain.form", "levels", "tiles"}};

void replaceWithdrawn(std::vector<RawParameter>& parameters, FindingList& notes) {
  for (RawParameter& p : parameters)
    for (const WithdrawnChoice& choice : kWithdrawnChoices)
      if (p.key == choice.key && json::readString(p.value) == choice.value) {
        p.value = '"' + std::string(choice.replacement) + '"';
        notes.add({Severity::note, p.where, p.key, "a value of this version",
                   std::string(choice.value) + ", which was withdrawn; " + std::string(choice.replacement) +
                       " is used"});
      }
}

/// A key that was renamed while the version stayed: files of this version have either.
struct FormerKey {
  std::string_view former, now;
};
constexpr FormerKey kFormerKeys[] = {{"static_lod.terrain", "terrain.form"}};

void renameFormer(std::vector<RawParameter>& parameters, FindingList& notes) {
  for (RawParameter& p : parameters)
    for (const FormerKey& key : kFormerKeys)
      if (p.key == key.former) rename(p, key.now, notes);
}

/// A parameter that no version reads any more: it is dropped, and a note says so.
constexpr std::string_view kWithdrawnKeys[] = {"hold.exposure_ms"};

void dropWithdrawn(std::vector<RawParameter>& parameters, FindingList& notes) {
  std::erase_if(parameters, [&notes](const RawParameter& p) {
    if (std::find(std::begin(kWithdrawnKeys), std::end(kWithdrawnKeys), p.key) == std::end(kWithdrawnKeys))
      return false;
    notes.add({Severity::note, p.where, p.key, "a parameter of this version",
               p.value.substr(0, 60) + ", of a parameter that was withdrawn; it has no effect"});
    return true;
  });
}

/// Version 2 had keys for the four rules of a fixed rule base, which replaceFormerRules() reads.
void fromVersion2(const TuningParameters&, std::vector<RawParameter>&, FindingList&) {}

/// migrations[i] brings version i + 1 to version i + 2.
constexpr void (*kMigrations[])(const TuningParameters&, std::vector<RawParameter>&, FindingList&) = {
    fromVersion1, fromVersion2};
static_assert(std::size(kMigrations) == kPresetVersion - 1, "each older version needs its migration");

/// Says what an image generator did before a parameter existed, where the parameter's default does otherwise.
struct FormerBehaviour {
  std::string_view key, value;
};
constexpr FormerBehaviour kFormerBehaviours[] = {{"weather.precipitation_form", "effect"}};

}  // namespace

void keepFormerBehaviour(std::vector<RawParameter>& parameters, const std::string& where,
                         FindingList& notes) {
  for (const FormerBehaviour& former : kFormerBehaviours) {
    const auto has = [&](const RawParameter& p) { return p.key == former.key; };
    if (std::any_of(parameters.begin(), parameters.end(), has)) continue;
    parameters.push_back({std::string(former.key), '"' + std::string(former.value) + '"', where});
    notes.add({Severity::note, where, std::string(former.key), "every parameter in an export",
               "an export older than it; " + std::string(former.value) + " is used, as it was then"});
  }
}

void migrate(int fromVersion, const TuningParameters& base, std::vector<RawParameter>& parameters,
             FindingList& notes) {
  for (int version = fromVersion; version < kPresetVersion; ++version)
    kMigrations[version - 1](base, parameters, notes);
  renameFormer(parameters, notes);
  replaceWithdrawn(parameters, notes);
  dropWithdrawn(parameters, notes);
  replaceFormerRules(base, parameters, notes);
}

}  // namespace trimtab
