#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drawn_samples.h"
#include "search.h"
#include "tune.h"

namespace trimtab::tune {

/// The folder of a run: its plan, the samples of each flight, and the front of each search.
class RunFolder {
 public:
  /// Makes the folder if it is missing. Fails if the folder holds another plan, saying what differs, or
  /// something else.
  static Result<RunFolder> open(const std::filesystem::path& folder, const Plan& plan,
                                const std::string& machine);

  std::filesystem::path samplesFile(std::size_t flight) const;
  std::filesystem::path searchFile(std::size_t search) const;
  /// Returns nothing if the file is not there or cannot be read; it is then made again.
  std::optional<DrawnSamples> samples(std::size_t flight) const;
  Result<Done> write(std::size_t flight, const DrawnSamples& samples) const;
  std::optional<std::vector<Candidate>> search(std::size_t search) const;
  Result<Done> write(std::size_t search, const std::vector<Candidate>& front) const;
  const std::filesystem::path& path() const { return folder_; }

 private:
  explicit RunFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}
  std::filesystem::path folder_;
};

}  // namespace trimtab::tune
