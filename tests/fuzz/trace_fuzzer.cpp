#include <cstdlib>

#include "trimtab/measure/trace.h"

/// A trace is read or refused with reasons; one that is read is written to a text that is read and written
/// the same.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  const auto rows = parseTrace({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!rows) {
    if (rows.findings().empty()) std::abort();
    return 0;
  }
  const auto written = [](const std::vector<TraceRow>& all) {
    std::string text = traceHeader() + '\n';
    for (const TraceRow& row : all) appendTraceRow(text, row);
    return text;
  };
  const std::string text = written(*rows);
  const auto again = parseTrace(text, "again");
  if (!again || written(*again) != text) std::abort();
  return 0;
}
