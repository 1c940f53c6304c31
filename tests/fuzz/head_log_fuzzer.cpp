#include <cmath>
#include <cstdlib>

#include "trimtab/host/head_log.h"

/// A head log or a sweep is read or refused with reasons; what is read has times that rise and angles that
/// are numbers.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const auto& log :
       {parseHeadLog(text, "fuzz"), parseHeadLog(text, "fuzz", BadRows::leave_out), parseSweep(text)}) {
    if (!log) {
      if (log.findings().empty()) std::abort();
      continue;
    }
    double last = -1;
    for (const HeadSample& s : log->samples) {
      if (!(s.timeS > last) || !std::isfinite(s.timeS) || !std::isfinite(s.headingDeg)) std::abort();
      if (!(std::abs(s.pitchDeg) <= 90) || !std::isfinite(s.rollDeg)) std::abort();
      last = s.timeS;
    }
    const Attitude head = headAt(*log, log->durationS() / 3);
    if (!std::isfinite(head.heading.value()) || !std::isfinite(head.pitch.value())) std::abort();
  }
  return 0;
}
