#include "culling_queries.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <random>

#include "core/scene/gl/gl_api.h"
#include "culling_frames.h"
#include "culling_query_peers.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/scene/renderer.h"

namespace trimtab::bench {
namespace {

/// osg::OcclusionQueryNode asks every fifth frame: frames are counted in whole cycles of it.
constexpr int kCycle = 5;

/// What a cycle's frames of one way took in all, and drew.
struct Sum {
  double ms = 0;
  std::size_t drawn = 0;
};

class Queries {
 public:
  explicit Queries(const std::shared_ptr<const terrain::Database>& database)
      : database_(database), peers_(database, kWidth, kHeight) {
    auto created = scene::Offscreen::create(kWidth, kHeight);
    if (!created) return;
    offscreen_ = std::move(created).value();
    offscreen_->makeCurrent();
    ready_ = peers_.ready() && renderer_.initialize().usable;
    renderer_.setTerrain(database_);
  }
  ~Queries() {
    if (!offscreen_) return;
    offscreen_->makeCurrent();
    renderer_.release();
  }
  bool ready() const { return ready_; }

  void rows(Report& report, const std::string& terrain, double feet) {
    sums_ = {};
    inView_ = frames_ = 0;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(0.25, 0.75), heading(0, 360);
    for (int view = 0; view < (report.quick() ? 3 : 8); ++view) {
      FrameRequest r;
      const double east = place(random), north = place(random);
      r.eye = placeOver(*database_, east, north, feet * kMetresAFoot);
      r.attitude = {Degrees{heading(random)}, Degrees{-5}, Degrees{0}};
      r.view.widthPx = kWidth, r.view.heightPx = kHeight;
      r.cullingCase = CullingCase::proposed;
      // All surfaces that may hide others at once: the peer has its scene whole too.
      r.reproducible = true;
      r.levers.drawn.errorPx = kErrorPx;
      // The band of level flight below 4,000 ft, and above 8,000 ft.
      r.levers.drawn.occlusion = feet < 4000 ? OcclusionResolution{800, 600} : OcclusionResolution{320, 240};
      measure(r, report.quick() ? 2 : 4);
    }
    const std::string at = "_" + terrain + "_" + std::to_string(static_cast<int>(feet)) + "ft";
    for (const auto& [peer, id, name] :
         {Peer{kNode, "culling.query_node", "osg::OcclusionQueryNode a tile, up to 5 frames late"},
          Peer{kGl, "culling.gl_queries", "GL query a tile, two passes"}})
      for (const auto& [ours, ending, method] :
           {Ours{kHorizon, "", "horizon"}, Ours{kDepthMap, "_depth_map", "depth map"}}) {
        char share[240];
        std::snprintf(share, sizeof share,
                      ", mean over %s; of %zu tiles in view %.0f %% left out, by the peer %.0f %%; "
                      "the peer's scene without queries %.2f ms",
                      terrain.c_str(), inView_ / frames_, hidden(ours), hidden(peer), mean(kPlain));
        report.add(ratioAtMost(1, {.id = id + at + ending,
                                   .what = std::string("Frame of proposed (") + method + ")" + share,
                                   .value = mean(ours),
                                   .unit = "ms",
                                   .peer = name,
                                   .peerValue = mean(peer),
                                   .peerFrom = "run"}));
      }
  }

 private:
  enum Way : std::size_t { kHorizon, kDepthMap, kPlain, kNode, kGl, kWays };
  struct Peer {
    Way way;
    const char *id, *name;
  };
  struct Ours {
    Way way;
    const char *ending, *method;
  };

  double mean(Way way) const { return sums_[way].ms / static_cast<double>(frames_); }
  double hidden(Way way) const {
    return 100 - 100.0 * static_cast<double>(sums_[way].drawn) / static_cast<double>(inView_);
  }

  void measure(FrameRequest r, int cycles) {
    const TerrainIndex& index = database_->index();
    const ViewShape v = r.view;
    LevelCut cut;
    selectLevels(index, poseOf(r).position, {kErrorPx, 1, pixelsPerRadian(v)}, cut);
    const Mat3 up = index.frame.ecefToLocal() * eastNorthUp(r.eye.latitude, r.eye.longitude);
    peers_.begin(cut, up.row[2], r.eye.height.value());
    // All know by then what they saw, and have their tiles.
    for (int i = 0; i < 2; ++i) cycle(r, v);
    std::array<Sum, kWays> least = cycle(r, v);
    for (int i = 1; i < cycles; ++i) {
      const std::array<Sum, kWays> next = cycle(r, v);
      for (std::size_t way = 0; way < kWays; ++way)
        if (next[way].ms < least[way].ms) least[way] = next[way];
    }
    for (std::size_t way = 0; way < kWays; ++way) {
      sums_[way].ms += least[way].ms;
      sums_[way].drawn += least[way].drawn;
    }
    inView_ += kCycle * inViewNow_;
    frames_ += kCycle;
  }

  /// Each way's frames in turn.
  std::array<Sum, kWays> cycle(FrameRequest& r, const ViewShape& v) {
    std::array<Sum, kWays> sums;
    for (int i = 0; i < kCycle; ++i) {
      // A head that moves on: nothing is the same as in the frame before.
      r.eye.height = r.eye.height + Metres{0.01};
      for (const Way way : {kHorizon, kDepthMap}) {
        r.occlusion = way == kHorizon ? OcclusionMethod::horizon : OcclusionMethod::depth_map;
        offscreen_->makeCurrent();
        const double start = monotonicSeconds();
        const FrameResult result = renderer_.draw(r, offscreen_->framebuffer());
        glFinish();
        sums[way].ms += 1e3 * (monotonicSeconds() - start);
        sums[way].drawn += result.visible.tiles.size();
        if (way == kHorizon) inViewNow_ = result.visible.occluded + result.visible.tiles.size();
      }
      for (const auto& [way, peer] : {std::pair{kPlain, QueryPeers::Way::none},
                                      {kNode, QueryPeers::Way::node},
                                      {kGl, QueryPeers::Way::gl}}) {
        sums[way].ms += peers_.ms(peer, poseOf(r), v);
        sums[way].drawn += peers_.drawn();
      }
    }
    return sums;
  }

  EyePose poseOf(const FrameRequest& r) const {
    const LocalFrame& frame = database_->index().frame;
    return {frame.fromGeodetic(r.eye), eyeAxes(frame, r.eye, r.attitude)};
  }

  std::shared_ptr<const terrain::Database> database_;
  QueryPeers peers_;
  std::unique_ptr<scene::Offscreen> offscreen_;
  scene::Renderer renderer_;
  bool ready_ = false;
  std::array<Sum, kWays> sums_;
  std::size_t inView_ = 0, inViewNow_ = 0, frames_ = 0;
};

}  // namespace

void queryRows(Report& report, const std::string& name,
               const std::shared_ptr<const terrain::Database>& database) {
  Queries queries(database);
  if (!queries.ready()) return;
  for (const double feet : {2000.0, 8000.0}) queries.rows(report, name, feet);
}

}  // namespace trimtab::bench
