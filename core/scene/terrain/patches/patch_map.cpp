#include "patch_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "trimtab/frame/box_union.h"

namespace trimtab::scene {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
/// Squares a side that slopes, and that boxes of parts are gathered by.
constexpr int kSlopeSquares = 24, kPartSquares = 8;

struct SquareRange {
  int x0, y0, x1, y1;
};
/// Something by squares of a patch as seen from above.
template <class T>
class Squares {
 public:
  Squares(const Box& box, float size, T value)
      : x_(box.minX),
        y_(box.minY),
        perM_(1 / size),
        width_(last(box.maxX - box.minX) + 1),
        height_(last(box.maxY - box.minY) + 1),
        values_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), value) {}
  SquareRange of(float x0, float y0, float x1, float y1, int around = 0) const {
    const auto at = [&](float v, float from, int count, int more) {
      return std::clamp(static_cast<int>((v - from) * perM_) + more, 0, count - 1);
    };
    return {at(x0, x_, width_, -around), at(y0, y_, height_, -around), at(x1, x_, width_, around),
            at(y1, y_, height_, around)};
  }
  template <class Work>
  void each(const SquareRange& r, const Work& work) {
    for (int y = r.y0; y <= r.y1; ++y)
      for (int x = r.x0; x <= r.x1; ++x) work((*this)(x, y));
  }
  T& operator()(int x, int y) { return values_[static_cast<std::size_t>(y * width_ + x)]; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  int last(float extent) const { return std::max(0, static_cast<int>(extent * perM_)); }
  float x_, y_, perM_;
  int width_, height_;
  std::vector<T> values_;
};

}  // namespace

