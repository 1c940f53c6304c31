#include "placed_instances.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trimtab/terrain/objects/build_objects.h"

namespace trimtab::terrain {

namespace {

constexpr double kOriginStepM = 16;
constexpr double kTurnSteps = 32767;

float below(double value) {
  const auto f = static_cast<float>(value);
  return double{f} <= value ? f : std::nextafter(f, -std::numeric_limits<float>::infinity());
}
float above(double value) {
  return -below(-value);
}

/// A box in doubles.
struct Extent {
  Vec3 low, high;

  void add(const Extent& other) {
    low = {std::min(low.x, other.low.x), std::min(low.y, other.low.y), std::min(low.z, other.low.z)};
    high = {std::max(high.x, other.high.x), std::max(high.y, other.high.y), std::max(high.z, other.high.z)};
  }
};

/// Returns the box of a model's box as it is drawn. The instance is drawn in floats: what they round is a
/// small part of the radius, and of the way from the cell's origin.
Extent turnedBox(const ModelExtent& model, const ObjectInstance& instance, Vec3 cellOrigin) {
  constexpr double kRounding = 1e-6;
  const Mat3 turn = rotationOf(instance.turn);
  const Vec3 offset{instance.x, instance.y, instance.z};
  const Vec3 middle = (model.low + model.high) * 0.5, half = (model.high - model.low) * 0.5;
  const double scale = instance.scale;
  const Vec3 centre = offset + cellOrigin + (turn * middle) * scale;
  const auto reach = [&](const Vec3& row) {
    return scale * (std::abs(row.x) * half.x + std::abs(row.y) * half.y + std::abs(row.z) * half.z) +
           kRounding * (scale * model.radiusM + length(offset));
  };
  const Vec3 size{reach(turn.row[0]), reach(turn.row[1]), reach(turn.row[2])};
  return {centre - size, centre + size};
}

class CellBuilder {
 public:
  CellBuilder(std::vector<PlacedInstance>& placed, const std::vector<ModelExtent>& extents,
              ObjectIndex& index)
      : placed_(placed), extents_(extents), index_(index) {}

