#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "results.h"
#include "trimtab/scene/error_meter.h"

namespace trimtab::harness {

/// A unit's worst frames, without pictures: largest FLIP, largest geometric error, longest frame; one that is
/// the worst in several ways is there once. What no frame has an error of is left out.
std::vector<WorstFrame> worstFrames(const Unit& unit, std::size_t number, std::size_t most);

/// The names of a worst frame's pictures: the unit's number, and letters, digits, '-' and '_' of its name.
void namePictures(WorstFrame& worst, const Unit& unit, std::size_t number);
/// Reference, ours and FLIP's map as PNG into `folder`.
Result<Done> writePictures(const WorstFrame& worst, const scene::ErrorPictures& pictures,
                           const std::filesystem::path& folder);

}  // namespace trimtab::harness
