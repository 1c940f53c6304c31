#include "mesher_bench.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support.h"
#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/mesh/mesher.h"

namespace trimtab::bench {
namespace {

using namespace terrain;

/// What the greedy Delaunay mesher github.com/fogleman/hmm makes of the same posts with a tenth or a
/// hundredth of the triangles, measured once, outside of this program. Its speed is the one that its author
/// publishes.
struct Greedy {
  double maxM, rmsM, trianglesPerSecond;
};

struct Land {
  std::string id, name;
  std::uint32_t columns = 0, rows = 0;
  std::vector<float> z;
  Greedy tenth, hundredth;
  double postM = 30;
  HeightField field() const { return {z.data(), columns, rows, columns}; }
};

/// Fractal ground by midpoint displacement; half as large a step is lower by 2^-0.8.
Land fractalLand(std::uint32_t size) {
  constexpr int kSide = 2048, kPosts = kSide + 1;
  std::vector<double> z(std::size_t{kPosts} * kPosts, 0.0);
  const auto at = [&](int x, int y) -> double& {
    return z[static_cast<std::size_t>(y) * kPosts + static_cast<std::size_t>(x)];
  };
  const auto noise = [](int x, int y, std::uint32_t seed) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9e3779b1u ^
                      static_cast<std::uint32_t>(y) * 0x85ebca77u ^ seed * 0xc2b2ae3du;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return static_cast<double>(h ^ (h >> 15)) / 4294967296.0 - 0.5;
  };
  double high = 3000;
  for (int step = kSide; step > 1; step /= 2, high *= std::pow(0.5, 0.8)) {
    const int half = step / 2;
    for (int y = half; y < kPosts; y += step)
      for (int x = half; x < kPosts; x += step)
        at(x, y) = (at(x - half, y - half) + at(x + half, y - half) + at(x - half, y + half) +
                    at(x + half, y + half)) /
                       4 +
                   high * noise(x, y, 1);
    for (int y = 0; y < kPosts; y += half)
      for (int x = y / half % 2 != 0 ? 0 : half; x < kPosts; x += step) {
        double sum = 0;
        int count = 0;
        for (const auto& [dx, dy] : {std::pair{-half, 0}, {half, 0}, {0, -half}, {0, half}}) {
          if (x + dx < 0 || x + dx >= kPosts || y + dy < 0 || y + dy >= kPosts) continue;
          sum += at(x + dx, y + dy);
          ++count;
        }
        at(x, y) = sum / count + high * std::pow(0.5, 0.4) * noise(x, y, 2);
      }
  }
  Land land{"fractal", "fractal ground", size, size, {}, {8.424, 3.314, 8e6}, {23.561, 7.653, 28e6}};
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x)
      land.z.push_back(static_cast<float>(at(static_cast<int>(x), static_cast<int>(y))));
  return land;
}

/// Cuts off rows and columns, those with the most voids first, until none is left: about a raster that stands
/// askew on the grid.
void cutVoids(Land& land) {
  struct Edge {
    std::uint32_t firstColumn, endColumn, firstRow, endRow;
    std::size_t posts() const { return std::size_t{endColumn - firstColumn} * (endRow - firstRow); }
  };
  const auto voids = [&](const Edge& of) {
    std::size_t count = 0;
    for (std::uint32_t y = of.firstRow; y < of.endRow; ++y)
      for (std::uint32_t x = of.firstColumn; x < of.endColumn; ++x)
        count += std::isnan(land.z[std::size_t{y} * land.columns + x]);
    return count;
  };
  Edge all{0, land.columns, 0, land.rows};
  while (all.posts() > 0 && voids(all) > 0) {
    const auto [west, east, south, north] = all;
    const std::pair<Edge, Edge> cuts[] = {{{west, west + 1, south, north}, {west + 1, east, south, north}},
                                          {{east - 1, east, south, north}, {west, east - 1, south, north}},
                                          {{west, east, south, south + 1}, {west, east, south + 1, north}},
                                          {{west, east, north - 1, north}, {west, east, south, north - 1}}};
    const auto share = [&](const std::pair<Edge, Edge>& cut) {
      return static_cast<double>(voids(cut.first)) / static_cast<double>(cut.first.posts());
    };
    all = std::max_element(std::begin(cuts), std::end(cuts), [&](const auto& a, const auto& b) {
            return share(a) < share(b);
          })->second;
  }
  std::vector<float> z;
  for (std::uint32_t y = all.firstRow; y < all.endRow; ++y) {
    const auto row = land.z.begin() + static_cast<std::ptrdiff_t>(std::size_t{y} * land.columns);
    z.insert(z.end(), row + all.firstColumn, row + all.endColumn);
  }
  land.z = std::move(z);
  land.columns = all.endColumn - all.firstColumn;
  land.rows = all.endRow - all.firstRow;
}

