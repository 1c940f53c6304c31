#include "occluder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scene/surface/tile_indices.h"
#include "trimtab/frame/box_union.h"

namespace trimtab::scene {
namespace {

constexpr int kSide = terrain::TileMesh::kSide;
constexpr int kCells = TerrainIndex::kTileCells;
constexpr std::size_t kVertices = static_cast<std::size_t>(kSide) * kSide;
using Heights = std::array<float, kVertices>;

std::size_t at(int column, int row) {
  return static_cast<std::size_t>(row * kSide + column);
}

/// Finds the lowest that the drawn surface can be at each post. A stitched side leaves its odd posts out.
void lowestDrawn(const terrain::TileMesh& mesh, Heights& low) {
  for (std::size_t i = 0; i < kVertices; ++i) low[i] = mesh.vertices[i].z;
  for (int i = 1; i < kCells; i += 2)
    for (const int side : {0, kCells}) {
      const auto between = [&mesh](std::size_t a, std::size_t b) {
        return 0.5f * (mesh.vertices[a].z + mesh.vertices[b].z);
      };
      low[at(i, side)] = std::min(low[at(i, side)], between(at(i - 1, side), at(i + 1, side)));
      low[at(side, i)] = std::min(low[at(side, i)], between(at(side, i - 1), at(side, i + 1)));
    }
}

/// How far the two coarse triangles of a cell rise above the drawn surface, metres. Triangulations are
/// nested, so the largest difference is at a post. The cell is the 2 x 2 block at an even post; its diagonal
/// runs from south-west to north-east where (x + y) / 2 is even.
struct CellRise {
  float lower, upper;  ///< the triangle with the south side, and the one with the north side
};
CellRise riseOf(const terrain::TileMesh& mesh, const Heights& low, int x, int y) {
  const auto z = [&mesh](int column, int row) { return mesh.vertices[at(column, row)].z; };
  const auto rise = [&](int column, int row, float coarse) { return coarse - low[at(column, row)]; };
  const bool southWestToNorthEast = (x + y) / kOccluderStep % 2 == 0;
  const float centre =
      southWestToNorthEast ? 0.5f * (z(x, y) + z(x + 2, y + 2)) : 0.5f * (z(x + 2, y) + z(x, y + 2));
  const float south = rise(x + 1, y, 0.5f * (z(x, y) + z(x + 2, y)));
  const float north = rise(x + 1, y + 2, 0.5f * (z(x, y + 2) + z(x + 2, y + 2)));
  const float west = rise(x, y + 1, 0.5f * (z(x, y) + z(x, y + 2)));
  const float east = rise(x + 2, y + 1, 0.5f * (z(x + 2, y) + z(x + 2, y + 2)));
  const float middle = std::max(0.0f, rise(x + 1, y + 1, centre));
  return southWestToNorthEast ? CellRise{std::max({middle, south, east}), std::max({middle, north, west})}
                              : CellRise{std::max({middle, south, west}), std::max({middle, north, east})};
}

float horizontalDistance(const terrain::TileVertex& a, const terrain::TileVertex& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

float slopeOf(const terrain::TileVertex& v) {
  return v.slope == 255 ? 1e3f : static_cast<float>(v.slope) / 16.0f;
}

float steepestAround(const terrain::TileMesh& mesh, int x, int y) {
  float steepest = 0;
  for (int row = std::max(0, y - kOccluderStep); row <= std::min(kCells, y + kOccluderStep); ++row)
    for (int column = std::max(0, x - kOccluderStep); column <= std::min(kCells, x + kOccluderStep); ++column)
      steepest = std::max(steepest, slopeOf(mesh.vertices[at(column, row)]));
  return steepest;
}

/// Spacing of neighbouring posts, metres. Beyond the data's edge posts repeat and do not count.
struct Spacing {
  float smallest = std::numeric_limits<float>::max(), largest = 0;
};
Spacing spacingOf(const terrain::TileMesh& mesh) {
  Spacing s;
  const auto see = [&s, &mesh](std::size_t a, std::size_t b) {
    const float d = horizontalDistance(mesh.vertices[a], mesh.vertices[b]);
    if (d <= 0) return;
    s.smallest = std::min(s.smallest, d);
    s.largest = std::max(s.largest, d);
  };
  for (int y = 0; y < kSide; y += kCells)
    for (int x = 0; x < kCells; ++x) {
      see(at(x, y), at(x + 1, y));
      see(at(y, x), at(y, x + 1));
    }
  // Spacing changes by less than 1 % across a tile that is not at a pole.
  return {s.smallest * 0.99f, s.largest * 1.01f};
}

/// Returns the index of a border vertex, counted counter-clockwise from the south-west corner.
std::size_t onRing(int i) {
  constexpr int kEdge = kOccluderSide - 1;
  const int along = i % kEdge;
  const auto index = [](int x, int y) { return static_cast<std::size_t>(y * kOccluderSide + x); };
  switch (i / kEdge % 4) {
    case 0:
      return index(along, 0);
    case 1:
      return index(kEdge, along);
    case 2:
      return index(kEdge - along, kEdge);
    default:
      return index(0, kEdge - along);
  }
}

/// Returns the box of a square of cells, metres from the tile's origin.
Box boxOfCells(const terrain::TileMesh& mesh, int x0, int y0, int cells) {
  Box box = kNoBox;
  for (int y = y0; y <= y0 + cells; ++y)
    for (int x = x0; x <= x0 + cells; ++x) {
      const terrain::TileVertex& v = mesh.vertices[at(x, y)];
      box = united(box, v.x, v.y, v.z);
    }
  return box;
}

void makeParts(const terrain::TileMesh& mesh, TileOccluder& occluder) {
  constexpr int kCellsASide = kCells / kPartsPerSide;
  for (int part = 0; part < kParts; ++part) {
    const int x0 = part % kPartsPerSide * kCellsASide, y0 = part / kPartsPerSide * kCellsASide;
    const Box b = boxOfCells(mesh, x0, y0, kCellsASide);
    occluder.parts[static_cast<std::size_t>(part)] = {{b.minX, b.minY, b.minZ, 0},
                                                      {b.maxX, b.maxY, b.maxZ, 0}};
  }
}

}  // namespace

std::vector<std::uint16_t> makeOccluderIndices() {
  std::vector<std::uint16_t> indices = makeCoarseIndices(kOccluderStep);
  constexpr int kFirst = kOccluderSide * kOccluderSide;
  for (int i = 0; i < kRing; ++i) {
    const int next = (i + 1) % kRing;
    const auto a = static_cast<std::uint16_t>(onRing(i)), b = static_cast<std::uint16_t>(onRing(next));
    const auto low = static_cast<std::uint16_t>(kFirst + i),
               lowNext = static_cast<std::uint16_t>(kFirst + next);
    indices.insert(indices.end(), {low, lowNext, b, low, b, a});
  }
  return indices;
}

void makeOccluder(const terrain::TileMesh& mesh, float slopeMax, TileOccluder& occluder) {
  static_assert(kOccluderStep == 2, "riseOf looks at the 2 x 2 blocks");
  const Spacing spacing = spacingOf(mesh);
  // Slopes of vertices hold for two posts around them (TileVertex::slope); here they are the largest in a
  // triangle's span. The index's slope holds for all of the neighbouring tiles too, but a coarser neighbour's
  // triangle may be 1.42 times steeper than each of the finer ones in it.
  occluder.limits = {2 * spacing.smallest, 0.5f * kCells * spacing.smallest, 1.5f * slopeMax,
                     1.5f * kOccluderStep * spacing.largest};

  Heights low;
  lowestDrawn(mesh, low);
  std::array<float, kOccluderVertices> rise{};
  const auto raise = [&rise](int x, int y, float r) {
    float& most = rise[static_cast<std::size_t>(y / kOccluderStep * kOccluderSide + x / kOccluderStep)];
    most = std::max(most, r);
  };
  for (int y = 0; y < kCells; y += kOccluderStep)
    for (int x = 0; x < kCells; x += kOccluderStep) {
      const CellRise cell = riseOf(mesh, low, x, y);
      const bool southWestToNorthEast = (x + y) / kOccluderStep % 2 == 0;
      const float both = std::max(cell.lower, cell.upper);
      raise(x, y, southWestToNorthEast ? both : cell.lower);
      raise(x + 2, y + 2, southWestToNorthEast ? both : cell.upper);
      raise(x + 2, y, southWestToNorthEast ? cell.lower : both);
      raise(x, y + 2, southWestToNorthEast ? cell.upper : both);
    }

  occluder.vertices.resize(kOccluderVertices);
  for (int y = 0; y < kOccluderSide; ++y)
    for (int x = 0; x < kOccluderSide; ++x) {
      const auto i = static_cast<std::size_t>(y * kOccluderSide + x);
      const terrain::TileVertex& v = mesh.vertices[at(x * kOccluderStep, y * kOccluderStep)];
      const float slope = steepestAround(mesh, x * kOccluderStep, y * kOccluderStep);
      // Posts are not quite on a plane grid, because meridians converge and the earth is round. The
      // difference is below edge^2 / R.
      const float curved = occluder.limits.edge * occluder.limits.edge / 6.3e6f * (1 + slope) + 0.01f;
      occluder.vertices[i] = {v.x, v.y, v.z - rise[i] - curved, slope};
    }
  // Deeper than the borders of neighbours can differ. A wall that reaches lower hides no more than the border
  // above it.
  const float depth = *std::max_element(rise.begin(), rise.end()) + 0.25f * occluder.limits.edge;
  for (int i = 0; i < kRing; ++i) {
    OccluderVertex v = occluder.vertices[onRing(i)];
    v.z -= depth;
    occluder.vertices[static_cast<std::size_t>(kOccluderSide * kOccluderSide + i)] = v;
  }
  makeParts(mesh, occluder);
}

}  // namespace trimtab::scene
