#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/frame/object_index.h"
#include "trimtab/units/linear.h"

namespace trimtab::terrain {

/// What a cell needs to know of a model to hold its instances.
struct ModelExtent {
  Vec3 low, high;      ///< of all levels, metres at scale 1
  double radiusM = 0;  ///< the farthest vertex of any level from the origin
  float coarsestErrorM = 0;
};

/// An instance before it is in a cell.
struct PlacedInstance {
  Vec3 place;                        ///< in the local frame
  std::array<std::int16_t, 4> turn;  ///< as in ObjectInstance
  float scale = 1;
  std::uint32_t model = 0;
};

/// Returns x and y as one number whose bits take turns, so that each quarter of a square is a run of it.
std::uint64_t quarters(std::uint32_t x, std::uint32_t y);
/// Returns the origin of a cell around a place, in steps of 16 m.
std::array<std::int32_t, 3> originOf(Vec3 place);
/// Returns the smallest box in floats that holds both corners.
Box boxAround(Vec3 low, Vec3 high);
/// Returns the unit quaternion of a rotation times 32767, as ObjectInstance holds it.
std::array<std::int16_t, 4> quantisedTurn(const Mat3& rotation);
/// Returns the rotation of a turn, by its direction alone.
Mat3 rotationOf(const std::array<std::int16_t, 4>& turn);

/// Makes the cells and instances of an index. The order of `placed` does not matter but among instances of
/// one model in one leaf. It is sorted.
void fillCells(std::vector<PlacedInstance>& placed, const std::vector<ModelExtent>& extents,
               ObjectIndex& index);

}  // namespace trimtab::terrain
