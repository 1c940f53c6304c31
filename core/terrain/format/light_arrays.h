#pragma once

#include <string>

#include "array_file.h"
#include "trimtab/frame/light_index.h"

/// The lights of objects.bin, from its version 2 on.
namespace trimtab::terrain {

void addLights(const LightIndex& lights, ArrayWriter& out);
void readLights(ArrayReader& in, LightIndex& lights);
/// Returns the first thing that keeps a reader from relying on the arrays, or nothing.
std::string faultOfLights(const LightIndex& lights);

}  // namespace trimtab::terrain
