#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tests/core/terrain/grid/fill_grid.h"
#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/grid/post_grid.h"

/// What openElevation gives, as a whole grid in memory.
namespace trimtab::test {

/// Reads all rows; voids are NaN.
inline Result<terrain::HeightGrid> allRows(terrain::ElevationSource& source) {
  const terrain::PostGrid& posts = source.posts();
  constexpr std::uint32_t kBand = 128;
  terrain::HeightGrid grid{posts, std::vector<float>(posts.size()), 0, {}};
  std::vector<std::uint8_t> beyond;
  for (std::uint32_t row = 0; row < posts.rows; row += kBand) {
    const std::uint32_t rows = std::min(kBand, posts.rows - row);
    const std::size_t count = std::size_t{rows} * posts.columns;
    beyond.resize(count);
    const std::span<float> heights(grid.heights.data() + std::size_t{row} * posts.columns, count);
    if (auto read = source.readRows(row, rows, heights, beyond); !read) return read.findings();
    for (std::size_t i = 0; i < count; ++i)
      if (beyond[i] != 0 && std::isnan(heights[i])) ++grid.outside;
  }
  return grid;
}

/// Reads one file; voids are NaN.
inline Result<terrain::HeightGrid> readElevation(const std::filesystem::path& file) {
  auto source = terrain::openElevation(std::span(&file, 1));
  if (!source) return source.findings();
  auto grid = allRows(**source);
  if (!grid) return grid.findings();
  return Result<terrain::HeightGrid>(std::move(grid).value(), source.findings());
}

struct Imported {
  terrain::HeightGrid grid;  ///< no voids left
  std::uint64_t voidsFilled = 0;
};

/// Reads files or folders and fills the voids. Findings are those of openElevation, and the share of each
/// file.
inline Result<Imported> importElevation(std::span<const std::filesystem::path> sources) {
  auto source = terrain::openElevation(sources);
  if (!source) return source.findings();
  Findings findings = source.findings();
  auto grid = allRows(**source);
  if (!grid) return grid.findings();
  const Findings shares = terrain::sharesOf((*source)->names(), (*source)->given());
  findings.insert(findings.end(), shares.begin(), shares.end());
  Imported imported{std::move(grid).value(), 0};
  const std::uint64_t filled = fillVoids(imported.grid);
  imported.voidsFilled = filled - std::min(filled, imported.grid.outside);
  return Result<Imported>(std::move(imported), std::move(findings));
}

}  // namespace trimtab::test
