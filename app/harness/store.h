#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "run.h"

namespace trimtab::harness {

/// A run's folder: the plan it belongs to and what was measured so far, a file a sampled frame of a flight.
class Store {
 public:
  /// Makes the folder where there is none. Refused where it holds another plan (with what differs) or
  /// something else by a name that the run would write.
  static Result<Store> open(const std::filesystem::path& folder, const Plan& plan,
                            const std::string& machine);

  /// All units of a flight with one frame each; none where it was not measured yet, or is not whole.
  std::optional<std::vector<Unit>> frame(std::size_t flight, std::size_t row) const;
  Result<Done> writeFrame(std::size_t flight, std::size_t row, std::vector<Unit> units) const;
  /// All units of a flight without frames, with what their skips saved.
  std::optional<std::vector<Unit>> skips(std::size_t flight) const;
  Result<Done> writeSkips(std::size_t flight, std::vector<Unit> units) const;
  /// Atomically; where it fails `needs` tells the room.
  Result<Done> write(const std::string& name, const std::string& bytes) const;
  /// The findings of a write into the folder that failed, and how much room it needed and there is.
  Findings needs(Findings findings, std::size_t bytes) const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  explicit Store(std::filesystem::path folder) : folder_(std::move(folder)) {}
  std::optional<std::vector<Unit>> read(const std::string& name) const;
  std::filesystem::path folder_;
};

}  // namespace trimtab::harness
