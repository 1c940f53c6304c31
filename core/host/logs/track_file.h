#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "trimtab/units/result.h"

namespace trimtab {

/// Turns the track of a GPX or IGC file into a table of time, latitude, longitude and altitude. Returns
/// nothing for any other text. Points that lack one of them are passed over with a warning.
std::optional<Result<std::string>> tableOfTrack(std::string_view text, const std::string& where);

}  // namespace trimtab