bool readLand(Land& land, const std::string& file) {
  const auto path = test::sharedDir() / file;
  if (!std::filesystem::exists(path)) return false;
  const std::vector<std::filesystem::path> sources{path};
  auto source = openElevation(sources);
  if (!source) return false;
  land.columns = (*source)->posts().columns;
  land.rows = (*source)->posts().rows;
  land.z.resize(std::size_t{land.columns} * land.rows);
  if (!(*source)->readRows(0, land.rows, land.z)) return false;
  cutVoids(land);
  return land.columns > 1 && land.rows > 1;
}

struct Errors {
  double maxM = 0, rmsM = 0;
};
/// A vertex of either mesh: a post and its height.
struct MeshVertex {
  std::uint32_t column, row;
  float z;
};

/// Returns the errors at every post, computed by areas. Where a mesh lies over itself its nearer part counts.
Errors errorsOf(const Land& land, const std::vector<MeshVertex>& vertices,
                const std::vector<unsigned>& indices) {
  std::vector<double> off(land.z.size(), HUGE_VAL);
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const MeshVertex p[3] = {vertices[indices[i]], vertices[indices[i + 1]], vertices[indices[i + 2]]};
    const auto turn = [](const MeshVertex& a, const MeshVertex& b, std::int64_t x, std::int64_t y) {
      return (std::int64_t{b.column} - a.column) * (y - a.row) -
             (std::int64_t{b.row} - a.row) * (x - a.column);
    };
    const std::int64_t whole = turn(p[0], p[1], p[2].column, p[2].row), sign = whole < 0 ? -1 : 1;
    if (whole == 0) continue;
    const auto [x0, x1] = std::minmax({p[0].column, p[1].column, p[2].column});
    const auto [y0, y1] = std::minmax({p[0].row, p[1].row, p[2].row});
    for (std::uint32_t y = y0; y <= y1; ++y)
      for (std::uint32_t x = x0; x <= x1; ++x) {
        const std::int64_t a = sign * turn(p[1], p[2], x, y), b = sign * turn(p[2], p[0], x, y),
                           c = sign * turn(p[0], p[1], x, y);
        if (a < 0 || b < 0 || c < 0) continue;
        const std::size_t at = std::size_t{y} * land.columns + x;
        const double z = (static_cast<double>(a) * p[0].z + static_cast<double>(b) * p[1].z +
                          static_cast<double>(c) * p[2].z) /
                         static_cast<double>(sign * whole);
        off[at] = std::min(off[at], std::fabs(z - land.z[at]));
      }
  }
  Errors errors;
  double sum = 0;
  std::size_t posts = 0;
  for (const double d : off) {
    if (d == HUGE_VAL) continue;
    ++posts;
    sum += d * d;
    errors.maxM = std::max(errors.maxM, d);
  }
  errors.rmsM = std::sqrt(sum / static_cast<double>(posts));
  return errors;
}

/// Returns the field's outline, anticlockwise, its sides simplified to `tolerance`.
std::vector<PostPlace> outlineOf(const Land& land, double tolerance) {
  const std::uint32_t x = land.columns - 1, y = land.rows - 1;
  const PostPlace corners[] = {{0, 0}, {x, 0}, {x, y}, {0, y}};
  std::vector<PostPlace> border, side;
  for (std::size_t i = 0; i < 4; ++i) {
    simplifySide(land.field(), corners[i], corners[(i + 1) % 4], tolerance, side);
    border.insert(border.end(), side.begin(), side.end() - 1);
  }
  return border;
}

