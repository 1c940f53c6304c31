#include "tiles.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "side.h"

namespace trimtab::terrain {

namespace {

constexpr std::uint32_t kTilePosts = 100;
/// Sides keep their posts closer than tiles do: what they are off cannot be mended later, and they are few.
constexpr double kSideShare = 0.9;
constexpr std::size_t kAnyVertices = std::numeric_limits<std::size_t>::max();

}  // namespace

void onThreads(unsigned threads, std::uint32_t count, const std::function<void(std::uint32_t)>& work) {
  std::atomic<std::uint32_t> next{0};
  const auto run = [&] {
    for (std::uint32_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::thread> others;
  for (unsigned i = 1; i < threads && i < count; ++i) others.emplace_back(run);
  run();
  for (std::thread& t : others) t.join();
}

MeshTiles::MeshTiles(const HeightField& field, std::size_t mostTriangles, double nearer, unsigned threads)
    : field_(field), sideShare_(kSideShare * nearer), threads_(threads) {
  const auto count = [](std::uint32_t posts) {
    return std::max(1u, (posts - 1 + kTilePosts / 2) / kTilePosts);
  };
  across_ = count(field.columns);
  up_ = count(field.rows);
  // Sides cost triangles, and few triangles have none to spare.
  while (mostTriangles != 0 && std::size_t{across_} * up_ * 50 > mostTriangles && (across_ > 1 || up_ > 1)) {
    across_ = (across_ + 1) / 2;
    up_ = (up_ + 1) / 2;
  }
  const auto lines = [](std::uint32_t posts, std::uint32_t parts) {
    std::vector<std::uint32_t> at(parts + 1);
    for (std::uint32_t i = 0; i <= parts; ++i)
      at[i] = static_cast<std::uint32_t>(std::uint64_t{posts - 1} * i / parts);
    return at;
  };
  columns_ = lines(field.columns, across_);
  rows_ = lines(field.rows, up_);
  for (std::uint32_t j = 0; j <= up_; ++j)
    for (std::uint32_t i = 0; i < across_; ++i)
      sides_.push_back({{columns_[i], rows_[j]}, {columns_[i + 1], rows_[j]}, {}});
  for (std::uint32_t j = 0; j < up_; ++j)
    for (std::uint32_t i = 0; i <= across_; ++i)
      sides_.push_back({{columns_[i], rows_[j]}, {columns_[i], rows_[j + 1]}, {}});
  for (Side& side : sides_) {
    const bool flat = side.from.row == side.to.row;
    sideKeys(field.z + side.from.row * field.stride + side.from.column,
             flat ? 1 : static_cast<std::ptrdiff_t>(field.stride),
             flat ? side.to.column - side.from.column : side.to.row - side.from.row, 0, side.key);
  }
  tiles_.resize(std::size_t{across_} * up_);
  for (std::uint32_t j = 0; j < up_; ++j)
    for (std::uint32_t i = 0; i < across_; ++i) {
      Tile& tile = tiles_[std::size_t{j} * across_ + i];
      const std::uint32_t sides[4] = {horizontal(i, j), vertical(i + 1, j), horizontal(i, j + 1),
                                      vertical(i, j)};
      std::copy(sides, sides + 4, tile.sides);
    }
}

void MeshTiles::begin(Tile& tile, double tolerance) {
  std::vector<PolygonMesher::Point> border;
  std::int32_t count = 0;
  for (int s = 0; s < 4; ++s) {
    const Side& side = sides_[tile.sides[s]];
    const auto last = static_cast<std::int32_t>(side.key.size()) - 1;
    tile.vertex[s].assign(side.key.size(), -1);
    for (std::int32_t i = 0; i < last; ++i) {
      // South and east run as the side does, north and west against it; the far end is the next side's.
      const std::int32_t k = s < 2 ? i : last - i;
      if (i != 0 && !(side.key[static_cast<std::size_t>(k)] > sideShare_ * tolerance)) continue;
      const auto along = static_cast<std::uint32_t>(k);
      border.push_back(s % 2 == 0 ? PolygonMesher::Point{side.from.column + along, side.from.row}
                                  : PolygonMesher::Point{side.from.column, side.from.row + along});
      tile.vertex[s][along] = count++;
    }
  }
  // Corners by the sides that end there.
  tile.vertex[0].back() = tile.vertex[1].front();
  tile.vertex[1].back() = tile.vertex[2].back();
  tile.vertex[2].front() = tile.vertex[3].back();
  tile.vertex[3].front() = tile.vertex[0].front();
  tile.mesh.begin(field_, border);
}

void MeshTiles::addSides(Tile& tile, double tolerance) {
  for (int s = 0; s < 4; ++s) {
    const Side& side = sides_[tile.sides[s]];
    std::vector<std::int32_t>& vertex = tile.vertex[s];
    for (std::size_t k = 1; k + 1 < side.key.size(); ++k) {
      if (!(side.key[k] > sideShare_ * tolerance) || side.key[k] > sideShare_ * tile.tolerance) continue;
      std::size_t from = k;
      do from = s < 2 ? from - 1 : from + 1;
      while (vertex[from] < 0);
      const auto along = static_cast<std::uint32_t>(k);
      vertex[k] = static_cast<std::int32_t>(
          tile.mesh.addBorder(static_cast<std::uint32_t>(vertex[from]),
                              s % 2 == 0 ? PolygonMesher::Point{side.from.column + along, side.from.row}
                                         : PolygonMesher::Point{side.from.column, side.from.row + along}));
    }
  }
}

void MeshTiles::refine(double tolerance) {
  onThreads(threads_, static_cast<std::uint32_t>(tiles_.size()), [&](std::uint32_t index) {
    Tile& tile = tiles_[index];
    if (!tile.taken) return;
    if (!(tile.tolerance >= tolerance))
      begin(tile, tolerance);
    else
      addSides(tile, tolerance);
    tile.mesh.refine(tolerance, kAnyVertices);
    tile.tolerance = tolerance;
  });
}

void MeshTiles::add(std::size_t most, double bound) {
  const std::size_t before = triangles();
  std::vector<double> errors;
  for (const Tile& tile : tiles_)
    for (const double error : tile.mesh.errors())
      if (error > 0) errors.push_back(error);
  if (before >= most || errors.empty()) return;
  const std::size_t vertices = (most - before) / 2;
  const std::size_t nth = std::min(vertices, errors.size() - 1);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(nth), errors.end(),
                   std::greater<>());
  const double least = errors[nth];
  // Each tile gets as many as it has of the worst, and takes its own worst first. A post that is inserted can
  // leave others further off than it was; they are seen to at once, and a tile ends early where that takes
  // too many.
  std::vector<std::size_t> shares;
  std::size_t left = vertices;
  for (const Tile& tile : tiles_) {
    std::size_t wanted = 0;
    for (const double error : tile.mesh.errors()) wanted += error >= least;
    shares.push_back(std::min(wanted, left));
    left -= shares.back();
  }
  onThreads(threads_, static_cast<std::uint32_t>(tiles_.size()), [&](std::uint32_t index) {
    GreedyMesh& mesh = tiles_[index].mesh;
    const std::size_t had = mesh.points().size();
    const GreedyMesh kept = mesh;
    for (std::size_t share = shares[index]; share > 0; share /= 2) {
      mesh.refine(0, had + share);
      mesh.refine(bound, kAnyVertices);
      if (mesh.points().size() <= had + shares[index]) break;
      mesh = kept;
    }
  });
}

double MeshTiles::take(bool sample) {
  std::size_t taken = 0;
  for (std::size_t index = 0; index < tiles_.size(); ++index) {
    Tile& tile = tiles_[index];
    tile.taken = !sample || tiles_.size() < 32 || (index % across_ + 3 * (index / across_)) % 8 == 0;
    taken += tile.taken;
  }
  return static_cast<double>(taken) / static_cast<double>(tiles_.size());
}

std::size_t MeshTiles::triangles() const {
  std::size_t count = 0;
  for (const Tile& tile : tiles_)
    if (tile.taken) count += tile.mesh.mesh().triangles.size();
  return count;
}

double MeshTiles::maxErrorM() const {
  double worst = 0;
  for (const Tile& tile : tiles_) worst = std::max(worst, tile.mesh.maxErrorM());
  return worst;
}

void MeshTiles::eachTile(const std::function<void(GreedyMesh&, std::size_t)>& work) {
  onThreads(threads_, static_cast<std::uint32_t>(tiles_.size()), [&](std::uint32_t i) {
    work(tiles_[i].mesh, i);
    tiles_[i].tolerance = kNotBegun;
  });
}

Triangulation MeshTiles::join() const {
  constexpr std::int32_t kUnused = -2;
  Triangulation out;
  std::size_t vertices = 0, triangles = 0;
  for (const Tile& tile : tiles_) {
    vertices += tile.mesh.mesh().vertices.size();
    triangles += tile.mesh.mesh().triangles.size();
  }
  out.vertices.reserve(vertices);
  out.triangles.reserve(triangles);

  std::vector<std::vector<std::int32_t>> sideVertex(sides_.size());
  std::vector<std::int32_t> firstTriangle;
  std::vector<std::int32_t> corners(std::size_t{across_ + 1} * (up_ + 1), -1);
  for (std::size_t index = 0; index < tiles_.size(); ++index) {
    const Tile& tile = tiles_[index];
    const Triangulation& mesh = tile.mesh.mesh();
    const auto i = static_cast<std::uint32_t>(index % across_),
               j = static_cast<std::uint32_t>(index / across_);
    std::vector<std::int32_t> of(mesh.vertices.size(), kUnused);
    for (const Triangulation::Triangle& one : mesh.triangles)
      for (const std::uint32_t v : one.corner) of[v] = -1;
    // What another tile has brought already: along sides, then at corners.
    for (int s = 0; s < 4; ++s) {
      const std::vector<std::int32_t>& theirs = sideVertex[tile.sides[s]];
      for (std::size_t k = 0; k < theirs.size(); ++k)
        if (theirs[k] >= 0) of[static_cast<std::size_t>(tile.vertex[s][k])] = theirs[k];
    }
    const std::size_t corner[4] = {std::size_t{j} * (across_ + 1) + i, std::size_t{j} * (across_ + 1) + i + 1,
                                   std::size_t{j + 1} * (across_ + 1) + i + 1,
                                   std::size_t{j + 1} * (across_ + 1) + i};
    const std::int32_t cornerVertex[4] = {tile.vertex[0].front(), tile.vertex[0].back(),
                                          tile.vertex[2].back(), tile.vertex[2].front()};
    for (int k = 0; k < 4; ++k)
      if (corners[corner[k]] >= 0) of[static_cast<std::size_t>(cornerVertex[k])] = corners[corner[k]];
    for (std::size_t v = 0; v < of.size(); ++v) {
      if (of[v] != -1) continue;
      of[v] = static_cast<std::int32_t>(out.vertices.size());
      Triangulation::Vertex place = mesh.vertices[v];
      place.x += static_cast<std::int32_t>(tile.mesh.origin().column);
      place.y += static_cast<std::int32_t>(tile.mesh.origin().row);
      out.vertices.push_back(place);
    }
    for (int k = 0; k < 4; ++k) corners[corner[k]] = of[static_cast<std::size_t>(cornerVertex[k])];
    for (int s = 0; s < 4; ++s) {
      std::vector<std::int32_t>& mine = sideVertex[tile.sides[s]];
      if (!mine.empty()) continue;
      mine = tile.vertex[s];
      for (std::int32_t& v : mine)
        if (v >= 0) v = of[static_cast<std::size_t>(v)];
    }
    const auto base = static_cast<std::int32_t>(out.triangles.size());
    firstTriangle.push_back(base);
    for (Triangulation::Triangle one : mesh.triangles) {
      for (std::uint32_t& v : one.corner) v = static_cast<std::uint32_t>(of[v]);
      for (std::int32_t& h : one.twin) h = h < 0 ? -1 : h + 4 * base;
      out.triangles.push_back(one);
    }
  }
  // Across sides; what stays open is the border of the field.
  out.borderEdge.assign(out.vertices.size(), -1);
  const auto edge = [&](std::size_t tile, int s, std::size_t k) {
    const Tile& at = tiles_[tile];
    const auto v = static_cast<std::size_t>(at.vertex[s][k]);
    return at.mesh.mesh().borderEdge[v] + 4 * firstTriangle[tile];
  };
  for (std::size_t index = 0; index < tiles_.size(); ++index)
    for (int s = 0; s < 4; ++s) {
      const std::size_t i = index % across_, j = index / across_;
      const bool outer = s == 0 ? j == 0 : s == 1 ? i + 1 == across_ : s == 2 ? j + 1 == up_ : i == 0;
      const std::vector<std::int32_t>& vertex = tiles_[index].vertex[s];
      if (!outer && (s == 0 || s == 3)) continue;  // the neighbour sees to it
      std::size_t before = 0;
      for (std::size_t k = 1; k < vertex.size(); ++k) {
        if (vertex[k] < 0) continue;
        const std::size_t leaves = s < 2 ? before : k, arrives = s < 2 ? k : before;
        const std::int32_t mine = edge(index, s, leaves);
        if (outer) {
          out.link(mine, ~static_cast<std::int32_t>(
                             out.triangles[static_cast<std::size_t>(mine >> 2)].corner[mine & 3]));
        } else {
          const std::size_t other = s == 1 ? index + 1 : index + across_;
          out.link(mine, edge(other, s == 1 ? 3 : 0, arrives));
        }
        before = k;
      }
    }
  return out;
}

}  // namespace trimtab::terrain
