#include "trimtab/terrain/scenery/made.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <string>

#include "trimtab/terrain/grid/grid_height.h"
#include "trimtab/terrain/grid/parallel.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/mesh/mesher.h"

namespace trimtab::terrain {

namespace {

/// Tiles of scenery miss their buckets' borders by up to 0.1 m, as floats do at that size.
constexpr double kOnLineDegrees = 3e-6;
/// This is less than the distance over which trees join vertices (kJoinM).
constexpr double kSamePlaceDegrees = 9e-8;

struct Place {
  double longitude = 0, latitude = 0;
  Vec3 ecef;
};

/// Returns the vertices of scenery on edges that one triangle alone has, with longitudes turned by so many
/// degrees.
Result<std::vector<Place>> bordersOf(const SceneryCatalogue& scenery, double turn) {
  std::vector<Place> places;
  for (std::size_t tile = 0; tile < scenery.tiles().size(); ++tile) {
    const auto placed = scenery.mesh(tile);
    if (!placed) return placed.findings();
    const SceneryMesh& mesh = (*placed)->mesh;
    std::vector<std::uint64_t> edges;
    for (const SceneryMesh::Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint64_t a = t.vertex[k], b = t.vertex[(k + 1) % 3];
        edges.push_back(std::min(a, b) << 32 | std::max(a, b));
      }
    std::sort(edges.begin(), edges.end());
    std::set<std::uint32_t> open;
    for (std::size_t i = 0, end; i < edges.size(); i = end) {
      for (end = i; end < edges.size() && edges[end] == edges[i];) ++end;
      if (end - i != 1) continue;
      open.insert(static_cast<std::uint32_t>(edges[i] >> 32));
      open.insert(static_cast<std::uint32_t>(edges[i]));
    }
    for (const std::uint32_t v : open) {
      const Vec3& place = (*placed)->places[v];
      places.push_back({place.x + turn, place.y, mesh.vertices[v]});
    }
  }
  return places;
}

/// Knows what all made tiles lie in.
class Surroundings {
 public:
  Surroundings(const SceneryCatalogue& scenery, std::vector<Place> borders, const HeightSource& heights,
               const Rectangle& where)
      : heights_(heights), where_(where), borders_(std::move(borders)) {
    for (const SceneryCatalogue::Tile& tile : scenery.tiles())
      if (!tile.airport) there_.insert(tile.name);
  }

  const HeightSource& heights() const { return heights_; }
  const PostGrid& posts() const { return heights_.posts(); }
  const Rectangle& where() const { return where_; }
  const std::vector<Place>& borders() const { return borders_; }
  bool hasScenery(const Bucket& b) const { return b.index >= 0 && there_.contains(std::to_string(b.index)); }

  std::vector<Bucket> buckets() const {
    std::vector<Bucket> all;
    for (double latitude = std::floor(where_.south * 8) / 8 + 1.0 / 16; latitude - 1.0 / 16 < where_.north;
         latitude += 0.125)
      for (double longitude = where_.west + 1e-7; longitude < where_.east;) {
        const Bucket b = bucketNear(Degrees{latitude}, Degrees{longitude});
        if (b.index < 0) break;
        if (!hasScenery(b) && covers(clipped(b))) all.push_back(b);
        longitude = b.east.value() + 1e-7;
      }
    return all;
  }
  Rectangle clipped(const Bucket& b) const {
    return {std::max(b.west.value(), where_.west), std::max(b.south.value(), where_.south),
            std::min(b.east.value(), where_.east), std::min(b.north.value(), where_.north)};
  }

 private:
  /// Large enough for a ring and posts inside it.
  bool covers(const Rectangle& r) const {
    const double least = 4 * std::max(posts().stepLatitude, posts().stepLongitude);
    return r.east - r.west > least && r.north - r.south > least;
  }

  const HeightSource& heights_;
  Rectangle where_;
  std::vector<Place> borders_;
  std::set<std::string> there_;
};

/// One tile.
class Maker {
 public:
  explicit Maker(const Surroundings& around) : around_(around), where_(around.where()) {}

  SceneryMesh make(const Bucket& bucket) {
    const Rectangle r = around_.clipped(bucket);
    readWindow(r);
    SceneryMesh mesh;
    mesh.name = std::to_string(bucket.index);
    mesh.materials = {"Default", "Ocean"};
    std::array<std::vector<Place>, 4> sides{
        side(true, r.south, r.west, r.east, -1), side(false, r.east, r.south, r.north, 1),
        side(true, r.north, r.west, r.east, 1), side(false, r.west, r.south, r.north, -1)};
    std::reverse(sides[2].begin(), sides[2].end());
    std::reverse(sides[3].begin(), sides[3].end());
    // A rim that cuts through scenery's border ends at a vertex of it, so the sides have to meet there.
    for (std::size_t i = 0; i < 4; ++i) meet(sides[i], sides[(i + 1) % 4]);
    fill(sides, mesh);
    return mesh;
  }

