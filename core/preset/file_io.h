#pragma once

#include <filesystem>
#include <string>

#include "trimtab/units/result.h"

namespace trimtab {

/// Every byte of a file of at most 16 MiB. Reads pipes too, folders not.
Result<std::string> readWhole(const std::filesystem::path& file);

}  // namespace trimtab
