#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "run.h"

namespace trimtab::harness {

/// The folder of a run: its plan and what was measured so far, one file per sampled frame of a flight.
class Store {
 public:
  /// Makes the folder if it is missing. Fails if the folder holds another plan (saying what differs), or
  /// something else under a name that the run would write.
  static Result<Store> open(const std::filesystem::path& folder, const Plan& plan,
                            const std::string& machine);

  /// Returns all units of a flight with one frame each, or nothing if it is not measured completely.
  std::optional<std::vector<Unit>> frame(std::size_t flight, std::size_t row) const;
  std::filesystem::path fileOf(std::size_t flight, std::size_t row) const;
  Result<Done> writeFrame(std::size_t flight, std::size_t row, std::vector<Unit> units) const;
  /// Returns all units of a flight without frames, with what their skips saved.
  std::optional<std::vector<Unit>> skips(std::size_t flight) const;
  Result<Done> writeSkips(std::size_t flight, std::vector<Unit> units) const;
  /// Writes a file atomically. If that fails, the findings include those of `needs`.
  Result<Done> write(const std::string& name, const std::string& bytes) const;
  /// Adds to the findings of a failed write how much disk space it needed and how much is free.
  Findings needs(Findings findings, std::size_t bytes) const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  explicit Store(std::filesystem::path folder) : folder_(std::move(folder)) {}
  std::optional<std::vector<Unit>> read(const std::string& name) const;
  std::filesystem::path folder_;
};

}  // namespace trimtab::harness