 private:
  /// Posts in and about a rectangle.
  void readWindow(const Rectangle& r) {
    const PostGrid& posts = around_.posts();
    const auto post = [](double at, std::uint32_t count) {
      return static_cast<std::uint32_t>(std::clamp(std::floor(at), 0.0, count - 1.0));
    };
    window_.column = post((r.west - posts.west) / posts.stepLongitude - 1, posts.columns);
    window_.row = post((r.south - posts.south) / posts.stepLatitude - 1, posts.rows);
    window_.columns =
        post((r.east - posts.west) / posts.stepLongitude + 2, posts.columns) + 1 - window_.column;
    window_.rows = post((r.north - posts.south) / posts.stepLatitude + 2, posts.rows) + 1 - window_.row;
    posts_.resize(window_.size());
    around_.heights().read(window_, 1, posts_);
  }
  double heightAt(double longitude, double latitude) const {
    return heightOf(around_.posts(), longitude, latitude, [this](std::uint32_t row, std::uint32_t column) {
      const std::uint32_t r = row - window_.row, c = column - window_.column;
      if (r < window_.rows && c < window_.columns) return posts_[std::size_t{r} * window_.columns + c];
      // A grid all around the earth has its first column beside its last.
      float one = 0;
      around_.heights().read({column, row, 1, 1}, 1, std::span(&one, 1));
      return one;
    });
  }

  Place sampled(double longitude, double latitude) const {
    const double height = heightAt(longitude, latitude);
    return {longitude, latitude,
            toEcef({Degrees{latitude}, Degrees{longitude}, Metres{std::isnan(height) ? 0 : height}})};
  }
  /// Scenery's vertex at a corner, or a place of the grid.
  Place corner(double longitude, double latitude, bool& known) const {
    for (const Place& p : around_.borders())
      if (std::abs(p.longitude - longitude) < kOnLineDegrees &&
          std::abs(p.latitude - latitude) < kOnLineDegrees) {
        known = true;
        return p;
      }
    known = false;
    return sampled(longitude, latitude);
  }

  /// Returns the vertices along a line of latitude (`level`) or longitude, from its lesser end; `outward`
  /// says on which side the neighbours are. They are the same for both tiles at it.
  std::vector<Place> side(bool level, double line, double from, double to, int outward) const {
    std::vector<double> cuts{from};
    if (level) {
      for (double at = from + 1e-7; at < to;) {
        const Bucket b = bucketNear(Degrees{line + outward * 1e-6}, Degrees{at});
        if (b.index < 0 || b.east.value() >= to - 1e-7) break;
        cuts.push_back(b.east.value());
        at = b.east.value() + 1e-7;
      }
    }
    cuts.push_back(to);
    std::vector<Place> all;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double middle = (cuts[i] + cuts[i + 1]) / 2;
      const Bucket b = level ? bucketNear(Degrees{line + outward * 1e-6}, Degrees{middle})
                             : bucketNear(Degrees{middle}, Degrees{line + outward * 1e-6});
      const bool scenery = around_.hasScenery(b);
      auto part = scenery ? sceneryStretch(level, line, cuts[i], cuts[i + 1])
                          : gridStretch(level, line, cuts[i], cuts[i + 1]);
      if (!all.empty()) all.pop_back();
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }
  Place cornerOf(bool level, double line, double at, bool& known) const {
    return level ? corner(at, line, known) : corner(line, at, known);
  }
  std::vector<Place> sceneryStretch(bool level, double line, double from, double to) const {
    const auto along = [&](const Place& p) { return level ? p.longitude : p.latitude; };
    std::vector<Place> found;
    for (const Place& p : around_.borders())
      if (std::abs((level ? p.latitude : p.longitude) - line) < kOnLineDegrees &&
          along(p) > from - kOnLineDegrees && along(p) < to + kOnLineDegrees)
        found.push_back(p);
    std::sort(found.begin(), found.end(),
              [&](const Place& a, const Place& b) { return along(a) < along(b); });
    const auto last = std::unique(found.begin(), found.end(), [&](const Place& a, const Place& b) {
      return along(b) - along(a) < kSamePlaceDegrees;
    });
    found.erase(last, found.end());
    if (found.size() >= 2) return found;
    return gridStretch(level, line, from, to);
  }
  std::vector<Place> gridStretch(bool level, double line, double from, double to) const {
    bool known = false;
    std::vector<Place> all{cornerOf(level, line, from, known)};
    const double step = 2 * (level ? around_.posts().stepLongitude : around_.posts().stepLatitude);
    const int count = std::max(1, static_cast<int>(std::lround((to - from) / step)));
    for (int i = 1; i < count; ++i) {
      const double at = from + (to - from) * i / count;
      all.push_back(level ? sampled(at, line) : sampled(line, at));
    }
    all.push_back(cornerOf(level, line, to, known));
    return all;
  }
  void meet(std::vector<Place>& first, std::vector<Place>& second) const {
    const Place &a = first.back(), &b = second.front();
    if (std::abs(a.longitude - b.longitude) < kOnLineDegrees &&
        std::abs(a.latitude - b.latitude) < kOnLineDegrees) {
      second.front() = a;
      return;
    }
    // The one on scenery keeps its end: the other's end is a place of the rim.
    const auto onRim = [&](const Place& p) {
      return std::abs(p.longitude - where_.west) < 1e-9 || std::abs(p.longitude - where_.east) < 1e-9 ||
             std::abs(p.latitude - where_.south) < 1e-9 || std::abs(p.latitude - where_.north) < 1e-9;
    };
    if (onRim(b))
      second.front() = a;
    else
      first.back() = b;
  }

