#include "builders.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>

#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/static_lod/error.h"
#include "trimtab/terrain/static_lod/lattice.h"
#include "trimtab/terrain/static_lod/level.h"

namespace trimtab::experiment {
namespace {

using terrain::Lattice;
using terrain::LatticeSurface;
using terrain::VerticalDistance;

SurfaceError against(const LatticeSurface& source, const VerticalDistance& toSource,
                     const LatticeSurface& surface) {
  SurfaceError error;
  double sum = 0;
  std::uint64_t samples = 0;
  const auto add = [&](std::optional<double> metres) {
    if (!metres) return;
    sum += *metres * *metres;
    error.maxM = std::max(error.maxM, *metres);
    ++samples;
  };
  const VerticalDistance toSurface(surface.vertices, surface.triangles);
  const auto count = [](const LatticeSurface& s) { return static_cast<std::uint32_t>(s.triangles.size()); };
  const std::set<Lattice> there(source.vertices.begin(), source.vertices.end());
  for (const Lattice& p : source.vertices) add(toSurface.metres(p, 0, count(surface)));
  for (const Lattice& p : surface.vertices)
    if (!there.contains(p)) add(toSource.metres(p, 0, count(source)));
  error.rmsM = samples > 0 ? std::sqrt(sum / static_cast<double>(samples)) : 0;
  return error;
}

Box boxOf(const LatticeSurface& surface) {
  Box box{1e9f, 1e9f, 1e9f, -1e9f, -1e9f, -1e9f};
  for (const Lattice& p : surface.vertices) {
    const Vec3 m = p.metres();
    box.minX = std::min(box.minX, static_cast<float>(m.x)),
    box.maxX = std::max(box.maxX, static_cast<float>(m.x));
    box.minY = std::min(box.minY, static_cast<float>(m.y)),
    box.maxY = std::max(box.maxY, static_cast<float>(m.y));
  }
  return box;
}

/// Patches of one depth over a tile, as they are gathered from pages.
struct Cut {
  LatticeSurface surface;
  std::uint64_t triangles = 0, vertices = 0;
};

void gather(const terrain::PatchMesh& mesh, std::size_t variant, const VerticalDistance& toSource, Cut& cut) {
  const auto first = mesh.firstIndex[variant], last = mesh.firstIndex[variant + 1];
  std::map<std::uint16_t, std::uint32_t> numbers;
  std::set<std::uint16_t> inside;
  const auto placed = [&](std::uint16_t v) {
    const terrain::PatchVertex& p = mesh.vertices[v];
    const auto step = [](std::int32_t origin, float metres) {
      return origin * 4096 + static_cast<std::int32_t>(std::lround(double{metres} * 256));
    };
    return Lattice{step(mesh.origin[0], p.x), step(mesh.origin[1], p.y), step(mesh.origin[2], p.z)};
  };
  for (std::uint32_t i = first; i + 2 < last; i += 3) {
    std::array<std::uint32_t, 3> corners{};
    std::int64_t x = 0, y = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint16_t v = mesh.indices[i + k];
      const auto [at, isNew] =
          numbers.try_emplace(v, static_cast<std::uint32_t>(cut.surface.vertices.size()));
      if (isNew) cut.surface.vertices.push_back(placed(v));
      corners[k] = at->second;
      x += cut.surface.vertices[at->second].x, y += cut.surface.vertices[at->second].y;
    }
    cut.surface.triangles.push_back(corners);
    const Lattice middle{static_cast<std::int32_t>(x / 3), static_cast<std::int32_t>(y / 3), 0};
    if (!toSource.at(middle)) continue;
    ++cut.triangles;
    for (std::size_t k = 0; k < 3; ++k) inside.insert(mesh.indices[i + k]);
  }
  cut.vertices += inside.size();
}

}  // namespace

std::vector<BuilderLevel> treeLevels(const terrain::StaticLodTerrain& trees, std::size_t tile) {
  const std::uint32_t levels = terrain::levelsOf(trees, tile);
  const LatticeSurface source = terrain::surfaceOfLevel(trees, tile, levels - 1);
  const VerticalDistance toSource(source.vertices, source.triangles);
  std::vector<BuilderLevel> all;
  for (std::uint32_t level = 0; level < levels; ++level) {
    const LatticeSurface surface = terrain::surfaceOfLevel(trees, tile, level);
    BuilderLevel& one = all.emplace_back(BuilderLevel{level, 0, against(source, toSource, surface)});
    one.error.triangles = surface.triangles.size();
    one.error.bytes = terrain::bytesOfLevel(trees, tile, level);
  }
  return all;
}

