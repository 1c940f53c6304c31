#include <cstdint>
#include <cstdlib>

#include "trimtab/preset/preset.h"

/// Whatever is accepted is saved to a text that is accepted too and saved to itself.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  const auto preset = parsePreset({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!preset) {
    if (preset.findings().empty()) std::abort();
    return 0;
  }
  const auto text = presetText(*preset);
  if (!text) std::abort();
  const auto again = parsePreset(*text, "fuzz");
  if (!again || *presetText(*again) != *text) std::abort();
  return 0;
}