  void build() {
    double west = placed_[0].place.x, south = placed_[0].place.y;
    for (const PlacedInstance& p : placed_) {
      west = std::min(west, p.place.x);
      south = std::min(south, p.place.y);
    }
    // The smallest squares are kLeafSideM wide.
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(placed_.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
      order[i] = {quarters(static_cast<std::uint32_t>((placed_[i].place.x - west) / kLeafSideM),
                           static_cast<std::uint32_t>((placed_[i].place.y - south) / kLeafSideM)),
                  i};
    std::sort(order.begin(), order.end());
    std::vector<PlacedInstance> sorted;
    sorted.reserve(order.size());
    codes_.reserve(order.size());
    for (const auto& [code, number] : order) {
      sorted.push_back(placed_[number]);
      codes_.push_back(code);
    }
    placed_ = std::move(sorted);
    index_.instances.reserve(placed_.size());
    cell(0, static_cast<std::uint32_t>(placed_.size()));
  }

 private:
  Extent cell(std::uint32_t first, std::uint32_t last) {
    const std::size_t number = index_.cells.size();
    index_.cells.emplace_back();
    ObjectIndex::Cell made;
    made.firstInstance = first;
    made.instances = last - first;
    const std::uint64_t differ = codes_[first] ^ codes_[last - 1];
    Extent extent;
    if (last - first <= kLeafInstances || differ == 0) {
      extent = leaf(first, last, made);
    } else {
      // The first pair of bits that is not the same all over: quarters of the smallest square around all.
      int shift = 0;
      while (differ >> shift > 3) shift += 2;
      bool begun = false;
      for (std::uint32_t from = first; from < last;) {
        const std::uint64_t quarter = codes_[from] >> shift;
        const auto end = std::partition_point(codes_.begin() + from, codes_.begin() + last,
                                              [&](std::uint64_t code) { return code >> shift == quarter; });
        const auto to = static_cast<std::uint32_t>(end - codes_.begin());
        const std::size_t child = index_.cells.size();
        const Extent inner = cell(from, to);
        if (begun)
          extent.add(inner);
        else
          extent = inner;
        begun = true;
        made.largestRadiusM = std::max(made.largestRadiusM, index_.cells[child].largestRadiusM);
        made.coarsestFromM = std::max(made.coarsestFromM, index_.cells[child].coarsestFromM);
        from = to;
      }
      made.origin = originOf((extent.low + extent.high) * 0.5);
    }
    made.bounds = boxAround(extent.low, extent.high);
    made.end = static_cast<std::uint32_t>(index_.cells.size());
    index_.cells[number] = made;
    return extent;
  }

  Extent leaf(std::uint32_t first, std::uint32_t last, ObjectIndex::Cell& made) {
    std::stable_sort(placed_.begin() + first, placed_.begin() + last,
                     [](const PlacedInstance& a, const PlacedInstance& b) { return a.model < b.model; });
    Vec3 low = placed_[first].place, high = low;
    for (std::uint32_t i = first; i < last; ++i) {
      const Vec3 p = placed_[i].place;
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    made.origin = originOf((low + high) * 0.5);
    const Vec3 origin =
        Vec3{double(made.origin[0]), double(made.origin[1]), double(made.origin[2])} * kOriginStepM;
    Extent extent;
    for (std::uint32_t i = first; i < last; ++i) {
      const PlacedInstance& p = placed_[i];
      const ModelExtent& model = extents_[p.model];
      const Vec3 from = p.place - origin;
      const ObjectInstance instance{static_cast<float>(from.x),
                                    static_cast<float>(from.y),
                                    static_cast<float>(from.z),
                                    p.turn,
                                    p.scale,
                                    p.model};
      const Extent box = turnedBox(model, instance, origin);
      if (i == first)
        extent = box;
      else
        extent.add(box);
      made.largestRadiusM = std::max(made.largestRadiusM, above(model.radiusM * double{p.scale}));
      made.coarsestFromM =
          std::max(made.coarsestFromM, above(double{model.coarsestErrorM} * double{p.scale}));
      index_.instances.push_back(instance);
    }
    return extent;
  }

  std::vector<PlacedInstance>& placed_;
  const std::vector<ModelExtent>& extents_;
  ObjectIndex& index_;
  std::vector<std::uint64_t> codes_;
};

}  // namespace

std::uint64_t quarters(std::uint32_t x, std::uint32_t y) {
  const auto spread = [](std::uint64_t v) {
    v = (v | v << 16) & 0x0000ffff0000ffffu;
    v = (v | v << 8) & 0x00ff00ff00ff00ffu;
    v = (v | v << 4) & 0x0f0f0f0f0f0f0f0fu;
    v = (v | v << 2) & 0x3333333333333333u;
    return (v | v << 1) & 0x5555555555555555u;
  };
  return spread(x) | spread(y) << 1;
}

std::array<std::int32_t, 3> originOf(Vec3 place) {
  const auto steps = [](double v) { return static_cast<std::int32_t>(std::lround(v / kOriginStepM)); };
  return {steps(place.x), steps(place.y), steps(place.z)};
}

Box boxAround(Vec3 low, Vec3 high) {
  return {below(low.x), below(low.y), below(low.z), above(high.x), above(high.y), above(high.z)};
}

std::array<std::int16_t, 4> quantisedTurn(const Mat3& m) {
  const double xx = m.row[0].x, yy = m.row[1].y, zz = m.row[2].z;
  // The largest of the four squares is at least a quarter, so that nothing small is divided by.
  double q[4] = {1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz, 1 + xx + yy + zz};
  switch (std::max_element(q, q + 4) - q) {
    case 0:
      q[1] = m.row[1].x + m.row[0].y;
      q[2] = m.row[2].x + m.row[0].z;
      q[3] = m.row[2].y - m.row[1].z;
      break;
    case 1:
      q[0] = m.row[1].x + m.row[0].y;
      q[2] = m.row[2].y + m.row[1].z;
      q[3] = m.row[0].z - m.row[2].x;
      break;
    case 2:
      q[0] = m.row[2].x + m.row[0].z;
      q[1] = m.row[2].y + m.row[1].z;
      q[3] = m.row[1].x - m.row[0].y;
      break;
    default:
      q[0] = m.row[2].y - m.row[1].z;
      q[1] = m.row[0].z - m.row[2].x;
      q[2] = m.row[1].x - m.row[0].y;
  }
  const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const double sign = q[3] < 0 ? -1 : 1;
  std::array<std::int16_t, 4> turn;
  for (std::size_t i = 0; i < 4; ++i)
    turn[i] = static_cast<std::int16_t>(std::lround(sign * q[i] / size * kTurnSteps));
  return turn;
}

Mat3 rotationOf(const std::array<std::int16_t, 4>& turn) {
  double x = turn[0], y = turn[1], z = turn[2], w = turn[3];
  const double size = std::sqrt(x * x + y * y + z * z + w * w);
  x /= size;
  y /= size;
  z /= size;
  w /= size;
  return {{Vec3{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
           Vec3{2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
           Vec3{2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
}

void fillCells(std::vector<PlacedInstance>& placed, const std::vector<ModelExtent>& extents,
               ObjectIndex& index) {
  if (!placed.empty()) CellBuilder(placed, extents, index).build();
}

}  // namespace trimtab::terrain
