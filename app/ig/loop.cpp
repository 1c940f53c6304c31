#include "loop.h"

#include <cmath>
#include <iostream>
#include <utility>

#include "app/link/link.h"
#include "app/link/link_watch.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/scene/load_index.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/scene/osg_database.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/units/labelled.h"

namespace trimtab::ig {
namespace {

/// Between packets a viewer sees the eye move on at this rate.
constexpr double kViewerPeriodS = 1.0 / 60;
/// The newest frames, whose cost the summary reports.
constexpr std::size_t kFramesKept = 8192;

class Loop {
 public:
  explicit Loop(const Run& run) : run_(run), frameMs_(kFramesKept), stages_(kFramesKept) {}

  Summary run() {
    if (run_.options.listen) begin();
    while (!run_.wake.stop() && !enough()) {
      const double start = link::now();
      if (run_.health) run_.health->look(start, summary_.frames, summary_.terrainReloads, run_.session);
      complain(start);
      const bool news = run_.feed.advance(run_.session, start);
      bool stale = false;
      if (!run_.surface.handleEvents(stale)) break;
      stale |= reloaded();
      if (news || ((stale || viewerIsDue(start)) && run_.session.hasState()))
        drawFrame(start);
      else if (run_.feed.finished())
        break;
      else
        sleep();
    }
    // What arrived before the stop is decided and counted, though no image can show it.
    if (run_.options.listen && run_.wake.stop()) run_.feed.advance(run_.session, link::now());
    complain(link::now());
    return finishedSummary();
  }

 private:
  void complain(double now) {
    // The line is written in one piece, for whoever waits for it.
    if (const std::optional<std::string> line = run_.feed.complaint(now))
      std::cerr << "warning: " + *line + "\n" << std::flush;
    if (const auto& doubt = run_.session.groundDoubt(); doubt && !std::exchange(saidDoubt_, true))
      report({toFinding(*doubt)});
  }

  /// Decides what came while the program made itself ready like all else, but no image can have shown it in
  /// time.
  void begin() {
    run_.feed.ready();
    run_.feed.advance(run_.session, link::now());
    run_.session.noPicture();
    if (run_.session.hasState()) drawFrame(link::now());
  }

  bool enough() const { return run_.options.frames > 0 && summary_.frames >= run_.options.frames; }

  bool viewerIsDue(double now) const {
    return run_.surface.hasViewer() && now - lastFrame_ >= kViewerPeriodS && run_.session.needsImage(now);
  }

  void sleep() {
    const double now = link::now();
    double seconds = run_.feed.dueIn(now);
    if (run_.options.listen) seconds = std::fmin(seconds, link::LinkWatch::kLookS);
    if (run_.health) seconds = std::fmin(seconds, std::fmax(run_.health->dueIn(now), 0));
    const LinkState link = run_.session.linkState(now);
    const bool moving = link == LinkState::live || link == LinkState::jumped || run_.session.unsettled();
    if (run_.surface.hasViewer() && moving) seconds = std::fmin(seconds, kViewerPeriodS);
    run_.wake.wait(seconds, run_.surface.eventFd());
  }

  /// Reloads what changed, and reports whether a changed preset or terrain took effect.
  bool reloaded() {
    if (!run_.watch) return false;
    bool stale = false;
    while (const auto terrain = run_.terrainWatch->take()) stale |= takes(*terrain);
    while (const auto preset = run_.watch->take()) stale |= takes(*preset);
    return stale;
  }

  /// Reports whether another terrain replaced the last one. A refused one is reported and changes nothing.
  bool takes(const Result<std::shared_ptr<const terrain::Database>>& database) {
    report(database.findings());
    if (!database) {
      ++summary_.terrainsRefused;
      std::cerr << "warning: " << run_.options.terrain.string() << ": refused; the last terrain stays"
                << std::endl;
      return false;
    }
    ++summary_.terrainReloads;
    run_.renderer.setTerrain(*database);
    run_.session.setGround(*database);
    run_.feed.setGround(*database);
    run_.session.setLoadIndex(scene::loadIndexOf(*database));
    run_.damage.setDatabase(*database);
    std::cerr << "note: " << run_.options.terrain.string() << ": loaded again" << std::endl;
    return true;
  }

  /// Reports whether a changed preset took effect. A refused one is reported and changes nothing.
  bool takes(const Result<ActivePreset>& preset) {
    report(preset.findings());
    if (!preset) {
      ++summary_.presetsRefused;
      std::cerr << "warning: " << run_.options.preset << ": refused; the last good preset stays" << std::endl;
      return false;
    }
    ++summary_.presetReloads;
    run_.session.setParameters(preset->parameters);
    std::cerr << "note: " << run_.options.preset << ": loaded again" << std::endl;
    return true;
  }