void compare(Report& report, const Land& land, std::size_t part, const Greedy& greedy) {
  const std::size_t whole = 2 * std::size_t{land.columns - 1} * (land.rows - 1), most = whole / part;
  std::vector<MeshVertex> posts;
  std::vector<float> places;
  for (std::uint32_t y = 0; y < land.rows; ++y)
    for (std::uint32_t x = 0; x < land.columns; ++x) {
      posts.push_back({x, y, land.field().at(x, y)});
      for (const double v : {x * land.postM, y * land.postM, static_cast<double>(posts.back().z)})
        places.push_back(static_cast<float>(v));
    }
  std::vector<unsigned> indices;
  for (std::uint32_t y = 0; y + 1 < land.rows; ++y)
    for (std::uint32_t x = 0; x + 1 < land.columns; ++x) {
      const unsigned a = y * land.columns + x, c = a + land.columns;
      for (const unsigned v : {a, a + 1, c, a + 1, c + 1, c}) indices.push_back(v);
    }
  std::vector<unsigned> theirs(indices.size());
  std::size_t left = 0;
  const std::vector<PostPlace> border = outlineOf(land, greedy.maxM);
  PolygonMesher mesher;
  const auto mesh = [&] {
    mesher.begin(land.field(), border);
    mesher.refine(greedy.maxM, posts.size());
  };
  mesh();
  std::vector<std::uint32_t> ours;
  mesher.triangles(ours);
  const int turns = report.quick() ? 1 : 3;
  const auto [seconds, theirSeconds] =
      leastInTurn(turns, std::pair{2, mesh},
                  std::pair{1, [&] {
                              left = meshopt_simplify(theirs.data(), indices.data(), indices.size(),
                                                      places.data(), posts.size(), 3 * sizeof(float),
                                                      ours.size(), 1.0f, meshopt_SimplifyLockBorder, nullptr);
                            }});
  theirs.resize(left);
  std::vector<MeshVertex> vertices;
  for (const PostPlace& p : mesher.vertices())
    vertices.push_back({p.column, p.row, land.field().at(p.column, p.row)});
  const Errors our = errorsOf(land, vertices, ours), their = errorsOf(land, posts, theirs);
  const double count = static_cast<double>(whole);
  const std::string id = "terrain.mesh_" + land.id + "_" + std::to_string(100 / part);
  const std::string from = land.name + ", " + std::to_string(whole) + " to " +
                           std::to_string(ours.size() / 3) + " triangles (theirs " +
                           std::to_string(left / 3) + ")";
  const std::string quoted = land.name + " to " + std::to_string(100 / part) + " %";
  report.add(ratioAtLeast(part == 10 ? 5 : 15, {.id = id + "_rate",
                                                .what = "Meshing " + from + ", one core",
                                                .value = count / seconds,
                                                .unit = "triangles/s",
                                                .peer = "meshopt_simplify",
                                                .peerValue = count / theirSeconds,
                                                .peerFrom = "run"}));
  report.add(ratioAtMost(1.0 / 3, {.id = id + "_max",
                                   .what = "Largest error at a post, " + from,
                                   .value = our.maxM,
                                   .unit = "m",
                                   .peer = "meshopt_simplify",
                                   .peerValue = their.maxM,
                                   .peerFrom = "run"}));
  report.add(ratioAtMost(1.05, {.id = id + "_rms",
                                .what = "RMS error at posts, " + from,
                                .value = our.rmsM,
                                .unit = "m",
                                .peer = "meshopt_simplify",
                                .peerValue = their.rmsM,
                                .peerFrom = "run"}));
  report.add(ratioAtLeast(1, {.id = id + "_rate_hmm",
                              .what = "Meshing " + quoted + ", one core",
                              .value = count / seconds,
                              .unit = "triangles/s",
                              .peer = "hmm",
                              .peerValue = greedy.trianglesPerSecond,
                              .peerFrom = "quoted"}));
  report.add(ratioAtMost(1.1, {.id = id + "_triangles_hmm",
                               .what = "Triangles for the same largest error at a post, " + quoted,
                               .value = static_cast<double>(ours.size()) / 3,
                               .unit = "triangles",
                               .peer = "hmm",
                               .peerValue = static_cast<double>(most),
                               .peerFrom = "quoted"}));
  report.add(ratioAtMost(1.05, {.id = id + "_rms_hmm",
                                .what = "RMS error at posts, " + quoted,
                                .value = our.rmsM,
                                .unit = "m",
                                .peer = "hmm",
                                .peerValue = greedy.rmsM,
                                .peerFrom = "quoted"}));
}

}  // namespace

void mesherRows(Report& report) {
  std::vector<Land> lands;
  Land everest{"everest", "Everest", 0, 0, {}, {36.0, 12.817, 8e6}, {177.339, 53.074, 28e6}, 90};
  Land tujunga{"tujunga", "Big Tujunga", 0, 0, {}, {7.261, 2.661, 8e6}, {57.971, 12.504, 28e6}, 30};
  if (readLand(everest, "data/dem-srtm3-everest/N27E086.hgt")) lands.push_back(everest);
  if (!report.quick() && readLand(tujunga, "data/dem-30m-bigtujunga/bigtujunga.tif"))
    lands.push_back(tujunga);
  if (!report.quick() || lands.empty()) lands.push_back(fractalLand(1201));
  for (const Land& land : lands) {
    compare(report, land, 10, land.tenth);
    compare(report, land, 100, land.hundredth);
  }
}

}  // namespace trimtab::bench
