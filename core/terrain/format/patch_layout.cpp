#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "trimtab/frame/box_union.h"
#include "trimtab/terrain/format/patch_layout.h"
#include "trimtab/terrain/format/patch_shape.h"

namespace trimtab::terrain {

namespace {

constexpr std::uint32_t kNone = PatchIndex::kNone;
static_assert(kCoarseLeafCells <= TerrainIndex::kTileCells);
constexpr std::uint32_t kLargestRoot = 1u << 15;  ///< columns of vertices are counted in 16 bits

struct Corner {
  std::int64_t column, row;
  int side;  ///< of the edge that leaves it
};

/// Keeps what is at most `last` along an axis. Edges run along axes and diagonals, so crossings are posts.
void cut(std::vector<Corner>& polygon, std::int64_t Corner::*axis, std::int64_t Corner::*other,
         std::int64_t last) {
  std::vector<Corner> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const auto crossing = [&](int side) {
      Corner c{};
      const std::int64_t along = std::abs(b.*axis - a.*axis), step = std::abs(last - a.*axis);
      c.*axis = last;
      c.*other = a.*other + (b.*other - a.*other) / along * step;
      c.side = side;
      return c;
    };
    if (a.*axis <= last) {
      kept.push_back(a);
      if (b.*axis > last) {
        if (a.*axis == last)
          kept.back().side = PatchEdge::kDataEdge;
        else
          kept.push_back(crossing(PatchEdge::kDataEdge));
      }
    } else if (b.*axis < last) {
      kept.push_back(crossing(a.side));
    }
  }
  polygon = std::move(kept);
}

std::array<Corner, 3> corners(const PatchIndex& index, const PatchPlace& place) {
  const std::int64_t s = index.squareCells(place.pair);
  const std::int64_t west = place.column * s, south = place.row * s;
  const int depth = place.depth();
  // Hypotenuse from the first to the second; the third is the right angle. Legs are hypotenuses of the next.
  const auto at = [&](int c, int r, int side) { return Corner{west + c * s / 2, south + r * s / 2, side}; };
  const auto triangle = [&](int pc, int pr, int qc, int qr, int ac, int ar) {
    return std::array{at(pc, pr, depth), at(qc, qr, depth + 1), at(ac, ar, depth + 1)};
  };
  const bool diagonal = southWestDiagonal(place.column, place.row);
  switch (place.part) {
    case 0:
      return diagonal ? triangle(2, 2, 0, 0, 2, 0) : triangle(2, 0, 0, 2, 0, 0);
    case 1:
      return diagonal ? triangle(0, 0, 2, 2, 0, 2) : triangle(0, 2, 2, 0, 2, 2);
    case 2:
      return triangle(0, 0, 2, 0, 1, 1);
    case 3:
      return triangle(2, 0, 2, 2, 1, 1);
    case 4:
      return triangle(2, 2, 0, 2, 1, 1);
    default:
      return triangle(0, 2, 0, 0, 1, 1);
  }
}

/// Reports whether floats in 1/256 m reach all of a square from its middle, whichever way it is turned in the
/// frame.
bool reaches(const PostGrid& posts, const PostGeometry& geometry, std::uint32_t column, std::uint32_t row,
             std::uint32_t cells) {
  constexpr std::uint32_t kSamples = 4;  // a side: the ground between bends by metres
  constexpr double kMarginM = 500;       // for that bend, and for where the origin is rounded to
  constexpr double kHeights[] = {-11000, 9000};
  constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max();
  PostGeometry::Lattice low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
  for (std::uint32_t j = 0; j <= kSamples; ++j)
    for (std::uint32_t i = 0; i <= kSamples; ++i)
      for (const double height : kHeights) {
        const PostGeometry::Lattice p =
            geometry.lattice(std::min(row + cells / kSamples * j, posts.rows - 1),
                             std::min(column + cells / kSamples * i, posts.columns - 1), height);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
  const std::int64_t widest = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  return static_cast<double>(widest) / 2 / PostGeometry::kStepsPerMetre + kMarginM <= PostGeometry::kReachM;
}

/// Root squares are as large as floats reach. Posts of the smallest squares are rounded by PostGeometry so
/// that they always do: its finest tiles are no smaller.
std::uint32_t largestRoot(const PostGrid& posts, const PostGeometry& geometry, std::uint32_t leafCells) {
  const std::uint32_t most = std::max(posts.columns, posts.rows) - 1;
  std::uint32_t cells = leafCells;
  while (cells < most && cells < kLargestRoot) cells *= 2;
  const auto allReach = [&] {
    for (std::uint32_t row = 0; row + 1 < posts.rows; row += cells)
      for (std::uint32_t column = 0; column + 1 < posts.columns; column += cells)
        if (!reaches(posts, geometry, column, row, cells)) return false;
    return true;
  };
  while (cells > leafCells && !allReach()) cells /= 2;
  return cells;
}

}  // namespace

int pairs(const PatchIndex& index) {
  return std::countr_zero(index.rootCells) - std::countr_zero(index.leafCells) + 1;
}

std::uint32_t squaresAlong(const PatchIndex& index, int pair, std::uint32_t posts) {
  const std::uint32_t s = index.squareCells(pair);
  return (posts - 2) / s + 1;
}

std::vector<PatchEdge> patchEdges(const PatchIndex& index, const PatchPlace& place) {
  const auto whole = corners(index, place);
  std::vector<Corner> polygon(whole.begin(), whole.end());
  cut(polygon, &Corner::column, &Corner::row, index.columns - 1);
  cut(polygon, &Corner::row, &Corner::column, index.rows - 1);
  std::vector<PatchEdge> edges;
  std::int64_t area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    area += a.column * b.row - a.row * b.column;
    if (a.column != b.column || a.row != b.row)
      edges.push_back({{static_cast<std::uint32_t>(a.column), static_cast<std::uint32_t>(a.row)},
                       {static_cast<std::uint32_t>(b.column), static_cast<std::uint32_t>(b.row)},
                       a.side});
  }
  if (area == 0) edges.clear();
  return edges;
}

