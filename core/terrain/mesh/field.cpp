#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "errors.h"
#include "fit.h"
#include "regroup.h"
#include "thin.h"
#include "tiles.h"

namespace trimtab::terrain {

namespace {

/// So many more triangles than the budget are inserted where some are taken out again: with 1.16 the largest
/// error is 4 to 9 % more, with 1.4 4 to 6 % less for a tenth more time.
constexpr double kOver = 1.3;
/// Share of its bound that a coarse mesh is brought down to. With 0.765 it takes a tenth more time, and the
/// largest error is 1 to 3 % less: more vertices come than can go, and the bound has to be raised again.
constexpr double kNearer = 0.785;
/// Shares of a budget that are near enough.
struct Near {
  double least, most;
};

/// Refines until the triangles are near the budget, or the tolerance is down to `least`. The tolerance that
/// it ended at; of a sample that which all tiles may begin with.
double spend(MeshTiles& tiles, double tolerance, double least, double budget, Near near, bool sample,
             double& power) {
  double fits = HUGE_VAL, tooMany = 0, lastCount = 0, lastTolerance = 0;
  for (int step = 0; step < 100; ++step) {
    tiles.refine(tolerance);
    const auto count = static_cast<double>(tiles.triangles());
    if (count > near.most * budget) {
      // Too far, and insertion takes nothing back: again from the start, to where it was fewer.
      const double over = tolerance * std::pow(count / budget, 1 / power);
      if (sample && fits < HUGE_VAL) return std::min(over, fits);
      tooMany = tolerance;
      tolerance = fits == HUGE_VAL ? 1.02 * over : std::min(1.005 * over, 0.5 * (tolerance + fits));
      if (fits - tooMany < 1e-3 * fits) {
        // Many posts are off by the same: some of them are taken.
        // One step makes a little more or less of a tolerance than many did.
        for (tiles.refine(fits); static_cast<double>(tiles.triangles()) > budget; tiles.refine(fits))
          fits *= 1.005;
        tiles.add(static_cast<std::size_t>(budget), fits);
        return fits;
      }
      continue;
    }
    fits = tolerance;
    if (tolerance <= least) return tolerance;
    if (count >= near.least * budget) {
      if (sample) return fits * std::pow(count / budget, 1 / power);
      // A tolerance for the rest would often be too far, and each time all begins anew.
      if (near.most == 1) tiles.add(static_cast<std::size_t>(budget), fits);
      return fits;
    }
    if (lastCount > 0 && count > lastCount * 1.01)
      power = std::clamp(std::log(count / lastCount) / std::log(lastTolerance / tolerance), 0.8, 4.0);
    lastCount = count;
    lastTolerance = tolerance;
    // Part of the way first: the power is a guess that gets better.
    const double share = count / budget;
    const double aim = share < 0.2     ? 3 * share
                       : share < 0.6   ? 0.8
                       : share < 0.9   ? 0.965
                       : share < 0.985 ? 0.993
                                       : 0.9985;
    tolerance *= std::clamp(std::pow(share / aim, 1 / power), 0.4, 0.9995);
    tolerance = std::max({tolerance, least, tooMany == 0 ? 0 : 0.5 * (fits + tooMany)});
  }
  tiles.refine(fits);
  return fits;
}

void spend(MeshTiles& tiles, const HeightField& field, double least, double budget, Near near) {
  LaneRange heights(field.at(0, 0), field.at(0, 0));
  for (std::uint32_t y = 0; y < field.rows; ++y) {
    const float* const row = field.z + y * field.stride;
    heights.add(row, row + field.columns);
  }
  double tolerance = std::max(least, (static_cast<double>(heights.high()) - heights.low()) / 8), power = 1.5;
  // Tiles that are refined in many steps have a few triangles more than those that go straight to where they
  // end: so the steps are taken by some of them.
  if (const double share = tiles.take(true); share < 1)
    tolerance = spend(tiles, tolerance, least, budget * share, {0.85, 1.1}, true, power);
  tiles.take(false);
  spend(tiles, std::max(tolerance, least), least, budget, near, false, power);
}

struct Fitted {
  Triangulation mesh;
  std::vector<PostSum> sums;
};

/// All tiles as one mesh.
Fitted join(const MeshTiles& tiles, std::vector<std::vector<PostSum>> sums) {
  Fitted out{tiles.join(), {}};
  out.sums.reserve(out.mesh.triangles.size());
  for (std::size_t i = 0; i < tiles.count(); ++i) {
    forgetBorder(tiles.tile(i).mesh(), sums[i]);
    out.sums.insert(out.sums.end(), sums[i].begin(), sums[i].end());
  }
  return out;
}

PostRows rowsOf(const HeightField& field, const GreedyMesh& tile) {
  const PolygonMesher::Point origin = tile.origin();
  return {field.z + origin.row * field.stride + origin.column, field.stride,
          static_cast<std::int32_t>(field.columns - origin.column)};
}

/// Takes out `excess` vertices. Tiles give as many as they have triangles; what some have not to give, others
/// do in further rounds.
void thin(MeshTiles& tiles, const HeightField& field, double bound, std::size_t excess, int rounds,
          std::vector<std::vector<PostSum>>& sums) {
  std::vector<std::uint8_t> gives(tiles.count(), 1);
  for (int round = 0; round < rounds && excess > 0; ++round) {
    std::vector<std::size_t> before(1, 0);
    for (std::size_t i = 0; i < tiles.count(); ++i)
      before.push_back(before.back() + (gives[i] != 0 ? tiles.tile(i).mesh().triangles.size() : 0));
    const std::size_t total = before.back();
    if (total == 0) return;
    std::atomic<std::size_t> gone{0};
    tiles.eachTile([&](GreedyMesh& tile, std::size_t i) {
      const std::size_t share = excess * before[i + 1] / total - excess * before[i] / total;
      if (share == 0) return;
      MeshFit one(tile.mesh(), rowsOf(field, tile), std::move(sums[i]));
      const std::size_t given = MeshThin(tile.mesh(), one).thin(share, bound);
      gives[i] = given == share;
      gone += given;
      sums[i] = std::move(one.sums());
    });
    excess -= gone;
  }
}

/// A mesh in parts with other borders than those of tiles: what lay on their sides is free there.
class Regrouped {
 public:
  Regrouped(Fitted& all, const MeshTiles& tiles, const HeightField& field, unsigned threads)
      : all_(all), field_(field), width_(tiles.width()), height_(tiles.height()), threads_(threads) {}

