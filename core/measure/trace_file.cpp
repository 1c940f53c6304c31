#include "trimtab/measure/trace_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <fstream>
#include <system_error>

#include "trimtab/preset/file_io.h"

namespace trimtab {
namespace {

namespace fs = std::filesystem;

fs::path partOf(fs::path file) {
  return file += ".part";
}

/// Whether there is a line behind the header, be it whole or not.
bool hasRows(const fs::path& part) {
  std::ifstream in(part, std::ios::binary);
  std::string header;
  return std::getline(in, header) && in.peek() != std::ifstream::traits_type::eof();
}

/// A row that a full disk cut off is no row.
void cutToWholeRows(const fs::path& part) {
  std::error_code error;
  std::ifstream in(part, std::ios::binary);
  const std::uintmax_t size = fs::file_size(part, error);
  std::uintmax_t end = error ? 0 : size;
  while (end > 0 && in.seekg(static_cast<std::streamoff>(end - 1)) && in.peek() != '\n') --end;
  if (in && end > 0 && end < size) fs::resize_file(part, end, error);
}

Finding unusable(const fs::path& where, std::string expected, std::string found) {
  return {Severity::error, where.string(), "", std::move(expected), std::move(found)};
}

}  // namespace

Result<TraceFile> TraceFile::open(const fs::path& file) {
  std::error_code error;
  const fs::file_status there = fs::status(file, error);
  if (fs::is_directory(there)) return unusable(file, "a file", "a folder");
  if (fs::exists(there) && !fs::is_regular_file(there)) return unusable(file, "a file", "a pipe or a device");
  if (fs::exists(there) && ::access(file.c_str(), W_OK) != 0)
    return unusable(file, "room and permission to write it", std::generic_category().message(errno));
  const fs::path part = partOf(file);
  if (fs::is_regular_file(part, error) && hasRows(part))
    return unusable(part, "no trace that was cut off",
                    "one that can be read as it is: give it another name, or remove it");
  Result<TraceWriter> writer = TraceWriter::open(part);
  if (!writer) return writer.findings();
  return TraceFile(file, std::move(writer).value());
}

Result<Done> TraceFile::write(std::span<const TraceRow> rows) {
  if (failed_) return Done{};
  for (const TraceRow& row : rows) writer_.write(row);
  failed_ = !writer_.good();
  if (!failed_) return Done{};
  return unusable(partOf(file_), "room for more rows", "that writing failed: no further row is recorded");
}

Result<Done> TraceFile::finish() {
  Result<Done> done = writer_.close();
  if (done) done = putInPlace(partOf(file_), file_);
  if (done) return done;
  cutToWholeRows(partOf(file_));
  Findings why = done.findings();
  why.push_back({Severity::note, partOf(file_).string(), "", "", "the rows so far are kept there"});
  return why;
}

}  // namespace trimtab
