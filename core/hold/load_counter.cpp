#include "trimtab/hold/load_counter.h"

#include <algorithm>
#include <cmath>

#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/frustum.h"
#include "trimtab/culling/tree_walk.h"
#include "trimtab/units/sphere.h"

namespace trimtab {
namespace {

/// Triangles by step as differences, so that a node adds to any range of steps at once.
class Ladder {
 public:
  void add(std::size_t from, std::size_t to, double triangles) {
    if (from >= to) return;
    difference_[from] += triangles;
    difference_[to] -= triangles;
  }
  TriangleLadder sums() const {
    TriangleLadder ladder{};
    double sum = 0;
    for (std::size_t k = 0; k < kErrorSteps; ++k) ladder[k] = sum += difference_[k];
    return ladder;
  }

 private:
  std::array<double, kErrorSteps + 1> difference_{};
};

/// Finds the first step of the ladder at which an error is accepted.
class Accepted {
 public:
  Accepted(double askedPx, double spread)
      : toNext_(placesToNext(askedPx)), places_(0.5 * double{kPlacesPerOctave} / spread) {}
  /// Returns it, at most kErrorSteps. `ratio` is the square of the error over the square of what step 0
  /// accepts.
  std::size_t operator()(double ratio) const {
    if (!(ratio > 1)) return 0;
    const double step = 1 + std::max(std::ceil(std::log2(ratio) * places_ - toNext_ - 1e-9), 0.0);
    return step < static_cast<double>(kErrorSteps) ? static_cast<std::size_t>(step) : kErrorSteps;
  }

 private:
  double toNext_, places_;
};

/// Reports whether a view leaves out a box.
class Outside {
 public:
  explicit Outside(const LoadView& view)
      : frustum_(view.eye, view.view), eye_(view.eye.position), far2_(view.farM * view.farM) {}
  bool operator()(const Box& box) const {
    return !frustum_.mayShow(box) || distanceSquared(box, eye_) > far2_;
  }

