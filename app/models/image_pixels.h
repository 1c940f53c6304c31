#pragma once

#include <osg/Image>

#include <optional>

#include "trimtab/terrain/objects/source_model.h"

namespace trimtab::models {

/// Returns the pixels of an image as RGBA, at most 1,024 a side (larger ones are means of blocks); none for
/// an image without pixels and for a compressed one.
std::optional<terrain::SourceTexture> pixelsOf(const osg::Image& image);

}  // namespace trimtab::models