PatchPlace parentOf(const PatchPlace& place) {
  enum { kSouth = 2, kEast, kNorth, kWest };
  const bool diagonal = southWestDiagonal(place.column, place.row);
  if (place.part >= 2) {
    const bool first = place.part == kSouth || place.part == (diagonal ? kEast : kWest);
    return {place.pair, place.column, place.row, first ? 0 : 1};
  }
  // Its right angle is the middle of a side of the square that this one is a quarter of.
  const bool east = place.column % 2 == 1, north = place.row % 2 == 1;
  int part;
  if (east == north)
    part = place.part == 0 ? (east ? kEast : kSouth) : (east ? kNorth : kWest);
  else
    part = place.part == 0 ? (east ? kSouth : kWest) : (east ? kEast : kNorth);
  return {place.pair - 1, place.column / 2, place.row / 2, part};
}

bool acrossHypotenuse(const PatchIndex& index, const PatchPlace& place, PatchPlace& other) {
  other = place;
  switch (place.part) {
    case 0:
    case 1:
      other.part = 1 - place.part;
      return true;
    case 2:
      other.part = 4;
      return other.row-- > 0;
    case 3:
      other.part = 5;
      return ++other.column < squaresAlong(index, place.pair, index.columns);
    case 4:
      other.part = 2;
      return ++other.row < squaresAlong(index, place.pair, index.rows);
    default:
      other.part = 3;
      return other.column-- > 0;
  }
}

