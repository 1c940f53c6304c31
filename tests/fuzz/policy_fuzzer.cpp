#include <cstdint>
#include <cstdlib>

#include "trimtab/policy/policy_file.h"
#include "trimtab/preset/policy_lines.h"

/// Whatever is accepted is written as text that means the same: as a file of either language, and as lines.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const RuleFormat format : {RuleFormat::fuzzylite, RuleFormat::matlab}) {
    const auto read = readPolicyFile(text, "fuzz", format);
    if (!read && read.findings().empty()) std::abort();
    if (!read) continue;
    const auto written = policyFileText(*read, "fuzz", format);
    const auto again = written ? readPolicyFile(*written, "fuzz", format) : written.findings();
    if (!again || *policyFileText(*again, "fuzz", format) != *written) std::abort();
  }
  PolicyParameters lines;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at), at += at != text.npos)
    (text[at] == 'i' || text[at] == 'o' ? lines.rules : lines.terms)
        .line.push_back(text.substr(at, text.find('\n', at) - at));
  const auto policy = policyOf(lines);
  if (!policy) return 0;
  lines = policyLines(*policy);
  const auto again = policyOf(lines);
  if (!again || policyLines(*again) != lines) std::abort();
  return 0;
}
