#pragma once

#include <cmath>
#include <cstdint>
#include <map>

#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/planted_defects.h"
#include "trimtab/scene/renderer.h"

namespace trimtab::test {

/// Which node owns a pixel, held against the picture itself.
class NodeOwners : public SceneTest {
 protected:
  /// What each node owns must be exactly where the picture changes once the node is left out.
  void compareWithLeavingOut(const FrameRequest& r, std::size_t most) {
    FrameResult result;
    picture(r, &result);
    const auto distances = renderer.readDistances();
    const auto nodes = renderer.readNodes();
    ASSERT_EQ(nodes.size(), distances.size());
    EXPECT_EQ(renderer.readDistances(), distances) << "the picture stays as it is";
    std::map<std::uint32_t, std::size_t> owned;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      EXPECT_EQ(nodes[i] == scene::Renderer::kNoNode, std::isinf(distances[i]));
      if (nodes[i] != scene::Renderer::kNoNode) ++owned[nodes[i]];
    }
    EXPECT_GT(owned.size(), 3u);
    std::size_t tried = 0;
    for (const TileDraw& tile : result.visible.tiles) {
      if (tried++ == most) break;
      plant(renderer, {.culledNode = tile.node});
      picture(r);
      const auto without = renderer.readDistances();
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < nodes.size(); ++i)
        wrong += (without[i] != distances[i]) != (nodes[i] == tile.node);
      EXPECT_EQ(wrong, 0u) << "node " << tile.node << " owns " << owned[tile.node];
    }
    plant(renderer, {});
  }
};

}  // namespace trimtab::test
