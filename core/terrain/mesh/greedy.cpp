#include "greedy.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "trimtab/terrain/mesh/lanes.h"

namespace trimtab::terrain {

namespace {

/// In a triangle of so many rows every so-manyth is enough to find a post to insert: its posts soon lie in
/// others.
constexpr std::int32_t kTall = 16, kEveryRow = 4;

struct Facet {
  const Triangulation::Vertex* corner[3];
  bool border[3];
  double scale;
};

Facet facetOf(const Triangulation& mesh, std::int32_t t) {
  const Triangulation::Triangle& one = mesh.triangles[static_cast<std::size_t>(t)];
  Facet out{};
  for (int i = 0; i < 3; ++i) {
    out.corner[i] = &mesh.vertices[one.corner[i]];
    out.border[i] = one.twin[i] < 0;
    out.scale = std::max(out.scale, std::fabs(static_cast<double>(out.corner[i]->z)));
  }
  return out;
}

/// Of a triangle, at a place in it.
double heightAt(const Triangulation& mesh, const Triangulation::Triangle& one, std::int32_t x,
                std::int32_t y) {
  double sum = 0, whole = 0;
  for (int i = 0; i < 3; ++i) {
    const Triangulation::Vertex &a = mesh.vertices[one.corner[Triangulation::next(i)]],
                                &b = mesh.vertices[one.corner[Triangulation::before(i)]];
    const auto beside = static_cast<double>(Triangulation::turn(a, b, x, y));
    sum += beside * mesh.vertices[one.corner[i]].z;
    whole += beside;
  }
  return sum / whole;
}

[[maybe_unused]] bool allFinite(const HeightField& field, std::span<const PolygonMesher::Point> border) {
  std::uint32_t west = ~0u, east = 0, south = ~0u, north = 0;
  for (const PolygonMesher::Point& p : border) {
    west = std::min(west, p.column / field.step), east = std::max(east, p.column / field.step);
    south = std::min(south, p.row / field.step), north = std::max(north, p.row / field.step);
  }
  for (std::uint32_t row = south; row <= north; ++row)
    for (std::uint32_t column = west; column <= east; ++column)
      if (!std::isfinite(field.at(column, row))) return false;
  return true;
}

}  // namespace

void GreedyMesh::begin(const HeightField& field, std::span<const Point> border,
                       std::span<const float> borderZ) {
  assert(border.size() >= 3 && (borderZ.empty() || borderZ.size() == border.size()));
  originX_ = originY_ = ~0u;
  for (const Point& p : border) {
    assert(p.column / field.step < field.columns && p.row / field.step < field.rows);
    originX_ = std::min(originX_, p.column);
    originY_ = std::min(originY_, p.row);
  }
  assert(allFinite(field, border));
  originX_ -= originX_ % field.step;
  originY_ -= originY_ % field.step;
  step_ = static_cast<std::int32_t>(field.step);
  z_ = field.z + originY_ / field.step * field.stride + originX_ / field.step;
  stride_ = field.stride;
  columns_ = static_cast<std::int32_t>(field.columns - originX_ / field.step);
  border_.reset();
  posts_ = 0;
  points_.assign(border.begin(), border.end());
  mesh_.vertices.clear();
  for (std::size_t i = 0; i < border.size(); ++i) {
    const Point& p = border[i];
    mesh_.vertices.push_back(
        {static_cast<std::int32_t>(p.column - originX_), static_cast<std::int32_t>(p.row - originY_),
         borderZ.empty() ? field.at(p.column / field.step, p.row / field.step) : borderZ[i]});
  }
  mesh_.fillPolygon();
  error_.assign(mesh_.triangles.size(), kUnknown);
  squares_.assign(mesh_.triangles.size(), 0);
  unknown_ = true;
}

std::uint32_t GreedyMesh::addBorder(std::uint32_t from, Point at) {
  const auto v = static_cast<std::uint32_t>(points_.size());
  const auto x = static_cast<std::int32_t>(at.column - originX_),
             y = static_cast<std::int32_t>(at.row - originY_);
  border_.reset();
  points_.push_back(at);
  mesh_.vertices.push_back({x, y, row(y / step_)[x / step_]});
  mesh_.splitBorder(from, v);
  error_.resize(mesh_.triangles.size());
  squares_.resize(mesh_.triangles.size());
  // All that changed is about v, from one side of it on the border to the other.
  std::int32_t h = 4 * (mesh_.borderEdge[v] >> 2) + 2;
  while (h >= 0) {
    error_[static_cast<std::size_t>(h >> 2)] = kUnknown;
    h = mesh_.triangles[static_cast<std::size_t>(h >> 2)].twin[1];
  }
  unknown_ = true;
  return v;
}

TRIMTAB_LANES GreedyMesh::Scan GreedyMesh::scanPosts(const Triangulation::Vertex* const corner[3],
                                                     const bool border[3], const PostRows& posts,
                                                     std::int32_t everyRow) {
  // Places as one number: row times kPlaces + column.
  constexpr std::int64_t kPlaces = std::int64_t{1} << 20;
  Lanes worst{}, place{}, squares{};
  forEachFour(
      corner, border, posts,
      [&](const Lanes& off, const Lanes(&)[3], std::int32_t x, std::int32_t y)
          __attribute__((always_inline)) {
            Lanes size;
            absoluteLanes(off, size);
            const LaneMask more = size > worst;
            worst = more ? size : worst;
            place = more ? Lanes{} + static_cast<double>(y * kPlaces + x) : place;
            squares += off * off;
          },
      everyRow);
  const double most = mostOfLanes(worst);
  const LaneMask is = worst == Lanes{} + most;
  int lane = kLanes - 1;
  for (int k = kLanes - 2; k >= 0; --k) lane = is[k] != 0 ? k : lane;
  const auto at = static_cast<std::int64_t>(place[lane]) + lane;
  return {most, sumOfLanes(squares), static_cast<std::int32_t>(at % kPlaces),
          static_cast<std::int32_t>(at / kPlaces)};
}

GreedyMesh::Scan GreedyMesh::scanSteps(const Triangulation::Vertex* const corner[3],
                                       const bool border[3]) const {
  Scan scan;
  forEachRow(corner, border, step_, [&](const FacetRow& r) {
    const float* const z = row(r.y);
    double at = r.z;
    for (std::int32_t x = r.first; x <= r.last; ++x) {
      const double off = std::fabs(static_cast<double>(z[x]) - at);
      if (off > scan.worst) {
        scan.worst = off;
        scan.x = x;
        scan.y = r.y;
      }
      scan.squares += off * off;
      at += r.slope;
    }
  });
  return scan;
}

void GreedyMesh::scan(std::int32_t t, bool all) {
  const Facet facet = facetOf(mesh_, t);
  if (step_ == 1 &&
      Triangulation::turn(*facet.corner[0], *facet.corner[1], facet.corner[2]->x, facet.corner[2]->y) == 1) {
    // No post but its corners.
    error_[static_cast<std::size_t>(t)] = squares_[static_cast<std::size_t>(t)] = 0;
    return;
  }
  const auto worstOf = [&](const Scan& scan) {
    return roundedError(scan.worst, std::max(facet.scale, scan.worst));
  };
  Scan found;
  double worst = 0;
  const PostRows posts{z_, stride_, columns_};
  const auto [low, high] = std::minmax({facet.corner[0]->y, facet.corner[1]->y, facet.corner[2]->y});
  const bool some = !all && step_ == 1 && high - low >= kTall;
  if (some) {
    found = scanPosts(facet.corner, facet.border, posts, kEveryRow);
    found.squares = kUnknown;
    worst = worstOf(found);
  }
  if (!some || worst <= tolerance_) {
    found =
        step_ == 1 ? scanPosts(facet.corner, facet.border, posts, 1) : scanSteps(facet.corner, facet.border);
    worst = worstOf(found);
  }
  Triangulation::Triangle& one = mesh_.triangles[static_cast<std::size_t>(t)];
  one.postX = found.x;
  one.postY = found.y;
  error_[static_cast<std::size_t>(t)] = worst;
  squares_[static_cast<std::size_t>(t)] = worst == 0 ? 0 : found.squares;
  if (worst > tolerance_) queue_.put(t, worst);
}

void GreedyMesh::scanAbout(std::int32_t first) {
  std::int32_t t = first;
  do {
    queue_.remove(t);
    scan(t, false);
    t = mesh_.triangles[static_cast<std::size_t>(t)].twin[1] >> 2;
  } while (t != first);
}

void GreedyMesh::know(std::span<const PostSum> sums, double tolerance) {
  assert(sums.size() == error_.size());
  for (std::size_t t = 0; t < sums.size(); ++t) {
    error_[t] = sums[t].worst > tolerance ? kUnknown : sums[t].worst;
    squares_[t] = sums[t].squares;
  }
  unknown_ = true;
}

void GreedyMesh::refine(double tolerance, std::size_t mostVertices, double ease) {
  tolerance_ = std::max(tolerance, 0.0);
  queue_.begin(std::max(tolerance_, 0x1p-40));
  const auto count = static_cast<std::int32_t>(mesh_.triangles.size());
  for (std::int32_t t = 0; t < count; ++t) {
    const double error = error_[static_cast<std::size_t>(t)];
    if (error < 0)
      scan(t, false);
    else if (error > tolerance_)
      queue_.put(t, error);
  }
  unknown_ = false;
  for (std::int32_t t; points_.size() < mostVertices && (t = queue_.top()) >= 0;) {
    const Triangulation::Triangle& one = mesh_.triangles[static_cast<std::size_t>(t)];
    const std::int32_t x = one.postX * step_, y = one.postY * step_;
    float z = row(one.postY)[one.postX];
    if (ease > 0) {
      const double off = z - heightAt(mesh_, one, x, y);
      z = static_cast<float>(z - std::clamp(off, -ease, ease));
    }
    const auto v = static_cast<std::uint32_t>(points_.size());
    points_.push_back({static_cast<std::uint32_t>(x) + originX_, static_cast<std::uint32_t>(y) + originY_});
    mesh_.vertices.push_back({x, y, z});
    const std::int32_t about = mesh_.insert(t, v);
    error_.resize(mesh_.triangles.size());
    squares_.resize(mesh_.triangles.size());
    scanAbout(about);
  }
  if (queue_.top() < 0) return;
  for (std::size_t t = 0; t < squares_.size(); ++t)
    if (squares_[t] < 0) scan(static_cast<std::int32_t>(t), true);
}

template <class Visit>
void GreedyMesh::eachBorderPost(const Visit& visit) const {
  for (std::size_t v = 0; v < mesh_.borderEdge.size(); ++v) {
    const std::int32_t h = mesh_.borderEdge[v];
    if (h < 0) continue;
    const Triangulation::Triangle& one = mesh_.triangles[static_cast<std::size_t>(h >> 2)];
    const Triangulation::Vertex& a = mesh_.vertices[v];
    const Triangulation::Vertex& b = mesh_.vertices[one.corner[Triangulation::next(h & 3)]];
    const std::int32_t steps = std::gcd(b.x - a.x, b.y - a.y);
    const double rise = static_cast<double>(b.z) - a.z;
    const double scale = std::max(std::fabs(static_cast<double>(a.z)), std::fabs(static_cast<double>(b.z)));
    for (std::int32_t i = 1; i < steps; ++i) {
      const std::int32_t x = a.x + (b.x - a.x) / steps * i, y = a.y + (b.y - a.y) / steps * i;
      if (x % step_ != 0 || y % step_ != 0) continue;
      const double off = std::fabs(row(y / step_)[x / step_] - (a.z + rise * i / steps));
      visit(roundedError(off, std::max(scale, off)));
    }
  }
}

const PostSum& GreedyMesh::border() const {
  if (!border_) {
    border_.emplace();
    eachBorderPost([&](double off) {
      border_->worst = std::max(border_->worst, off);
      border_->squares += off * off;
    });
  }
  return *border_;
}

double GreedyMesh::maxErrorM() const {
  double worst = border().worst;
  if (!unknown_) {
    for (const double error : error_) worst = std::max(worst, error);
    return worst;
  }
  GreedyMesh copy(*this);
  copy.refine(HUGE_VAL, 0);
  return std::max(worst, copy.maxErrorM());
}

template <class Visit>
void GreedyMesh::eachInnerPost(const Visit& visit) const {
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh_.triangles.size()); ++t) {
    const Facet facet = facetOf(mesh_, t);
    forEachRow(facet.corner, facet.border, step_, [&](const FacetRow& r) {
      const float* const z = row(r.y);
      double at = r.z;
      for (std::int32_t x = r.first; x <= r.last; ++x) {
        const double off = std::fabs(z[x] - at);
        visit(roundedError(off, std::max(facet.scale, off)));
        at += r.slope;
      }
    });
  }
}

