#include "trimtab/terrain/scenery/raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace trimtab::terrain {

namespace {

/// Part of a post by which a triangle is widened, so that no post falls between two of them.
constexpr double kSlack = 1e-4;

double edge(const Vec3& a, const Vec3& b, const Vec3& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}
double distance(const Vec3& a, const Vec3& b) {
  return std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
}

/// Holds some rows of the grid.
struct Rows {
  std::int64_t columns, first, end;
  std::span<float> heights;
  std::span<std::uint8_t> image;

  /// Adds a triangle; its corners are in columns and rows of the grid.
  void add(const Vec3& a, const Vec3& b, const Vec3& c, const std::array<std::uint8_t, 3>& colour) const {
    const auto low = [](double x) { return static_cast<std::int64_t>(std::ceil(x - kSlack)); };
    const auto high = [](double x) { return static_cast<std::int64_t>(std::floor(x + kSlack)); };
    const std::int64_t south = std::max(low(std::min({a.y, b.y, c.y})), first),
                       north = std::min(high(std::max({a.y, b.y, c.y})), end - 1);
    if (south > north) return;
    const double area = edge(a, b, c);
    if (std::abs(area) < 1e-9) return;  // seen from above it is a line
    const std::int64_t west = std::max<std::int64_t>(low(std::min({a.x, b.x, c.x})), 0),
                       east = std::min<std::int64_t>(high(std::max({a.x, b.x, c.x})), columns - 1);
    const double sign = area > 0 ? 1 : -1;
    const double slackA = -kSlack * distance(b, c), slackB = -kSlack * distance(c, a),
                 slackC = -kSlack * distance(a, b);
    const double lowest = std::min({a.z, b.z, c.z}), highest = std::max({a.z, b.z, c.z});
    for (std::int64_t row = south; row <= north; ++row)
      for (std::int64_t column = west; column <= east; ++column) {
        const Vec3 p{static_cast<double>(column), static_cast<double>(row), 0};
        const double wa = edge(b, c, p) * sign, wb = edge(c, a, p) * sign, wc = edge(a, b, p) * sign;
        if (wa < slackA || wb < slackB || wc < slackC) continue;
        const double height = std::clamp((wa * a.z + wb * b.z + wc * c.z) / (area * sign), lowest, highest);
        const auto rounded = static_cast<float>(std::round(height * 100) / 100);
        const auto post = static_cast<std::size_t>((row - first) * columns + column);
        if (heights[post] > rounded) continue;  // false while it is void
        heights[post] = rounded;
        if (image.empty()) continue;
        std::copy_n(colour.data(), 3, &image[post * 4]);
        image[post * 4 + 3] = 255;
      }
  }
};

}  // namespace

SceneryRaster::SceneryRaster(const SceneryCatalogue& catalogue, const PostGrid& posts)
    : catalogue_(catalogue),
      posts_(posts),
      turn_(catalogue.turnTo(posts.longitude((posts.columns - 1) / 2.0))) {
  const auto index = [](double x, std::uint32_t count) {
    return static_cast<std::uint32_t>(std::clamp(x, 0.0, static_cast<double>(count)));
  };
  for (const SceneryCatalogue::Tile& tile : catalogue.tiles()) {
    if (tile.extent.empty()) {
      spans_.push_back({0, 0, 0, 0});
      continue;
    }
    const Rectangle r = tile.extent.turned(turn_);
    const double west = (r.west - posts.west) / posts.stepLongitude,
                 east = (r.east - posts.west) / posts.stepLongitude,
                 south = (r.south - posts.south) / posts.stepLatitude,
                 north = (r.north - posts.south) / posts.stepLatitude;
    spans_.push_back(
        {index(std::ceil(west - 1e-3), posts.columns), index(std::floor(east + 1e-3) + 1, posts.columns),
         index(std::ceil(south - 1e-3), posts.rows), index(std::floor(north + 1e-3) + 1, posts.rows)});
  }
}

Result<Done> SceneryRaster::read(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                                 std::span<std::uint8_t> image) const {
  std::fill(heights.begin(), heights.end(), std::numeric_limits<float>::quiet_NaN());
  std::fill(image.begin(), image.end(), std::uint8_t{0});
  const Rows target{posts_.columns, first, std::int64_t{first} + rows, heights, image};
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    if (spans_[i].firstRow >= first + rows || spans_[i].endRow <= first) continue;
    const auto tile = catalogue_.mesh(i);
    if (!tile) return tile.findings();
    const PlacedMesh& placed = **tile;
    std::vector<Vec3> places = placed.places;
    for (Vec3& p : places) {
      p.x = (p.x + turn_ - posts_.west) / posts_.stepLongitude;
      p.y = (p.y - posts_.south) / posts_.stepLatitude;
    }
    std::vector<std::array<std::uint8_t, 3>> colours;
    for (const std::string& material : placed.mesh.materials) colours.push_back(materialColour(material));
    for (const SceneryMesh::Triangle& t : placed.mesh.triangles)
      target.add(places[t.vertex[0]], places[t.vertex[1]], places[t.vertex[2]], colours[t.material]);
  }
  return Done{};
}

void SceneryRaster::reached(std::uint32_t row, std::span<std::uint8_t> posts) const {
  std::fill(posts.begin(), posts.end(), std::uint8_t{0});
  for (const Span& s : spans_)
    if (row >= s.firstRow && row < s.endRow && s.firstColumn < s.endColumn)
      std::fill(posts.begin() + s.firstColumn, posts.begin() + s.endColumn, std::uint8_t{1});
}

}  // namespace trimtab::terrain
