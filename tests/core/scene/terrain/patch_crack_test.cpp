#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "patched_terrain.h"
#include "tests/core/scene/scene_test.h"
#include "tests/core/terrain/elevation/read_elevation.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"

namespace trimtab {
namespace {

using test::PatchedTerrain;

/// Patches of which some pages cannot be read, so that the land is coarser there; and of which one has a
/// border vertex out of its place.
class Mixture final : public terrain::PatchTerrain {
 public:
  Mixture(std::shared_ptr<const terrain::PatchTerrain> inner, double missing, std::uint32_t seed)
      : inner_(std::move(inner)), missing_(missing), seed_(seed) {}
  const PatchIndex& index() const override { return inner_->index(); }
  const std::vector<terrain::PatchFacts>& facts() const override { return inner_->facts(); }
  std::uint64_t pageBytes(std::uint32_t page) const override { return inner_->pageBytes(page); }
  Result<terrain::PatchPage> readPage(std::uint32_t page) const override {
    std::mt19937 random(seed_ + page * 7919);
    if (index().pages[page].pair > 0 && std::uniform_real_distribution<double>(0, 1)(random) < missing_)
      return Finding{Severity::error, "page", "", "it", "none"};
    auto read = inner_->readPage(page);
    if (shiftM == 0 || !read) return read;
    terrain::PatchPage shifted = std::move(read).value();
    for (terrain::PatchMesh& mesh : shifted.patches)
      if (!mesh.vertices.empty()) mesh.vertices.front().z += shiftM;
    return shifted;
  }
  float shiftM = 0;  ///< of the first vertex of each patch, which is on its border

 private:
  std::shared_ptr<const terrain::PatchTerrain> inner_;
  double missing_;
  std::uint32_t seed_;
};

/// Rough land of all sizes: midpoint displacement with H = 0.8 or so.
terrain::HeightGrid fractal(std::uint32_t cells) {
  terrain::HeightGrid grid;
  grid.posts = {7, 46, 1.0 / 1200, 1.0 / 1200, cells + 1, cells + 1};
  grid.heights.assign(grid.posts.size(), 0);
  std::mt19937 random(11);
  std::normal_distribution<float> normal;
  const auto at = [&](std::uint32_t c, std::uint32_t r) -> float& {
    return grid.heights[std::size_t{r} * (cells + 1) + c];
  };
  float size = 900;
  for (std::uint32_t step = cells; step > 1; step /= 2, size *= 0.57f) {
    const std::uint32_t half = step / 2;
    for (std::uint32_t r = half; r < cells; r += step)
      for (std::uint32_t c = half; c < cells; c += step)
        at(c, r) = 0.25f * (at(c - half, r - half) + at(c + half, r - half) + at(c - half, r + half) +
                            at(c + half, r + half)) +
                   size * normal(random);
    for (std::uint32_t r = 0; r <= cells; r += half)
      for (std::uint32_t c = (r / half % 2 == 0) ? half : 0; c <= cells; c += step) {
        float sum = 0, count = 0;
        const auto add = [&](std::uint32_t x, std::uint32_t y) {
          if (x <= cells && y <= cells) sum += at(x, y), ++count;
        };
        add(c - half, r), add(c + half, r), add(c, r - half), add(c, r + half);
        at(c, r) = sum / count + size * normal(random);
      }
  }
  return grid;
}

class PatchCracks : public test::SceneTest {
 protected:
  static constexpr int kW = 320, kH = 180;

  /// So many views of random places, heights, attitudes and scales; how many pixels show the clear colour
  /// where a ray from the eye must have met the drawn surface.
  ///
  /// The oracle: with one height over each place, what is drawn lies nowhere lower than the source's bilinear
  /// surface less what the drawn patches say that they err from it. A ray that begins above the drawn surface
  /// and comes to be lower than that, over the data, has met it. Rays, places and heights in doubles.
  std::size_t holes(const PatchedTerrain& terrain, int views, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::size_t found = 0;
    int seen = 0;
    // Where an eye would be under what is drawn, nothing is known.
    for (int i = 0; seen < views && i < 4 * views; ++i) {
      auto r = request(over(0.08 + 0.84 * unit(random), 0.08 + 0.84 * unit(random), 0), {});
      r.view.widthPx = kW;
      r.view.heightPx = kH;
      r.view.nearM = 0.5;
      r.attitude = {Degrees{360 * unit(random)}, Degrees{40 - 130 * unit(random)},
                    Degrees{360 * unit(random)}};
      r.terrain.form = TerrainForm::patches;
      r.waitForPages = true;
      r.overlays.showHoles = true;
      r.levers.drawn.errorPx = 0.3 * std::pow(100, unit(random));
      r.levers.drawn.lodScale = std::pow(8, unit(random));
      r.levers.drawn.occlusion = OcclusionResolution{160, 120};
      r.cullingCase = i % 3 == 0   ? CullingCase::none
                      : i % 3 == 1 ? CullingCase::view_frustum
                                   : CullingCase::proposed;
      // Above whatever may be drawn there.
      r.eye.height = r.eye.height + Metres{3 * std::pow(3000, unit(random))};
      FrameResult result;
      picture(r, &result);
      lower(terrain, result.visible.tiles);
      const double sink = errorUnder(terrain, r.eye);
      if (sink > 0) {
        r.eye.height = r.eye.height + Metres{sink};
        picture(r, &result);
        lower(terrain, result.visible.tiles);
      }
      if (errorUnder(terrain, r.eye) > sink) continue;
      found += holesIn(terrain, r);
      ++seen;
    }
    seen_ += seen;
    return found;
  }

