#pragma once

#include <memory>
#include <string>

#include "tests/bench/row.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::bench {

/// What no culling can beat: the frame of nothing but the triangles that own a pixel, which an oracle tells,
/// beside the view frustum's; also of whole meshes and of squares of them that have such a triangle. At
/// 2,000 ft, as tiles and as patches, at 2 px and at the finest levels.
void floorRows(Report& report, const std::string& terrain,
               const std::shared_ptr<const terrain::Database>& database);

}  // namespace trimtab::bench
