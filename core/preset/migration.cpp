#include "trimtab/preset/migration.h"

#include "trimtab/preset/number.h"

namespace trimtab {

namespace {

void rename(RawParameter& parameter, std::string_view key, Findings& notes) {
  notes.push_back({Severity::note, parameter.where, parameter.key, "the key " + std::string(key),
                   "its former name, taken as that"});
  parameter.key = key;
}

/// Version 1 is the draft of the format: other names, and hysteresis in degrees of pitch, of which the
/// published line makes 1/60 of membership each. It was never released; its kept file keeps this path in use.
void fromVersion1(std::vector<RawParameter>& parameters, Findings& notes) {
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

/// migrations[i] brings version i + 1 to version i + 2.
constexpr void (*kMigrations[])(std::vector<RawParameter>&, Findings&) = {fromVersion1};
static_assert(std::size(kMigrations) == kPresetVersion - 1, "each older version needs its migration");

}  // namespace

void migrate(int fromVersion, std::vector<RawParameter>& parameters, Findings& notes) {
  for (int version = fromVersion; version < kPresetVersion; ++version)
    kMigrations[version - 1](parameters, notes);
}

}  // namespace trimtab
