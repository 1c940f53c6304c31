#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "trimtab/culling/cut_rule.h"
#include "trimtab/culling/select_static.h"
#include "trimtab/frame/eye_pose.h"
#include "trimtab/frame/object_index.h"
#include "trimtab/frame/patch_index.h"
#include "trimtab/frame/static_lod_index.h"
#include "trimtab/frame/terrain_index.h"

/// Counts the triangles that a view would draw, and names its nodes, without drawing it.
namespace trimtab {

/// The scale of allowed errors: place i is 2^(i/16) times the first, from 1/8 to 64 px. Where triangles
/// fall by half from octave to octave, a place is worth 4 percent of their time.
inline constexpr double kFirstErrorPx = 0.125;
inline constexpr std::size_t kPlacesPerOctave = 16, kErrorPlaces = 9 * kPlacesPerOctave + 1;

/// The ladder of allowed errors: step 0 is the error that is asked for, the others are the places of the
/// scale above it, over four octaves.
inline constexpr std::size_t kErrorSteps = 2 + 4 * kPlacesPerOctave;
using TriangleLadder = std::array<double, kErrorSteps>;

/// Returns how far the first place above an error is, in places: above 0 and at most 1.
double placesToNext(double errorPx);

/// What the objects of a terrain draw, by cell and by the error that is accepted: made once, so that a count
/// visits cells and no instances.
class ObjectLoad {
 public:
  explicit ObjectLoad(std::shared_ptr<const ObjectIndex> index);
  const ObjectIndex& index() const { return *index_; }
  /// Returns where an accepted error, metres, lies among steps of half an octave, from 0.01 m on.
  static double stepOf(double acceptedM);
  /// Returns the triangles that a cell without children draws where the error at a step is accepted: all
  /// between two whole steps are counted alike.
  double triangles(std::uint32_t cell, double step) const;
  /// From this step on every cell draws its fewest triangles.
  static constexpr double kLastStep = 23;

 private:
  static constexpr std::size_t kSteps = static_cast<std::size_t>(kLastStep) + 1;
  std::shared_ptr<const ObjectIndex> index_;
  std::vector<std::array<float, kSteps>> triangles_;  ///< one row per cell, empty for cells with children
};

/// The indices of a terrain's forms, all in one local frame. A form that the terrain does not have is null.
struct LoadIndex {
  std::shared_ptr<const TerrainIndex> tiles;
  std::shared_ptr<const PatchIndex> patches;
  std::shared_ptr<const StaticLodIndex> trees;
  std::shared_ptr<const ObjectLoad> objects;  ///< null if nothing stands on the ground
  LocalFrame frame;
};

struct LoadView {
  EyePose eye;
  ViewShape view;
  double farM = std::numeric_limits<double>::infinity();  ///< nothing farther is drawn
};

/// Returns the triangles in the frustum for each step of the ladder, of one form. It visits only the nodes in
/// the frustum that the finest step draws, and their ancestors. It does not know what neighbours add to a cut
/// nor what occlusion hides. `askedPx` is the error that the rule allows, which places the ladder on the
/// scale. `stack` is working storage.
TriangleLadder countTriangles(const TerrainIndex& index, const LoadView& view, const CutRule& rule,
                              double askedPx, std::vector<std::uint64_t>& stack);
TriangleLadder countTriangles(const PatchIndex& index, const LoadView& view, const CutRule& rule,
                              double askedPx, std::vector<std::uint64_t>& stack);
/// `error` is staticLodError() of the measure in use.
TriangleLadder countTriangles(const StaticLodIndex& index, const std::vector<float>& error,
                              const LoadView& view, const StaticLodRule& rule, double askedPx,
                              std::vector<std::uint64_t>& stack);

/// Returns the triangles of objects in the frustum likewise. `rule` is the objects' own; an octave of the
/// ladder is an octave of its error too. Of what is too small or too far only whole cells are left out.
TriangleLadder countTriangles(const ObjectLoad& load, const LoadView& view, const CutRule& rule,
                              double askedPx, const FrameLevers& levers);

/// Appends the nodes that a view draws, as step 0 of the ladder counts them.
void collectNodes(const TerrainIndex& index, const LoadView& view, const CutRule& rule,
                  std::vector<std::uint64_t>& stack, std::vector<std::uint32_t>& nodes);
void collectNodes(const StaticLodIndex& index, const std::vector<float>& error, const LoadView& view,
                  const StaticLodRule& rule, std::vector<std::uint64_t>& stack,
                  std::vector<std::uint32_t>& nodes);

/// Returns the share of the image, 0..1, whose lines of sight run below the horizon of a smooth earth:
/// where ground is drawn over flat country. `up` is the vertical at the eye, `heightM` the height above the
/// sea.
double shareBelowHorizon(const LoadView& view, Vec3 up, double heightM);

}  // namespace trimtab
