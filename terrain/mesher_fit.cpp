#include "trimtab/terrain/mesher_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "trimtab/terrain/mesher_regroup.h"
#include "trimtab/terrain/mesher_scan.h"

namespace trimtab::terrain {

namespace {

using Vertex = Triangulation::Vertex;
using Triangle = Triangulation::Triangle;

/// Posts are brought within this share of the bound where that can be done.
constexpr double kMend = 0.95;

double post(const float* z, std::size_t stride, const Vertex& v) {
  return z[static_cast<std::size_t>(v.y) * stride + static_cast<std::size_t>(v.x)];
}

}  // namespace

MeshFit::Sum MeshFit::sumOf(const Vertex& a, const Vertex& b, const Vertex& c, const bool border[3]) const {
  const Vertex* const corner[3] = {&a, &b, &c};
  Sum sum;
  forEachRow(corner, border, 1, [&](const FacetRow& r) {
    const float* const z = z_ + static_cast<std::size_t>(r.y) * stride_;
    double at = r.z;
    for (std::int32_t x = r.first; x <= r.last; ++x) {
      const double off = z[x] - at;
      sum.squares += off * off;
      sum.worst = std::max(sum.worst, std::fabs(off));
      at += r.slope;
    }
  });
  return sum;
}

MeshFit::Sum MeshFit::sumOf(std::int32_t t) const {
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
  Sum& sumT = sums_[static_cast<std::size_t>(t)];
  Sum& sumU = sums_[static_cast<std::size_t>(u)];
  const double now = sumT.squares + sumU.squares;
  // What can be won is less than a hundredth of what one post may be off: leave it.
  if (now <= 0.01 * bound * bound) return false;
  const Vertex &a = mesh_.vertices[one.corner[i]], &b = mesh_.vertices[one.corner[Triangulation::next(i)]],
               &c = mesh_.vertices[one.corner[Triangulation::before(i)]],
               &d = mesh_.vertices[two.corner[Triangulation::before(j)]];
  if (Triangulation::turn(a, d, c.x, c.y) <= 0 || Triangulation::turn(d, b, c.x, c.y) <= 0) return false;
  const double worst = std::max({bound, sumT.worst, sumU.worst});
  const bool borderT[3] = {two.twin[Triangulation::next(j)] < 0, false,
                           one.twin[Triangulation::before(i)] < 0};
  const Sum newT = sumOf(a, d, c, borderT);
  if (newT.squares >= now || newT.worst > worst) return false;
  const bool borderU[3] = {two.twin[Triangulation::before(j)] < 0, one.twin[Triangulation::next(i)] < 0,
                           false};
  const Sum newU = sumOf(d, b, c, borderU);
  if (newT.squares + newU.squares >= now * (1 - 1e-9) || newU.worst > worst) return false;
  if (i != 0) {
    const Triangle was = one;
    for (int k = 0; k < 3; ++k) one.corner[k] = was.corner[(i + k) % 3];
    for (int k = 0; k < 3; ++k) mesh_.link(4 * t + k, was.twin[(i + k) % 3]);
  }
  mesh_.flip(t);
  sumT = newT;
  sumU = newU;
  changed_[static_cast<std::size_t>(t)] = changed_[static_cast<std::size_t>(u)] = 1;
  return true;
}

void MeshFit::flipEdges(double bound) {
  const auto count = static_cast<std::int32_t>(mesh_.triangles.size());
  for (int pass = 0; pass < 3; ++pass) {
    std::size_t flips = 0;
    for (std::int32_t t = 0; t < count; ++t) {
      if (!changed_[static_cast<std::size_t>(t)]) continue;
      changed_[static_cast<std::size_t>(t)] = 0;
      for (int i = 0; i < 3; ++i) {
        const std::int32_t other = mesh_.triangles[static_cast<std::size_t>(t)].twin[i];
        if (other < 0) continue;
        // Where both changed, once: from the one that comes later, as the other is not changed any more.
        if (changed_[static_cast<std::size_t>(other >> 2)] && other >> 2 > t) continue;
        if (tryFlip(t, i, bound)) {
          ++flips;
          break;
        }
      }
    }
    if (flips * 50 < static_cast<std::size_t>(count)) break;
  }
}

bool MeshFit::gather(std::int32_t start, const Vertex& at, Star& star) {
  star = {};
  std::size_t count = 0;
  std::int32_t h = start;
  do {
    const Triangle& one = mesh_.triangles[static_cast<std::size_t>(h >> 2)];
    const int i = h & 3;
    const Vertex &b = mesh_.vertices[one.corner[Triangulation::next(i)]],
                 &c = mesh_.vertices[one.corner[Triangulation::before(i)]];
    const std::int64_t twice = Triangulation::turn(at, b, c.x, c.y);
    if (twice <= 0) return false;
    star.area += twice;
    const double area = static_cast<double>(twice);
    const bool border[3] = {false, one.twin[Triangulation::next(i)] < 0, false};
    const Vertex* const corner[3] = {&at, &b, &c};
    const double slopeW = -static_cast<double>(c.y - b.y) / area;
    double wr = 0, ww = 0;
    forEachRow(corner, border, 1, [&](const FacetRow& row) {
      const float* const z = z_ + static_cast<std::size_t>(row.y) * stride_;
      double w = static_cast<double>(Triangulation::turn(b, c, row.first, row.y)) / area, facet = row.z;
      const std::size_t had = count;
      count += static_cast<std::size_t>(row.last - row.first + 1);
      if (about_.size() < count) about_.resize(2 * count);
      About* about = &about_[had];
      for (std::int32_t x = row.first; x <= row.last; ++x) {
        const double r = z[x] - facet;
        *about++ = {r, w};
        wr += w * r;
        ww += w * w;
        star.rr += r * r;
        star.worst = std::max(star.worst, std::fabs(r));
        w += slopeW;
        facet += row.slope;
      }
    });
    star.wr += wr;
    star.ww += ww;
    // Moving the vertex by (dx, dy, dz) changes a residual by -w (dz - gx dx - gy dy).
    const double zb = static_cast<double>(b.z) - at.z, zc = static_cast<double>(c.z) - at.z;
    const double gx = (zb * (c.y - at.y) - zc * (b.y - at.y)) / area;
    const double gy = ((b.x - at.x) * zc - (c.x - at.x) * zb) / area;
    star.xz -= ww * gx;
    star.yz -= ww * gy;
    star.xx += ww * gx * gx;
    star.xy += ww * gx * gy;
    star.yy += ww * gy * gy;
    star.rx -= wr * gx;
    star.ry -= wr * gy;
    h = one.twin[Triangulation::before(i)];
  } while (h != start);
  const double rv = post(z_, stride_, at) - at.z;
  if (about_.size() <= count) about_.resize(2 * count + 1);
  about_[count] = {rv, 1};
  star.posts = count + 1;
  star.wr += rv;
  star.ww += 1;
  star.rr += rv * rv;
  star.worst = std::max(star.worst, std::fabs(rv));
  return true;
}

bool MeshFit::bestHeight(const Star& star, float was, double limit, float& z, double& squares) const {
  double low = -HUGE_VAL, high = HUGE_VAL;
  for (std::size_t i = 0; i < star.posts; ++i) {
    const About& p = about_[i];
    if (p.w < 1e-9) {
      if (std::fabs(p.r) > limit) return false;
      continue;
    }
    const double inverse = 1 / p.w;
    low = std::max(low, (p.r - limit) * inverse);
    high = std::min(high, (p.r + limit) * inverse);
  }
  if (low > high) return false;
  z = static_cast<float>(was + std::clamp(star.wr / star.ww, low, high));
  // Rounding to the precision of heights must not break the bound.
  double d = static_cast<double>(z) - was;
  if (d < low) z = std::nextafter(z, HUGE_VALF);
  if (d > high) z = std::nextafter(z, -HUGE_VALF);
  d = static_cast<double>(z) - was;
  if (d < low || d > high) {
    if (low > 0 || high < 0) return false;
    z = was;
    d = 0;
  }
  squares = star.rr + d * (d * star.ww - 2 * star.wr);
  return true;
}

void MeshFit::moveVertex(std::uint32_t v, double bound) {
  Vertex& at = mesh_.vertices[v];
  Star star;
  gather(starts_[v], at, star);
  if (star.rr < 1e-3 * bound * bound) return;
  // Where a post is too far off already, any place that mends it is better; else none that makes it worse.
  const bool broken = star.worst > bound;
  double limit = bound, least = star.rr;
  Vertex best = at;
  float z;
  double squares;
  bool better = bestHeight(star, at.z, bound, z, squares);
  if (!better && broken) {
    limit = star.worst;
    better = bestHeight(star, at.z, limit, z, squares);
  }
  const bool mended = better && broken && limit == bound;
  if (better && (squares < least * (1 - 1e-4) || mended)) {
    least = squares;
    best.z = z;
  } else {
    better = false;
  }

  // Newton's step with the height eliminated.
  const double xx = star.xx - star.xz * star.xz / star.ww, yy = star.yy - star.yz * star.yz / star.ww,
               xy = star.xy - star.xz * star.yz / star.ww;
  const double rx = star.rx - star.xz * star.wr / star.ww, ry = star.ry - star.yz * star.wr / star.ww;
  const double damped = 1e-2 * (xx + yy) + 1e-300;
  const double det = (xx + damped) * (yy + damped) - xy * xy;
  const double dx = (rx * (yy + damped) - ry * xy) / det, dy = (ry * (xx + damped) - rx * xy) / det;
  if (dx * rx + dy * ry > 0.02 * star.rr) {
    const double most = std::max(1.0, 0.3 * std::sqrt(static_cast<double>(star.area) / 6));
    const double longest = std::max(std::fabs(dx), std::fabs(dy));
    const double part = longest > most ? most / longest : 1.0;
    Vertex there = at;
    there.x += static_cast<std::int32_t>(std::lround(dx * part));
    there.y += static_cast<std::int32_t>(std::lround(dy * part));
    if (there.x != at.x || there.y != at.y) {
      there.z = static_cast<float>(post(z_, stride_, there));
      Star moved;
      float zThere;
      if (gather(starts_[v], there, moved)) {
        if (bestHeight(moved, there.z, limit, zThere, squares) && squares < least * (1 - 1e-4)) {
          best = there;
          best.z = zThere;
          better = true;
        }
      }
    }
  }
  if (!better) return;
  at = best;
  moved_[v] = 1;
}

void MeshFit::moveVertices(double bound) {
  for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v)
    if (starts_[v] >= 0) moveVertex(v, bound);
}

