#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "trimtab/host/placement_list.h"
#include "trimtab/terrain/cdb/catalogue.h"

namespace trimtab::terrain {

/// Where point features stand, and what they are drawn by.
struct CdbFeatures : PlacedModels {
  std::size_t specific = 0;                         ///< features of one place (100) that are placed
  std::size_t typical = 0;                          ///< features of many places (101) that are placed
  std::size_t replaced = 0;                         ///< rows of coarser tables whose place has a finer one
  std::size_t lights = 0;                           ///< airport and other lights, which are not drawn
  std::map<std::string, std::size_t> withoutModel;  ///< features by the model that there is none of
};

/// Reads the point features of a CDB (100 and 101): instances with the attributes of their classes. Of tables
/// at one place the finest that has a row counts. AO1 is the heading. A feature stands on the ground, higher
/// by its point's height, or at that height if AHGT is true. SCALX, SCALY and SCALZ make it larger; if they
/// differ, its model is stretched. RTAI, which says what to leave out first, is not used: what an instance is
/// worth is measured in flight.
///
/// A row that cannot be used, an archive and a table that cannot be read are left out with a warning;
/// features whose model is not there are counted by its name. None of them is an error.
CdbFeatures readCdbFeatures(const CdbCatalogue& cdb, Findings& findings);

/// Returns notes of what a CDB holds: levels, tiles, gaps, features, models and what is not drawn.
Findings aboutCdb(const CdbCatalogue& cdb, const CdbFeatures& features);

}  // namespace trimtab::terrain
