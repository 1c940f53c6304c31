#include "trimtab/terrain/mesh/mesher.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>

#include "queue.h"
#include "trimtab/terrain/mesh/lanes.h"
#include "trimtab/terrain/mesh/triangulation.h"

namespace trimtab::terrain {

namespace {

/// In a triangle of at least kTall rows, every kEveryRow-th row is enough to find a post to insert: its posts
/// soon lie in other triangles.
constexpr std::int32_t kTall = 16, kEveryRow = 4;
constexpr double kUnknown = -1;

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

/// Sums up over some posts.
struct PostSum {
  double squares = 0, worst = 0;
};

}  // namespace

/// Places are counted from `origin`, the least place of the border.
struct PolygonMesher::Impl {
  void begin(const HeightField& field, std::span<const Point> border, std::span<const float> borderZ);
  void refine(double tolerance, std::size_t mostVertices);
  double maxErrorM() const;
  double rmsErrorM() const;
  std::uint64_t posts() const;

  Triangulation mesh_;
  std::vector<Point> points_;

 private:
  /// A triangle's worst post, and the sum of the squares of all its errors.
  struct Scan {
    double worst = 0, squares = 0;
    std::int32_t x = 0, y = 0;
  };
  static Scan scanPosts(const Triangulation::Vertex* const corner[3], const bool border[3],
                        const PostRows& posts, std::int32_t everyRow);
  Scan scanSteps(const Triangulation::Vertex* const corner[3], const bool border[3]) const;
  /// Looks at all posts of triangle t, or only at so many as show that one is beyond the tolerance.
  void scan(std::int32_t t, bool all);
  void scanAbout(std::int32_t t);
  const float* row(std::int32_t y) const { return z_ + static_cast<std::size_t>(y) * stride_; }
  template <class Visit>
  void eachBorderPost(const Visit& visit) const;
  template <class Visit>
  void eachInnerPost(const Visit& visit) const;
  const PostSum& border() const;
  std::uint64_t countPosts() const;

  ErrorQueue queue_;
  std::vector<double> error_;    ///< worst error at the posts of each triangle
  std::vector<double> squares_;  ///< their sum per triangle; kUnknown if only some rows were looked at
  const float* z_ = nullptr;     ///< the height at the origin
  std::size_t stride_ = 0;
  std::uint32_t originX_ = 0, originY_ = 0;
  std::int32_t step_ = 1, columns_ = 0;
  double tolerance_ = 0;
  bool unknown_ = false;  ///< some errors are kUnknown
  // Refinement changes neither, so they are computed once.
  mutable std::optional<PostSum> border_;
  mutable std::uint64_t posts_ = 0;
};

void PolygonMesher::Impl::begin(const HeightField& field, std::span<const Point> border,
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

TRIMTAB_LANES PolygonMesher::Impl::Scan PolygonMesher::Impl::scanPosts(
    const Triangulation::Vertex* const corner[3], const bool border[3], const PostRows& posts,
    std::int32_t everyRow) {
  // Places as one number: row times kPlaces + column.
  constexpr std::int64_t kPlaces = std::int64_t{1} << 20;
  Lanes worst{}, place{}, squares{};
  forEachFour(
      corner, border, posts,
      [&](const Lanes& off, std::int32_t x, std::int32_t y) __attribute__((always_inline)) {
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

PolygonMesher::Impl::Scan PolygonMesher::Impl::scanSteps(const Triangulation::Vertex* const corner[3],
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

void PolygonMesher::Impl::scan(std::int32_t t, bool all) {
  const Facet facet = facetOf(mesh_, t);
  if (step_ == 1 &&
      Triangulation::turn(*facet.corner[0], *facet.corner[1], facet.corner[2]->x, facet.corner[2]->y) == 1) {
    // The triangle has no post but its corners.
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

void PolygonMesher::Impl::scanAbout(std::int32_t first) {
  std::int32_t t = first;
  do {
    queue_.remove(t);
    scan(t, false);
    t = mesh_.triangles[static_cast<std::size_t>(t)].twin[1] >> 2;
  } while (t != first);
}

void PolygonMesher::Impl::refine(double tolerance, std::size_t mostVertices) {
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
    const float z = row(one.postY)[one.postX];
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
void PolygonMesher::Impl::eachBorderPost(const Visit& visit) const {
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

const PostSum& PolygonMesher::Impl::border() const {
  if (!border_) {
    border_.emplace();
    eachBorderPost([&](double off) {
      border_->worst = std::max(border_->worst, off);
      border_->squares += off * off;
    });
  }
  return *border_;
}

double PolygonMesher::Impl::maxErrorM() const {
  double worst = border().worst;
  if (!unknown_) {
    for (const double error : error_) worst = std::max(worst, error);
    return worst;
  }
  Impl copy(*this);
  copy.refine(HUGE_VAL, 0);
  return std::max(worst, copy.maxErrorM());
}

template <class Visit>
void PolygonMesher::Impl::eachInnerPost(const Visit& visit) const {
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

double PolygonMesher::Impl::rmsErrorM() const {
  if (unknown_) {
    Impl copy(*this);
    copy.refine(HUGE_VAL, 0);
    return copy.rmsErrorM();
  }
  double sum = border().squares;
  for (const double squares : squares_) sum += squares;
  return std::sqrt(sum / static_cast<double>(std::max<std::uint64_t>(posts(), 1)));
}

std::uint64_t PolygonMesher::Impl::posts() const {
  if (posts_ == 0) posts_ = countPosts();
  return posts_;
}

std::uint64_t PolygonMesher::Impl::countPosts() const {
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

PolygonMesher::PolygonMesher() : impl_(std::make_unique<Impl>()) {}
PolygonMesher::~PolygonMesher() = default;

void PolygonMesher::begin(const HeightField& field, std::span<const Point> border,
                          std::span<const float> borderZ) {
  impl_->begin(field, border, borderZ);
}
void PolygonMesher::refine(double tolerance, std::size_t mostVertices) {
  impl_->refine(tolerance, mostVertices);
}
const std::vector<PolygonMesher::Point>& PolygonMesher::vertices() const {
  return impl_->points_;
}
void PolygonMesher::triangles(std::vector<std::uint32_t>& indices, std::vector<std::int32_t>* twins) const {
  const std::vector<Triangulation::Triangle>& all = impl_->mesh_.triangles;
  indices.resize(all.size() * 3);
  for (std::size_t t = 0; t < all.size(); ++t) std::copy_n(all[t].corner, 3, &indices[3 * t]);
  if (twins == nullptr) return;
  twins->resize(all.size() * 3);
  for (std::size_t t = 0; t < all.size(); ++t) std::copy_n(all[t].twin, 3, &(*twins)[3 * t]);
}
double PolygonMesher::maxErrorM() const {
  return impl_->maxErrorM();
}
double PolygonMesher::rmsErrorM() const {
  return impl_->rmsErrorM();
}
std::uint32_t PolygonMesher::posts() const {
  return static_cast<std::uint32_t>(impl_->posts());
}

}  // namespace trimtab::terrain