  /// What the drawn patches may err by, by squares of posts; infinite where none is drawn.
  void lower(const PatchedTerrain& terrain, const std::vector<TileDraw>& drawn) {
    const terrain::PostGrid& posts = terrain.grid().posts;
    const PatchIndex& index = terrain.patches()->index();
    acrossSquares_ = (posts.columns + kSquare - 1) / kSquare;
    lowered_.assign(std::size_t{acrossSquares_} * ((posts.rows + kSquare - 1) / kSquare), -1);
    for (const TileDraw& patch : drawn) {
      const float error = terrain.patches()->facts()[patch.node].bilinearErrorM[patch.variant.number];
      // The patch's square, from its box: a little more does no harm.
      const Box& b = index.bounds[patch.node];
      double west = 1e9, east = -1e9, south = 1e9, north = -1e9;
      for (const float x : {b.minX, b.maxX})
        for (const float y : {b.minY, b.maxY})
          for (const float z : {b.minZ, b.maxZ}) {
            const auto [column, row, height] = postOf(terrain, {x, y, z});
            west = std::min(west, column), east = std::max(east, column);
            south = std::min(south, row), north = std::max(north, row);
          }
      const auto square = [](double post, std::uint32_t count) {
        return static_cast<std::uint32_t>(std::clamp(post, 0.0, count - 1.0)) / kSquare;
      };
      for (std::uint32_t y = square(south, posts.rows); y <= square(north, posts.rows); ++y)
        for (std::uint32_t x = square(west, posts.columns); x <= square(east, posts.columns); ++x) {
          float& most = lowered_[std::size_t{y} * acrossSquares_ + x];
          most = std::max(most, error);
        }
    }
  }

  double errorUnder(const PatchedTerrain& terrain, const GeodeticPosition& eye) const {
    const terrain::PostGrid& p = terrain.grid().posts;
    return loweredAt((eye.longitude.value() - p.west) / p.stepLongitude,
                     (eye.latitude.value() - p.south) / p.stepLatitude);
  }
  double loweredAt(double column, double row) const {
    return lowered_[static_cast<std::size_t>(row) / kSquare * acrossSquares_ +
                    static_cast<std::size_t>(column) / kSquare];
  }

  struct Place {
    double column, row, height;
  };
  static Place postOf(const PatchedTerrain& terrain, Vec3 local) {
    const GeodeticPosition g = terrain.patches()->index().frame.toGeodetic(local);
    const terrain::PostGrid& p = terrain.grid().posts;
    return {(g.longitude.value() - p.west) / p.stepLongitude, (g.latitude.value() - p.south) / p.stepLatitude,
            g.height.value()};
  }

  std::size_t holesIn(const PatchedTerrain& terrain, const FrameRequest& r) {
    const auto pixels = renderer.readPixels(kW, kH);
    const LocalFrame& frame = terrain.patches()->index().frame;
    const EyePose eye{frame.fromGeodetic(r.eye), eyeAxes(frame, r.eye, r.attitude)};
    std::size_t found = 0;
    for (int y = 0; y < kH; ++y)
      for (int x = 0; x < kW; ++x) {
        const std::uint8_t* p = &pixels[4 * (static_cast<std::size_t>(y) * kW + static_cast<std::size_t>(x))];
        if (p[0] != 255 || p[1] != 0 || p[2] != 255) continue;
        const Vec3 seen{r.view.left + (r.view.right - r.view.left) * (x + 0.5) / kW,
                        r.view.bottom + (r.view.top - r.view.bottom) * (y + 0.5) / kH, -1};
        const Vec3 ray =
            normalized(eye.axes.row[0] * seen.x + eye.axes.row[1] * seen.y + eye.axes.row[2] * seen.z);
        ++rays_;
        found += meetsGround(terrain, eye.position, ray);
      }
    return found;
  }

