#include <algorithm>
#include <atomic>
#include <cmath>

#include "trimtab/terrain/mesher_errors.h"
#include "trimtab/terrain/mesher_fit.h"
#include "trimtab/terrain/mesher_regroup.h"
#include "trimtab/terrain/mesher_thin.h"
#include "trimtab/terrain/mesher_tiles.h"

namespace trimtab::terrain {

namespace {

/// So many more triangles than the budget are inserted where some are taken out again: with 1.16 the largest
/// error is 4 to 9 % more, with 1.4 4 to 6 % less for a tenth more time, from 1.5 on a coarse mesh gets
/// worse.
constexpr double kOver = 1.3;
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
/// do.
void thin(MeshTiles& tiles, const HeightField& field, double bound, std::size_t excess,
          std::vector<std::vector<PostSum>>& sums) {
  // The first round is nearly always the last.
  constexpr int kRounds = 4;
  std::vector<std::uint8_t> gives(tiles.count(), 1);
  for (int round = 0; round < kRounds && excess > 0; ++round) {
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

/// Flips edges and moves vertices; takes out what is more than `most` triangles, where that can be done.
Fitted fit(MeshTiles& tiles, const HeightField& field, double bound, std::size_t most, unsigned threads) {
  // Of the squares that one post may add.
  constexpr double kFirst = 0.2, kAgain = 0.1;
  const std::size_t total = tiles.triangles();
  std::vector<std::vector<PostSum>> sums(tiles.count());
  tiles.eachTile([&](GreedyMesh& tile, std::size_t i) {
    MeshFit one(tile.mesh(), rowsOf(field, tile), tile.sums());
    one.flipEdges(bound);
    one.moveHeights(bound);
    // Where many are about to go, none is worth being moved aside yet.
    if (total <= most) one.moveAside(bound, kFirst * bound * bound);
    sums[i] = std::move(one.sums());
  });
  if (total > most) thin(tiles, field, bound, (total - most + 1) / 2, sums);
  // Again with other borders: what lay on the sides of tiles is free now.
  Fitted out = join(tiles, std::move(sums));
  eachPart(
      out.mesh, tiles.width(), tiles.height(), threads,
      [&](Triangulation& part, std::span<const std::int32_t> members) {
        std::vector<PostSum> some;
        some.reserve(members.size());
        for (const std::int32_t t : members) some.push_back(out.sums[static_cast<std::size_t>(t)]);
        MeshFit one(part, {field.z, field.stride, static_cast<std::int32_t>(field.columns)}, std::move(some));
        one.flipEdges(bound);
        one.moveHeights(bound);
        one.moveAside(bound, kAgain * bound * bound);
        forgetBorder(part, one.sums());
        for (std::size_t k = 0; k < members.size(); ++k)
          out.sums[static_cast<std::size_t>(members[k])] = one.sums()[k];
      });
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
  MeshTiles tiles(field, most, threads);
  Fitted fitted;
  const auto make = [&](double share, Near near) {
    if (most == 0)
      tiles.refine(options.maxErrorM);
    else
      spend(tiles, field, options.maxErrorM, share * static_cast<double>(most), near);
    const double bound = std::max(options.maxErrorM, tiles.maxErrorM());
    const std::size_t keep = most == 0 ? tiles.triangles() : most;
    fitted = options.fitHeights ? fit(tiles, field, bound, keep, threads) : unfitted(tiles);
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
