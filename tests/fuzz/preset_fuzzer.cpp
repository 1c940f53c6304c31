#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>

#include "trimtab/preset/preset.h"
#include "trimtab/preset/sealed.h"

/// Whatever is accepted is saved to a text that is accepted too and saved to itself. The checksum of every
/// other text is made right, so that its lies are believed.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  std::string input(reinterpret_cast<const char*>(data), size);
  if (size % 2 == 0) input = sealed(std::move(input));
  const auto preset = parsePreset(input, "fuzz");
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
