#pragma once

#include <cstdint>
#include <optional>

namespace trimtab::scene {

class Renderer;
class ErrorMeter;

/// Mistakes made on purpose, so that a test can see that it finds them. It serves tests only.
struct Defects {
  double loweringScale =
      1;  ///< share of the lowering that the proof in occlusion.h asks for; below 1 loses pixels
  std::optional<std::uint32_t> culledNode = {};  ///< a node that is left out although it is visible
  double statedErrorScale = 1;  ///< factor on the errors that LODs state; below 1 understates them
  int depthMapShiftTexels = 0;  ///< how far to the side the depth map is read
  friend bool operator==(const Defects&, const Defects&) = default;
};

/// Makes the next frames of a renderer wrong; `{}` ends it.
void plant(Renderer& renderer, const Defects& defects);
/// Makes the images that a meter measures wrong; its references stay right.
void plant(ErrorMeter& meter, const Defects& defects);

}  // namespace trimtab::scene
