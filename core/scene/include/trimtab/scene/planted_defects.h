#pragma once

#include <cstdint>
#include <optional>

namespace trimtab::scene {

/// Mistakes made on purpose, so that a measurement can be seen to find them.
struct Defects {
  double loweringScale = 1;  ///< of what the proof of occlusion.h asks for; less than 1 loses pixels
  std::optional<std::uint32_t> culledNode = {};  ///< left out although it is visible
  double statedErrorScale = 1;  ///< of the errors that levels state; less than 1 understates them
  int depthMapShiftTexels = 0;  ///< the depth map is read so many texels to the side
  friend bool operator==(const Defects&, const Defects&) = default;
};

}  // namespace trimtab::scene
