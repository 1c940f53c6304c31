#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include "app/experiment/stage.h"
#include "row.h"
#include "trimtab/measure/paired_ratio.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/bake/cache.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/synthetic/sample.h"

/// What benchmarks of pictures share: the sample's terrain, a context, a view over it, and pairs in turn.
namespace trimtab::bench {

/// The sample, `km` a side; baked once into a folder beside the temporary files.
inline std::shared_ptr<const terrain::Database> sampleTerrain(double km) {
  const auto folder = std::filesystem::temp_directory_path() / "trimtab-bench";
  const auto tif = folder / ("sample-" + std::to_string(static_cast<int>(km)) + "km.tif");
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  terrain::SampleOptions options;
  options.sizeKm = km;
  if (!std::filesystem::exists(tif)) {
    const auto part = folder / "sample-part.tif";
    if (const auto written = terrain::writeSample(part, options); !written) {
      std::cerr << toString(written.findings());
      return nullptr;
    }
    std::filesystem::rename(part, tif);
  }
  auto opened = terrain::openOrBake(tif, folder, {});
  if (!opened) std::cerr << toString(opened.findings());
  return opened ? opened.value() : nullptr;
}

class BenchScene {
 public:
  static constexpr int kWidth = 1280, kHeight = 720;

  /// Without a terrain there is the sky alone.
  explicit BenchScene(std::shared_ptr<const terrain::Database> database) : database_(std::move(database)) {
    auto created = scene::Offscreen::create(kWidth, kHeight);
    if (!created) return;
    offscreen_ = std::move(created).value();
    gl_ = renderer_.initialize();
    renderer_.setTerrain(database_);
  }
  ~BenchScene() {
    if (!offscreen_) return;
    offscreen_->makeCurrent();
    renderer_.release();
  }
  BenchScene(const BenchScene&) = delete;
  BenchScene& operator=(const BenchScene&) = delete;
  bool ready() const { return gl_.usable; }
  bool softwareRasteriser() const { return gl_.software; }
  void use(std::shared_ptr<const terrain::Database> database) {
    database_ = std::move(database);
    offscreen_->makeCurrent();
    renderer_.setTerrain(database_);
  }

  /// Level, 2,000 ft above the ground in the middle.
  FrameRequest request() const {
    FrameRequest r;
    r.view.widthPx = kWidth, r.view.heightPx = kHeight;
    r.cullingCase = CullingCase::view_frustum;
    r.eye = {Degrees{36.63}, Degrees{128.35}, Metres{610}};
    if (database_)
      r.eye.height = r.eye.height + database_->heightAt(r.eye.latitude, r.eye.longitude).value_or(Metres{0});
    r.attitude.heading = Degrees{30};
    r.attitude.pitch = Degrees{-4};
    return r;
  }
  FrameResult draw(const FrameRequest& r) {
    offscreen_->makeCurrent();
    return renderer_.draw(r, offscreen_->framebuffer());
  }
  std::optional<Metres> highestGround() const { return database_ ? database_->highest() : std::nullopt; }
  scene::Renderer& renderer() { return renderer_; }
  double ms(const FrameRequest& r) { return draw(r).cost.total; }

 private:
  std::shared_ptr<const terrain::Database> database_;
  std::unique_ptr<scene::Offscreen> offscreen_;
  scene::Renderer renderer_;
  scene::GlReport gl_;
};

/// Milliseconds of two ways, measured in turn after one pair that is not counted.
struct Pairs {
  std::vector<double> a, b;
  double medianA() const { return experiment::quantileOf(a, 0.5); }
  double medianB() const { return experiment::quantileOf(b, 0.5); }
  /// Median of a over b, pair by pair.
  double ratio() const { return pairedRatio(b, a).median; }
};
inline Pairs inTurn(int pairs, const std::function<double(int)>& a, const std::function<double(int)>& b) {
  Pairs result;
  for (int i = -1; i < pairs; ++i) {
    const double first = a(i), second = b(i);
    if (i < 0) continue;
    result.a.push_back(first);
    result.b.push_back(second);
  }
  return result;
}

/// The row of the first way, with the second as its peer.
inline Row rowOf(const Pairs& pairs, Row row) {
  row.value = pairs.medianA(), row.unit = "ms";
  row.peerValue = pairs.medianB(), row.peerFrom = "run";
  row.ratio = pairs.ratio();
  return row;
}

}  // namespace trimtab::bench
