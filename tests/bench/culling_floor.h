#pragma once

#include <memory>
#include <string>

#include "row.h"
#include "trimtab/terrain/database.h"

namespace trimtab::bench {

/// What no culling of whole tiles can beat: the frame that draws only the nodes with a pixel of the unculled
/// picture, which it is told, beside the view frustum's; at 2,000 ft, finest levels and 2 px.
void floorRows(Report& report, const std::string& terrain,
               const std::shared_ptr<const terrain::Database>& database);

}  // namespace trimtab::bench
