#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "trimtab/measure/trace.h"
#include "trimtab/preset/part_file.h"

namespace trimtab {

/// Writes a trace that appears under its name once it is complete; until then a file of that name stays as it
/// is. The rows so far are in `FILE.part`, which readTrace() reads, also after a crash.
class TraceFile {
 public:
  /// Refuses what finish() could not replace, and a `FILE.part` that holds rows or something else.
  static Result<TraceFile> open(const std::filesystem::path& file);
  /// Fails once, as soon as rows no longer reach the file; from then on rows are dropped, and finish() fails.
  Result<Done> write(std::span<const TraceRow> rows);
  /// Gives the trace its name. If it fails, the findings say where the rows are.
  Result<Done> finish();

 private:
  explicit TraceFile(PartFile part) : part_(std::move(part)) {}
  PartFile part_;
  std::string line_;
  bool failed_ = false;
};

}  // namespace trimtab
