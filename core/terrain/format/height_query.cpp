#include "trimtab/terrain/format/height_query.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "trimtab/terrain/format/patch_shape.h"
#include "trimtab/terrain/format/patch_terrain.h"

namespace trimtab::terrain {

namespace {

/// Returns which quarter of a square holds a point, 0 to 1 along each side: 2 to 5 as PatchPlace::part.
int quarterOf(double u, double v) {
  const bool belowRising = v <= u, belowFalling = v <= 1 - u;
  if (belowRising) return belowFalling ? 2 : 3;
  return belowFalling ? 5 : 4;
}

}  // namespace

std::uint32_t leafPatchAt(const PatchIndex& index, double column, double row) {
  const int pair = pairs(index) - 1;
  const double cells = index.squareCells(pair);
  const auto squareOf = [&](double along, std::uint32_t posts) {
    return std::min(static_cast<std::uint32_t>(along / cells), squaresAlong(index, pair, posts) - 1);
  };
  const std::uint32_t c = squareOf(column, index.columns), r = squareOf(row, index.rows);
  const int part = quarterOf(column / cells - c, row / cells - r);
  const std::uint32_t squares = index.pageSquares();
  std::uint32_t found = PatchIndex::kNone;
  for (const PatchIndex::Page& page : index.pages) {
    if (page.pair != pair || page.column != c / squares || page.row != r / squares) continue;
    const auto places = placesOfPage(index, page);
    for (std::uint32_t i = 0; i < places.size(); ++i) {
      const PatchPlace& place = places[i];
      if (place.column != c || place.row != r || place.part < 2) continue;
      // On the line between two quarters, one of them may have nothing but that line.
      if (found == PatchIndex::kNone || place.part == part) found = page.firstPatch + i;
    }
  }
  return found;
}

HeightQuery::HeightQuery(std::shared_ptr<const Database> database, std::optional<PostSources> sources)
    : database_(std::move(database)), patches_(database_->patches()), sources_(std::move(sources)) {
  const TerrainInfo& info = database_->info();
  posts_ = {info.southWest.longitude.value(),
            info.southWest.latitude.value(),
            info.postLongitude.value(),
            info.postLatitude.value(),
            info.columns,
            info.rows};
}

Result<HeightQuery> HeightQuery::open(const std::filesystem::path& folder) {
  auto database = Database::open(folder);
  if (!database) return database.findings();
  Findings findings = database.findings();
  auto sources = readPostSources(folder);
  findings.insert(findings.end(), sources.findings().begin(), sources.findings().end());
  if (!sources) return findings;
  return Result<HeightQuery>(HeightQuery(std::move(database).value(), std::move(sources).value()),
                             std::move(findings));
}

std::optional<GroundAt> HeightQuery::at(Degrees latitude, Degrees longitude) const {
  const auto height = database_->heightAt(latitude, longitude);
  if (!height) return {};
  GroundAt ground{*height, {}, {}, false};
  const double column = std::clamp(posts_.columnOf(longitude.value()), 0.0, posts_.columns - 1.0),
               row = std::clamp(posts_.rowOf(latitude.value()), 0.0, posts_.rows - 1.0);
  if (patches_)
    if (const std::uint32_t patch = leafPatchAt(patches_->index(), column, row); patch != PatchIndex::kNone)
      ground.error = Metres{std::max(double{patches_->index().errorM[patch][0]},
                                     double{patches_->facts()[patch].bilinearErrorM[0]})};
  if (!sources_) return ground;
  struct Post {
    double weight;
    std::uint16_t source;
  };
  std::array<Post, 4> nearest{};
  for (std::uint32_t k = 0; k < 4; ++k) {
    const auto c = static_cast<std::uint32_t>(column) + k % 2, r = static_cast<std::uint32_t>(row) + k / 2;
    nearest[k] = {std::max(0.0, 1 - std::abs(column - c)) * std::max(0.0, 1 - std::abs(row - r)),
                  sources_->at(r, c)};
  }
  std::stable_sort(nearest.begin(), nearest.end(),
                   [](const Post& a, const Post& b) { return a.weight > b.weight; });
  // A post that is a millionth of the way to the next has no say in the height.
  constexpr double kNoSay = 1e-6;
  for (const Post& post : nearest) {
    if (post.weight < kNoSay) continue;
    if (post.source == kNoSource) {
      ground.filled = true;
      if (ground.sources.empty() && &post == &nearest[0]) return ground;
      continue;
    }
    const std::string& name = sources_->names()[post.source];
    if (std::find(ground.sources.begin(), ground.sources.end(), name) == ground.sources.end())
      ground.sources.push_back(name);
  }
  return ground;
}

}  // namespace trimtab::terrain
