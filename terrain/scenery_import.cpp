#include "trimtab/terrain/scenery_import.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "trimtab/terrain/import.h"
#include "trimtab/terrain/scenery_blend.h"
#include "trimtab/terrain/scenery_sea.h"
#include "trimtab/terrain/voids.h"

namespace trimtab::terrain {

namespace {

constexpr double kMostPosts = 4e8, kUsualPosts = 6e6;
constexpr double kFinestM = 30, kCoarsestM = 60;
constexpr double kDegreeM = 111320;
constexpr double kMostSide = 1u << 20;  ///< as the store checks

/// Rectangle in degrees; longitudes on one side of the earth.
struct Extent {
  double west = 1e9, south = 1e9, east = -1e9, north = -1e9;

  bool empty() const { return west > east; }
  void add(double longitude, double latitude) {
    west = std::min(west, longitude);
    east = std::max(east, longitude);
    south = std::min(south, latitude);
    north = std::max(north, latitude);
  }
  void add(const Extent& other) {
    if (other.empty()) return;
    add(other.west, other.south);
    add(other.east, other.north);
  }
};

/// A mesh's vertices as longitude, latitude, height.
std::vector<Vec3> geodetic(const SceneryMesh& mesh, double nearLongitude) {
  std::vector<Vec3> places;
  places.reserve(mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) {
    const GeodeticPosition p = toGeodetic(v);
    const double turn = std::remainder(p.longitude.value() - nearLongitude, 360.0);
    places.push_back({nearLongitude + turn, p.latitude.value(), p.height.value()});
  }
  return places;
}

Extent extentOf(const SceneryMesh& mesh, std::span<const Vec3> places) {
  Extent extent;
  for (const SceneryMesh::Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t.vertex) extent.add(places[v].x, places[v].y);
  return extent;
}

double firstLongitude(std::span<const SceneryMesh> meshes) {
  for (const SceneryMesh& mesh : meshes)
    if (!mesh.triangles.empty())
      return toGeodetic(mesh.vertices[mesh.triangles[0].vertex[0]]).longitude.value();
  return 0;
}

/// Borders of buckets are eighths of a degree, which the tiles' floats miss by a millimetre.
double snapped(double degrees) {
  const double eighth = std::round(degrees * 8) / 8;
  return std::abs(degrees - eighth) < 1e-6 ? eighth : degrees;
}

/// Puts triangles on a grid: places are columns and rows.
class Raster {
 public:
  explicit Raster(HeightGrid& grid) : grid_(grid) {}

  void add(const Vec3& a, const Vec3& b, const Vec3& c, const std::array<std::uint8_t, 3>& colour) {
    const double area = edge(a, b, c);
    if (std::abs(area) < 1e-9) return;  // seen from above it is a line
    const auto first = [](double x) { return static_cast<std::int64_t>(std::ceil(x - kSlack)); };
    const auto last = [](double x) { return static_cast<std::int64_t>(std::floor(x + kSlack)); };
    const std::int64_t west = std::max<std::int64_t>(first(std::min({a.x, b.x, c.x})), 0),
                       south = std::max<std::int64_t>(first(std::min({a.y, b.y, c.y})), 0);
    const std::int64_t east =
                           std::min<std::int64_t>(last(std::max({a.x, b.x, c.x})), grid_.posts.columns - 1),
                       north = std::min<std::int64_t>(last(std::max({a.y, b.y, c.y})), grid_.posts.rows - 1);
    const double sign = area > 0 ? 1 : -1;
    const double slackA = -kSlack * distance(b, c), slackB = -kSlack * distance(c, a),
                 slackC = -kSlack * distance(a, b);
    const double low = std::min({a.z, b.z, c.z}), high = std::max({a.z, b.z, c.z});
    for (std::int64_t row = south; row <= north; ++row)
      for (std::int64_t column = west; column <= east; ++column) {
        const Vec3 p{static_cast<double>(column), static_cast<double>(row), 0};
        const double wa = edge(b, c, p) * sign, wb = edge(c, a, p) * sign, wc = edge(a, b, p) * sign;
        if (wa < slackA || wb < slackB || wc < slackC) continue;
        const double height = std::clamp((wa * a.z + wb * b.z + wc * c.z) / (area * sign), low, high);
        const auto rounded = static_cast<float>(std::round(height * 100) / 100);
        const std::size_t post =
            static_cast<std::size_t>(row) * grid_.posts.columns + static_cast<std::size_t>(column);
        float& known = grid_.heights[post];
        if (known > rounded) continue;  // false while it is void
        known = rounded;
        std::copy_n(colour.data(), 3, &grid_.image[post * 4]);
        grid_.image[post * 4 + 3] = 255;
      }
  }

