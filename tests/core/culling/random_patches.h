#pragma once

#include <algorithm>
#include <map>
#include <random>
#include <tuple>

#include "trimtab/frame/patch_index.h"

namespace trimtab::test {

/// Right triangles over columns x rows posts (which need not be those that the root squares cover), with
/// heights and errors by chance: errors grow up the tree, boxes hold their descendants'. A post every 10 m.
class RandomPatches {
 public:
  static PatchIndex make(std::uint32_t columns, std::uint32_t rows, std::uint32_t rootCells,
                         std::uint32_t leafCells, std::size_t variants, unsigned seed) {
    RandomPatches patches(columns, rows, rootCells, leafCells, variants, seed);
    patches.addRoots();
    patches.addDescendants();
    patches.number();
    patches.measure();
    return std::move(patches.index_);
  }

 private:
  static constexpr std::uint32_t kNone = PatchIndex::kNone;
  struct Post {
    std::uint32_t column, row;
    friend bool operator==(const Post&, const Post&) = default;
  };
  static Post middle(Post a, Post b) { return {(a.column + b.column) / 2, (a.row + b.row) / 2}; }
  struct Triangle {
    Post apex, a, b;  ///< the right angle, and the ends of the hypotenuse
    std::uint8_t depth;
    std::size_t parent;
    std::array<std::size_t, 2> children;
    std::uint32_t number = kNone;
  };
  static constexpr std::size_t kNo = ~std::size_t{0};
  static constexpr std::uint32_t kPageSquares = 4;

  RandomPatches(std::uint32_t columns, std::uint32_t rows, std::uint32_t rootCells, std::uint32_t leafCells,
                std::size_t variants, unsigned seed)
      : leafCells_(leafCells), variants_(variants), random_(seed) {
    index_.columns = columns;
    index_.rows = rows;
    index_.rootCells = rootCells;
  }

