#include <algorithm>
#include <cmath>

#include "trimtab/terrain/mesher_fit.h"
#include "trimtab/terrain/mesher_tiles.h"

namespace trimtab::terrain {

namespace {

/// Refines until there are at least `enough` of `budget` triangles, never more than all of it, or the
/// tolerance is down to `least`. The tolerance that it ended at.
double spend(MeshTiles& tiles, double tolerance, double least, double budget, double enough, bool sample,
             double& power) {
  double fits = HUGE_VAL, tooMany = 0, lastCount = 0, lastTolerance = 0;
  for (int step = 0; step < 100; ++step) {
    tiles.refine(tolerance);
    const auto count = static_cast<double>(tiles.triangles());
    if (count > budget) {
      // Too far, and nothing is ever taken out: again from the start, to where it was fewer.
      const double over = tolerance * std::pow(count / budget, 1 / power);
      if (sample && fits < HUGE_VAL) return std::min(over, fits);
      tiles.restart(sample);
      tooMany = tolerance;
      tolerance = fits == HUGE_VAL ? 1.02 * over : std::min(1.005 * over, 0.5 * (tolerance + fits));
      if (fits - tooMany < 1e-3 * fits) {
        // Many posts are off by the same: some of them are taken.
        // One step makes a little more or less of a tolerance than many did.
        for (tiles.refine(fits); static_cast<double>(tiles.triangles()) > budget; tiles.refine(fits)) {
          fits *= 1.005;
          tiles.restart(sample);
        }
        tiles.add(static_cast<std::size_t>(budget), fits);
        return fits;
      }
      continue;
    }
    fits = tolerance;
    if (tolerance <= least) return tolerance;
    if (count >= enough * budget) {
      // A tolerance for the rest would often be too far, and each time all begins anew.
      if (!sample) tiles.add(static_cast<std::size_t>(budget), fits);
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

void spend(MeshTiles& tiles, const HeightField& field, double least, std::size_t budget) {
  float low = field.at(0, 0), high = low;
  for (std::uint32_t y = 0; y < field.rows; ++y) {
    const float* const row = field.z + y * field.stride;
    const auto [a, b] = std::minmax_element(row, row + field.columns);
    low = std::min(low, *a);
    high = std::max(high, *b);
  }
  const auto wanted = static_cast<double>(budget);
  double tolerance = std::max(least, (static_cast<double>(high) - low) / 8), power = 1.5;
  // Tiles that are refined in many steps have a few triangles more than those that go straight to where they
  // end: so the steps are taken by some of them.
  tiles.restart(true);
  if (tiles.taken() < 1) tolerance = spend(tiles, tolerance, least, wanted * tiles.taken(), 0.9, true, power);
  tiles.restart(false);
  spend(tiles, tolerance, least, wanted, 0.97, false, power);
}

}  // namespace

FieldMesh meshField(const HeightField& field, const MeshOptions& options) {
  FieldMesh out;
  if (field.columns < 2 || field.rows < 2) return out;
  const unsigned threads = std::max(options.threads, 1u);
  MeshTiles tiles(field, options.mostTriangles, threads);
  tiles.restart(false);
  if (options.mostTriangles == 0)
    tiles.refine(options.maxErrorM);
  else
    spend(tiles, field, options.maxErrorM, options.mostTriangles);
  const double bound = std::max(options.maxErrorM, tiles.maxErrorM());
  Triangulation mesh = options.fitHeights ? fitTiles(tiles, field, bound, threads) : tiles.join();
  std::vector<PostSum> sums = postSums(mesh, field, threads);
  if (options.fitHeights) mendPosts(mesh, field, bound, sums);

  out.vertices.reserve(mesh.vertices.size());
  for (const Triangulation::Vertex& v : mesh.vertices)
    out.vertices.push_back({static_cast<std::uint32_t>(v.x), static_cast<std::uint32_t>(v.y), v.z});
  out.indices.reserve(mesh.triangles.size() * 3);
  for (const Triangulation::Triangle& t : mesh.triangles)
    out.indices.insert(out.indices.end(), t.corner, t.corner + 3);
  const PostErrors errors = postErrors(mesh, field, sums);
  out.maxErrorM = errors.max;
  out.rmsErrorM = errors.rms;
  return out;
}

}  // namespace trimtab::terrain