  /// Where a ray from the eye is, in posts. Three places a segment are worked out, the rest lies on a
  /// parabola through them: over 10 km, 3 mm and less off.
  class Way {
   public:
    Way(const PatchedTerrain& terrain, Vec3 eye, Vec3 ray) : terrain_(terrain), eye_(eye), ray_(ray) {}
    /// `metres` never less than in the call before.
    Place at(double metres) {
      if (!(metres <= from_ + 2 * half_)) {
        from_ = metres;
        half_ = std::clamp(0.1 * metres, 500.0, 5000.0);
        for (int i = 0; i < 3; ++i)
          places_[static_cast<std::size_t>(i)] = postOf(terrain_, eye_ + ray_ * (from_ + i * half_));
      }
      const double t = (metres - from_) / half_;
      const double a = 0.5 * (t - 1) * (t - 2), b = t * (2 - t), c = 0.5 * t * (t - 1);
      const auto& [p, q, r] = places_;
      return {a * p.column + b * q.column + c * r.column, a * p.row + b * q.row + c * r.row,
              a * p.height + b * q.height + c * r.height};
    }

   private:
    const PatchedTerrain& terrain_;
    Vec3 eye_, ray_;
    double from_ = 0, half_ = -1;
    std::array<Place, 3> places_{};
  };

  /// Stepping by a post or so, wider far away and high above: a ray that goes through a hole stays below for
  /// longer.
  bool meetsGround(const PatchedTerrain& terrain, Vec3 eye, Vec3 ray) const {
    const terrain::PostGrid& p = terrain.grid().posts;
    const double postM = p.stepLatitude * 111e3;
    Way way(terrain, eye, ray);
    for (double metres = 0; metres < 400e3;) {
      const auto [column, row, height] = way.at(metres);
      if (!(column >= 0 && row >= 0 && column < p.columns - 1 && row < p.rows - 1)) return false;
      const double above = height - highestM_;
      if (above > 0) {
        if (ray.z > 0) return false;
        metres += std::max(postM, above / std::max(-ray.z, 1e-3) * 0.5);
        continue;
      }
      const double lowered = loweredAt(column, row);
      if (lowered >= 0 && height < *terrain.heightAtPost(column, row) - lowered - 0.05) return true;
      metres += std::max(postM * 0.7, metres * 0.02);
    }
    return false;
  }

  void look(std::shared_ptr<PatchedTerrain> terrain, int views, std::uint32_t seed) {
    const auto inner = terrain->patches();
    highestM_ = *std::max_element(terrain->grid().heights.begin(), terrain->grid().heights.end());
    // All of its pages, and mixtures where some are not there.
    constexpr int kMixtures = 5;
    for (int mixture = 0; mixture < kMixtures; ++mixture) {
      const auto change =
          std::make_shared<Mixture>(inner, mixture * 0.17, seed + static_cast<std::uint32_t>(mixture));
      terrain->replace(change);
      use(terrain);
      EXPECT_EQ(
          holes(*terrain, std::max(1, views / kMixtures), seed * 31 + static_cast<std::uint32_t>(mixture)),
          0u)
          << terrain->info().name << ", mixture " << mixture;
    }
    std::printf("%d views, %zu rays of pixels without terrain\n", seen_, rays_);
    EXPECT_EQ(seen_, views);
    EXPECT_GT(rays_, 1000u * static_cast<std::size_t>(views));
  }
  static int views() { return std::getenv("TRIMTAB_SOAK") ? 1000 : 20; }

  static std::shared_ptr<PatchedTerrain> imported(const std::string& folder) {
    const std::filesystem::path source = test::sharedDir() / "data" / folder;
    auto grid = test::importElevation(std::span(&source, 1));
    if (!grid) {
      ADD_FAILURE() << toString(grid.findings());
      return nullptr;
    }
    return std::make_shared<PatchedTerrain>(std::move(grid->grid), nullptr, false);
  }

  static constexpr std::uint32_t kSquare = 16;
  std::vector<float> lowered_;
  std::uint32_t acrossSquares_ = 0;
  double highestM_ = 0;
  int seen_ = 0;
  std::size_t rays_ = 0;
};

TEST_F(PatchCracks, noneOverFractalLand) {
  look(std::make_shared<PatchedTerrain>(fractal(1024), nullptr, false), views(), 1);
}

TEST_F(PatchCracks, noneOverEverest) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  if (const auto terrain = imported("dem-srtm3-everest")) look(terrain, views(), 2);
}

TEST_F(PatchCracks, noneOverBigTujunga) {
  TRIMTAB_NEEDS_SHARED("data/dem-30m-bigtujunga");
  if (const auto terrain = imported("dem-30m-bigtujunga")) look(terrain, views(), 3);
}

TEST_F(PatchCracks, areSeenWhereBorderVerticesAreOutOfPlace) {
  const auto terrain = std::make_shared<PatchedTerrain>(fractal(512), nullptr, false);
  highestM_ = *std::max_element(terrain->grid().heights.begin(), terrain->grid().heights.end());
  const auto broken = std::make_shared<Mixture>(terrain->patches(), 0.0, 5u);
  broken->shiftM = -60;
  terrain->replace(broken);
  use(terrain);
  EXPECT_GT(holes(*terrain, 30, 9), 0u);
}

}  // namespace
}  // namespace trimtab