  /// Whether the triangle has an area where the posts are.
  bool holdsPosts(const Triangle& t) const {
    std::vector<std::array<double, 2>> polygon;
    for (const Post p : {t.apex, t.a, t.b}) polygon.push_back({double(p.column), double(p.row)});
    for (const std::size_t axis : {0, 1}) {
      const double most = (axis == 0 ? index_.columns : index_.rows) - 1.0;
      std::vector<std::array<double, 2>> kept;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        if (p[axis] <= most) kept.push_back(p);
        if ((p[axis] < most) == (q[axis] < most) || p[axis] == most || q[axis] == most) continue;
        const double along = (most - p[axis]) / (q[axis] - p[axis]);
        kept.push_back({p[0] + along * (q[0] - p[0]), p[1] + along * (q[1] - p[1])});
      }
      polygon = std::move(kept);
    }
    double area = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const auto p = polygon[i], q = polygon[(i + 1) % polygon.size()];
      area += p[0] * q[1] - q[0] * p[1];
    }
    return std::abs(area) > 0.1;
  }

  void add(Triangle t) {
    if (!holdsPosts(t)) return;
    if (t.parent != kNo) {
      auto& children = triangles_[t.parent].children;
      children[children[0] == kNo ? 0 : 1] = triangles_.size();
    }
    t.children = {kNo, kNo};
    triangles_.push_back(t);
  }

  void addRoots() {
    const std::uint32_t s = index_.rootCells;
    for (std::uint32_t r = 0; r + 1 < index_.rows; r += s)
      for (std::uint32_t c = 0; c + 1 < index_.columns; c += s) {
        const Post sw{c, r}, se{c + s, r}, nw{c, r + s}, ne{c + s, r + s};
        // Diagonals alternate, so that squares side by side halve their common side together.
        if ((c / s + r / s) % 2 == 0) {
          add({se, sw, ne, 0, kNo, {}});
          add({nw, ne, sw, 0, kNo, {}});
        } else {
          add({sw, nw, se, 0, kNo, {}});
          add({ne, se, nw, 0, kNo, {}});
        }
      }
  }

  void addDescendants() {
    const std::uint32_t deepest =
        1 + 2 * static_cast<std::uint32_t>(std::countr_zero(index_.rootCells) - std::countr_zero(leafCells_));
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const Triangle t = triangles_[i];
      if (t.depth == deepest) continue;
      const Post m = middle(t.a, t.b);
      add({m, t.apex, t.a, static_cast<std::uint8_t>(t.depth + 1), i, {}});
      add({m, t.b, t.apex, static_cast<std::uint8_t>(t.depth + 1), i, {}});
    }
  }

  /// Pages from the coarsest, patches by page, and what links them.
  void number() {
    const auto pageOf = [&](const Triangle& t) {
      const std::uint32_t pair = t.depth / 2u, block = (index_.rootCells >> pair) * kPageSquares;
      // Twice the coordinates of a point well inside.
      const std::uint32_t column = (t.apex.column + middle(t.a, t.b).column) / 2,
                          row = (t.apex.row + middle(t.a, t.b).row) / 2;
      return std::tuple(pair, row / block, column / block);
    };
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::vector<std::size_t>> pages;
    for (std::size_t i = 0; i < triangles_.size(); ++i) pages[pageOf(triangles_[i])].push_back(i);
    std::uint32_t count = 0;
    for (const auto& [place, members] : pages) {
      const auto page = static_cast<std::uint32_t>(index_.pages.size());
      index_.pages.push_back({count, static_cast<std::uint32_t>(members.size()),
                              static_cast<std::uint8_t>(std::get<0>(place)), std::get<1>(place),
                              std::get<2>(place)});
      for (const std::size_t i : members) {
        triangles_[i].number = count++;
        order_.push_back(i);
        index_.page.push_back(page);
      }
    }
    const auto numberOf = [&](std::size_t i) { return i == kNo ? kNone : triangles_[i].number; };
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint8_t>, std::uint32_t> diamonds;
    for (const std::size_t i : order_) {
      const Triangle& t = triangles_[i];
      index_.depth.push_back(t.depth);
      index_.parent.push_back(numberOf(t.parent));
      index_.children.push_back({numberOf(t.children[0]), numberOf(t.children[1])});
      const auto [at, isNew] = diamonds.try_emplace(
          std::tuple(t.a.column + t.b.column, t.a.row + t.b.row, t.depth), index_.diamonds.size());
      if (isNew) index_.diamonds.push_back({});
      auto& patches = index_.diamonds[at->second].patches;
      patches[patches[0] == kNone ? 0 : 1] = t.number;
      index_.diamond.push_back(at->second);
    }
    for (PatchIndex::Diamond& diamond : index_.diamonds)
      for (std::size_t half = 0; half < 2; ++half) {
        const std::uint32_t patch = diamond.patches[half];
        if (patch != kNone && index_.parent[patch] != kNone)
          diamond.parents[half] = index_.diamond[index_.parent[patch]];
      }
  }

  void measure() {
    std::uniform_real_distribution<float> chance(0, 1);
    const std::size_t n = order_.size();
    index_.bounds.resize(n);
    index_.errorM = VariantTable<float>(variants_, n);
    index_.triangles = VariantTable<std::uint16_t>(variants_, n);
    for (std::size_t p = n; p-- > 0;) {
      const Triangle& t = triangles_[order_[p]];
      const auto metres = [](std::uint32_t post) { return 10 * static_cast<float>(post); };
      const float z = 900 * chance(random_);
      Box box{metres(std::min({t.apex.column, t.a.column, t.b.column})),
              metres(std::min({t.apex.row, t.a.row, t.b.row})),
              z,
              metres(std::min(index_.columns - 1, std::max({t.apex.column, t.a.column, t.b.column}))),
              metres(std::min(index_.rows - 1, std::max({t.apex.row, t.a.row, t.b.row}))),
              z + 200 * chance(random_)};
      const std::span<float> error = index_.errorM[p];
      float least = chance(random_) < 0.1f ? 0 : 0.2f * chance(random_);
      for (std::size_t v = 0; v < error.size(); ++v) {
        for (const std::uint32_t child : index_.children[p])
          if (child != kNone) least = std::max(least, index_.errorM[child][v] * (1 + chance(random_)));
        error[v] = least;
        least *= 1 + 0.3f * chance(random_);
        index_.triangles[p][v] = static_cast<std::uint16_t>(900 >> v);
      }
      for (const std::uint32_t child : index_.children[p])
        if (child != kNone) {
          box.minZ = std::min(box.minZ, index_.bounds[child].minZ);
          box.maxZ = std::max(box.maxZ, index_.bounds[child].maxZ);
        }
      index_.bounds[p] = box;
    }
  }

  std::uint32_t leafCells_;
  std::size_t variants_;
  std::mt19937 random_;
  PatchIndex index_;
  std::vector<Triangle> triangles_;
  std::vector<std::size_t> order_;
};

inline PatchIndex randomPatches(std::uint32_t columns, std::uint32_t rows, std::uint32_t rootCells,
                                std::uint32_t leafCells, std::size_t variants, unsigned seed) {
  return RandomPatches::make(columns, rows, rootCells, leafCells, variants, seed);
}

}  // namespace trimtab::test