double GreedyMesh::rmsErrorM() const {
  if (unknown_) {
    GreedyMesh copy(*this);
    copy.refine(HUGE_VAL, 0);
    return copy.rmsErrorM();
  }
  double sum = border().squares;
  for (const double squares : squares_) sum += squares;
  return std::sqrt(sum / static_cast<double>(std::max<std::uint64_t>(posts(), 1)));
}

std::uint64_t GreedyMesh::posts() const {
  if (posts_ == 0) posts_ = countPosts();
  return posts_;
}

std::uint64_t GreedyMesh::countPosts() const {
  if (step_ != 1) {
    std::uint64_t count = 0;
    const auto add = [&](double) { ++count; };
    eachBorderPost(add);
    eachInnerPost(add);
    for (const Triangulation::Vertex& v : mesh_.vertices) count += v.x % step_ == 0 && v.y % step_ == 0;
    return count;
  }
  // Pick: twice the area = 2 inside + border - 2.
  std::int64_t area = 0, border = 0;
  for (std::size_t v = 0; v < mesh_.borderEdge.size(); ++v) {
    const std::int32_t h = mesh_.borderEdge[v];
    if (h < 0) continue;
    const Triangulation::Triangle& one = mesh_.triangles[static_cast<std::size_t>(h >> 2)];
    const Triangulation::Vertex& a = mesh_.vertices[v];
    const Triangulation::Vertex& b = mesh_.vertices[one.corner[Triangulation::next(h & 3)]];
    area += std::int64_t{a.x} * b.y - std::int64_t{b.x} * a.y;
    border += std::gcd(b.x - a.x, b.y - a.y);
  }
  return static_cast<std::uint64_t>((area + border + 2) / 2);
}

}  // namespace trimtab::terrain