 private:
  /// Part of a post by which a triangle is widened, so that no post falls between two of them.
  static constexpr double kSlack = 1e-4;

  static double edge(const Vec3& a, const Vec3& b, const Vec3& p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
  }
  static double distance(const Vec3& a, const Vec3& b) {
    return std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
  }

  HeightGrid& grid_;
};

}  // namespace

Result<PostGrid> sceneryPosts(std::span<const SceneryMesh> meshes, std::optional<Metres> distance) {
  const double reference = firstLongitude(meshes);
  Extent whole;
  for (const SceneryMesh& mesh : meshes) whole.add(extentOf(mesh, geodetic(mesh, reference)));
  const Finding nothing{Severity::error, "scenery", "", "triangles that cover ground", "none"};
  if (whole.empty()) return nothing;
  return postsOver(snapped(whole.west), snapped(whole.south), snapped(whole.east), snapped(whole.north),
                   distance);
}

Result<PostGrid> postsOver(double west, double south, double east, double north,
                           std::optional<Metres> distance) {
  const double narrow = std::min(std::abs(south), std::abs(north)) * std::numbers::pi / 180;
  const double wideM = (east - west) * kDegreeM * (south * north <= 0 ? 1 : std::cos(narrow)),
               highM = (north - south) * kDegreeM;
  if (!(wideM > 0 && highM > 0))
    return Finding{Severity::error, "scenery", "", "triangles that cover ground", "none"};
  double step = kFinestM;
  if (distance)
    step = distance->value();
  else
    step = std::clamp(std::sqrt(wideM * highM / kUsualPosts), kFinestM, kCoarsestM);
  const double columns = std::max(std::ceil(wideM / step), 1.0) + 1,
               rows = std::max(std::ceil(highM / step), 1.0) + 1;
  if (!(step > 0) || !(columns * rows <= kMostPosts) || !(std::max(columns, rows) <= kMostSide))
    return Finding{Severity::error, "scenery", "size",
                   "at most 400 million posts, and 1,048,576 a side, at the distance wanted",
                   std::to_string(columns * rows) + " posts, " + std::to_string(step) + " m apart"};
  PostGrid posts;
  posts.west = west;
  posts.south = south;
  posts.columns = static_cast<std::uint32_t>(columns);
  posts.rows = static_cast<std::uint32_t>(rows);
  posts.stepLongitude = (east - west) / (columns - 1);
  posts.stepLatitude = (north - south) / (rows - 1);
  return posts;
}

Result<HeightGrid> rasterised(std::span<const SceneryMesh> meshes, const PostGrid& posts,
                              const Progress& progress, const HeightGrid* elevation) {
  HeightGrid grid{posts, std::vector<float>(posts.size(), std::numeric_limits<float>::quiet_NaN()), 0,
                  std::vector<std::uint8_t>(posts.size() * 4, 0)};
  std::vector<std::uint8_t> reached(posts.size(), 0);
  Raster raster(grid);
  const double middle = posts.longitude((posts.columns - 1) / 2.0);
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const SceneryMesh& mesh = meshes[m];
    if (progress &&
        !progress(static_cast<double>(m) / static_cast<double>(meshes.size()), "putting triangles on posts"))
      return cancelled("putting triangles on posts");
    std::vector<Vec3> places = geodetic(mesh, middle);
    for (Vec3& p : places) {
      p.x = (p.x - posts.west) / posts.stepLongitude;
      p.y = (p.y - posts.south) / posts.stepLatitude;
    }
    const Extent extent = extentOf(mesh, places);
    if (extent.empty()) continue;
    std::vector<std::array<std::uint8_t, 3>> colours;
    for (const std::string& material : mesh.materials) colours.push_back(materialColour(material));
    for (const SceneryMesh::Triangle& t : mesh.triangles)
      raster.add(places[t.vertex[0]], places[t.vertex[1]], places[t.vertex[2]], colours[t.material]);
    const auto index = [](double x, std::uint32_t count) {
      return static_cast<std::uint32_t>(std::clamp(x, 0.0, static_cast<double>(count)));
    };
    const std::uint32_t c0 = index(std::ceil(extent.west - 1e-3), posts.columns),
                        c1 = index(std::floor(extent.east + 1e-3) + 1, posts.columns),
                        r0 = index(std::ceil(extent.south - 1e-3), posts.rows),
                        r1 = index(std::floor(extent.north + 1e-3) + 1, posts.rows);
    for (std::uint32_t r = r0; r < r1; ++r)
      std::fill_n(reached.begin() + static_cast<std::ptrdiff_t>(std::size_t{r} * posts.columns + c0),
                  c1 > c0 ? c1 - c0 : 0, std::uint8_t{1});
  }
  if (elevation != nullptr) blendElevation(grid, *elevation, reached);
  grid.outside = static_cast<std::uint64_t>(std::count(reached.begin(), reached.end(), 0));
  Findings notes;
  if (const std::uint64_t sea = fillOpenSea(grid, reached); sea > 0)
    notes.push_back({Severity::note, "scenery", "outline", "tiles over the whole rectangle of the terrain",
                     std::to_string(sea) + " posts beyond them, taken for open sea"});
  return Result<HeightGrid>(std::move(grid), std::move(notes));
}

