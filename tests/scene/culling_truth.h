#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scene_test.h"

namespace trimtab::test {

/// TRIMTAB_SOAK in the environment multiplies the views.
int soak();

/// Every way of hiding that a preset can choose, by the name that files give it: a new one joins by itself.
struct OcclusionChoice {
  OcclusionMethod method;
  const char* name;
};
std::vector<OcclusionChoice> occlusionChoices();

/// Holds what culling draws against what the scene without any culling shows. The truth of a view is the
/// number of the node that owns each pixel of the whole cut, of which nothing is left out. A node that owns a
/// pixel and is not drawn was culled wrongly.
class CullingTruth : public SceneTest {
 protected:
  /// The sizes of the published bands, and an odd one.
  static constexpr std::array<DepthMapSize, 5> kBands{
      {{320, 240}, {400, 300}, {640, 480}, {800, 600}, {333, 251}}};

  using Owners = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  ///< nodes and their pixels, by node

  struct View {
    scene::FrameRequest request;  ///< without method, occlusion and size
    Owners owners;
    std::size_t cut = 0, frustum = 0;   ///< nodes of the cut, and in the frustum
    std::size_t hidden = 0;             ///< of those in the frustum: none of their pixels shows
    std::size_t pixelsFromBehind = 0;   ///< with the picture: of nodes that show nothing but their backs
    std::vector<std::uint8_t> picture;  ///< of the unculled scene; empty but for one view in twenty
  };

  struct Tally {
    std::size_t sets = 0, occluded = 0, hidden = 0;
    std::size_t wrongNodes = 0, wrongPixels = 0, told = 0;
    std::size_t pictures = 0, differing = 0;  ///< pictures compared, and pixels in them
  };

  void SetUp() override;

  /// Fixes for all views which form of the terrain is drawn.
  void useForm(TerrainForm form) { form_ = form; }
  scene::FrameRequest viewOf(const GeodeticPosition& eye, const Attitude& attitude) const;

  /// Views of all kinds: low and high, in valleys, steep, rolled, lopsided, narrow and wide, at the finest
  /// levels and at coarse ones, in fog, beyond the data's edge and below the ground.
  std::vector<scene::FrameRequest> anyViews(int count, unsigned seed) const;
  /// Frames at 60 Hz on one path: 600 kt low over the ground, the head turning at 200 deg/s to both sides;
  /// standing while it turns; now and then a leap to somewhere else.
  std::vector<scene::FrameRequest> flight(int frames, unsigned seed) const;

  /// Its numbers, so that it can be drawn again.
  static std::string describe(const scene::FrameRequest& r);

  /// Draws a view without culling, and by the frustum alone. `withPicture`: keeps the unculled picture.
  View truthOf(const scene::FrameRequest& request, bool withPicture);
  /// Draws it by a method and adds what is found.
  void compare(const View& view, CullingCase culling, OcclusionMethod method, DepthMapSize band,
               Tally& tally);

  /// All methods over `count` views, each in one band, or in all where it soaks; and each method over
  /// frames of flight one after the other, so that what it keeps from frame to frame is used. Prints what was
  /// found, and fails where a node was culled wrongly.
  void prove(TerrainForm form, int count, unsigned seed);

 private:
  Owners owners();
  void tell(const char* what, const std::string& method, const Tally& tally);
  void proveViews(const std::vector<scene::FrameRequest>& requests);
  void proveFlight(const std::vector<scene::FrameRequest>& requests);

  TerrainForm form_ = TerrainForm::levels;
};

}  // namespace trimtab::test