 private:
  Frustum frustum_;
  Vec3 eye_;
  double far2_;
};

/// Packs a node that waits with the first step that draws its parent instead.
std::uint64_t packed(std::uint32_t node, std::size_t below) {
  static_assert(kErrorSteps <= 0xff);
  return std::uint64_t{node} << 8 | below;
}

double ratioOf(const CutRule& rule, double error, double distance2) {
  return spreadSquared(error * error / rule.limit(), rule.spread, rule.spreadFromM) / distance2;
}

/// Walks the nodes in view that a step below `steps` draws, and their ancestors. `ratio(node, distance2)`
/// returns what Accepted takes. `draw(node, first, below)` is called for each of them: the steps from `first`
/// to before `below` draw it, and no step does if `first` is not less than `below`.
template <class Index, class Ratio, class Draw>
void walk(const Index& index, const LoadView& view, const Accepted& accepted, std::size_t steps,
          std::vector<std::uint64_t>& stack, const Ratio& ratio, const Draw& draw) {
  const Outside outside(view);
  stack.clear();
  forEachRoot(index, [&](std::uint32_t root) { stack.push_back(packed(root, steps)); });
  while (!stack.empty()) {
    const auto node = static_cast<std::uint32_t>(stack.back() >> 8);
    const std::size_t below = stack.back() & 0xff;
    stack.pop_back();
    if (outside(index.bounds[node])) continue;
    const double distance2 = distanceSquared(index.bounds[node], view.eye.position);
    const std::size_t first = hasChildren(index, node) ? accepted(ratio(node, distance2)) : 0;
    draw(node, first, below);
    const std::size_t drawn = std::min(first, below);
    if (drawn > 0)
      forEachChild(index, node, [&](std::uint32_t child) { stack.push_back(packed(child, drawn)); });
  }
}

/// Walks tiles so.
template <class Draw>
void walkTiles(const TerrainIndex& index, const LoadView& view, const CutRule& rule, double askedPx,
               std::size_t steps, std::vector<std::uint64_t>& stack, const Draw& draw) {
  const auto ratio = [&](std::uint32_t node, double distance2) {
    return ratioOf(rule, index.errorM[node], distance2);
  };
  walk(index, view, Accepted(askedPx, rule.spread), steps, stack, ratio, draw);
}

/// Walks nodes of static trees so.
template <class Draw>
void walkTrees(const StaticLodIndex& index, const std::vector<float>& error, const LoadView& view,
               const StaticLodRule& rule, double askedPx, std::size_t steps,
               std::vector<std::uint64_t>& stack, const Draw& draw) {
  const double square = rule.distancePerError * rule.distancePerError;
  const auto ratio = [&](std::uint32_t node, double distance2) {
    const double e = error[node];
    return spreadSquared(e * e * square, rule.spread, rule.spreadFromM) / distance2;
  };
  walk(index, view, Accepted(askedPx, rule.spread), steps, stack, ratio, draw);
}

/// The error that is accepted at the first step of ObjectLoad, metres.
constexpr double kFirstAcceptedM = 0.01;

/// The error that is asked for, where only step 0 counts and no other place is looked at.
constexpr double kNoScale = 1;

/// Collects what step 0 draws.
auto collector(std::vector<std::uint32_t>& nodes) {
  return [&nodes](std::uint32_t node, std::size_t first, std::size_t below) {
    if (first < below) nodes.push_back(node);
  };
}

}  // namespace

double placesToNext(double errorPx) {
  const double place = double{kPlacesPerOctave} * std::log2(errorPx / kFirstErrorPx);
  return std::isfinite(place) ? std::floor(place) + 1 - place : 1;
}

TriangleLadder countTriangles(const TerrainIndex& index, const LoadView& view, const CutRule& rule,
                              double askedPx, std::vector<std::uint64_t>& stack) {
  constexpr double kTriangles = 2.0 * TerrainIndex::kTileCells * TerrainIndex::kTileCells;
  Ladder ladder;
  walkTiles(
      index, view, rule, askedPx, kErrorSteps, stack,
      [&](std::uint32_t, std::size_t first, std::size_t below) { ladder.add(first, below, kTriangles); });
  return ladder.sums();
}

void collectNodes(const TerrainIndex& index, const LoadView& view, const CutRule& rule,
                  std::vector<std::uint64_t>& stack, std::vector<std::uint32_t>& nodes) {
  walkTiles(index, view, rule, kNoScale, 1, stack, collector(nodes));
}

TriangleLadder countTriangles(const PatchIndex& index, const LoadView& view, const CutRule& rule,
                              double askedPx, std::vector<std::uint64_t>& stack) {
  const Accepted accepted(askedPx, rule.spread);
  Ladder ladder;
  walk(
      index, view, accepted, kErrorSteps, stack,
      [&](std::uint32_t patch, double distance2) { return ratioOf(rule, index.errorM[patch][0], distance2); },
      [&](std::uint32_t patch, std::size_t from, std::size_t below) {
        const double distance2 = distanceSquared(index.bounds[patch], view.eye.position);
        const std::span<const float> errors = index.errorM[patch];
        // Each variant serves from the step that accepts it up to the next coarser one.
        for (std::size_t v = 0; v < errors.size() && from < below; ++v) {
          const bool last = v + 1 == errors.size();
          const std::size_t next =
              last ? below : std::clamp(accepted(ratioOf(rule, errors[v + 1], distance2)), from, below);
          ladder.add(from, next, index.triangles[patch][v]);
          from = next;
        }
      });
  return ladder.sums();
}

TriangleLadder countTriangles(const StaticLodIndex& index, const std::vector<float>& error,
                              const LoadView& view, const StaticLodRule& rule, double askedPx,
                              std::vector<std::uint64_t>& stack) {
  Ladder ladder;
  walkTrees(index, error, view, rule, askedPx, kErrorSteps, stack,
            [&](std::uint32_t node, std::size_t first, std::size_t below) {
              ladder.add(first, below, index.nodes[node].triangles);
            });
  return ladder.sums();
}

void collectNodes(const StaticLodIndex& index, const std::vector<float>& error, const LoadView& view,
                  const StaticLodRule& rule, std::vector<std::uint64_t>& stack,
                  std::vector<std::uint32_t>& nodes) {
  walkTrees(index, error, view, rule, kNoScale, 1, stack, collector(nodes));
}

ObjectLoad::ObjectLoad(std::shared_ptr<const ObjectIndex> index) : index_(std::move(index)) {
  triangles_.resize(index_->cells.size());
  for (std::uint32_t number = 0; number < index_->cells.size(); ++number) {
    const ObjectIndex::Cell& cell = index_->cells[number];
    if (!cell.isLeaf(number)) continue;
    for (std::uint32_t i = cell.firstInstance; i < cell.firstInstance + cell.instances; ++i) {
      const ObjectInstance& instance = index_->instances[i];
      const ObjectIndex::Model& model = index_->models[instance.model];
      std::uint32_t level = 0;
      for (std::size_t step = 0; step < kSteps; ++step) {
        const double accepted = kFirstAcceptedM * std::exp2(0.5 * static_cast<double>(step)) / instance.scale;
        while (level + 1 < model.levels && index_->levels[model.firstLevel + level + 1].errorM <= accepted)
          ++level;
        triangles_[number][step] += static_cast<float>(index_->levels[model.firstLevel + level].triangles);
      }
    }
  }
}

double ObjectLoad::stepOf(double acceptedM) {
  return 2 * std::log2(acceptedM / kFirstAcceptedM);
}

double ObjectLoad::triangles(std::uint32_t cell, double step) const {
  return triangles_[cell][static_cast<std::size_t>(std::clamp(step, 0.0, kLastStep))];
}

TriangleLadder countTriangles(const ObjectLoad& load, const LoadView& view, const CutRule& rule,
                              double askedPx, const FrameLevers& levers) {
  const ObjectIndex& index = load.index();
  const Outside outside(view);
  const double toNext = placesToNext(askedPx), perDistance = std::sqrt(rule.limit());
  constexpr double kStepsPerPlace = 2 / double{kPlacesPerOctave};
  Ladder ladder;
  for (std::uint32_t number = 0; number < index.cells.size();) {
    const ObjectIndex::Cell& cell = index.cells[number];
    const double away = std::sqrt(distanceSquared(cell.bounds, view.eye.position));
    if (outside(cell.bounds) || away > levers.objectFarM ||
        2 * cell.largestRadiusM * rule.pixelsPerRadian < levers.smallFeaturePx * away) {
      number = cell.end;
      continue;
    }
    if (cell.isLeaf(number)) {
      const double spread = std::sqrt(spreadSquared(away * away, 1 / rule.spread, rule.spreadFromM));
      const double asked = ObjectLoad::stepOf(perDistance * spread);
      ladder.add(0, 1, load.triangles(number, asked));
      // Places that lie between the same two steps are added at once.
      for (std::size_t k = 1; k < kErrorSteps;) {
        const double step = asked + (toNext + static_cast<double>(k - 1)) * kStepsPerPlace;
        std::size_t next = kErrorSteps;
        if (step < ObjectLoad::kLastStep) {
          const double places = std::ceil((std::floor(std::max(step, 0.0)) + 1 - step) / kStepsPerPlace);
          if (places < static_cast<double>(kErrorSteps)) next = k + static_cast<std::size_t>(places);
        }
        ladder.add(k, std::min(next, kErrorSteps), load.triangles(number, step));
        k = next;
      }
    }
    ++number;
  }
  return ladder.sums();
}

double shareBelowHorizon(const LoadView& view, Vec3 up, double heightM) {
  constexpr int kColumns = 9, kRows = 16;
  const double horizon = -std::sin(horizonDip(heightM));
  const ViewShape& v = view.view;
  const Mat3& axes = view.eye.axes;
  int below = 0;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const double x = v.left + (v.right - v.left) * (column + 0.5) / kColumns;
      const double y = v.bottom + (v.top - v.bottom) * (row + 0.5) / kRows;
      const Vec3 ray = axes.row[0] * x + axes.row[1] * y - axes.row[2];
      below += dot(ray, up) < horizon * length(ray);
    }
  return static_cast<double>(below) / (kColumns * kRows);
}

}  // namespace trimtab
