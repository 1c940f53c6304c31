#pragma once

#include <string>
#include <string_view>

#include "trimtab/units/result.h"

/// An export's checksum: "sha256:" and 64 digits, over every byte of the file but those digits. It is the
/// last of that form in the file, whatever the format.
namespace trimtab {

/// What stands in for the digits until seal() is called.
std::string checksumBlank();
/// The text with its last checksumBlank() (or checksum) made true.
std::string sealed(std::string text);
/// The checksum that a text carries, "sha256:...", and whether it is true; findings say what was expected and
/// found.
Result<std::string> checkSeal(std::string_view text, const std::string& where);

}  // namespace trimtab
