#pragma once

#include <memory>

#include "trimtab/hold/load_counter.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::scene {

/// Returns the indices of a terrain's forms, in which a session counts the triangles of coming views. They
/// keep the database open. It is null without one.
std::shared_ptr<const LoadIndex> loadIndexOf(const std::shared_ptr<const terrain::Database>& database);

}  // namespace trimtab::scene
