#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::test {

/// How many views are of which kind; most are of several.
class CullingKinds {
 public:
  void add(const FrameRequest& request, const terrain::Database& database);
  void add(const CullingKinds& other);
  /// "412 low, 118 high, …".
  std::string text() const;

 private:
  enum Kind {
    low,         ///< less than 300 m above the ground
    high,        ///< more than 3 km above it
    inValley,    ///< over ground that is lower than three quarters of what is around, in relief
    atCoast,     ///< sea and land within 3 km
    steep,       ///< pitch of more than 45 degrees
    rolled,      ///< by more than 15 degrees
    dateLine,    ///< within a degree
    pole,        ///< within a degree
    below,       ///< under the ground
    beyondEdge,  ///< of the data
    inFog,
    kinds
  };
  std::array<std::size_t, kinds> counts_{};
};

}  // namespace trimtab::test