  /// Makes a ring between the border and a rectangle of the grid's posts, and the rectangle meshed.
  void fill(const std::array<std::vector<Place>, 4>& sides, SceneryMesh& mesh) const {
    Rectangle in{-1e9, -1e9, 1e9, 1e9};
    for (const Place& p : sides[0]) in.south = std::max(in.south, p.latitude);
    for (const Place& p : sides[1]) in.east = std::min(in.east, p.longitude);
    for (const Place& p : sides[2]) in.north = std::min(in.north, p.latitude);
    for (const Place& p : sides[3]) in.west = std::max(in.west, p.longitude);
    const PostGrid& posts = around_.posts();
    // An edge along a parallel leaves it by its sag, and nothing of the rectangle may come that near.
    double longest = 0;
    for (const std::size_t i : {0u, 2u})
      for (std::size_t k = 0; k + 1 < sides[i].size(); ++k)
        longest = std::max(longest, length(sides[i][k + 1].ecef - sides[i][k].ecef));
    const double steep = std::abs(std::tan(in.north * std::numbers::pi / 180));
    const double sag = longest * longest / (8 * 6.37e6) * std::min(steep, 100.0) / 111320;
    in.west += posts.stepLongitude / 2, in.east -= posts.stepLongitude / 2;
    in.south += posts.stepLatitude / 2 + 2 * sag, in.north -= posts.stepLatitude / 2 + 2 * sag;
    const auto count = [](double length, double step) {
      return static_cast<std::uint32_t>(std::max(1.0, std::round(length / step))) + 1;
    };
    const std::uint32_t columns = count(in.east - in.west, posts.stepLongitude),
                        rows = count(in.north - in.south, posts.stepLatitude);
    const auto longitude = [&](std::uint32_t c) { return in.west + (in.east - in.west) * c / (columns - 1); };
    const auto latitude = [&](std::uint32_t r) { return in.south + (in.north - in.south) * r / (rows - 1); };
    const LocalFrame frame({Degrees{(in.south + in.north) / 2}, Degrees{(in.west + in.east) / 2}, Metres{0}});
    std::vector<float> z(std::size_t{columns} * rows);  // with the earth's curve, as triangles are flat
    bool sea = true;
    for (std::uint32_t r = 0; r < rows; ++r)
      for (std::uint32_t c = 0; c < columns; ++c) {
        const Place p = sampled(longitude(c), latitude(r));
        const Vec3 local = frame.fromEcef(p.ecef);
        z[std::size_t{r} * columns + c] = static_cast<float>(local.z);
        sea = sea && heightAt(p.longitude, p.latitude) == 0;
      }
    const HeightField field{z.data(), columns, rows, columns};
    constexpr double kDegreeM = 111320;
    const double tolerance = posts.stepLatitude * kDegreeM / 15;
    using Point = PolygonMesher::Point;
    const std::array<Point, 4> corners{Point{0, 0}, Point{columns - 1, 0}, Point{columns - 1, rows - 1},
                                       Point{0, rows - 1}};
    std::vector<Point> ring, line;
    std::array<std::size_t, 5> first{};
    for (std::size_t i = 0; i < 4; ++i) {
      simplifySide(field, corners[i], corners[(i + 1) % 4], tolerance, line);
      first[i] = ring.size();
      ring.insert(ring.end(), line.begin(), line.end() - 1);
    }
    first[4] = ring.size();
    PolygonMesher mesher;
    mesher.begin(field, ring);
    mesher.refine(tolerance, z.size());
    const std::uint16_t material = sea ? 1 : 0;
    for (const Point& p : mesher.vertices())
      mesh.vertices.push_back(sampled(longitude(p.column), latitude(p.row)).ecef);
    std::vector<std::uint32_t> indices;
    mesher.triangles(indices);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
      mesh.triangles.push_back({{indices[i], indices[i + 1], indices[i + 2]}, material});

    // The ring: each side's vertices but its last, which is the next one's first.
    const auto outer = static_cast<std::uint32_t>(mesh.vertices.size());
    std::array<std::uint32_t, 5> firstOuter{};
    for (std::size_t i = 0; i < 4; ++i) {
      firstOuter[i] = static_cast<std::uint32_t>(mesh.vertices.size()) - outer;
      for (std::size_t k = 0; k + 1 < sides[i].size(); ++k) mesh.vertices.push_back(sides[i][k].ecef);
    }
    firstOuter[4] = static_cast<std::uint32_t>(mesh.vertices.size()) - outer;
    for (std::size_t i = 0; i < 4; ++i) {
      const bool level = i % 2 == 0;
      const double sign = i < 2 ? 1 : -1;
      const auto outerAt = [&](std::uint32_t k) {
        const Place& p = k < sides[i].size() ? sides[i][k] : sides[i].back();
        return sign * (level ? p.longitude : p.latitude);
      };
      const auto innerAt = [&](std::size_t k) {
        const Point p = ring[(first[i] + k) % ring.size()];
        return sign * (level ? longitude(p.column) : latitude(p.row));
      };
      const auto outerNumber = [&](std::uint32_t k) { return outer + (firstOuter[i] + k) % firstOuter[4]; };
      const auto innerNumber = [&](std::size_t k) {
        return static_cast<std::uint32_t>((first[i] + k) % ring.size());
      };
      const auto outers = static_cast<std::uint32_t>(sides[i].size() - 1);
      const std::size_t inners = first[i + 1] - first[i];
      std::uint32_t o = 0;
      for (std::size_t k = 0; o < outers || k < inners;) {
        if (k == inners || (o < outers && outerAt(o) + outerAt(o + 1) <= innerAt(k) + innerAt(k + 1))) {
          mesh.triangles.push_back({{outerNumber(o), outerNumber(o + 1), innerNumber(k)}, material});
          ++o;
        } else {
          mesh.triangles.push_back({{outerNumber(o), innerNumber(k + 1), innerNumber(k)}, material});
          ++k;
        }
      }
    }
    mesh.trianglesInFile = mesh.triangles.size();
  }