  /// Flips edges and moves vertices, aside where the squares promise to fall by `least` of the square that
  /// one post may add. Takes out up to `excess` vertices.
  void fit(double bound, double least, std::size_t excess) {
    allGive();
    work(excess, true, [&](Triangulation& mesh, MeshFit& part, std::size_t share) {
      part.flipEdges(bound);
      part.moveHeights(bound, bound);
      part.moveAside(bound, least * bound * bound);
      return share == 0 || MeshThin(mesh, part).thin(share, bound) == share;
    });
  }
  /// Takes out up to `excess` vertices, none where there were too few the last time.
  void thin(double bound, std::size_t excess) {
    work(excess, false, [&](Triangulation& mesh, MeshFit& part, std::size_t share) {
      return MeshThin(mesh, part).thin(share, bound) == share;
    });
  }
  void allGive() { gives_.assign(partCount(all_.mesh, width_, height_), 1); }

 private:
  /// Parts give as many as they have triangles.
  std::size_t shareOf(const MeshPart& part, std::size_t excess) const {
    std::size_t before = 0, total = 0;
    for (std::size_t p = 0; p < gives_.size(); ++p) {
      if (p == part.index) before = total;
      if (gives_[p] != 0) total += part.first[p + 1] - part.first[p];
    }
    if (gives_[part.index] == 0) return 0;
    return excess * (before + part.members.size()) / total - excess * before / total;
  }

