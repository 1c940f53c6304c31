#include "trimtab/terrain/mesher_fit.h"

#include <algorithm>
#include <cmath>

#include "trimtab/terrain/mesher_regroup.h"
#include "trimtab/terrain/mesher_scan.h"

namespace trimtab::terrain {

namespace {

using Vertex = Triangulation::Vertex;
using Triangle = Triangulation::Triangle;

/// Posts are brought within this share of the bound where that can be done.
constexpr double kMend = 0.95;

double post(const PostRows& posts, const Vertex& v) {
  return posts.row(v.y)[v.x];
}

}  // namespace

TRIMTAB_LANES PostSum MeshFit::sumOf(const Vertex& a, const Vertex& b, const Vertex& c,
                                     const bool border[3]) const {
  const Vertex* const corner[3] = {&a, &b, &c};
  Lanes squares{}, worst{};
  forEachFour(
      corner, border,
      posts_, [&](const Lanes& off, const Lanes&, std::int32_t, std::int32_t) __attribute__((always_inline)) {
        Lanes size;
        absoluteLanes(off, size);
        worst = size > worst ? size : worst;
        squares += off * off;
      });
  return {sumOfLanes(squares), mostOfLanes(worst)};
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
  // What can be won is less than a hundredth of what one post may be off: leave it.
  if (now <= 0.01 * bound * bound) return false;
  const Vertex &a = mesh_.vertices[one.corner[i]], &b = mesh_.vertices[one.corner[Triangulation::next(i)]],
               &c = mesh_.vertices[one.corner[Triangulation::before(i)]],
               &d = mesh_.vertices[two.corner[Triangulation::before(j)]];
  if (Triangulation::turn(a, d, c.x, c.y) <= 0 || Triangulation::turn(d, b, c.x, c.y) <= 0) return false;
  const double worst = std::max({bound, sumT.worst, sumU.worst});
  const bool borderT[3] = {two.twin[Triangulation::next(j)] < 0, false,
                           one.twin[Triangulation::before(i)] < 0};
  const PostSum newT = sumOf(a, d, c, borderT);
  if (newT.squares >= now || newT.worst > worst) return false;
  const bool borderU[3] = {two.twin[Triangulation::before(j)] < 0, one.twin[Triangulation::next(i)] < 0,
                           false};
  const PostSum newU = sumOf(d, b, c, borderU);
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

void MeshFit::flipEdges(double bound, int passes, std::vector<PostSum> known) {
  const auto count = static_cast<std::int32_t>(mesh_.triangles.size());
  sums_ = std::move(known);
  if (sums_.empty())
    for (std::int32_t t = 0; t < count; ++t) sums_.push_back(sumOf(t));
  changed_.assign(mesh_.triangles.size(), 1);
  for (int pass = 0; pass < passes; ++pass) {
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

bool MeshFit::mayStand(std::int32_t start, const Vertex& there) const {
  std::int32_t h = start;
  do {
    const Triangle& one = mesh_.triangles[static_cast<std::size_t>(h >> 2)];
    const Vertex &b = mesh_.vertices[one.corner[Triangulation::next(h & 3)]],
                 &c = mesh_.vertices[one.corner[Triangulation::before(h & 3)]];
    if (Triangulation::turn(there, b, c.x, c.y) <= 0) return false;
    h = one.twin[Triangulation::before(h & 3)];
  } while (h != start);
  return true;
}

TRIMTAB_LANES void MeshFit::gather(std::int32_t start, const Vertex& at, Star& star) {
  star = {};
  std::size_t count = 0;
  Lanes rr{}, worst{};
  std::int32_t h = start;
  do {
    const Triangle& one = mesh_.triangles[static_cast<std::size_t>(h >> 2)];
    const int i = h & 3;
    const Vertex &b = mesh_.vertices[one.corner[Triangulation::next(i)]],
                 &c = mesh_.vertices[one.corner[Triangulation::before(i)]];
    const std::int64_t twice = Triangulation::turn(at, b, c.x, c.y);
    star.area += twice;
    const bool border[3] = {false, one.twin[Triangulation::next(i)] < 0, false};
    const Vertex* const corner[3] = {&at, &b, &c};
    Lanes wrs{}, wws{};
    forEachFour(
        corner, border, posts_,
        [&](const Lanes& r, const Lanes& w, std::int32_t, std::int32_t) __attribute__((always_inline)) {
          if (about_.size() < count + 4 * kLanes) about_.resize(2 * count + 8 * kLanes);
          std::memcpy(&about_[count], &r, sizeof r);
          std::memcpy(&about_[count + kLanes], &w, sizeof w);
          count += 2 * kLanes;
          wrs += w * r;
          wws += w * w;
          rr += r * r;
          Lanes size;
          absoluteLanes(r, size);
          worst = size > worst ? size : worst;
        });
    const double wr = sumOfLanes(wrs), ww = sumOfLanes(wws);
    star.wr += wr;
    star.ww += ww;
    // Moving the vertex by (dx, dy, dz) changes a residual by -w (dz - gx dx - gy dy).
    const double perArea = 1 / static_cast<double>(twice);
    const double zb = static_cast<double>(b.z) - at.z, zc = static_cast<double>(c.z) - at.z;
    const double gx = (zb * (c.y - at.y) - zc * (b.y - at.y)) * perArea;
    const double gy = ((b.x - at.x) * zc - (c.x - at.x) * zb) * perArea;
    star.xz -= ww * gx;
    star.yz -= ww * gy;
    star.xx += ww * gx * gx;
    star.xy += ww * gx * gy;
    star.yy += ww * gy * gy;
    star.rx -= wr * gx;
    star.ry -= wr * gy;
    h = one.twin[Triangulation::before(i)];
  } while (h != start);
  // The vertex's own post.
  const double own = post(posts_, at) - at.z;
  const Lanes r{own, 0, 0, 0}, w{1, 0, 0, 0};
  if (about_.size() < count + 2 * kLanes) about_.resize(2 * count + 2 * kLanes);
  std::memcpy(&about_[count], &r, sizeof r);
  std::memcpy(&about_[count + kLanes], &w, sizeof w);
  star.posts = count + 2 * kLanes;
  star.wr += own;
  star.ww += 1;
  star.rr = sumOfLanes(rr) + own * own;
  star.worst = std::max(mostOfLanes(worst), std::fabs(own));
}

/// Whether no post about the vertex is further off than `limit` where it rises so far.
TRIMTAB_LANES bool MeshFit::keeps(const Star& star, double rise, double limit) const {
  Lanes worst{};
  for (std::size_t i = 0; i < star.posts; i += 2 * kLanes) {
    Lanes r, w, size;
    std::memcpy(&r, &about_[i], sizeof r);
    std::memcpy(&w, &about_[i + kLanes], sizeof w);
    absoluteLanes(r - w * rise, size);
    worst = size > worst ? size : worst;
  }
  return mostOfLanes(worst) <= limit;
}

bool MeshFit::bestHeight(const Star& star, float was, double limit, float& z, double& squares) const {
  const auto take = [&](float height) {
    z = height;
    const double d = static_cast<double>(z) - was;
    squares = star.rr + d * (d * star.ww - 2 * star.wr);
  };
  // Mostly the best of all keeps the limit.
  const auto best = static_cast<float>(was + star.wr / star.ww);
  if (keeps(star, static_cast<double>(best) - was, limit)) {
    take(best);
    return true;
  }
  double low = -HUGE_VAL, high = HUGE_VAL;
  for (std::size_t i = 0; i < star.posts; i += 2 * kLanes)
    for (std::size_t k = i; k < i + kLanes; ++k) {
      const double r = about_[k], w = about_[k + kLanes];
      if (w < 1e-9) {
        if (std::fabs(r) > limit) return false;
        continue;
      }
      // Those that allow what others allow anyway are not divided.
      if (r - limit > low * w) low = (r - limit) / w;
      if (r + limit < high * w) high = (r + limit) / w;
    }
  if (low > high) return false;
  auto height = static_cast<float>(was + std::clamp(star.wr / star.ww, low, high));
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
    if ((there.x != at.x || there.y != at.y) && mayStand(starts_[v], there)) {
      there.z = static_cast<float>(post(posts_, there));
      Star moved;
      gather(starts_[v], there, moved);
      float zThere;
      if (bestHeight(moved, there.z, limit, zThere, squares) && squares < least * (1 - 1e-4)) {
        best = there;
        best.z = zThere;
        better = true;
      }
    }
  }
  if (better) at = best;
}

void MeshFit::findStarts() {
  const auto count = static_cast<std::int32_t>(mesh_.triangles.size());
  starts_.assign(mesh_.vertices.size(), -1);
  for (std::int32_t t = 0; t < count; ++t)
    for (int i = 0; i < 3; ++i) starts_[mesh_.triangles[static_cast<std::size_t>(t)].corner[i]] = 4 * t + i;
  for (const Triangle& one : mesh_.triangles)
    for (int i = 0; i < 3; ++i)
      if (one.twin[i] < 0) starts_[one.corner[i]] = starts_[one.corner[Triangulation::next(i)]] = -1;
}

void MeshFit::moveVertices(double bound) {
  findStarts();
  for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v)
    if (starts_[v] >= 0) moveVertex(v, bound);
}

void MeshFit::mendPosts(double bound, std::span<PostSum> sums) {
  constexpr int kRounds = 3;
  findStarts();
  bool better = true;
  for (int round = 0; round < kRounds && better; ++round) {
    better = false;
    for (std::size_t t = 0; t < sums.size(); ++t)
      for (int i = 0; i < 3 && sums[t].worst > bound; ++i) {
        const std::uint32_t v = mesh_.triangles[t].corner[i];
        if (starts_[v] < 0 || !mendVertex(v, bound)) continue;
        better = true;
        std::int32_t h = starts_[v];
        do {
          sums[static_cast<std::size_t>(h >> 2)] = sumOf(h >> 2);
          h = mesh_.triangles[static_cast<std::size_t>(h >> 2)].twin[Triangulation::before(h & 3)];
        } while (h != starts_[v]);
      }
  }
}

bool MeshFit::mendVertex(std::uint32_t v, double bound) {
  constexpr int kHalvings = 5;
  Vertex& at = mesh_.vertices[v];
  Star star;
  gather(starts_[v], at, star);
  const double was = star.worst;
  Vertex best = at;
  // The least limit that some height keeps at its own place or one beside it, to a few percent.
  double high = was * (1 - 1e-3);
  for (std::int32_t place = 0; place < 9 && high > bound; ++place) {
    Vertex there = at;
    if (place != 0) {
      there.x += (place + 4) % 9 % 3 - 1;
      there.y += (place + 4) % 9 / 3 - 1;
      if (!mayStand(starts_[v], there)) continue;
      there.z = static_cast<float>(post(posts_, there));
      gather(starts_[v], there, star);
    }
    double low = 0;
    for (int i = 0; i < kHalvings && high > bound; ++i) {
      const double limit = std::max(bound, i == 0 ? high : 0.5 * (low + high));
      float z;
      double squares;
      if (bestHeight(star, there.z, limit, z, squares)) {
        high = limit;
        best = there;
        best.z = z;
      } else if (i == 0) {
        break;
      } else {
        low = limit;
      }
    }
  }
  if (best == at) return false;
  at = best;
  return true;
}

Triangulation fitTiles(MeshTiles& tiles, const HeightField& field, double bound, unsigned threads) {
  tiles.eachTile([&](GreedyMesh& tile) {
    const PolygonMesher::Point origin = tile.origin();
    MeshFit fit(tile.mesh(), {field.z + origin.row * field.stride + origin.column, field.stride,
                              static_cast<std::int32_t>(field.columns - origin.column)});
    fit.flipEdges(kMend * bound, 1, tile.sums());
    fit.moveVertices(kMend * bound);
  });
  // Again with other borders: what lay on the sides of tiles is free now.
  Triangulation mesh = tiles.join();
  eachPart(mesh, tiles.width(), tiles.height(), threads, [&](Triangulation& part) {
    MeshFit fit(part, {field.z, field.stride, static_cast<std::int32_t>(field.columns)});
    fit.flipEdges(kMend * bound, 3, {});
    fit.moveVertices(kMend * bound);
  });
  return mesh;
}

void mendPosts(Triangulation& mesh, const HeightField& field, double bound, std::vector<PostSum>& sums) {
  if (std::none_of(sums.begin(), sums.end(), [&](const PostSum& sum) { return sum.worst > kMend * bound; }))
    return;
  MeshFit(mesh, {field.z, field.stride, static_cast<std::int32_t>(field.columns)})
      .mendPosts(kMend * bound, sums);
}

}  // namespace trimtab::terrain
