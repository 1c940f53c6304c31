#include "trimtab/measure/trace_file.h"

namespace trimtab {

Result<TraceFile> TraceFile::open(const std::filesystem::path& file) {
  Result<PartFile> part = PartFile::open(file, traceHeader() + '\n');
  if (!part) return part.findings();
  return TraceFile(std::move(part).value());
}

Result<Done> TraceFile::write(std::span<const TraceRow> rows) {
  if (failed_) return Done{};
  for (const TraceRow& row : rows) {
    line_.clear();
    appendTraceRow(line_, row);
    const Result<Done> written = part_.append(line_);
    if (written) continue;
    failed_ = true;
    return Finding{Severity::error, part_.path().string(), "", "room for more rows",
                   written.findings().front().found + ": no further row is recorded"};
  }
  return Done{};
}

Result<Done> TraceFile::finish() {
  Findings why;
  if (failed_)
    why.push_back(
        {Severity::error, part_.path().string(), "", "room for the whole trace", "rows are missing"});
  else if (const Result<Done> done = part_.putInPlace(); done)
    return done;
  else
    why = done.findings();
  why.push_back({Severity::note, part_.path().string(), "", "", "the rows so far are kept there"});
  return why;
}

}  // namespace trimtab