  template <class Work>
  void work(std::size_t excess, bool everyPart, const Work& visit) {
    std::vector<std::uint8_t> gives = gives_;
    const std::vector<std::int32_t> was =
        eachPart(all_.mesh, width_, height_, threads_, [&](const MeshPart& part) {
          const std::size_t share = shareOf(part, excess);
          if (share == 0 && !everyPart) return;
          std::vector<PostSum> some;
          some.reserve(part.members.size());
          for (const std::int32_t t : part.members) some.push_back(all_.sums[static_cast<std::size_t>(t)]);
          MeshFit one(part.mesh, {field_.z, field_.stride, static_cast<std::int32_t>(field_.columns)},
                      std::move(some));
          if (!visit(part.mesh, one, share)) gives[part.index] = 0;
          forgetBorder(part.mesh, one.sums());
          for (std::size_t k = 0; k < one.sums().size(); ++k)
            all_.sums[static_cast<std::size_t>(part.members[k])] = one.sums()[k];
        });
    gives_ = std::move(gives);
    if (was.empty()) return;
    for (std::size_t t = 0; t < was.size(); ++t) all_.sums[t] = all_.sums[static_cast<std::size_t>(was[t])];
    all_.sums.resize(was.size());
  }

  Fitted& all_;
  HeightField field_;
  std::int32_t width_, height_;
  unsigned threads_;
  std::vector<std::uint8_t> gives_;
};

/// As much as a vertex is moved aside for, of the squares that one post may add.
constexpr double kFirst = 0.2, kAgain = 0.1;

/// Flips edges and moves vertices; takes out what is more than `most` triangles, where that can be done.
Fitted fit(MeshTiles& tiles, const HeightField& field, double bound, std::size_t most, unsigned threads) {
  constexpr int kRounds = 4;  // The first is nearly always the last.
  const std::size_t total = tiles.triangles();
  std::vector<std::vector<PostSum>> sums(tiles.count());
  tiles.eachTile([&](GreedyMesh& tile, std::size_t i) {
    MeshFit one(tile.mesh(), rowsOf(field, tile), tile.sums());
    one.flipEdges(bound);
    one.moveHeights(bound, bound);
    // Where many are about to go, none is worth being moved aside yet.
    if (total <= most) one.moveAside(bound, kFirst * bound * bound);
    sums[i] = std::move(one.sums());
  });
  if (total > most) thin(tiles, field, bound, (total - most + 1) / 2, kRounds, sums);
  Fitted out = join(tiles, std::move(sums));
  Regrouped(out, tiles, field, threads).fit(bound, kAgain, 0);
  return out;
}

/// The same of a mesh with more than `most` triangles, and brings the posts that are furthest off nearer:
/// those that are beyond a lower bound where heights are fitted get vertices, and as many more go elsewhere.
Fitted fitNearer(MeshTiles& tiles, const HeightField& field, double bound, std::size_t most,
                 unsigned threads) {
  // In shares of the bound: with vertices at the posts themselves nearly twice as many would come.
  constexpr double kEase = 0.6;
  // As kAgain, for each post of a triangle.
  constexpr double kAside = 0.04;
  const double posts = static_cast<double>(field.columns) * field.rows / static_cast<double>(most);
  const double nearer = kNearer * bound;
  std::vector<std::vector<PostSum>> sums(tiles.count());
  tiles.eachTile([&](GreedyMesh& tile, std::size_t i) {
    // Edges are flipped when most of what is to go has gone: now that would win nothing.
    MeshFit one(tile.mesh(), rowsOf(field, tile), tile.sums());
    one.moveHeights(HUGE_VAL, nearer);
    tile.know(one.sums(), nearer);
    tile.refine(nearer, std::numeric_limits<std::size_t>::max(), kEase * nearer);
    sums[i] = tile.sums();
  });
  const auto excess = [&](std::size_t triangles) {
    return triangles > most ? (triangles - most + 1) / 2 : 0;
  };
  thin(tiles, field, nearer, excess(tiles.triangles()), 1, sums);
  Fitted out = join(tiles, std::move(sums));
  Regrouped parts(out, tiles, field, threads);
  parts.fit(nearer, kAside * posts, excess(out.mesh.triangles.size()));
  // The last of them, where the bound is in the way, for as little more as will do. A part that is asked for
  // one may have none to give, so that a few more are asked, and others after them.
  constexpr int kAsked = 4;
  double now = nearer;
  for (int round = 0; out.mesh.triangles.size() > most && now < bound; ++round) {
    now = std::min(nearer * (1 + 0.01 * round * round), bound);
    if (round > 0) parts.allGive();
    for (int asked = 0; asked < kAsked && out.mesh.triangles.size() > most; ++asked)
      parts.thin(now, excess(out.mesh.triangles.size()) + most / 2048);
  }
  return out;
}

Fitted unfitted(const MeshTiles& tiles) {
  std::vector<std::vector<PostSum>> sums;
  for (std::size_t i = 0; i < tiles.count(); ++i) sums.push_back(tiles.tile(i).sums());
  return join(tiles, std::move(sums));
}

}  // namespace

FieldMesh meshField(const HeightField& field, const MeshOptions& options) {
  FieldMesh out;
  if (field.columns < 2 || field.rows < 2) return out;
  const unsigned threads = std::max(options.threads, 1u);
  // A search for fewer than there can be would end nowhere.
  const std::size_t most = options.mostTriangles == 0 ? 0 : std::max<std::size_t>(options.mostTriangles, 2);
  // It would take a quarter more time of a mesh with 5 posts a triangle, and takes none of one with 50.
  constexpr std::size_t kCoarsePosts = 16;
  const bool nearer =
      options.fitHeights && most != 0 && std::size_t{field.columns} * field.rows >= kCoarsePosts * most;
  MeshTiles tiles(field, most, nearer ? kNearer : 1, threads);
  Fitted fitted;
  const auto make = [&](double share, Near near) {
    if (most == 0)
      tiles.refine(options.maxErrorM);
    else
      spend(tiles, field, options.maxErrorM, share * static_cast<double>(most), near);
    const double bound = std::max(options.maxErrorM, tiles.maxErrorM());
    const std::size_t keep = most == 0 ? tiles.triangles() : most;
    if (!options.fitHeights)
      fitted = unfitted(tiles);
    else if (nearer && tiles.triangles() > keep)
      fitted = fitNearer(tiles, field, bound, keep, threads);
    else
      fitted = fit(tiles, field, bound, keep, threads);
  };
  constexpr Near kStrictly{0.97, 1};
  if (options.fitHeights)
    make(kOver, {0.95, 1.07});
  else
    make(1, kStrictly);
  // Where none can be taken out, no more are put in.
  if (most != 0 && options.fitHeights && fitted.mesh.triangles.size() > most) make(1, kStrictly);
  const Triangulation& mesh = fitted.mesh;

  out.vertices.reserve(mesh.vertices.size());
  for (const Triangulation::Vertex& v : mesh.vertices)
    out.vertices.push_back({static_cast<std::uint32_t>(v.x), static_cast<std::uint32_t>(v.y), v.z});
  out.indices.reserve(mesh.triangles.size() * 3);
  for (const Triangulation::Triangle& t : mesh.triangles)
    out.indices.insert(out.indices.end(), t.corner, t.corner + 3);
  const PostErrors errors = postErrors(mesh, field, fitted.sums, threads);
  out.maxErrorM = errors.max;
  out.rmsErrorM = errors.rms;
  return out;
}

}  // namespace trimtab::terrain
