#include "patch_support.h"

#include <algorithm>
#include "trimtab/terrain/format/patch_layout.h"

namespace trimtab::test {

using namespace terrain;

HeightGrid fractal(const PostGrid& posts, unsigned seed, double reliefM, double roughness) {
  HeightGrid grid = gridOf(posts, [](std::uint32_t, std::uint32_t) { return 0; });
  std::mt19937 random(seed);
  const std::uint32_t longest = std::max(posts.columns, posts.rows);
  for (std::uint32_t cells = 2; cells < longest; cells *= 2, reliefM *= std::exp2(-roughness)) {
    const std::size_t side = cells + 2;
    std::vector<double> noise(side * side);
    for (double& n : noise) n = static_cast<double>(random()) / 4294967296.0 - 0.5;
    for (std::uint32_t r = 0; r < posts.rows; ++r)
      for (std::uint32_t c = 0; c < posts.columns; ++c) {
        const double x = static_cast<double>(c) * cells / longest,
                     y = static_cast<double>(r) * cells / longest;
        const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
        const auto eased = [](double t) { return t * t * (3 - 2 * t); };
        const double u = eased(x - static_cast<double>(i)), v = eased(y - static_cast<double>(j));
        const double low = noise[j * side + i] * (1 - u) + noise[j * side + i + 1] * u;
        const double high = noise[(j + 1) * side + i] * (1 - u) + noise[(j + 1) * side + i + 1] * u;
        grid.heights[std::size_t{r} * posts.columns + c] +=
            static_cast<float>(reliefM * (low * (1 - v) + high * v));
      }
  }
  return grid;
}

HeightGrid imported(const std::string& file) {
  const std::vector<std::filesystem::path> sources{sharedDir() / file};
  auto read = importElevation(sources);
  return read ? std::move((*read).grid) : HeightGrid{};
}

WholeTerrain::WholeTerrain(std::shared_ptr<const PatchTerrain> of) : terrain(std::move(of)) {
  for (std::uint32_t page = 0; page < index().pages.size(); ++page)
    pages.push_back(terrain->readPage(page).value());
}

WholeTerrain built(const HeightGrid& grid, double leafToleranceM) {
  return built(grid, leafToleranceM, leafCellsOf(grid.posts));
}

WholeTerrain built(const HeightGrid& grid, double leafToleranceM, std::uint32_t leafCells) {
  return WholeTerrain(buildPatches(GridHeights(grid), leafToleranceM, leafCells));
}

DrawnVertex drawn(const PatchMesh& mesh, std::uint32_t vertex) {
  const PatchVertex& v = mesh.vertices[vertex];
  const auto steps = [](std::int32_t origin, float metres) {
    return std::int64_t{origin} * 4096 + static_cast<std::int64_t>(metres * 256.0f);
  };
  return {steps(mesh.origin[0], v.x), steps(mesh.origin[1], v.y), steps(mesh.origin[2], v.z),
          mesh.firstColumn + v.column, mesh.firstRow + v.row};
}

std::vector<Chosen> randomCut(const PatchIndex& index, std::mt19937& random, double share) {
  std::vector<std::uint8_t> split(index.diamonds.size(), 0);
  const auto chance = [&] { return static_cast<double>(random()) / 4294967296.0; };
  for (std::uint32_t d = 0; d < index.diamonds.size(); ++d) {
    bool may = true, any = false;
    for (std::size_t k = 0; k < 2; ++k) {
      const PatchIndex::Diamond& diamond = index.diamonds[d];
      if (diamond.parents[k] != PatchIndex::kNone && !split[diamond.parents[k]]) may = false;
      if (diamond.patches[k] != PatchIndex::kNone)
        any = any || index.children[diamond.patches[k]][0] != PatchIndex::kNone;
    }
    split[d] = may && any && chance() < share;
  }
  std::vector<Chosen> cut;
  for (std::uint32_t p = 0; p < index.size(); ++p) {
    const bool there = index.parent[p] == PatchIndex::kNone || split[index.diamond[index.parent[p]]];
    if (there && !split[index.diamond[p]]) cut.push_back({p, random() % index.variants()});
  }
  return cut;
}

std::vector<Pieces> piecesOf(const WholeTerrain& terrain) {
  std::vector<Pieces> pieces(terrain.index().size());
  for (std::uint32_t patch = 0; patch < pieces.size(); ++patch) {
    const PatchMesh& mesh = terrain.mesh(patch);
    std::vector<DrawnVertex> vertices;
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) vertices.push_back(drawn(mesh, i));
    for (std::size_t v = 0; v < terrain.index().variants(); ++v) {
      Piece& piece = pieces[patch][v];
      std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
      for (std::uint32_t i = mesh.firstIndex[v]; i < mesh.firstIndex[v + 1]; i += 3) {
        std::int64_t twice = 0;
        for (std::uint32_t k = 0; k < 3; ++k) {
          const std::uint32_t from = mesh.indices[i + k], to = mesh.indices[i + (k + 1) % 3];
          twice += std::int64_t{vertices[from].column} * vertices[to].row -
                   std::int64_t{vertices[from].row} * vertices[to].column;
          edges.push_back({from, to});
        }
        if (twice <= 0) piece.wrong = "a triangle of patch " + std::to_string(patch) + " has no area";
        piece.twiceArea += twice;
      }
      std::sort(edges.begin(), edges.end());
      if (std::adjacent_find(edges.begin(), edges.end()) != edges.end())
        piece.wrong = "an edge of patch " + std::to_string(patch) + " twice the same way round";
      for (const auto& [from, to] : edges)
        if (!std::binary_search(edges.begin(), edges.end(), std::pair(to, from)))
          piece.border.push_back({vertices[from], vertices[to]});
    }
  }
  return pieces;
}

std::string wrongWith(const PatchIndex& index, const std::vector<Pieces>& pieces,
                      const std::vector<Chosen>& cut) {
  using Edge = std::pair<DrawnVertex, DrawnVertex>;
  std::vector<Edge> forward, back;
  std::int64_t area = 0;
  for (const Chosen& c : cut) {
    const Piece& piece = pieces[c.patch][c.variant];
    if (!piece.wrong.empty()) return piece.wrong;
    area += piece.twiceArea;
    for (const auto& [a, b] : piece.border) {
      const bool end = (a.column == b.column && (a.column == 0 || a.column + 1 == index.columns)) ||
                       (a.row == b.row && (a.row == 0 || a.row + 1 == index.rows));
      if (end) continue;
      if (a < b)
        forward.push_back({a, b});
      else
        back.push_back({b, a});
    }
  }
  std::sort(forward.begin(), forward.end());
  std::sort(back.begin(), back.end());
  if (std::adjacent_find(forward.begin(), forward.end()) != forward.end()) return "patches overlap";
  const auto [f, b] = std::mismatch(forward.begin(), forward.end(), back.begin(), back.end());
  if (f != forward.end() || b != back.end()) {
    const auto& [from, to] = f != forward.end() ? *f : *b;
    return "crack from post " + std::to_string(from.column) + ", " + std::to_string(from.row) + " to " +
           std::to_string(to.column) + ", " + std::to_string(to.row);
  }
  const std::int64_t whole = 2 * std::int64_t{index.columns - 1} * (index.rows - 1);
  if (area != whole) return "area " + std::to_string(area) + " instead of " + std::to_string(whole);
  return "";
}

}  // namespace trimtab::test