std::vector<PatchPlace> placesOfPage(const PatchIndex& index, const PatchIndex::Page& page) {
  const std::uint32_t k = index.pageSquares();
  std::vector<PatchPlace> places;
  const std::uint32_t columns = squaresAlong(index, page.pair, index.columns),
                      rows = squaresAlong(index, page.pair, index.rows), s = index.squareCells(page.pair);
  for (std::uint32_t r = page.row * k; r < std::min(rows, (page.row + 1) * k); ++r)
    for (std::uint32_t c = page.column * k; c < std::min(columns, (page.column + 1) * k); ++c) {
      const bool inside = (c + 1) * s < index.columns && (r + 1) * s < index.rows;
      for (int part = 0; part < kPatchParts; ++part) {
        const PatchPlace place{page.pair, c, r, part};
        if (inside || !patchEdges(index, place).empty()) places.push_back(place);
      }
    }
  return places;
}

std::uint32_t leafCellsOf(const PostGrid& posts, std::uint64_t mostFine) {
  const auto squares = [](std::uint32_t along) { return (std::uint64_t{along} - 2) / kFineLeafCells + 1; };
  return squares(posts.columns) * squares(posts.rows) <= mostFine ? kFineLeafCells : kCoarseLeafCells;
}

/// Variants lie in the half octave between a depth and the one above. Two of them, of which the coarser spans
/// two thirds of it, serve squares of 16 cells: a third, all a quarter of an octave apart, takes 2 % off a
/// view at 1 px and 4 % at 2 px, for two fifths more triangles to build, store and hold. With squares of 32
/// cells fewer patches share a view, and it takes 1.24 times the triangles of an unconstrained mesh at 1 px
/// and 1.44 times at 2 px (Everest) instead of 1.28 and 1.51: a third is worth its room there. A fifth of an
/// octave apart they take 1.22 and 1.44 times, with 2 % more to hold; a third of an octave apart 1.27
/// and 1.45. A fourth takes nothing off at 1 px and 1.5 % at 2 px, for a quarter more.
PatchVariants variantsOf(std::uint32_t leafCells) {
  return leafCells <= kFineLeafCells ? PatchVariants{2, 1.0 / 3} : PatchVariants{3, 0.25};
}

