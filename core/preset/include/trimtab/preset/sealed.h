#pragma once

#include <string>
#include <string_view>

#include "trimtab/units/result.h"

/// Makes and checks an export's checksum: "sha256:" and 64 digits, over every byte of the file but those
/// digits. It is the last text of that form in the file, whatever the format.
namespace trimtab {

/// Returns the checksum with zeros, for a text that sealed() completes.
std::string checksumBlank();
/// Returns the text with its last checksum replaced by the right one.
std::string sealed(std::string text);
/// Returns the checksum that a text carries, "sha256:...", if it is right; otherwise findings with the
/// expected and the found one. If it is right but for a byte order mark or Windows line ends, as editors add
/// them, it is returned with a warning that names them.
Result<std::string> checkSeal(std::string_view text, const std::string& where);

}  // namespace trimtab