void makePatchSurface(const terrain::PatchMesh& mesh, int variant, PatchSurface& out) {
  out = {};
  out.variant = static_cast<std::uint8_t>(variant);
  const auto first = mesh.firstIndex[static_cast<std::size_t>(variant)],
             end = mesh.firstIndex[static_cast<std::size_t>(variant) + 1];
  const std::span<const std::uint16_t> corners = std::span(mesh.indices).subspan(first, end - first);
  DepthMesh& m = out.mesh;
  m.origin = {16.0 * mesh.origin[0], 16.0 * mesh.origin[1], 16.0 * mesh.origin[2]};
  Box box = kNoBox;
  for (const terrain::PatchVertex& v : mesh.vertices) box = united(box, v.x, v.y, v.z);
  if (corners.empty() || !(box.maxX >= box.minX)) return;
  const float extent = std::max(box.maxX - box.minX, box.maxY - box.minY);
  m.reach = std::max(extent / kSlopeSquares, 1e-3f);
  m.farReach = extent / 2;

  // Slopes, longest edge, and which edges have one triangle.
  Squares<float> steep(box, m.reach, 0.0f), steepAround(box, m.reach, 0.0f);
  std::map<std::pair<std::uint16_t, std::uint16_t>, int> edges;
  const auto boxOf = [&](std::size_t i) {
    Box b = kNoBox;
    for (std::size_t k = 0; k < 3; ++k) {
      const terrain::PatchVertex& v = mesh.vertices[corners[i + k]];
      b = united(b, v.x, v.y, v.z);
    }
    return b;
  };
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const terrain::PatchVertex& v = mesh.vertices[corners[i + k]];
      p[k] = {double{v.x}, double{v.y}, double{v.z}};
      const std::uint16_t from = corners[i + k], to = corners[i + (k + 1) % 3];
      edges[std::minmax(from, to)] += from < to ? 1 : 2;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 d = p[(k + 1) % 3] - p[k];
      m.edge = std::max(m.edge, static_cast<float>(std::hypot(d.x, d.y)) * 1.001f);
    }
    const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
    const float slope =
        normal.z > 0 ? static_cast<float>(std::hypot(normal.x, normal.y) / normal.z) * 1.0001f : kInfinite;
    out.steepest = std::max(out.steepest, slope);
    const Box b = boxOf(i);
    steep.each(steep.of(b.minX, b.minY, b.maxX, b.maxY), [&](float& s) { s = std::max(s, slope); });
  }
  for (int y = 0; y < steep.height(); ++y)
    for (int x = 0; x < steep.width(); ++x)
      steepAround.each({std::max(x - 1, 0), std::max(y - 1, 0), std::min(x + 1, steep.width() - 1),
                        std::min(y + 1, steep.height() - 1)},
                       [&, s = steep(x, y)](float& most) { most = std::max(most, s); });

  // Marks what is within `reach` of the border: two squares around steps along it.
  Squares<std::uint8_t> beside(box, m.reach, 0);
  std::vector<std::pair<std::uint16_t, std::uint16_t>> outline;
  for (const auto& [ends, sides] : edges) {
    if (sides == 3) continue;
    outline.push_back(sides == 1 ? ends : std::pair{ends.second, ends.first});
    const terrain::PatchVertex &a = mesh.vertices[ends.first], &b = mesh.vertices[ends.second];
    const int steps = 1 + static_cast<int>(std::hypot(b.x - a.x, b.y - a.y) / (0.5f * m.reach));
    for (int i = 0; i <= steps; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(steps), x = a.x + t * (b.x - a.x),
                  y = a.y + t * (b.y - a.y);
      beside.each(beside.of(x, y, x, y, 2), [](std::uint8_t& s) { s = 1; });
    }
  }
  for (int y = 0; y < steep.height(); ++y)
    for (int x = 0; x < steep.width(); ++x)
      if (beside(x, y) != 0) out.borderSteepest = std::max(out.borderSteepest, steep(x, y));

  // Vertices: the patch's, then its outline's once more, lower.
  const std::size_t count = mesh.vertices.size();
  if (count + outline.size() > 0xffff) return;
  m.setVertices(count + outline.size());
  out.slope.assign(count + outline.size(), 0.0f);
  std::vector<std::uint8_t> atBorder(count + outline.size());
  Squares<Box> parts(box, std::max(extent / kPartSquares, 1e-3f), kNoBox);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const Box b = boxOf(i);
    float most = 0;
    bool border = false;
    const auto range = steep.of(b.minX, b.minY, b.maxX, b.maxY);
    steepAround.each(range, [&](float& s) { most = std::max(most, s); });
    beside.each(range, [&](std::uint8_t& s) { border = border || s != 0; });
    for (std::size_t k = 0; k < 3; ++k) {
      out.slope[corners[i + k]] = std::max(out.slope[corners[i + k]], most);
      atBorder[corners[i + k]] |= border;
    }
    const auto at = parts.of(0.5f * (b.minX + b.maxX), 0.5f * (b.minY + b.maxY), b.minX, b.minY);
    Box& part = parts(at.x0, at.y0);
    part = united(part, b);
  }
  std::vector<std::uint16_t> indices(corners.begin(), corners.end());
  const float wall = 0.02f * extent + 5;
  std::map<std::uint16_t, std::uint16_t> below;
  std::size_t next = count;
  for (const auto& [from, to] : outline)
    if (below.emplace(from, static_cast<std::uint16_t>(next)).second) ++next;
  for (std::size_t i = 0; i < count; ++i)
    m.setVertex(i, mesh.vertices[i].x, mesh.vertices[i].y, mesh.vertices[i].z, out.slope[i]);
  for (const auto& [top, low] : below) {
    m.setVertex(low, m.x[top], m.y[top], m.z[top] - wall, out.slope[top]);
    out.slope[low] = out.slope[top];
    atBorder[low] = 1;
  }
  m.vertices = next;
  for (const auto& [from, to] : outline)
    if (const auto b = below.find(to); b != below.end())
      indices.insert(indices.end(), {below[from], b->second, to, below[from], to, from});
  m.finishVertices();
  for (std::uint32_t i = 0; i < next; ++i)
    if (atBorder[i] != 0) out.border.push_back(i);
  out.triangles = depth::Triangles(indices);
  std::vector<Box> boxes;
  for (int y = 0; y < parts.height(); ++y)
    for (int x = 0; x < parts.width(); ++x)
      if (parts(x, y).maxX >= parts(x, y).minX) boxes.push_back(parts(x, y));
  m.setBoxes(boxes);
}

void PatchMapCulling::setTerrain(std::shared_ptr<const terrain::Database> database) {
  known_ = false;
  surfaces_.reset(database && database->patches() ? database->patches()->index().size() : 0);
  if (!database) return;
  const terrain::TerrainInfo& info = database->info();
  extent_ = DataExtent(info);
  metresEast_ = std::max(1e-3, info.postLongitude.value() * extent_.metresPerDegreeEast());
  metresNorth_ = std::max(1e-3, info.postLatitude.value() * extent_.metresPerDegreeNorth());
}

