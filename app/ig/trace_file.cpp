#include "trace_file.h"

#include "trimtab/preset/file_io.h"

namespace trimtab::ig {
namespace {

std::filesystem::path partOf(std::filesystem::path file) {
  return file += ".part";
}

}  // namespace

Result<TraceFile> TraceFile::open(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    return Finding{Severity::error, file.string(), {}, "a file", "a folder"};
  Result<TraceWriter> writer = TraceWriter::open(partOf(file));
  if (!writer) return writer.findings();
  return TraceFile(file, std::move(writer).value());
}

void TraceFile::write(const std::vector<TraceRow>& rows) {
  for (const TraceRow& row : rows) writer_.write(row);
}

Result<Done> TraceFile::finish() {
  Result<Done> closed = writer_.close();
  if (!closed) return closed;
  return putInPlace(partOf(file_), file_);
}

}  // namespace trimtab::ig
