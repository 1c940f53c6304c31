#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "culling_kinds.h"
#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"

namespace trimtab::test {

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
  /// The sizes of the published bands, and an odd one; no picture has any of them.
  static constexpr std::array<OcclusionResolution, 5> kBands{
      {{320, 240}, {400, 300}, {640, 480}, {800, 600}, {333, 251}}};

  using Owners = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  ///< nodes and their pixels, by node

  struct View {
    FrameRequest request;  ///< without method, occlusion and size
    Owners owners;
    std::size_t cut = 0, frustum = 0;   ///< nodes of the cut, and in the frustum
    std::size_t hidden = 0;             ///< of those in the frustum: none of their pixels shows
    std::size_t pixelsFromBehind = 0;   ///< with the picture: of nodes that show nothing but their backs
    std::size_t ridges = 0, open = 0;   ///< with the picture: pixels that GL's face culling changes, and of
                                        ///< these such that show what lies behind a ridge
    std::vector<std::uint8_t> picture;  ///< of the unculled scene; empty but for one view in twenty
  };

  struct Tally {
    std::size_t sets = 0, occluded = 0, hidden = 0;
    std::size_t wrongNodes = 0, wrongPixels = 0, told = 0;
    std::size_t pictures = 0, differing = 0;  ///< pictures compared, and pixels in them
    void add(const Tally& other);
  };

  void SetUp() override;

  /// Fixes for all views which form of the terrain is drawn.
  void useForm(TerrainForm form) { form_ = form; }
  FrameRequest viewOf(const GeodeticPosition& eye, const Attitude& attitude) const;

  /// Views of all kinds: low and high, in valleys, steep, rolled, lopsided, narrow and wide, at the finest
  /// levels and at coarse ones, in fog, beyond the data's edge and below the ground.
  std::vector<FrameRequest> anyViews(int count, unsigned seed) const;
  /// Frames at 60 Hz on one path: 600 kt low over the ground, or as far a frame as at 15 Hz and up to three
  /// times as fast; the head turning at 200 deg/s to both sides; standing while it turns; a leap to somewhere
  /// else after each leg.
  std::vector<FrameRequest> flight(int frames, unsigned seed) const;
  /// Long enough for what is built ahead over many frames, where there is time for it.
  static int legFrames() { return soak() > 1 ? 48 : 8; }

  /// Its numbers, so that it can be drawn again.
  static std::string describe(const FrameRequest& r);

  /// Draws a view without culling, and by the frustum alone. `withPicture`: keeps the unculled picture.
  /// `bothSides`: the owners are those of a scene without GL's face culling too.
  View truthOf(const FrameRequest& request, bool withPicture, bool bothSides = false);
  /// Adds what a method finds. `wholly`: with all that a frame does, and its picture where the view has one;
  /// else only its visible set is made, and maps of the GPU.
  void compare(const View& view, CullingCase culling, OcclusionMethod method, OcclusionResolution band,
               Tally& tally, bool wholly = true);

  FrameResult draw(const FrameRequest& request, bool wholly);
  static std::vector<std::uint32_t> nodesOf(const VisibleSet& visible);  ///< sorted

  struct Part {
    TerrainForm form;
    int count;  ///< of views
  };
  /// In each form, all methods over so many views, each in one band, or in all where it soaks; and each
  /// method over frames of flight one after the other, so that what it keeps from frame to frame is used.
  /// Prints what was found, and a line for all of it; fails where a node was culled wrongly.
  void prove(std::initializer_list<Part> parts, unsigned seed);

 private:
  /// Of all forms of a terrain together.
  struct Sum {
    std::size_t views = 0, frames = 0;
    CullingKinds kinds;
    Tally all;
    std::map<std::string, Tally> methods;
  };

  Owners owners();
  static double shareOf(const Tally& t) {
    return t.hidden > 0 ? 100 * static_cast<double>(t.occluded) / static_cast<double>(t.hidden) : 0;
  }
  void tell(const char* what, const std::string& method, const Tally& tally);
  void proveViews(const std::vector<FrameRequest>& requests, Sum& sum);
  void proveFlight(const std::vector<FrameRequest>& requests, Sum& sum);
  void tellSum(const Sum& sum) const;

  TerrainForm form_ = TerrainForm::tiles;
};

}  // namespace trimtab::test