PatchIndex makePatchIndex(const PostGrid& posts, const PostGeometry& geometry, std::uint32_t leafCells) {
  PatchIndex index;
  index.frame = geometry.frame();
  index.columns = posts.columns;
  index.rows = posts.rows;
  index.rootCells = largestRoot(posts, geometry, leafCells);
  index.leafCells = leafCells;

  // These list the patches of a pair and of the one before, by square and part.
  std::vector<std::uint32_t> before, now;
  std::uint32_t columnsBefore = 0;
  const auto makeDiamonds = [&](std::uint32_t first, const std::vector<PatchPlace>& places, int half) {
    const std::uint32_t columns = squaresAlong(index, places.front().pair, posts.columns);
    const auto find = [&](const PatchPlace& at) {
      return now[(std::size_t{at.row} * columns + at.column) * kPatchParts + static_cast<unsigned>(at.part)];
    };
    for (std::uint32_t i = 0; i < places.size(); ++i) {
      const std::uint32_t patch = first + i;
      if (places[i].depth() % 2 != half || index.diamond[patch] != kNone) continue;
      PatchIndex::Diamond diamond;
      diamond.patches[0] = patch;
      PatchPlace other;
      if (acrossHypotenuse(index, places[i], other)) diamond.patches[1] = find(other);
      for (std::size_t k = 0; k < 2; ++k) {
        const std::uint32_t p = diamond.patches[k];
        if (p == kNone) continue;
        index.diamond[p] = static_cast<std::uint32_t>(index.diamonds.size());
        if (index.parent[p] != kNone) diamond.parents[k] = index.diamond[index.parent[p]];
      }
      index.diamonds.push_back(diamond);
    }
  };

  for (int pair = 0; pair < pairs(index); ++pair) {
    const std::uint32_t k = index.pageSquares();
    const std::uint32_t columns = squaresAlong(index, pair, posts.columns),
                        rows = squaresAlong(index, pair, posts.rows);
    now.assign(std::size_t{columns} * rows * kPatchParts, kNone);
    const auto first = static_cast<std::uint32_t>(index.depth.size());
    std::vector<PatchPlace> all;
    for (std::uint32_t row = 0; row < (rows + k - 1) / k; ++row)
      for (std::uint32_t column = 0; column < (columns + k - 1) / k; ++column) {
        PatchIndex::Page page;
        page.firstPatch = static_cast<std::uint32_t>(index.depth.size());
        page.pair = static_cast<std::uint8_t>(pair);
        page.row = row;
        page.column = column;
        for (const PatchPlace& place : placesOfPage(index, page)) {
          const auto patch = static_cast<std::uint32_t>(index.depth.size());
          now[(std::size_t{place.row} * columns + place.column) * kPatchParts +
              static_cast<unsigned>(place.part)] = patch;
          std::uint32_t parent = kNone;
          if (place.part >= 2 || pair > 0) {
            const PatchPlace up = parentOf(place);
            parent = place.part >= 2
                         ? now[(std::size_t{up.row} * columns + up.column) * kPatchParts +
                               static_cast<unsigned>(up.part)]
                         : before[(std::size_t{up.row} * columnsBefore + up.column) * kPatchParts +
                                  static_cast<unsigned>(up.part)];
          }
          if (parent != kNone) {
            auto& children = index.children[parent];
            children[children[0] == kNone ? 0 : 1] = patch;
          }
          index.depth.push_back(static_cast<std::uint8_t>(place.depth()));
          index.parent.push_back(parent);
          index.children.push_back({kNone, kNone});
          index.diamond.push_back(kNone);
          index.page.push_back(static_cast<std::uint32_t>(index.pages.size()));
          all.push_back(place);
        }
        page.patches = static_cast<std::uint32_t>(index.depth.size()) - page.firstPatch;
        index.pages.push_back(page);
      }
    // Both depths of a pair are made in turn: parents before children.
    makeDiamonds(first, all, 0);
    makeDiamonds(first, all, 1);
    before.swap(now);
    columnsBefore = columns;
  }
  index.bounds.resize(index.depth.size());
  const std::size_t variants = variantsOf(leafCells).count;
  index.errorM = VariantTable<float>(variants, index.depth.size());
  index.triangles = VariantTable<std::uint16_t>(variants, index.depth.size());
  return index;
}

std::vector<double> patchTolerances(const PatchIndex& index, double leafM) {
  const int depths = 2 * pairs(index);
  std::vector<double> tolerances;
  for (int depth = 0; depth < depths; ++depth)
    tolerances.push_back(leafM * std::exp2((depths - 1 - depth) / 2.0));
  return tolerances;
}

double defaultLeafToleranceM(const PostGrid& posts) {
  constexpr double kDegreeM = 111320;
  return posts.stepLatitude * kDegreeM / 10;
}

void countTriangles(const PatchMesh& mesh, std::span<std::uint16_t> triangles) {
  for (std::size_t v = 0; v < triangles.size(); ++v)
    triangles[v] = static_cast<std::uint16_t>((mesh.firstIndex[v + 1] - mesh.firstIndex[v]) / 3);
}

void finishPatchIndex(PatchIndex& index, std::vector<Box> ownBounds, VariantTable<float> ownErrorM,
                      VariantTable<std::uint16_t> triangles) {
  index.bounds = std::move(ownBounds);
  index.errorM = std::move(ownErrorM);
  index.triangles = std::move(triangles);
  for (std::size_t patch = index.size(); patch-- > 0;) {
    const std::span<float> errors = index.errorM[patch];
    for (std::size_t v = 1; v < errors.size(); ++v) errors[v] = std::max(errors[v], errors[v - 1]);
    const std::uint32_t parent = index.parent[patch];
    if (parent == kNone) continue;
    index.bounds[parent] = united(index.bounds[parent], index.bounds[patch]);
    for (std::size_t v = 0; v < errors.size(); ++v)
      index.errorM[parent][v] = std::max(index.errorM[parent][v], errors[v]);
  }
}

}  // namespace trimtab::terrain
