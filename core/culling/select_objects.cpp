#include "trimtab/culling/select_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/frustum.h"

namespace trimtab {
namespace {

/// Error of positions in single precision relative to the eye, as a share of their distance, and a margin in
/// metres for what is near.
constexpr double kRounding = 1e-6, kNearRoundingM = 1e-3;

/// Returns the coarsest level of a model whose error `accepts` takes, at this scale; else the finest.
template <typename Accepts>
std::uint32_t coarsestLevel(const ObjectIndex& index, const ObjectIndex::Model& model, double scale,
                            const Accepts& accepts) {
  std::uint32_t level = model.firstLevel + model.levels - 1;
  while (level > model.firstLevel && !accepts(double{index.levels[level].errorM} * scale)) --level;
  return level;
}

class Selection {
 public:
  Selection(const ObjectIndex& index, const ObjectQuery& query, VisibleObjects& visible)
      : index_(index),
        query_(query),
        eye_(query.eye.position),
        frustum_(query.eye, query.view),
        limit_(query.rule.limit()),
        plain_(query.rule.spread == 1),
        perDistance_(std::sqrt(limit_)),
        leastPerM_(query.leastPx > 0 ? query.leastPx / query.rule.pixelsPerRadian : 0),
        farM_(std::min(std::max(query.farM, 0.0), std::numeric_limits<double>::max())),
        airM_(query.cull ? std::max(query.airM, 0.0) : std::numeric_limits<double>::infinity()),
        hidden_(query.cull && query.hidden.size() >= index.cells.size() ? query.hidden
                                                                        : std::span<const std::uint8_t>{}),
        visible_(visible) {
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      const Frustum::Plane& plane = frustum_.planes()[i];
      planes_[i] = {static_cast<float>(plane.normal.x), static_cast<float>(plane.normal.y),
                    static_cast<float>(plane.normal.z), static_cast<float>(plane.offset)};
    }
  }

  void run() {
    const auto cells = static_cast<std::uint32_t>(index_.cells.size());
    for (std::uint32_t cell = 0; cell < cells;) {
      const ObjectIndex::Cell& c = index_.cells[cell];
      const CullReason reason = reasonOf(cell);
      if (reason != CullReason::drawn) {
        std::fill(visible_.reason.begin() + cell, visible_.reason.begin() + c.end, reason);
        cell = c.end;
        continue;
      }
      visible_.reason[cell] = CullReason::drawn;
      if (c.isLeaf(cell)) leaf(cell);
      ++cell;
    }
    sortByLevel();
  }

 private:
  /// Returns why nothing of a cell is drawn, and counts its instances under that.
  CullReason reasonOf(std::uint32_t number) {
    const ObjectIndex::Cell& cell = index_.cells[number];
    const double nearest = nearestFoot(cell);
    if (nearest > farM_ || nearest - cell.largestRadiusM > airReach(nearest))
      return count(visible_.tooFar, cell, CullReason::beyond_visibility);
    if (2 * cell.largestRadiusM < leastPerM_ * nearest)
      return count(visible_.tooSmall, cell, CullReason::beyond_visibility);
    if (!query_.cull) return CullReason::drawn;
    if (!frustum_.mayShow(cell.bounds))
      return count(visible_.outsideFrustum, cell, CullReason::outside_frustum);
    if (!hidden_.empty() && hidden_[number] != 0) return count(visible_.occluded, cell, CullReason::occluded);
    return CullReason::drawn;
  }
  /// Returns a distance, metres, that the origin of no instance of the cell is nearer than.
  double nearestFoot(const ObjectIndex::Cell& cell) const {
    return std::max(std::sqrt(distanceSquared(cell.bounds, eye_)) * (1 - kRounding) - kNearRoundingM -
                        cell.largestRadiusM,
                    0.0);
  }
  static CullReason count(std::size_t& instances, const ObjectIndex::Cell& cell, CullReason reason) {
    instances += cell.instances;
    return reason;
  }

  void leaf(std::uint32_t number) {
    const ObjectIndex::Cell& cell = index_.cells[number];
    const Vec3 origin{16.0 * cell.origin[0] - eye_.x, 16.0 * cell.origin[1] - eye_.y,
                      16.0 * cell.origin[2] - eye_.z};
    const bool whole = !query_.cull || frustum_.holds(cell.bounds);
    const bool coarsest = accepts(cell.coarsestFromM, std::max(nearestFoot(cell) - cell.largestRadiusM, 0.0));
    for (std::uint32_t i = cell.firstInstance; i < cell.firstInstance + cell.instances; ++i) {
      const ObjectInstance& instance = index_.instances[i];
      const ObjectIndex::Model& model = index_.models[instance.model];
      const Vec3 foot = origin + Vec3{instance.x, instance.y, instance.z};
      const double distance = length(foot), radius = double{model.radiusM} * instance.scale;
      if (!(distance <= farM_) || distance - radius > airReach(distance)) {
        ++visible_.tooFar;
        continue;
      }
      if (2 * radius < leastPerM_ * distance) {
        ++visible_.tooSmall;
        continue;
      }
      if (!whole && isOutside(foot, radius)) {
        ++visible_.outsideFrustum;
        continue;
      }
      const double nearest = std::max(distance - radius, 0.0);
      const std::uint32_t level = coarsestLevel(
          index_, model, instance.scale, [&](double error) { return coarsest || accepts(error, nearest); });
      visible_.found.push_back({static_cast<float>(foot.x), static_cast<float>(foot.y),
                                static_cast<float>(foot.z), instance.scale, instance.turn, i, number});
      visible_.levelOfFound.push_back(level);
    }
  }