void MeshFit::run(double bound, int sweeps) {
  const auto count = static_cast<std::int32_t>(mesh_.triangles.size());
  sums_.resize(static_cast<std::size_t>(count));
  changed_.assign(static_cast<std::size_t>(count), 1);
  moved_.assign(mesh_.vertices.size(), 0);
  for (std::int32_t t = 0; t < count; ++t) sums_[static_cast<std::size_t>(t)] = sumOf(t);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    flipEdges(bound);
    starts_.assign(mesh_.vertices.size(), -1);
    for (std::int32_t t = 0; t < count; ++t)
      for (int i = 0; i < 3; ++i) starts_[mesh_.triangles[static_cast<std::size_t>(t)].corner[i]] = 4 * t + i;
    for (const Triangle& one : mesh_.triangles)
      for (int i = 0; i < 3; ++i)
        if (one.twin[i] < 0) starts_[one.corner[i]] = starts_[one.corner[Triangulation::next(i)]] = -1;
    moveVertices(bound);
    if (sweep + 1 == sweeps) break;
    for (std::int32_t t = 0; t < count; ++t) {
      const Triangle& one = mesh_.triangles[static_cast<std::size_t>(t)];
      if (!moved_[one.corner[0]] && !moved_[one.corner[1]] && !moved_[one.corner[2]]) continue;
      changed_[static_cast<std::size_t>(t)] = 1;
      sums_[static_cast<std::size_t>(t)] = sumOf(t);
    }
    moved_.assign(mesh_.vertices.size(), 0);
  }
}

