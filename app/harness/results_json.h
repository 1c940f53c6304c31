#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "results.h"

namespace trimtab::harness {

using Json = nlohmann::ordered_json;

/// Returns what results.json says; a page adds to it.
Json documentOf(const Results& results);
/// Returns the number, or a string for NaN and infinity, which JSON does not have. That keeps them apart from
/// what is absent.
Json numberJson(double value);
/// Returns the document as one line. Bytes that are not UTF-8 become U+FFFD.
std::string textOf(const Json& json);

}  // namespace trimtab::harness
