#pragma once

#include <cstdint>
#include <optional>

#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::scene {

/// What an engineer asks about one node of a frame.
struct NodeDescription {
  TerrainForm form = TerrainForm::levels;
  int level = 0;  ///< of tiles 0 is the finest; of patches and static trees the depth, 0 at the root
  std::uint32_t triangles = 0;
  double errorM = 0;     ///< geometric error of what is drawn of it
  double errorPx = 0;    ///< the same at `distanceM`, at the centre of the image
  double distanceM = 0;  ///< from the eye to the nearest place of `bounds`
  Box bounds;            ///< in the terrain's frame
  CullReason reason = CullReason::other_level;
};

/// Describes a node by its number in the form that `drawn` was drawn in, for example one that
/// Renderer::readNodes returned. Returns nothing if that form has no such node. Its cost grows with the size
/// of the cut.
std::optional<NodeDescription> describeNode(const terrain::Database& database, const FrameRequest& request,
                                            const FrameResult& drawn, std::uint32_t node);

}  // namespace trimtab::scene