  void drawFrame(double start) {
    std::optional<FrameRequest> request =
        run_.session.request(start, run_.options.headless ? run_.options.width : run_.surface.width(),
                             run_.options.headless ? run_.options.height : run_.surface.height());
    // With nobody to wait for a frame, its image depends on the flight alone.
    request->waitForPages = request->reproducible =
        run_.options.headless && !run_.options.realtime && !run_.options.listen;
    run_.surface.fit(request->view.widthPx, request->view.heightPx);
    const FrameResult result = run_.renderer.draw(*request, run_.surface.framebuffer());
    run_.surface.present();
    const double end = link::now();
    run_.damage.look(result.paging.failed);
    stages_.add(run_.session.finished(result, end));
    if (const auto& why = run_.session.hold().model().whyAnew(); why && !std::exchange(saidAnew_, true))
      report({*why});
    // Where images follow one another at once, time saved later is time spent now.
    if (run_.options.listen || run_.options.realtime)
      run_.session.builtAhead(
          run_.renderer.buildAhead(run_.session.nodesAhead(*request), run_.session.aheadMs()).left);
    const double ms = (end - start) * 1e3;
    frameMs_.add(ms);
    lastFrame_ = end;
    if (summary_.frames++ == 0) summary_.firstFrameTime = end;
    summary_.levers.add(request->levers);
    ++summary_.held[static_cast<std::size_t>(request->hold.reason)];
    summary_.lastRequest = request;
    summary_.depthMapsDrawn = result.counters.depthMapsDrawn;
    summary_.horizonsBuilt = result.counters.horizonsBuilt;
    writeRows(false);
  }

  void writeRows(bool all) {
    rows_.clear();
    run_.session.takeRows(rows_, all);
    for (const TraceRow& row : rows_) {
      if (lastBand_ && *lastBand_ != row.decision.band) ++summary_.decisionChanges;
      lastBand_ = row.decision.band;
    }
    if (run_.trace) report(run_.trace->write(rows_).findings());
  }

  Summary finishedSummary() {
    writeRows(true);
    const Latency& latency = run_.session.latency();
    summary_.packets = run_.session.packets();
    summary_.jumps = run_.session.jumps();
    if (const auto& doubt = run_.session.groundDoubt()) summary_.groundDoubted = doubt->states;
    summary_.overBudget = run_.session.overBudget();
    summary_.medianFrameMs = frameMs_.median();
    summary_.p99FrameMs = frameMs_.quantile(0.99);
    for (std::size_t i = 0; i < kCostStages.size(); ++i) summary_.stages[i] = stages_.of(kCostStages[i].ms);
    summary_.decodedP50Ms = latency.decoded.median();
    summary_.decodedP99Ms = latency.decoded.quantile(0.99);
    summary_.shownP50Ms = latency.shown.median();
    summary_.shownP99Ms = latency.shown.quantile(0.99);
    summary_.everyP99Ms = latency.every.quantile(0.99);
    return summary_;
  }

  const Run& run_;
  Summary summary_;
  SampleWindow frameMs_;
  FrameStatistics stages_;
  std::optional<int> lastBand_;
  std::vector<TraceRow> rows_;
  double lastFrame_ = 0;
  bool saidAnew_ = false;   ///< that the cost model began anew
  bool saidDoubt_ = false;  ///< that the host's height above ground is not the terrain's
};

}  // namespace

void warmUp(const Run& run, const terrain::Database& database) {
  const terrain::TerrainInfo& info = database.info();
  Session session(run.session.parameters());
  AircraftState state;
  state.position = scene::placeIn(info, 0.5, 0.5);
  state.position.height = info.highest + Feet{1000}.as<Metres>();
  session.look(state);
  FrameRequest request = *session.request(0, run.options.width, run.options.height);
  run.surface.fit(request.view.widthPx, request.view.heightPx);
  request.levers.drawn.occlusion.reset();
  run.renderer.draw(request, run.surface.framebuffer());
  for (const Band& band : run.session.parameters()->scheme.bands.span()) {
    request.levers.drawn.occlusion = OcclusionResolution{band.widthPx, band.heightPx};
    run.renderer.draw(request, run.surface.framebuffer());
  }
  run.surface.present();
}

Result<std::shared_ptr<const terrain::Database>> openDatabase(const Options& options) {
  const std::filesystem::path& folder = options.terrain;
  if (scene::isOsgScene(folder)) return scene::openOsgScene(folder, options.origin);
  std::error_code error;
  // A link that leads elsewhere meanwhile must not mix the files of two databases.
  const std::filesystem::path place =
      std::filesystem::is_symlink(folder, error) ? std::filesystem::canonical(folder, error) : folder;
  if (!error && terrain::isDatabase(place)) return terrain::Database::open(place);
  return Finding{
      Severity::error,
      folder.string(),
      {},
      "the folder of a baked terrain database, or a scene of OpenSceneGraph (.ive, .osgb, .osgt, .txp); bake "
      "elevation or scenery with `trimtab-cli terrain bake`",
      std::filesystem::exists(folder, error) ? "something else" : "nothing"};
}

Summary drawFrames(const Run& run) {
  return Loop(run).run();
}

Result<Done> takeScreenshot(const Run& run, const Summary& summary, const std::filesystem::path& file) {
  if (!summary.lastRequest)
    return Finding{Severity::error, file.string(), {}, "a picture to write", "no frame was drawn"};
  FrameRequest request = *summary.lastRequest;
  request.waitForPages = true;
  const ViewShape& view = request.view;
  run.damage.look(run.renderer.draw(request, run.surface.framebuffer()).paging.failed);
  return scene::writePng(file, run.renderer.readPixels(view.widthPx, view.heightPx), view.widthPx,
                         view.heightPx);
}

void report(const Findings& findings) {
  std::cerr << labelled(findings);
}

}  // namespace trimtab::ig
