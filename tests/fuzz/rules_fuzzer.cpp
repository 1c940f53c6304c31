#include <cstdint>
#include <cstdlib>

#include "trimtab/fuzzy/rule_file.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/rules.h"

/// Whatever is accepted lies in the table's ranges and is written as text that means the same.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  for (const RuleFormat format : {RuleFormat::fuzzylite, RuleFormat::matlab}) {
    const auto read = readRuleFile({reinterpret_cast<const char*>(data), size}, "fuzz", format, {});
    if (!read) {
      if (read.findings().empty()) std::abort();
      continue;
    }
    for (const Finding& f : rangeFindings(*read))
      if (f.severity == Severity::error) std::abort();
    const auto text = ruleFileText(*read, "fuzz", format);
    if (!text) std::abort();
    const auto again = readRuleFile(*text, "fuzz", format, {});
    if (!again || !differences(*again, *read).empty()) std::abort();
  }
  return 0;
}
