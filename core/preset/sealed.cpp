#include "trimtab/preset/sealed.h"

#include <algorithm>
#include <optional>

#include "trimtab/preset/sha256.h"
#include "trimtab/units/text.h"

namespace trimtab {

namespace {

constexpr std::string_view kPrefix = "sha256:";
constexpr std::size_t kDigits = 64;

/// Offset of the last checksum's digits.
std::optional<std::size_t> digitsAt(std::string_view text) {
  const std::size_t at = text.rfind(kPrefix);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view digits = text.substr(at + kPrefix.size(), kDigits);
  const bool hex = std::all_of(digits.begin(), digits.end(),
                               [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
  if (digits.size() != kDigits || !hex) return std::nullopt;
  return at + kPrefix.size();
}

std::string sumWithout(std::string_view text, std::size_t digits) {
  Sha256 sum;
  sum.add(text.substr(0, digits));
  sum.add(text.substr(digits + kDigits));
  return sum.hex();
}

/// A text without what editors add when they only save it: no export has either.
struct Restored {
  std::string text, undone;
};

Restored withoutEditorsBytes(std::string_view text) {
  Restored restored;
  const std::string_view marked = text;
  text = withoutByteOrderMark(text);
  if (text.size() < marked.size()) restored.undone = "a byte order mark";
  if (text.find("\r\n") != std::string_view::npos)
    restored.undone += std::string(restored.undone.empty() ? "" : " and ") + "Windows line ends (CR LF)";
  for (std::size_t at = 0; at < text.size(); ++at)
    if (text.substr(at, 2) != "\r\n") restored.text += text[at];
  return restored;
}

}  // namespace

std::string checksumBlank() {
  return std::string(kPrefix) + std::string(kDigits, '0');
}

std::string sealed(std::string text) {
  if (const auto at = digitsAt(text)) text.replace(*at, kDigits, sumWithout(text, *at));
  return text;
}

Result<std::string> checkSeal(std::string_view text, const std::string& where) {
  const auto at = digitsAt(text);
  if (!at)
    return Finding{Severity::error, where, "checksum", "sha256: and 64 digits", "none: the file is damaged"};
  const std::string_view carried = text.substr(*at, kDigits);
  const std::string sum = sumWithout(text, *at);
  if (sum == carried) return std::string(kPrefix) + sum;
  const Restored restored = withoutEditorsBytes(text);
  if (!restored.undone.empty())
    if (const auto held = checkSeal(restored.text, where))
      return {*held,
              {{Severity::warning, where, "checksum", "the bytes of the export",
                restored.undone + ", which an editor added; without that the checksum holds"}}};
  return Finding{Severity::error, where, "checksum", std::string(kPrefix) + sum,
                 std::string(kPrefix) + std::string(carried) + ": the file was changed after its export" +
                     (restored.undone.empty() ? "" : ", and not only by " + restored.undone)};
}

}  // namespace trimtab