  const Surroundings& around_;
  Rectangle where_;
  PostWindow window_;
  std::vector<float> posts_;
};

}  // namespace

Result<Done> makeTiles(SceneryCatalogue& scenery, const HeightSource& heights, const Rectangle& where,
                       const Progress& progress) {
  const PostGrid& posts = heights.posts();
  auto borders = bordersOf(scenery, scenery.turnTo(posts.longitude((posts.columns - 1) / 2.0)));
  if (!borders) return borders.findings();
  const auto around =
      std::make_shared<const Surroundings>(scenery, std::move(borders).value(), heights, where);
  const std::vector<Bucket> buckets = around->buckets();
  // A few at a time: what does not stay is gone before the next are made.
  constexpr std::size_t kTogether = 8;
  for (std::size_t from = 0; from < buckets.size(); from += kTogether) {
    const std::size_t some = std::min(kTogether, buckets.size() - from);
    if (progress &&
        !progress(static_cast<double>(from) / static_cast<double>(buckets.size()), "tiles between scenery"))
      return cancelled("tiles between scenery");
    std::vector<SceneryMesh> made(some);
    forEachParallel(static_cast<std::uint32_t>(some),
                    [&](std::uint32_t i) { made[i] = Maker(*around).make(buckets[from + i]); }, {});
    for (std::size_t i = 0; i < some; ++i)
      scenery.add(std::move(made[i]),
                  [around, bucket = buckets[from + i]] { return Maker(*around).make(bucket); });
  }
  return Done{};
}

}  // namespace trimtab::terrain
