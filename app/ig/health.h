#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "trimtab/preset/unfinished.h"
#include "trimtab/session/session.h"
#include "trimtab/units/result.h"

namespace trimtab::ig {

/// Writes every ten seconds what the program holds and how late its images are, one CSV row each, so that a
/// long flight shows what grows: memory in kB, open handles, threads, the objects of the GL context, and
/// percentiles of the latency from the kernel's time stamp of a packet to the image that shows it, in
/// milliseconds over the newest 4,096 images. The file takes the place of an older one with its first row;
/// from then on rows are there as soon as they are made.
class Health {
 public:
  static constexpr double kPeriodS = 10;

  /// Refuses a file that could not be made or replaced.
  static Result<Health> open(const std::filesystem::path& file);
  /// Returns the seconds until the next row is due.
  double dueIn(double now) const { return next_ - now; }
  /// Writes a row if one is due. Call it with the GL context current.
  void look(double now, std::uint64_t images, std::uint64_t terrains, const Session& session);
  /// Fails if any row could not be written.
  Result<Done> finish();

 private:
  explicit Health(std::filesystem::path file) : path_(std::move(file)) {}
  void write(const std::string& row);

  std::filesystem::path path_;
  std::optional<Unfinished> file_;  ///< from the first row on
  Findings findings_;
  double start_ = 0, next_ = 0;
};

}  // namespace trimtab::ig
