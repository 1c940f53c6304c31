#include "fit.h"

#include <algorithm>
#include <cmath>

namespace trimtab::terrain {

namespace {

using Vertex = Triangulation::Vertex;
using Triangle = Triangulation::Triangle;

/// More than what rounding adds, in shares of the least error that counts.
constexpr double kRounding = 1e-4;

}  // namespace

std::vector<std::int32_t> innerStarts(const Triangulation& mesh) {
  std::vector<std::int32_t> starts(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) starts[mesh.triangles[t].corner[i]] = 4 * static_cast<std::int32_t>(t) + i;
  for (const Triangle& one : mesh.triangles)
    for (int i = 0; i < 3; ++i)
      if (one.twin[i] < 0) starts[one.corner[i]] = starts[one.corner[Triangulation::next(i)]] = -1;
  return starts;
}

void forgetBorder(const Triangulation& mesh, std::span<PostSum> sums) {
  for (std::size_t t = 0; t < sums.size(); ++t) {
    const std::int32_t* const twin = mesh.triangles[t].twin;
    if (twin[0] < 0 || twin[1] < 0 || twin[2] < 0) sums[t] = PostSum::unknown();
  }
}

MeshFit::MeshFit(Triangulation& mesh, const PostRows& posts, std::vector<PostSum> sums)
    : mesh_(mesh), posts_(posts), sums_(std::move(sums)) {
  for (std::size_t t = 0; t < sums_.size(); ++t)
    if (!sums_[t].known()) sums_[t] = sumOf(static_cast<std::int32_t>(t));
}

PostSum MeshFit::sumOf(std::int32_t t) const {
  const Triangle& one = mesh_.triangles[static_cast<std::size_t>(t)];
  const bool border[3] = {one.twin[0] < 0, one.twin[1] < 0, one.twin[2] < 0};
  return sumOf(mesh_.vertices[one.corner[0]], mesh_.vertices[one.corner[1]], mesh_.vertices[one.corner[2]],
               border);
}

bool MeshFit::tryFlip(std::int32_t t, int i, double bound) {
  Triangle& one = mesh_.triangles[static_cast<std::size_t>(t)];
  const std::int32_t other = one.twin[i];
  const std::int32_t u = other >> 2;
  const int j = other & 3;
  const Triangle& two = mesh_.triangles[static_cast<std::size_t>(u)];
  PostSum& sumT = sums_[static_cast<std::size_t>(t)];
  PostSum& sumU = sums_[static_cast<std::size_t>(u)];
  const double now = sumT.squares + sumU.squares;
  // What can be won is less than a third of the squares that one post may have: leave it.
  if (now <= 0.3 * bound * bound) return false;
  const Vertex &a = mesh_.vertices[one.corner[i]], &b = mesh_.vertices[one.corner[Triangulation::next(i)]],
               &c = mesh_.vertices[one.corner[Triangulation::before(i)]],
               &d = mesh_.vertices[two.corner[Triangulation::before(j)]];
  const std::int64_t left = Triangulation::turn(a, d, c.x, c.y), right = Triangulation::turn(d, b, c.x, c.y);
  if (left <= 0 || right <= 0) return false;
  // A flip adds a tent over the four corners, as high as the two edges are apart where they cross. If its own
  // squares are twice those of the residuals, it hardly ever takes from them.
  const auto whole = static_cast<double>(left + right);
  const double above = static_cast<double>(Triangulation::turn(a, b, c.x, c.y));
  const double apart = (static_cast<double>(b.z) - a.z) * static_cast<double>(left) -
                       (static_cast<double>(c.z) - a.z) * (whole - above) -
                       (static_cast<double>(d.z) - a.z) * above;
  if (apart * apart > 24 * whole * now) return false;
  const bool borderT[3] = {two.twin[Triangulation::next(j)] < 0, false,
                           one.twin[Triangulation::before(i)] < 0};
  const PostSum newT = sumOf(a, d, c, borderT);
  if (newT.squares >= now || newT.worst > bound) return false;
  const bool borderU[3] = {two.twin[Triangulation::before(j)] < 0, one.twin[Triangulation::next(i)] < 0,
                           false};
  const PostSum newU = sumOf(d, b, c, borderU);
  if (newT.squares + newU.squares >= now * (1 - 1e-9) || newU.worst > bound) return false;
  if (i != 0) {
    const Triangle was = one;
    for (int k = 0; k < 3; ++k) one.corner[k] = was.corner[(i + k) % 3];
    for (int k = 0; k < 3; ++k) mesh_.link(4 * t + k, was.twin[(i + k) % 3]);
  }
  mesh_.flip(t);
  sumT = newT;
  sumU = newU;
  return true;
}

void MeshFit::flipEdges(double bound) {
  const auto count = static_cast<std::int32_t>(mesh_.triangles.size());
  for (std::int32_t t = 0; t < count; ++t)
    for (int i = 0; i < 3; ++i) {
      // Each edge once, from the triangle that comes later.
      const std::int32_t other = mesh_.triangles[static_cast<std::size_t>(t)].twin[i];
      if (other >= 0 && other >> 2 < t && tryFlip(t, i, bound)) break;
    }
}

TRIMTAB_LANES void MeshFit::measure(std::int32_t first, std::int32_t count) {
  for (auto t = static_cast<std::size_t>(first); t < static_cast<std::size_t>(first + count); ++t) {
    const Triangle& one = mesh_.triangles[t];
    const Vertex* const corner[3] = {&mesh_.vertices[one.corner[0]], &mesh_.vertices[one.corner[1]],
                                     &mesh_.vertices[one.corner[2]]};
    const bool border[3] = {one.twin[0] < 0, one.twin[1] < 0, one.twin[2] < 0};
    Lanes squares{}, worst{}, ww[3] = {}, wx[3] = {}, wr[3] = {};
    forEachFour(
        corner, border, posts_,
        [&](const Lanes& off, const Lanes(&w)[3], std::int32_t, std::int32_t) __attribute__((always_inline)) {
          Lanes size;
          absoluteLanes(off, size);
          worst = size > worst ? size : worst;
          squares += off * off;
          for (int i = 0; i < 3; ++i) {
            ww[i] += w[i] * w[i];
            wx[i] += w[i] * w[i == 2 ? 0 : i + 1];
            wr[i] += w[i] * off;
          }
        });
    sums_[t] = {sumOfLanes(squares), mostOfLanes(worst)};
    for (int i = 0; i < 3; ++i) {
      moments_[t].ww[i] = sumOfLanes(ww[i]);
      moments_[t].wx[i] = sumOfLanes(wx[i]);
      moments_[t].wr[i] = sumOfLanes(wr[i]);
    }
  }
}

/// Calls `visit(t, i)` for the triangles about an inner vertex, which is corner i of each.
template <class Visit>
void MeshFit::eachAbout(std::uint32_t v, const Visit& visit) const {
  std::int32_t h = starts_[v];
  do {
    const std::int32_t t = h >> 2;
    const int i = h & 3;
    h = mesh_.triangles[static_cast<std::size_t>(t)].twin[Triangulation::before(i)];
    visit(t, i);
  } while (h != starts_[v]);
}

void MeshFit::raise(std::uint32_t v, float z) {
  const double rise = static_cast<double>(z) - mesh_.vertices[v].z;
  if (rise == 0) return;
  eachAbout(v, [&](std::int32_t t, int i) {
    Moments& at = moments_[static_cast<std::size_t>(t)];
    double& squares = sums_[static_cast<std::size_t>(t)].squares;
    squares = std::max(squares + rise * (rise * at.ww[i] - 2 * at.wr[i]), 0.0);
    at.wr[i] -= rise * at.ww[i];
    at.wr[Triangulation::next(i)] -= rise * at.wx[i];
    at.wr[Triangulation::before(i)] -= rise * at.wx[Triangulation::before(i)];
  });
  mesh_.vertices[v].z = z;
}

void MeshFit::moveHeights(double bound, double own) {
  moments_.resize(mesh_.triangles.size());
  measure(0, static_cast<std::int32_t>(mesh_.triangles.size()));
  starts_ = innerStarts(mesh_);
  std::vector<float> before;
  before.reserve(mesh_.vertices.size());
  for (const Vertex& v : mesh_.vertices) before.push_back(v.z);
  // One sweep of Gauss and Seidel over the normal equations: a second wins 0.2 % of the RMS.
  for (std::uint32_t v = 0; v < before.size(); ++v) {
    if (starts_[v] < 0) continue;
    double wr = offAt(mesh_.vertices[v]), ww = 1;
    eachAbout(v, [&](std::int32_t t, int i) {
      wr += moments_[static_cast<std::size_t>(t)].wr[i];
      ww += moments_[static_cast<std::size_t>(t)].ww[i];
    });
    const double off = offAt(mesh_.vertices[v]), most = own * (1 - kRounding);
    raise(v, static_cast<float>(mesh_.vertices[v].z + std::clamp(wr / ww, off - most, off + most)));
  }
  keepBound(bound, kRounding * own, before);
}

/// Where heights brought posts beyond the bound, takes them back, and then as near as the bound allows.
void MeshFit::keepBound(double bound, double rounding, std::span<const float> before) {
  std::vector<std::int32_t> broken;
  const auto look = [&](std::int32_t t) {
    double& worst = sums_[static_cast<std::size_t>(t)].worst;
    worst = sumOf(t).worst;
    double ends = 0;
    for (const std::uint32_t v : mesh_.triangles[static_cast<std::size_t>(t)].corner)
      if (starts_[v] >= 0) ends = std::max(ends, std::fabs(offAt(mesh_.vertices[v])));
    if (std::max(worst, ends) > bound) broken.push_back(t);
  };
  for (std::size_t t = 0; t < sums_.size(); ++t) {
    double moved = 0, ends = 0;
    for (const std::uint32_t v : mesh_.triangles[t].corner) {
      moved = std::max(moved, std::fabs(static_cast<double>(mesh_.vertices[v].z) - before[v]));
      if (starts_[v] >= 0) ends = std::max(ends, std::fabs(offAt(mesh_.vertices[v])));
    }
    // The worst is no more than if all squares were of one post, or it had moved with the corner.
    PostSum& sum = sums_[t];
    const double most = std::min(sum.worst + moved, std::sqrt(sum.squares)) + rounding;
    if (std::max(most, ends) <= bound)
      sum.worst = most;
    else
      look(static_cast<std::int32_t>(t));
  }
  std::vector<std::uint32_t> back;
  while (!broken.empty()) {
    const std::int32_t t = broken.back();
    broken.pop_back();
    for (const std::uint32_t v : mesh_.triangles[static_cast<std::size_t>(t)].corner) {
      if (starts_[v] < 0 || mesh_.vertices[v].z == before[v]) continue;
      raise(v, before[v]);
      back.push_back(v);
      eachAbout(v, [&](std::int32_t u, int) { look(u); });
    }
  }
  for (const std::uint32_t v : back) {
    gather(v, mesh_.vertices[v]);
    float z;
    double squares;
    if (!bestHeight(mesh_.vertices[v].z, bound, z, squares) || squares >= rr_) continue;
    raise(v, z);
    eachAbout(v, [&](std::int32_t u, int) { sums_[static_cast<std::size_t>(u)].worst = bound; });
  }
}

bool MeshFit::mayStand(std::uint32_t v, const Vertex& there) const {
  bool may = true;
  eachAbout(v, [&](std::int32_t t, int i) {
    const Triangle& one = mesh_.triangles[static_cast<std::size_t>(t)];
    const Vertex &b = mesh_.vertices[one.corner[Triangulation::next(i)]],
                 &c = mesh_.vertices[one.corner[Triangulation::before(i)]];
    may = may && Triangulation::turn(there, b, c.x, c.y) > 0;
  });
  return may;
}

TRIMTAB_LANES void MeshFit::gather(std::uint32_t v, const Vertex& at) {
  std::size_t count = 0;
  Lanes rr{}, wrs{}, wws{};
  std::int32_t h = starts_[v];
  do {
    const Triangle& one = mesh_.triangles[static_cast<std::size_t>(h >> 2)];
    const int i = h & 3;
    const Vertex &b = mesh_.vertices[one.corner[Triangulation::next(i)]],
                 &c = mesh_.vertices[one.corner[Triangulation::before(i)]];
    const bool border[3] = {false, one.twin[Triangulation::next(i)] < 0, false};
    const Vertex* const corner[3] = {&at, &b, &c};
    forEachFour(
        corner, border, posts_,
        [&](const Lanes& r, const Lanes(&w)[3], std::int32_t, std::int32_t) __attribute__((always_inline)) {
          if (about_.size() < count + 4 * kLanes) about_.resize(2 * count + 8 * kLanes);
          std::memcpy(&about_[count], &r, sizeof r);
          std::memcpy(&about_[count + kLanes], &w[0], sizeof w[0]);
          count += 2 * kLanes;
          wrs += w[0] * r;
          wws += w[0] * w[0];
          rr += r * r;
        });
    h = one.twin[Triangulation::before(i)];
  } while (h != starts_[v]);
  // The vertex's own post.
  const double own = offAt(at);
  const Lanes r{own, 0, 0, 0}, w{1, 0, 0, 0};
  if (about_.size() < count + 2 * kLanes) about_.resize(2 * count + 2 * kLanes);
  std::memcpy(&about_[count], &r, sizeof r);
  std::memcpy(&about_[count + kLanes], &w, sizeof w);
  aboutCount_ = count + 2 * kLanes;
  wr_ = sumOfLanes(wrs) + own;
  ww_ = sumOfLanes(wws) + 1;
  rr_ = sumOfLanes(rr) + own * own;
}

/// Whether no post about the vertex is further off where it rises so far.
TRIMTAB_LANES bool MeshFit::keeps(double rise, double bound) const {
  Lanes worst{};
  for (std::size_t i = 0; i < aboutCount_; i += 2 * kLanes) {
    Lanes r, w, size;
    std::memcpy(&r, &about_[i], sizeof r);
    std::memcpy(&w, &about_[i + kLanes], sizeof w);
    absoluteLanes(r - w * rise, size);
    worst = size > worst ? size : worst;
  }
  return mostOfLanes(worst) <= bound;
}

bool MeshFit::bestHeight(float was, double bound, float& z, double& squares) const {
  const auto take = [&](float height) {
    z = height;
    const double d = static_cast<double>(z) - was;
    squares = rr_ + d * (d * ww_ - 2 * wr_);
  };
  // Mostly the best of all keeps the bound.
  const auto best = static_cast<float>(was + wr_ / ww_);
  if (keeps(static_cast<double>(best) - was, bound)) {
    take(best);
    return true;
  }
  double low = -HUGE_VAL, high = HUGE_VAL;
  for (std::size_t i = 0; i < aboutCount_; i += 2 * kLanes)
    for (std::size_t k = i; k < i + kLanes; ++k) {
      const double r = about_[k], w = about_[k + kLanes];
      if (w < 1e-9) {
        if (std::fabs(r) > bound) return false;
        continue;
      }
      // Those that allow what others allow anyway are not divided.
      if (r - bound > low * w) low = (r - bound) / w;
      if (r + bound < high * w) high = (r + bound) / w;
    }
  if (low > high) return false;
  auto height = static_cast<float>(was + std::clamp(wr_ / ww_, low, high));
  // Rounding to the precision of heights must not break the bound.
  double d = static_cast<double>(height) - was;
  if (d < low) height = std::nextafter(height, HUGE_VALF);
  if (d > high) height = std::nextafter(height, -HUGE_VALF);
  d = static_cast<double>(height) - was;
  if (d < low || d > high) {
    if (low > 0 || high < 0) return false;
    height = was;
  }
  take(height);
  return true;
}

MeshFit::Star MeshFit::starOf(std::uint32_t v) const {
  const Vertex& at = mesh_.vertices[v];
  const double own = offAt(at);
  Star star{.rr = own * own, .wr = own, .ww = 1};
  eachAbout(v, [&](std::int32_t t, int i) {
    const Triangle& one = mesh_.triangles[static_cast<std::size_t>(t)];
    const Vertex &b = mesh_.vertices[one.corner[Triangulation::next(i)]],
                 &c = mesh_.vertices[one.corner[Triangulation::before(i)]];
    const double wr = moments_[static_cast<std::size_t>(t)].wr[i],
                 ww = moments_[static_cast<std::size_t>(t)].ww[i];
    const std::int64_t twice = Triangulation::turn(at, b, c.x, c.y);
    // Moving the vertex by (dx, dy, dz) changes a residual by -w (dz - gx dx - gy dy).
    const double perArea = 1 / static_cast<double>(twice);
    const double zb = static_cast<double>(b.z) - at.z, zc = static_cast<double>(c.z) - at.z;
    const double gx = (zb * (c.y - at.y) - zc * (b.y - at.y)) * perArea;
    const double gy = ((b.x - at.x) * zc - (c.x - at.x) * zb) * perArea;
    star.area += twice;
    star.rr += sums_[static_cast<std::size_t>(t)].squares;
    star.wr += wr;
    star.ww += ww;
    star.xz -= ww * gx;
    star.yz -= ww * gy;
    star.xx += ww * gx * gx;
    star.xy += ww * gx * gy;
    star.yy += ww * gy * gy;
    star.rx -= wr * gx;
    star.ry -= wr * gy;
  });
  return star;
}

void MeshFit::tryAside(std::uint32_t v, double squares, double dx, double dy, double bound) {
  Vertex there = mesh_.vertices[v];
  there.x += static_cast<std::int32_t>(std::lround(dx));
  there.y += static_cast<std::int32_t>(std::lround(dy));
  if ((there.x == mesh_.vertices[v].x && there.y == mesh_.vertices[v].y) || !mayStand(v, there)) return;
  there.z = posts_.row(there.y)[there.x];
  gather(v, there);
  float z;
  double squaresThere;
  if (!bestHeight(there.z, bound, z, squaresThere) || squaresThere >= squares * (1 - 1e-4)) return;
  mesh_.vertices[v] = {there.x, there.y, z};
  eachAbout(v, [&](std::int32_t t, int) { measure(t, 1); });
}

void MeshFit::moveAside(double bound, double least) {
  for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
    if (starts_[v] < 0) continue;
    const Star star = starOf(v);
    if (star.rr < 0.4 * bound * bound) continue;
    // Newton's step with the height eliminated.
    const double xx = star.xx - star.xz * star.xz / star.ww, yy = star.yy - star.yz * star.yz / star.ww,
                 xy = star.xy - star.xz * star.yz / star.ww;
    const double rx = star.rx - star.xz * star.wr / star.ww, ry = star.ry - star.yz * star.wr / star.ww;
    const double damped = 1e-2 * (xx + yy) + 1e-300;
    const double det = (xx + damped) * (yy + damped) - xy * xy;
    const double dx = (rx * (yy + damped) - ry * xy) / det, dy = (ry * (xx + damped) - rx * xy) / det;
    if (!(dx * rx + dy * ry > least)) continue;
    const double most = std::max(1.0, 0.3 * std::sqrt(static_cast<double>(star.area) / 6));
    const double longest = std::max(std::fabs(dx), std::fabs(dy));
    const double part = longest > most ? most / longest : 1.0;
    tryAside(v, star.rr, dx * part, dy * part, bound);
  }
}

}  // namespace trimtab::terrain