  /// Returns whether the rule accepts an error, metres, at a distance, metres.
  bool accepts(double error, double distance) const {
    return plain_ ? error <= perDistance_ * distance
                  : !query_.rule.isTooCoarse(error, distance * distance, limit_);
  }

  /// Returns how far from the eye a vertex may be drawn in air through which a distance can just be seen.
  double airReach(double distance) const { return airM_ + kNearRoundingM + kRounding * distance; }

  bool isOutside(Vec3 foot, double radius) const {
    const auto x = static_cast<float>(foot.x), y = static_cast<float>(foot.y), z = static_cast<float>(foot.z);
    const auto reach = static_cast<float>(
        radius + kNearRoundingM + kRounding * (std::abs(foot.x) + std::abs(foot.y) + std::abs(foot.z)));
    for (const Plane& plane : planes_)
      if (plane.x * x + plane.y * y + plane.z * z < plane.offset - reach) return true;
    return false;
  }

  void sortByLevel() {
    std::vector<std::uint32_t>& first = visible_.firstOfLevel;
    first.assign(index_.levels.size() + 1, 0);
    for (const std::uint32_t level : visible_.levelOfFound) ++first[level + 1];
    for (std::size_t level = 0; level < index_.levels.size(); ++level) {
      visible_.triangles += std::uint64_t{first[level + 1]} * index_.levels[level].triangles;
      visible_.vertices += std::uint64_t{first[level + 1]} * index_.levels[level].vertices;
      first[level + 1] += first[level];
    }
    visible_.drawn.resize(visible_.found.size());
    for (std::size_t i = 0; i < visible_.found.size(); ++i)
      visible_.drawn[first[visible_.levelOfFound[i]]++] = visible_.found[i];
    // Each level's place has moved to the next level's.
    for (std::size_t level = index_.levels.size(); level > 0; --level) first[level] = first[level - 1];
    first[0] = 0;
  }

  struct Plane {
    float x, y, z, offset;
  };
  const ObjectIndex& index_;
  const ObjectQuery& query_;
  Vec3 eye_;
  Frustum frustum_;
  double limit_;
  bool plain_;
  double perDistance_, leastPerM_, farM_, airM_;
  std::span<const std::uint8_t> hidden_;
  std::array<Plane, 5> planes_;
  VisibleObjects& visible_;
};

}  // namespace

void selectObjects(const ObjectIndex& index, const ObjectQuery& query, VisibleObjects& visible) {
  visible.found.clear();
  visible.levelOfFound.clear();
  visible.reason.assign(index.cells.size(), CullReason::beyond_visibility);
  visible.outsideFrustum = visible.occluded = visible.tooFar = visible.tooSmall = 0;
  visible.triangles = visible.vertices = 0;
  Selection(index, query, visible).run();
}

Vec3 placeOfObject(const ObjectIndex& index, std::uint32_t instance) {
  const ObjectInstance& i = index.instances[instance];
  for (std::uint32_t number = 0; number < index.cells.size(); ++number)
    if (const ObjectIndex::Cell& cell = index.cells[number];
        cell.isLeaf(number) && instance - cell.firstInstance < cell.instances)
      return Vec3{i.x, i.y, i.z} + Vec3{16.0 * cell.origin[0], 16.0 * cell.origin[1], 16.0 * cell.origin[2]};
  return {};
}

std::uint32_t levelOfObject(const ObjectIndex& index, const ObjectInstance& instance, double distanceM,
                            const CutRule& rule) {
  const ObjectIndex::Model& model = index.models[instance.model];
  const double nearest = std::max(distanceM - double{model.radiusM} * instance.scale, 0.0);
  return coarsestLevel(index, model, instance.scale, [&](double error) {
    return !rule.isTooCoarse(error, nearest * nearest, rule.limit());
  });
}

void findHiddenCells(const ObjectIndex& index, const DepthPyramid& map, const EyePose& eye,
                     const ViewShape& view, std::vector<std::uint8_t>& hidden) {
  hidden.assign(index.cells.size(), 0);
  const Frustum frustum(eye, view);
  const auto cells = static_cast<std::uint32_t>(index.cells.size());
  for (std::uint32_t cell = 0; cell < cells;) {
    const ObjectIndex::Cell& c = index.cells[cell];
    const bool seen = frustum.mayShow(c.bounds), behind = seen && map.isHidden(c.bounds, eye, view);
    if (behind) std::fill(hidden.begin() + cell, hidden.begin() + c.end, std::uint8_t{1});
    cell = seen && !behind ? cell + 1 : c.end;
  }
}

std::vector<Relief> reliefsOfCells(const ObjectIndex& index) {
  std::vector<Relief> reliefs;
  reliefs.reserve(index.cells.size());
  for (const ObjectIndex::Cell& cell : index.cells) {
    Relief& relief = reliefs.emplace_back();
    const Box& b = cell.bounds;
    // Metres from the middle are small numbers, so that a step to the next float outwards costs nothing.
    relief.origin = 0.5 * Vec3{double{b.minX} + b.maxX, double{b.minY} + b.maxY, double{b.minZ} + b.maxZ};
    const auto half = [](float least, float most) {
      return std::nextafter(static_cast<float>(0.5 * (double{most} - least)), INFINITY);
    };
    const float x = half(b.minX, b.maxX), y = half(b.minY, b.maxY), z = half(b.minZ, b.maxZ);
    relief.bounds = {-x, -y, -z, x, y, z};
    relief.reach = std::max({x, y, z});
    relief.peak = {0, 0, z};
  }
  return reliefs;
}

}  // namespace trimtab
