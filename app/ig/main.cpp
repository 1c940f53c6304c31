#include <malloc.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <optional>
#include <string>

#include "app/link/stop_signals.h"
#include "loop.h"
#include "trimtab/hold/cost_model_file.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/scene/load_index.h"
#include "trimtab/scene/osg_database.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/store.h"

namespace trimtab::ig {
namespace {

/// Freed blocks of at least this size, in bytes, return to the system. By itself glibc keeps blocks up to the
/// largest that was ever freed, and so what terrains leave behind: the mean of memory is 310 MB then instead
/// of 252 while six presets take turns every 2 s and two terrains every 14 s, and it grows for hours.
constexpr int kReturnedBlock = 512 << 10;

/// Reports the findings, and returns whether there is a value.
template <class T>
bool accepted(const Result<T>& result) {
  report(result.findings());
  return result.ok();
}

/// Standard output for the summary alone: what libraries print there (OpenSceneGraph its notices) goes to
/// standard error.
class SummaryOutput {
 public:
  SummaryOutput() : file_(::fdopen(::dup(STDOUT_FILENO), "w")) { ::dup2(STDERR_FILENO, STDOUT_FILENO); }
  ~SummaryOutput() {
    if (file_) std::fclose(file_);
  }
  SummaryOutput(const SummaryOutput&) = delete;
  SummaryOutput& operator=(const SummaryOutput&) = delete;
  /// Refused where the text cannot be written, as to a full disk. Nowhere to write to is no refusal.
  Result<Done> print(const std::string& text) const {
    if (!file_ || (std::fprintf(file_, "%s\n", text.c_str()) >= 0 && std::fflush(file_) == 0)) return Done{};
    return Finding{
        Severity::error, "summary", {}, "standard output that can be written", std::strerror(errno)};
  }

 private:
  std::FILE* file_;
};

Result<Done> checkWatch(const Options& options) {
  std::error_code error;
  if (!options.watch || std::filesystem::is_regular_file(options.preset, error)) return Done{};
  return Finding{Severity::error, "--watch", {}, "a preset file", options.preset + ", which is not a file"};
}

Result<scene::GlReport> initialized(scene::Renderer& renderer) {
  scene::GlReport gl = renderer.initialize();
  if (gl.usable) return gl;
  return Finding{Severity::error, "OpenGL", {}, gl.missing, gl.renderer + ", version " + gl.version};
}

int runWith(const Options& options) {
  const SummaryOutput output;
  const Wake wake;
  // All inputs are looked at before any refusal ends the program: one run reports everything that is wrong.
  std::optional<PresetWatch> watch;
  const auto news = [&wake] { wake.post(); };
  if (options.watch)
    watch.emplace(
        options.preset, [&options] { return loadActivePreset(options.preset); }, news);
  const Result<ActivePreset> preset = loadActivePreset(options.preset);
  std::optional<TerrainWatch> terrainWatch;
  if (options.watch)
    terrainWatch.emplace(
        scene::isOsgScene(options.terrain) ? options.terrain : options.terrain / terrain::kManifestName,
        [&options] { return openDatabase(options); }, news);
  Result<std::shared_ptr<const terrain::Database>> database = openDatabase(options);
  Result<std::unique_ptr<Feed>> feed =
      openFeed(options, preset ? preset->parameters->host : HostParameters{}, wake);
  Result<HeadInput> head = openHeadInput(options);
  bool usable = accepted(preset);
  usable &= accepted(database);
  usable &= accepted(feed);
  usable &= accepted(head);
  usable &= accepted(checkWatch(options));
  // A screenshot that cannot be made is reported before the first frame, not after the last one.
  if (!options.screenshot.empty()) usable &= accepted(canMake(options.screenshot));
  std::optional<TraceFile> trace;
  if (usable && !options.trace.empty()) {
    Result<TraceFile> opened = TraceFile::open(options.trace);
    usable = accepted(opened);
    if (usable) trace.emplace(std::move(opened).value());
  }
  std::optional<Health> health;
  if (usable && !options.health.empty()) {
    Result<Health> opened = Health::open(options.health);
    usable = accepted(opened);
    if (usable) health.emplace(std::move(opened).value());
  }
  if (!usable) return kRefused;

  Result<std::unique_ptr<Surface>> surface = options.headless
                                                 ? openHeadless(options.width, options.height)
                                                 : openWindow(options.width, options.height, "trimtab-ig");
  if (!accepted(surface)) return kRefused;
  scene::Renderer renderer;
  const Result<scene::GlReport> gl = initialized(renderer);
  if (!accepted(gl)) return kRefused;
  if (gl->software) std::cerr << "note: OpenGL by software: " << gl->renderer << std::endl;
  std::shared_ptr<const terrain::Database> ground = std::move(database).value();
  renderer.setTerrain(ground);

  Session session(preset->parameters);
  session.setGround(ground);
  (*feed)->setGround(ground);
  session.setLoadIndex(scene::loadIndexOf(ground));
  // A watched preset may ask for the arbiter later.
  if (preset->parameters->hold.enabled || watch)
    report(recallCostModel(session.hold().model(), machineName(gl->renderer)));
  session.head() = std::move(head).value();
  session.keepRows(true);
  Damage damage(ground, renderer);
  const Run run{options,
                wake,
                session,
                renderer,
                **surface,
                **feed,
                damage,
                trace ? &*trace : nullptr,
                health ? &*health : nullptr,
                watch ? &*watch : nullptr,
                terrainWatch ? &*terrainWatch : nullptr};
  if (options.listen || options.realtime) warmUp(run, *ground);
  ground.reset();  // it is closed when another one takes its place
  Summary summary = drawFrames(run);
  report(rememberCostModel(session.hold().model(), machineName(gl->renderer)));

  bool written = true;
  if (trace) written &= accepted(trace->finish());
  if (health) written &= accepted(health->finish());
  if (!options.screenshot.empty()) written &= accepted(takeScreenshot(run, summary, options.screenshot));
  summary.damagedPlaces = damage.places();
  written &= accepted(
      output.print(options.json ? summaryJson(summary, **feed, options, *gl) : summaryLine(summary, **feed)));
  renderer.release();
  if (summary.damagedPlaces > 0)
    std::cerr << "error: the images show less than " << options.terrain.string()
              << " held: bake it again, or restore it from a copy" << std::endl;
  return written && summary.damagedPlaces == 0 ? kDone : kRefused;
}

}  // namespace
}  // namespace trimtab::ig

int main(int argc, char** argv) {
  trimtab::handleStopSignals();
  trimtab::failLargeWrites();
  ::mallopt(M_MMAP_THRESHOLD, trimtab::ig::kReturnedBlock);
  int exitCode = trimtab::ig::kDone;
  const std::optional<trimtab::ig::Options> options = trimtab::ig::parseOptions(argc, argv, exitCode);
  if (!options) return exitCode;
  try {
    return trimtab::ig::runWith(*options);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return trimtab::ig::kRefused;
  }
}
