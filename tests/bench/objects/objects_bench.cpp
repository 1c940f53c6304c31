#include <malloc.h>

#include <unistd.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <string>

#include "core/scene/gl/frame_buffer.h"
#include "core/scene/gl/gl_api.h"
#include "core/scene/objects/object_layer.h"
#include "core/scene/passes/scene_programs.h"
#include "object_peer.h"
#include "object_world.h"
#include "tests/bench/bench_scene.h"
#include "tests/core/scene/objects/objects_on.h"
#include "tests/shared_scene.h"
#include "trimtab/culling/select_objects.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/units/number.h"

/// Objects on the sample: what leaving out the hidden ones is worth, and what plain OpenSceneGraph takes.
namespace trimtab::bench {
namespace {

constexpr int kInstances = 200'000;

FrameRequest proposed(FrameRequest r) {
  r.cullingCase = CullingCase::proposed;
  r.occlusion = OcclusionMethod::horizon;
  r.levers.drawn.occlusion = OcclusionResolution{640, 480};
  return r;
}

/// Returns places so far from the terrain's middle, which is flat: those that have ground 120 m higher within
/// 1.5 km (`valley`), or any.
std::vector<GeodeticPosition> placesOver(const terrain::Database& ground, std::size_t count, double fromKm,
                                         double toKm, bool valley) {
  const terrain::TerrainInfo& info = ground.info();
  const double middleLatitude = 0.5 * (info.southWest.latitude.value() + info.northEast.latitude.value()),
               middleLongitude = 0.5 * (info.southWest.longitude.value() + info.northEast.longitude.value());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<GeodeticPosition> places;
  for (int tries = 0; places.size() < count && tries < 100000; ++tries) {
    GeodeticPosition p{Degrees{middleLatitude + 0.15 * unit(random)},
                       Degrees{middleLongitude + 0.18 * unit(random)}, Metres{0}};
    const double north = 111 * (p.latitude.value() - middleLatitude),
                 east = 89 * (p.longitude.value() - middleLongitude);
    if (const double away = std::hypot(north, east); away < fromKm || away > toKm) continue;
    const auto here = ground.heightAt(p.latitude, p.longitude);
    const auto high = ground.highestWithin(p.latitude, p.longitude, Metres{1500});
    if (!here || !high || (valley && high->value() - here->value() < 120)) continue;
    p.height = *here;
    places.push_back(p);
  }
  return places;
}

struct Height {
  const char* id;
  double aboveFt;
  bool valley;
  double goal;
};

/// The request over a place, for a view of its own.
FrameRequest overPlace(const BenchScene& scene, GeodeticPosition place, double aboveFt, std::size_t number) {
  FrameRequest r = scene.request();
  r.terrain.form = TerrainForm::patches;
  r.waitForPages = true;
  r.levers.drawn.smallFeaturePx = 1;
  r.eye = place;
  r.eye.height = r.eye.height + Metres{aboveFt * 0.3048};
  r.attitude.heading = Degrees{60.0 * static_cast<double>(number)};
  r.attitude.pitch = Degrees{-3};
  return r;
}
/// The same so many frames later, at 200 kt.
FrameRequest later(FrameRequest r, int frames) {
  r.eye.latitude = r.eye.latitude + Degrees{1.7 / 111e3 * frames};
  return r;
}

/// Proposed beside frustum culling in flight, by place. Rows have `name` in their ids; `what` stands in them.
void hiddenRows(Report& report, const std::shared_ptr<const terrain::Database>& world,
                const std::string& name, const std::string& what, std::initializer_list<Height> heights) {
  BenchScene scene(world);
  if (!scene.ready()) return;
  for (const Height& height : heights) {
    const auto places = placesOver(*world, report.quick() ? 5 : 12, 9, 16, height.valley);
    Pairs all;
    std::vector<double> bare;
    std::string each;
    double worst = 0, hidden = 0, inView = 0;
    for (std::size_t place = 0; place < places.size(); ++place) {
      FrameRequest r = overPlace(scene, places[place], height.aboveFt, place);
      FrameRequest hides = proposed(r);
      FrameRequest ground = r;
      ground.levers.drawn.objectFarM = 0;
      for (const FrameRequest* warm : {&r, &hides, &ground}) scene.draw(*warm);
      FrameResult drawn, plain;
      const auto taken = [&](const FrameRequest& request, FrameResult& result) {
        const double before = processorMs();
        result = scene.draw(request);
        return processorMs() - before;
      };
      const Pairs pairs = inTurn(
          report.quick() ? 10 : 30, [&](int i) { return taken(later(hides, i + 1), drawn); },
          [&](int i) { return taken(later(r, i + 1), plain); });
      FrameResult ignored;
      for (int i = 0; i < 5; ++i) bare.push_back(taken(later(ground, i + 1), ignored));
      inView += static_cast<double>(plain.objects.drawn);
      hidden += static_cast<double>(plain.objects.drawn) - static_cast<double>(drawn.objects.drawn);
      const PairedRatio here = pairedRatio(pairs.b, pairs.a);
      worst = std::max(worst, here.median);
      each += (each.empty() ? "" : ", ") + numberText(here.median, 2) + " (" + numberText(here.low, 2) +
              " to " + numberText(here.high, 2) + ")";
      all.a.insert(all.a.end(), pairs.a.begin(), pairs.a.end());
      all.b.insert(all.b.end(), pairs.b.begin(), pairs.b.end());
    }
    const std::string where = std::string(height.valley ? "valleys" : "any place") + ", " +
                              std::to_string(static_cast<int>(height.aboveFt)) + " ft, " + what;
    report.add(ratioAtMost(
        height.goal,
        rowOf(all,
              {.id = "objects." + name + "_" + height.id,
               .what = "Processor time of a frame with the horizon, " + where + "; it hides " +
                       std::to_string(static_cast<int>(100 * hidden / std::max(inView, 1.0))) + " % of " +
                       std::to_string(static_cast<int>(inView / static_cast<double>(places.size()))) +
                       " in view; the ground alone takes " +
                       std::to_string(static_cast<int>(quantileOf(bare, 0.5) + 0.5)) + " ms",
               .peer = "frustum culling alone"})));
    report.add(valueAtMost(1.02, {.id = "objects." + name + "_worst_" + height.id,
                                  .what = "The worst place's ratio of " + each,
                                  .value = worst,
                                  .unit = ""}));
  }
}

/// The sample's ground with 16,384 lights on 5 km, with and without them, at 300 ft in flight.
void lightRows(Report& report, const std::shared_ptr<const terrain::Database>& ground) {
  const auto lit = std::make_shared<terrain::ObjectTerrain>();
  lit->index.frame = ground->patches()->index().frame;
  const GeodeticPosition middle = placesOver(*ground, 1, 0, 1, false).front();
  // Squares of 16 x 16 lights, 40 m apart.
  std::vector<Vec3> places;
  for (int square = 0; square < 64; ++square)
    for (int i = 0; i < 256; ++i) {
      const double east = 40.0 * (16 * (square % 8) + i % 16 - 64),
                   north = 40.0 * (16 * (square / 8) + i / 16 - 64);
      GeodeticPosition at{
          middle.latitude + Degrees{north / 111e3}, middle.longitude + Degrees{east / 89e3}, {}};
      at.height = ground->heightAt(at.latitude, at.longitude).value_or(Metres{0}) + Metres{7};
      places.push_back(lit->index.frame.fromGeodetic(at));
    }
  test::addLights(*lit, places, LightIndex::kMostInCell);
  BenchScene scene(std::make_shared<const test::ObjectsOn>(ground, lit));
  if (!scene.ready()) return;
  const auto taken = [&](int i, double lightPx) {
    FrameRequest r = proposed(scene.request());
    r.terrain.form = TerrainForm::patches;
    r.waitForPages = true;
    r.eye = middle;
    r.eye.height = r.eye.height + Metres{91};
    r.eye.latitude = r.eye.latitude + Degrees{1.7 / 111e3 * (i + 1)};
    r.attitude = {Degrees{40}, Degrees{-3}, Degrees{0}};
    r.lightPx = lightPx;
    const double before = processorMs();
    scene.draw(r);
    return processorMs() - before;
  };
  taken(-1, 3);
  const Pairs pairs = inTurn(
      report.quick() ? 20 : 100, [&](int i) { return taken(i, 3); }, [&](int i) { return taken(i, 0); });
  report.add(
      rowOf(pairs, {.id = "objects.lights",
                    .what = "Processor time of a frame with lights of 3 px, 16,384 of them over 5 km, 300 ft",
                    .peer = "the same without lights"}));
}

/// Trees on the forest of a real scenery, if there is one.
void kansaiRows(Report& report) {
  if (!std::filesystem::exists(test::sharedDir() / "data/fg-kansai-e135n35")) return;
  const auto opened = test::bakedOnce("fg-kansai-e135n35");
  const auto trees = opened ? treesOnForest(**opened, kInstances, 19) : nullptr;
  if (!trees) return;
  hiddenRows(report, std::make_shared<const test::ObjectsOn>(*opened, trees), "kansai",
             "200,000 trees on the forest of Kansai over 38 km",
             {{"valley_300ft", 300, true, 0.5}, {"any_2000ft", 2000, false, 0.7}});
}

/// Our frame in valleys, hidden objects left out, beside our ground and OpenSceneGraph's objects.
void hiddenPeerRow(Report& report, const std::shared_ptr<const terrain::Database>& world) {
  BenchScene scene(world);
  if (!scene.ready()) return;
  const auto places = placesOver(*world, report.quick() ? 5 : 12, 9, 16, true);
  const LocalFrame& frame = world->objects()->index.frame;
  std::unique_ptr<ObjectPeer> peer;
  Pairs all;
  for (std::size_t place = 0; place < places.size(); ++place) {
    const FrameRequest r = overPlace(scene, places[place], 300, place);
    FrameRequest ground = r;
    ground.levers.drawn.objectFarM = 0;
    const auto ours = [&](int i) {
      const double before = processorMs();
      scene.draw(later(proposed(r), i + 1));
      return processorMs() - before;
    };
    const auto theirs = [&](int i) {
      const FrameRequest at = later(ground, i + 1);
      const double before = processorMs();
      scene.draw(at);
      const double groundMs = processorMs() - before;
      const EyePose eye{frame.fromGeodetic(at.eye), eyeAxes(frame, at.eye, at.attitude)};
      return groundMs + peer->draw(eye, at.view).frameProcessorMs;
    };
    scene.draw(r);
    if (!peer)
      peer =
          std::make_unique<ObjectPeer>(*world->objects(), objectRuleOf(r), r.view.widthPx, r.view.heightPx);
    const Pairs pairs = inTurn(report.quick() ? 10 : 30, ours, theirs);
    all.a.insert(all.a.end(), pairs.a.begin(), pairs.a.end());
    all.b.insert(all.b.end(), pairs.b.begin(), pairs.b.end());
  }
  const PairedRatio ratio = pairedRatio(all.b, all.a);
  report.add(ratioAtMost(
      1.0 / 3, rowOf(all, {.id = "objects.peer_hidden",
                           .what = "Processor time of a frame with ground and the horizon, valleys, 300 ft, "
                                   "200,000 objects over 38 km; ratio " +
                                   numberText(ratio.low, 2) + " to " + numberText(ratio.high, 2),
                           .peer = "the same ground, and the objects of plain OpenSceneGraph"})));
}

/// Bytes that the process holds in memory.
double residentMB() {
  malloc_trim(0);
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

/// Objects alone, without ground, ours beside OpenSceneGraph's.
void peerRows(Report& report, const terrain::Database& ground, const char* id, double radiusKm, double goal) {
  auto offscreen = scene::Offscreen::create(BenchScene::kWidth, BenchScene::kHeight);
  if (!offscreen) return;
  (*offscreen)->makeCurrent();
  const auto objects = scatteredOver(ground, kInstances, radiusKm);
  if (!objects) return;
  ViewShape view;
  view.widthPx = BenchScene::kWidth, view.heightPx = BenchScene::kHeight;
  const CutRule rule{.maxErrorPx = 2, .pixelsPerRadian = pixelsPerRadian(view)};
  const double before = residentMB();
  // As the renderer keeps it: what a database reads, what a frame selects, and what is on the GPU.
  const auto kept = std::make_unique<terrain::ObjectTerrain>(*objects);
  auto layer = std::make_unique<scene::ObjectLayer>();
  layer->setObjects(kept.get());
  scene::ScenePrograms programs;
  scene::FrameBuffer target;
  target.resize(view.widthPx, view.heightPx);
  VisibleObjects visible;
  const GeodeticPosition place = placesOver(ground, 1, 0, 3, false).front();
  const LocalFrame& frame = kept->index.frame;
  const auto queryAt = [&](int i) {
    GeodeticPosition at = place;
    at.height = at.height + Metres{91};
    at.latitude = at.latitude + Degrees{1.7 / 111e3 * i};
    ObjectQuery query;
    query.eye = {frame.fromGeodetic(at), eyeAxes(frame, at, {Degrees{40.0 + i}, Degrees{-3}, Degrees{0}})};
    query.view = view;
    query.rule = rule;
    query.leastPx = 1;
    return query;
  };
  double selectMs = 0;
  const auto ours = [&](int i) {
    const double start = monotonicSeconds();
    const ObjectQuery query = queryAt(i);
    selectObjects(kept->index, query, visible);
    selectMs = 1e3 * (monotonicSeconds() - start);
    layer->setInstances(visible, {});
    glBindFramebuffer(GL_FRAMEBUFFER, target.id());
    scene::SceneView seen;
    seen.eye = query.eye;
    seen.shape = view;
    programs.begin(seen);
    programs.clear(true);
    programs.use(scene::SceneShaders::objects);
    layer->draw(false);
    glFinish();
    return 1e3 * (monotonicSeconds() - start);
  };
  ours(0);
  const double ourMB = residentMB() - before;
  glUseProgram(0);
  const double beforePeer = residentMB();
  ObjectPeer peer(*kept, rule, view.widthPx, view.heightPx);
  ObjectPeer::Frame last;
  const auto theirs = [&](int i) {
    glBindFramebuffer(GL_FRAMEBUFFER, (*offscreen)->framebuffer());
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glClearDepth(1);
    const ObjectQuery query = queryAt(i);
    last = peer.draw(query.eye, query.view);
    return last.frameMs;
  };
  theirs(0);
  const double peerMB = residentMB() - beforePeer;
  Pairs frames, culls;
  for (int i = 0; i < (report.quick() ? 10 : 40); ++i) {
    frames.a.push_back(ours(i));
    culls.a.push_back(selectMs);
    frames.b.push_back(theirs(i));
    culls.b.push_back(last.cullMs);
  }
  const std::string what = "200,000 objects over " + std::to_string(static_cast<int>(2 * radiusKm)) +
                           " km, 300 ft, " + std::to_string(visible.drawn.size()) + " drawn (" +
                           std::to_string(visible.triangles / 1000) + " k triangles; peer " +
                           std::to_string(last.drawables) + " drawn)";
  const std::string prefix = std::string("objects.") + id;
  const std::string peerName = "plain OpenSceneGraph, MatrixTransform and LOD an instance";
  report.add(ratioAtMost(
      goal,
      rowOf(frames, {.id = prefix + "_frame", .what = "Frame without ground: " + what, .peer = peerName})));
  report.add(ratioAtMost(0.05, rowOf(culls, {.id = prefix + "_select",
                                             .what = "Selection in flight: " + what,
                                             .peer = peerName + ", cull"})));
  report.add(valueAtMost(
      0.4,
      {.id = prefix + "_select_ms", .what = "The same by itself", .value = culls.medianA(), .unit = "ms"}));
  report.add(ratioAtMost(0.5, {.id = prefix + "_memory",
                               .what = "Memory that the objects take, with GL's",
                               .value = ourMB,
                               .unit = "MB",
                               .peer = peerName,
                               .peerValue = peerMB,
                               .peerFrom = "run"}));
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  using namespace trimtab;
  bench::Report report(argc, argv);
  const auto ground = bench::sampleTerrain(40);
  if (!ground) return 1;
  if (report.wants("objects.sparse")) bench::peerRows(report, *ground, "sparse", 19, 0.4);
  if (report.wants("objects.dense")) bench::peerRows(report, *ground, "dense", 5, 0.6);
  if (report.wants("objects.lights")) bench::lightRows(report, ground);
  if (report.wants("objects.hidden") || report.wants("objects.peer_hidden")) {
    const auto world =
        std::make_shared<const test::ObjectsOn>(ground, bench::scatteredOver(*ground, bench::kInstances, 19));
    if (report.wants("objects.hidden"))
      bench::hiddenRows(report, world, "hidden", "200,000 objects over 38 km",
                        {{"valley_300ft", 300, true, 0.5},
                         {"any_300ft", 300, false, 1.02},
                         {"any_2000ft", 2000, false, 0.7},
                         {"any_8000ft", 8000, false, 1.02}});
    if (report.wants("objects.peer_hidden")) bench::hiddenPeerRow(report, world);
  }
  if (report.wants("objects.kansai")) bench::kansaiRows(report);
  return report.finish();
}
