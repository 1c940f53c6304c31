#include "trimtab/preset/preset.h"

#include "core/interface/handles.h"

namespace trimtab::c {
namespace {

trimtab_status keep(Result<Preset> loaded, trimtab_preset** preset, trimtab_findings** findings) {
  Findings all = loaded.findings();
  Result<ValidatedParameters> parameters = Findings{};
  if (loaded) {
    parameters = validate(loaded->parameters);
    // What validate() refuses, loading has already found; what only it says is added.
    for (const Finding& finding : parameters.findings())
      if (std::find(all.begin(), all.end(), finding) == all.end()) all.push_back(finding);
  }
  give(findings, std::move(all));
  if (!parameters) return TRIMTAB_REFUSED;
  *preset = new trimtab_preset{*parameters};
  return TRIMTAB_OK;
}

}  // namespace

void give(trimtab_findings** to, Findings findings) {
  if (to != nullptr) *to = new trimtab_findings{std::move(findings)};
}

std::size_t give(char* text, std::size_t capacity, std::string_view line) {
  if (text != nullptr && capacity > 0) {
    const std::size_t length = std::min(line.size(), capacity - 1);
    std::memcpy(text, line.data(), length);
    text[length] = 0;
  }
  return line.size();
}

}  // namespace trimtab::c

using namespace trimtab;

const char* trimtab_version() {
  return TRIMTAB_LIBRARY_VERSION;
}

std::size_t trimtab_findings_count(const trimtab_findings* findings) {
  return findings == nullptr ? 0 : findings->all.size();
}

trimtab_status trimtab_findings_get(const trimtab_findings* findings, std::size_t i, trimtab_finding* out) {
  if (findings == nullptr || i >= findings->all.size()) return TRIMTAB_MISUSE;
  const Finding& f = findings->all[i];
  const trimtab_finding finding{0,
                                static_cast<std::int32_t>(f.severity),
                                0,
                                f.where.c_str(),
                                f.key.c_str(),
                                f.expected.c_str(),
                                f.found.c_str()};
  return c::copyOut(out, finding, c::kFindingSize) ? TRIMTAB_OK : TRIMTAB_MISUSE;
}

void trimtab_findings_free(trimtab_findings* findings) {
  delete findings;
}

trimtab_status trimtab_preset_load(const char* nameOrFile, trimtab_preset** preset,
                                   trimtab_findings** findings) {
  if (nameOrFile == nullptr || preset == nullptr) return TRIMTAB_MISUSE;
  return c::guarded([&] { return c::keep(loadPreset(nameOrFile), preset, findings); });
}

trimtab_status trimtab_preset_parse(const char* text, std::size_t length, const char* where,
                                    trimtab_preset** preset, trimtab_findings** findings) {
  if (text == nullptr || where == nullptr || preset == nullptr) return TRIMTAB_MISUSE;
  return c::guarded([&] { return c::keep(parsePreset({text, length}, where), preset, findings); });
}

void trimtab_preset_free(trimtab_preset* preset) {
  delete preset;
}
