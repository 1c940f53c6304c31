#pragma once

#include <filesystem>
#include <span>

#include "trimtab/measure/trace.h"

namespace trimtab {

/// Writes a trace that appears under its name once it is complete; until then a file of that name stays as it
/// is. The rows so far are in `FILE.part`, which readTrace() reads, also after a crash.
class TraceFile {
 public:
  /// Refuses what finish() could not replace, and a `FILE.part` with rows: it may be all that is left of a
  /// flight.
  static Result<TraceFile> open(const std::filesystem::path& file);
  /// Fails once, as soon as rows no longer reach the file; from then on rows are dropped, and finish() fails.
  Result<Done> write(std::span<const TraceRow> rows);
  /// Gives the trace its name. If it fails, the findings say where the rows are.
  Result<Done> finish();

 private:
  TraceFile(std::filesystem::path file, TraceWriter writer)
      : file_(std::move(file)), writer_(std::move(writer)) {}
  std::filesystem::path file_;
  TraceWriter writer_;
  bool failed_ = false;
};

}  // namespace trimtab