std::vector<BuilderLevel> patchLevels(const terrain::Database& terrain,
                                      const terrain::StaticLodTerrain& trees, std::size_t tile) {
  const auto patches = terrain.patches();
  std::vector<BuilderLevel> all;
  if (!patches) return all;
  const PatchIndex& index = patches->index();
  const LatticeSurface source = terrain::surfaceOfLevel(trees, tile, terrain::levelsOf(trees, tile) - 1);
  const VerticalDistance toSource(source.vertices, source.triangles);
  const Box ground = boxOf(source);
  const auto meets = [&](const Box& b) {
    return b.minX <= ground.maxX && b.maxX >= ground.minX && b.minY <= ground.maxY && b.maxY >= ground.minY;
  };
  std::map<std::uint8_t, std::array<Cut, PatchIndex::kMostVariants>> cuts;
  for (std::uint32_t p = 0; p < index.pages.size(); ++p) {
    const PatchIndex::Page& page = index.pages[p];
    const std::span<const Box> bounds(index.bounds.data() + page.firstPatch, page.patches);
    if (std::none_of(bounds.begin(), bounds.end(), meets)) continue;
    const auto read = patches->readPage(p);
    if (!read) return {};
    for (std::uint32_t i = 0; i < page.patches; ++i) {
      if (!meets(index.bounds[page.firstPatch + i])) continue;
      auto& of = cuts[index.depth[page.firstPatch + i]];
      for (std::size_t v = 0; v < index.variants(); ++v) gather(read->patches[i], v, toSource, of[v]);
    }
  }
  for (auto& [depth, of] : cuts)
    for (auto v = static_cast<std::uint32_t>(index.variants()); v-- > 0;) {
      Cut& cut = of[v];
      if (cut.triangles == 0) continue;
      terrain::weld(cut.surface.vertices, cut.surface.triangles);  // patches share their borders
      BuilderLevel& one = all.emplace_back(BuilderLevel{depth, v, against(source, toSource, cut.surface)});
      one.error.triangles = cut.triangles;
      one.error.bytes =
          cut.triangles * 3 * sizeof(std::uint16_t) + cut.vertices * sizeof(terrain::PatchVertex);
    }
  return all;
}

SurfaceError postsError(const terrain::Database& terrain, const terrain::StaticLodTerrain& trees,
                        std::size_t tile) {
  const LatticeSurface source = terrain::surfaceOfLevel(trees, tile, terrain::levelsOf(trees, tile) - 1);
  SurfaceError error;
  double sum = 0;
  std::uint64_t samples = 0;
  for (const Lattice& p : source.vertices) {
    const GeodeticPosition g = trees.index.frame.toGeodetic(p.metres());
    const auto height = terrain.heightAt(g.latitude, g.longitude);
    if (!height) continue;
    const double off = std::abs((*height - g.height).value());
    sum += off * off;
    error.maxM = std::max(error.maxM, off);
    ++samples;
  }
  error.rmsM = samples > 0 ? std::sqrt(sum / static_cast<double>(samples)) : 0;
  return error;
}

const BuilderLevel* ofNoMoreTriangles(const std::vector<BuilderLevel>& levels, std::uint64_t triangles) {
  const BuilderLevel* best = nullptr;
  for (const BuilderLevel& level : levels)
    if (level.error.triangles <= triangles &&
        (best == nullptr || level.error.triangles > best->error.triangles))
      best = &level;
  return best;
}

const BuilderLevel* ofNoGreaterRms(const std::vector<BuilderLevel>& levels, double rmsM) {
  const BuilderLevel* best = nullptr;
  for (const BuilderLevel& level : levels)
    if (level.error.rmsM <= rmsM && (best == nullptr || level.error.triangles < best->error.triangles))
      best = &level;
  return best;
}

}  // namespace trimtab::experiment
