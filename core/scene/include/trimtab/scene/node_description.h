#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/frame/terrain_index.h"
#include "trimtab/terrain/format/database.h"

/// Declares what a person wants to know about one node of the terrain, or one object on it, that they picked
/// in the image.
namespace trimtab::scene {

struct NodeDescription {
  std::string_view form;  ///< "tile", "patch", "tree node" or "object"
  std::string model{};    ///< of an object, as its source called it
  /// 0 is the finest tile, or the finest mesh of an object; for patches and tree nodes it is the depth.
  int level = 0;
  std::uint64_t triangles = 0;  ///< of its mesh: for a patch that is drawn, of the variant drawn
  /// The largest distance that the mesh states: vertically from the source posts, or of an object from its
  /// finest mesh.
  double errorM = 0;
  double distanceM = 0;              ///< from the eye to the nearest point of its bounding box
  double errorPx = 0;                ///< `errorM` seen at that distance, but not nearer than the near plane
  double widthPx = 0, heightPx = 0;  ///< of its bounding box in the image, cut off at the image's edges
  CullReason reason = CullReason::other_level;
  Box bounds{};  ///< metres, local frame of the terrain
};

/// Describes a node of the frame that `request` and `result` belong to. Returns nothing if the terrain has no
/// such node: `node` may be Renderer::kNoNode, and an old result may belong to another terrain.
/// Searches the frame's cut once, so it is meant for one picked node, not for all of them.
std::optional<NodeDescription> describeNode(std::uint32_t node, const terrain::Database& database,
                                            const FrameRequest& request, const FrameResult& result);

/// Describes an object that the frame drew, by its number in ObjectIndex::instances. Its bounds are those of
/// its sphere. Returns nothing if the terrain has no such object.
std::optional<NodeDescription> describeObject(std::uint32_t instance, const terrain::Database& database,
                                              const FrameRequest& request);

/// Says in words why a node is drawn or left out, for example "outside the frustum".
std::string_view inWords(CullReason reason);

}  // namespace trimtab::scene
