#pragma once

#include <memory>
#include <string>

#include "tests/bench/row.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::bench {

/// Choosing levels and tiles in view, and how many triangles that leaves, beside a quadtree of osg::LOD.
void lodRows(Report& report, const std::string& name,
             const std::shared_ptr<const terrain::Database>& database);

}  // namespace trimtab::bench