const PatchSurface* PatchMapCulling::surfaceOf(TileDraw patch) const {
  const PatchSurface* kept = surfaces_.find(patch.node);
  return kept && kept->variant == patch.variant.number ? kept : nullptr;
}

void PatchMapCulling::make(const PatchCulling& patches, TileDraw patch) {
  const terrain::PatchMesh* mesh = patches.meshOf(patch.node);
  PatchSurface& surface = surfaces_.make(patch.node);
  makePatchSurface(*mesh, patch.variant.number, surface);
  const PatchIndex& index = patches.index();
  const double beside = extent_.sagM() + double{surface.mesh.farReach};
  surface.inside = std::all_of(mesh->vertices.begin(), mesh->vertices.end(), [&](const auto& v) {
    const double column = mesh->firstColumn + v.column, row = mesh->firstRow + v.row;
    return column * metresEast_ > beside && row * metresNorth_ > beside &&
           (index.columns - 1 - column) * metresEast_ > beside &&
           (index.rows - 1 - row) * metresNorth_ > beside;
  });
}

bool PatchMapCulling::takeInNeighbours(const PatchCulling& patches, Vec3 eye, SurfaceShare& share) {
  surfaces_.forgetOthers(patches.cut());
  const std::vector<TileDraw>& cut = patches.cut().tiles;
  const std::vector<Box>& bounds = patches.index().bounds;
  const std::size_t missing = share.makeNearest(
      cut, bounds, eye, [&](TileDraw patch) { return !surfaceOf(patch) && patches.meshOf(patch.node); },
      [&](TileDraw patch) { make(patches, patch); });
  places_.clear();
  for (std::uint32_t i = 0; i < cut.size(); ++i)
    places_.push_back({bounds[cut[i].node].minX, bounds[cut[i].node].maxX, i});
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) { return a.low < b.low; });
  // A place farther west reaches this one only if it is wide enough, so the widest one limits the search.
  float widest = 0;
  for (const Place& p : places_) widest = std::max(widest, p.high - p.low);
  for (const Place& place : places_) {
    PatchSurface* surface = surfaces_.find(cut[place.patch].node);
    if (!surface || surface->variant != cut[place.patch].variant.number || surface->mesh.vertices == 0)
      continue;
    const Box& box = bounds[cut[place.patch].node];
    const float reach = surface->mesh.reach, far = surface->mesh.farReach;
    float around = 0, farSlope = surface->steepest;
    auto other = std::lower_bound(places_.begin(), places_.end(), place.low - far - widest,
                                  [](const Place& p, float low) { return p.low < low; });
    for (; other != places_.end() && other->low <= place.high + far; ++other) {
      const Box& b = bounds[cut[other->patch].node];
      const auto within = [&](float distance) {
        return b.minX <= box.maxX + distance && b.maxX >= box.minX - distance &&
               b.minY <= box.maxY + distance && b.maxY >= box.minY - distance;
      };
      if (other->patch == place.patch || !within(far)) continue;
      const PatchSurface* beside = surfaces_.find(cut[other->patch].node);
      const bool there = beside && beside->variant == cut[other->patch].variant.number;
      const float steepest = there ? beside->steepest : kInfinite;
      farSlope = std::max(farSlope, steepest);
      if (within(reach))
        around = std::max(around, there && beside->mesh.reach >= reach ? beside->borderSteepest : steepest);
    }
    surface->mesh.farSlope = farSlope;
    if (surface->around == around) continue;
    surface->around = around;
    for (const std::uint32_t i : surface->border)
      surface->mesh.slope[i] = std::max(surface->slope[i], around);
  }
  return missing == 0;
}

std::span<const std::uint8_t> PatchMapCulling::hidden(const PatchCulling& patches, std::uint64_t cut,
                                                      std::span<const TileDraw> visible, const EyePose& eye,
                                                      const MapView& view, SurfaceShare& share) {
  if (!known_ || cut_ != cut) known_ = takeInNeighbours(patches, eye.position, share);
  cut_ = cut;
  items_.clear();
  for (const TileDraw& patch : visible) {
    const PatchSurface* surface = surfaces_.find(patch.node);
    if (surface && (surface->variant != patch.variant.number || surface->mesh.vertices == 0))
      surface = nullptr;
    items_.push_back(surface ? DepthMapCulling::Item{&surface->mesh, &surface->triangles, surface->inside}
                             : DepthMapCulling::Item{});
  }
  return culling_.hidden(items_, eye, view);
}

}  // namespace trimtab::scene
