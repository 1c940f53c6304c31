#include "preset_watch.h"

#include <algorithm>

namespace trimtab::ig {

Result<ActivePreset> loadActivePreset(const std::string& nameOrFile) {
  Result<Preset> preset = loadPreset(nameOrFile);
  if (!preset) return preset.findings();
  Findings findings = preset.findings();
  const Result<ValidatedParameters> valid = validate(preset->parameters);
  for (Finding finding : valid.findings()) {
    if (finding.where.empty()) finding.where = nameOrFile;
    // A broken rule is reported by the loader already.
    if (std::find(findings.begin(), findings.end(), finding) == findings.end())
      findings.push_back(std::move(finding));
  }
  if (!valid) return findings;
  return {ActivePreset{preset->name, *valid}, std::move(findings)};
}

}  // namespace trimtab::ig