SceneryCounts countsOf(const Scenery& scenery) {
  SceneryCounts counts;
  for (const SceneryMesh& mesh : scenery.tiles) {
    ++(mesh.airport ? counts.airports : counts.tiles);
    counts.trianglesInFile += mesh.trianglesInFile;
    counts.degenerate += mesh.degenerate;
    counts.triangles += mesh.triangles.size();
  }
  counts.missing = scenery.missing;
  return counts;
}

Result<Scenery> readSceneries(std::span<const std::filesystem::path> sources, const Progress& progress) {
  Scenery all;
  Findings findings;
  std::set<std::string> names;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    auto part = readScenery(sources[i], [&](double fraction, const std::string& what) {
      return !progress ||
             progress((static_cast<double>(i) + fraction) / static_cast<double>(sources.size()), what);
    });
    findings.insert(findings.end(), part.findings().begin(), part.findings().end());
    if (!part) return findings;
    for (SceneryMesh& mesh : (*part).tiles)
      if (names.insert(mesh.name).second) all.tiles.push_back(std::move(mesh));
    all.missing.insert(all.missing.end(), part->missing.begin(), part->missing.end());
  }
  // Ground that a broken tile leaves out would look like sea or like a plain: better no database than that.
  if (std::any_of(findings.begin(), findings.end(),
                  [](const Finding& f) { return f.severity == Severity::error; }))
    return findings;
  return Result<Scenery>(std::move(all), std::move(findings));
}

Result<ImportedScenery> importScenery(std::span<const std::filesystem::path> sources,
                                      std::optional<Metres> distance, const Progress& progress) {
  const auto stage = [&](double from, double to) -> Progress {
    return [&progress, from, to](double fraction, const std::string& what) {
      return !progress || progress(from + (to - from) * fraction, what);
    };
  };
  auto read = readSceneries(sources, stage(0, 0.5));
  if (!read) return read.findings();
  Findings findings = read.findings();
  Scenery& all = *read;
  ImportedScenery imported;
  imported.counts = countsOf(all);
  const auto posts = sceneryPosts(all.tiles, distance);
  if (!posts) {
    findings.insert(findings.end(), posts.findings().begin(), posts.findings().end());
    return findings;
  }
  auto grid = rasterised(all.tiles, *posts, stage(0.5, 1));
  findings.insert(findings.end(), grid.findings().begin(), grid.findings().end());
  if (!grid) return findings;
  imported.grid = std::move(grid).value();
  const std::uint64_t filled = fillVoids(imported.grid), outside = std::min(filled, imported.grid.outside);
  imported.voidsFilled = filled - outside;
  if (outside > 0)
    findings.push_back({Severity::note, sources[0].string(), "outline",
                        "tiles over the whole rectangle of the terrain",
                        std::to_string(outside) + " posts beyond them, continued from their edges"});
  imported.meshes = std::move(all.tiles);
  return Result<ImportedScenery>(std::move(imported), std::move(findings));
}

}  // namespace trimtab::terrain
