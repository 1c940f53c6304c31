#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "results.h"
#include "trimtab/scene/error_meter.h"

namespace trimtab::harness {

/// Returns at most `most` worst frames of a unit, without images: largest FLIP, largest geometric error,
/// longest frame. A frame that is worst in several ways appears once; an error that no frame has is skipped.
std::vector<WorstFrame> worstFrames(const Unit& unit, std::size_t number, std::size_t most);

/// Names the image files of a worst frame after the unit's number and the letters, digits, '-' and '_' of
/// its name.
void namePictures(WorstFrame& worst, const Unit& unit, std::size_t number);
/// Reports whether the folder has the image files of a worst frame.
bool havePictures(const WorstFrame& worst, const std::filesystem::path& folder);
/// Writes the reference, our image and the FLIP map as PNG files into `folder`.
Result<Done> writePictures(const WorstFrame& worst, const scene::ErrorPictures& pictures,
                           const std::filesystem::path& folder);

}  // namespace trimtab::harness
