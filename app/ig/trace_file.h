#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "trimtab/measure/trace.h"

namespace trimtab::ig {

/// Writes a trace that appears under its name once it is complete. Until then, and after a crash, its rows
/// are in `FILE.part`.
class TraceFile {
 public:
  static Result<TraceFile> open(const std::filesystem::path& file);
  void write(const std::vector<TraceRow>& rows);
  Result<Done> finish();

 private:
  TraceFile(std::filesystem::path file, TraceWriter writer)
      : file_(std::move(file)), writer_(std::move(writer)) {}
  std::filesystem::path file_;
  TraceWriter writer_;
};

}  // namespace trimtab::ig