Triangulation fitTiles(MeshTiles& tiles, const HeightField& field, double bound, unsigned threads) {
  tiles.eachTile([&](GreedyMesh& tile) {
    const PolygonMesher::Point origin = tile.origin();
    MeshFit(tile.mesh(), field.z + origin.row * field.stride + origin.column, field.stride)
        .run(kMend * bound, 1);
  });
  // Again with other borders: what lay on the sides of tiles is free now.
  Triangulation mesh = tiles.join();
  eachPart(mesh, tiles.width(), tiles.height(), threads,
           [&](Triangulation& part) { MeshFit(part, field.z, field.stride).run(kMend * bound, 1); });
  return mesh;
}

PostErrors postErrors(const Triangulation& mesh, const HeightField& field, unsigned threads) {
  constexpr std::int32_t kAtOnce = 8192;
  const auto count = static_cast<std::int32_t>(mesh.triangles.size());
  const auto parts = static_cast<std::uint32_t>((count + kAtOnce - 1) / kAtOnce);
  struct Sum {
    double squares = 0, worst = 0;
  };
  std::vector<Sum> sums(parts + 1);
  const auto add = [](Sum& sum, double off) {
    sum.squares += off * off;
    sum.worst = std::max(sum.worst, std::fabs(off));
  };
  onThreads(threads, parts, [&](std::uint32_t part) {
    Sum sum;
    const std::int32_t first = static_cast<std::int32_t>(part) * kAtOnce,
                       end = std::min(count, first + kAtOnce);
    for (std::int32_t t = first; t < end; ++t) {
      const Triangle& one = mesh.triangles[static_cast<std::size_t>(t)];
      const Vertex* const corner[3] = {&mesh.vertices[one.corner[0]], &mesh.vertices[one.corner[1]],
                                       &mesh.vertices[one.corner[2]]};
      const bool border[3] = {one.twin[0] < 0, one.twin[1] < 0, one.twin[2] < 0};
      double scale = 0;
      for (const Vertex* v : corner) scale = std::max(scale, std::fabs(static_cast<double>(v->z)));
      forEachRow(corner, border, 1, [&](const FacetRow& r) {
        const float* const z = field.z + static_cast<std::size_t>(r.y) * field.stride;
        double at = r.z;
        for (std::int32_t x = r.first; x <= r.last; ++x) {
          const double off = std::fabs(z[x] - at);
          add(sum, roundedError(off, std::max(scale, off)));
          at += r.slope;
        }
      });
    }
    sums[part] = sum;
  });
  Sum& rest = sums[parts];
  for (const Vertex& v : mesh.vertices) add(rest, post(field.z, field.stride, v) - v.z);
  for (std::size_t v = 0; v < mesh.borderEdge.size(); ++v) {
    const std::int32_t h = mesh.borderEdge[v];
    if (h < 0) continue;
    const Vertex& a = mesh.vertices[v];
    const Triangle& one = mesh.triangles[static_cast<std::size_t>(h >> 2)];
    const Vertex& b = mesh.vertices[one.corner[Triangulation::next(h & 3)]];
    const std::int32_t steps = std::gcd(b.x - a.x, b.y - a.y);
    for (std::int32_t i = 1; i < steps; ++i) {
      const Vertex at{a.x + (b.x - a.x) / steps * i, a.y + (b.y - a.y) / steps * i, 0};
      const double facet = a.z + (static_cast<double>(b.z) - a.z) * i / steps;
      const double height = post(field.z, field.stride, at), off = std::fabs(height - facet);
      add(rest, roundedError(off, std::max({std::fabs(height), std::fabs(facet)})));
    }
  }
  PostErrors out;
  double squares = 0;
  for (const Sum& sum : sums) {
    squares += sum.squares;
    out.max = std::max(out.max, sum.worst);
  }
  out.rms = std::sqrt(squares / (static_cast<double>(field.columns) * field.rows));
  return out;
}

}  // namespace trimtab::terrain
