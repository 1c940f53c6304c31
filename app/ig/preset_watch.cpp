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
    // A broken rule is told by the loader already.
    if (std::find(findings.begin(), findings.end(), finding) == findings.end())
      findings.push_back(std::move(finding));
  }
  if (!valid) return findings;
  return {ActivePreset{preset->name, *valid}, std::move(findings)};
}

PresetWatch::PresetWatch(std::string file) : file_(std::move(file)), seen_(stampOf(file_)) {}

std::optional<PresetWatch::Stamp> PresetWatch::stampOf(const std::string& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return std::nullopt;
  return Stamp{status.st_ino, status.st_size, status.st_mtim};
}

std::optional<Result<ActivePreset>> PresetWatch::poll() {
  const std::optional<Stamp> stamp = stampOf(file_);
  if (!stamp) return std::nullopt;
  if (seen_ && stamp->inode == seen_->inode && stamp->size == seen_->size &&
      stamp->time.tv_sec == seen_->time.tv_sec && stamp->time.tv_nsec == seen_->time.tv_nsec)
    return std::nullopt;
  seen_ = stamp;
  return loadActivePreset(file_);
}

}  // namespace trimtab::ig
