#include "culling_truth.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>

#include "trimtab/preset/choices.h"
#include "trimtab/scene/depth_read_back.h"

namespace trimtab::test {
namespace {

constexpr std::uint32_t kNoNode = scene::Renderer::kNoNode;

double between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

std::vector<std::uint32_t> nodesOf(const VisibleSet& visible) {
  std::vector<std::uint32_t> nodes;
  for (const TileDraw& tile : visible.tiles) nodes.push_back(tile.node);
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

bool contains(const std::vector<std::uint32_t>& nodes, std::uint32_t node) {
  return std::binary_search(nodes.begin(), nodes.end(), node);
}

}  // namespace

int soak() {
  const char* text = std::getenv("TRIMTAB_SOAK");
  return text ? std::max(1, std::atoi(text)) : 1;
}

std::vector<OcclusionChoice> occlusionChoices() {
  std::vector<OcclusionChoice> all;
  for (const auto& option : table::ChoicesOf<OcclusionMethod>::options)
    all.push_back({static_cast<OcclusionMethod>(all.size()), option.name.data()});
  return all;
}

void CullingTruth::SetUp() {
  SceneTest::SetUp();
  if (!offscreen) return;
  auto larger = scene::Offscreen::create(1280, 720);
  ASSERT_TRUE(larger) << toString(larger.findings());
  renderer.release();
  offscreen = std::move(larger).value();
  offscreen->makeCurrent();
  report = renderer.initialize();
  ASSERT_TRUE(report.usable) << report.missing;
}

scene::FrameRequest CullingTruth::viewOf(const GeodeticPosition& eye, const Attitude& attitude) const {
  auto r = request(eye, attitude);
  r.staticLod.terrain = form_;
  r.waitForPages = true;
  return r;
}

std::vector<scene::FrameRequest> CullingTruth::anyViews(int count, unsigned seed) const {
  std::mt19937 random(seed);
  std::vector<scene::FrameRequest> views;
  for (int i = 0; i < count; ++i) {
    double east = between(random, 0.02, 0.98), north = between(random, 0.02, 0.98);
    // Valleys and shores: the lowest of some places nearby.
    if (i % 3 == 1) {
      double lowest = 1e9;
      const double east0 = east, north0 = north;
      for (int k = 0; k < 12; ++k) {
        const double e = std::clamp(east0 + between(random, -0.03, 0.03), 0.0, 1.0),
                     n = std::clamp(north0 + between(random, -0.03, 0.03), 0.0, 1.0);
        const double height = over(e, n, 0).height.value();
        if (height < lowest) lowest = height, east = e, north = n;
      }
    }
    // Up to 9,000 m above the ground, most of them low, where much is hidden.
    double above = 8 * std::pow(9000 / 8.0, std::pow(between(random, 0, 1), 2.5));
    if (i % 16 == 5) above = between(random, 9000, 30000);
    if (i % 24 == 11) above = -between(random, 5, 300);
    if (i % 12 == 8) east = between(random, -0.2, 1.2), north = i % 8 == 0 ? -0.1 : 1.15;
    double pitch = between(random, -20, 5);
    if (i % 7 == 3) pitch = between(random, -89, -45);
    if (i % 13 == 6) pitch = between(random, 5, 60);
    if (i % 40 == 39) pitch = -90;
    const double roll = i % 3 == 0 ? between(random, -180, 180) : 0;
    auto r =
        viewOf(over(east, north, above), {Degrees{between(random, 0, 360)}, Degrees{pitch}, Degrees{roll}});
    ViewShape& v = r.view;
    if (i % 8 == 2) v.widthPx = 1280, v.heightPx = 720;
    if (i % 16 == 9) v.widthPx = 333, v.heightPx = 217;
    if (i % 5 == 4) v.left = -0.2, v.right = 0.9, v.bottom = -0.6, v.top = 0.1;
    if (i % 9 == 2) v.left = -1.7, v.right = 1.7, v.bottom = -1, v.top = 1;
    if (i % 11 == 7) v.left = -0.02, v.right = 0.02, v.bottom = -0.01, v.top = 0.01;
    r.lod.screenSpaceError = Pixels{i % 16 == 1 ? 0.1 : i % 4 == 0 ? 6.0 : i % 4 == 1 ? 0.5 : 2.0};
    r.staticLod.errorPx = r.lod.screenSpaceError;
    if (i % 10 == 6) {
      const double farM = between(random, 3000, 20000);
      r.decision.weather = {
          .fogged = true, .visibilityM = farM, .extinctionPerM = 3.912 / farM, .farM = farM};
    }
    views.push_back(r);
  }
  return views;
}

std::vector<scene::FrameRequest> CullingTruth::flight(int frames, unsigned seed) const {
  std::mt19937 random(seed);
  std::vector<scene::FrameRequest> path;
  constexpr double kStepM = 600 * 1852.0 / 3600 / 60, kTurnDeg = 200.0 / 60;
  // Long enough for what is built ahead over many frames, where there is time for it.
  const int legFrames = soak() > 1 ? 48 : 8;
  double east = 0.5, north = 0.5, course = 0, head = 0, above = 60;
  for (int i = 0; i < frames; ++i) {
    const int leg = i / legFrames, step = i % legFrames;
    if (step == 0) {  // a leap
      east = between(random, 0.2, 0.8), north = between(random, 0.2, 0.8);
      course = between(random, 0, 360), head = course;
      above = leg % 4 == 3 ? between(random, 1500, 4000) : between(random, 15, 400);
    }
    const bool stands = leg % 3 == 2;
    if (!stands) {
      const auto& info = database->info();
      const double heightM = 111e3 * (info.northEast.latitude - info.southWest.latitude).value(),
                   turned = course * 3.14159265358979 / 180;
      const double middle = (info.northEast.latitude + info.southWest.latitude).value() / 2;
      const double widthM = 111e3 * scene::widthOf(info).value() * std::cos(middle * 3.14159265358979 / 180);
      east += kStepM * std::sin(turned) / widthM, north += kStepM * std::cos(turned) / heightM;
      if (leg % 4 == 1) above += 2;
    }
    head += (step / (legFrames / 2) % 2 == 0 ? kTurnDeg : -kTurnDeg);
    if (leg % 5 == 4) head = course;
    auto r = viewOf(over(east, north, above),
                    {Degrees{head}, Degrees{leg % 4 == 2 ? -35.0 : -4.0}, Degrees{leg % 3 == 1 ? 30.0 : 0}});
    r.time = i / 60.0;
    r.lod.screenSpaceError = Pixels{leg % 3 == 0 ? 0.5 : 2.0};
    if (step >= legFrames * 3 / 4) r.decision.lodScale = 2;
    r.staticLod.errorPx = r.lod.screenSpaceError;
    path.push_back(r);
  }
  return path;
}

CullingTruth::Owners CullingTruth::owners() {
  std::map<std::uint32_t, std::uint32_t> owned;
  for (const std::uint32_t node : renderer.readNodes())
    if (node != kNoNode) ++owned[node];
  return {owned.begin(), owned.end()};
}

CullingTruth::View CullingTruth::truthOf(const scene::FrameRequest& r, bool withPicture) {
  View view;
  view.request = r;
  scene::FrameRequest whole = r;
  whole.method = CullingCase::none;
  whole.decision.depthMap.reset();
  scene::FrameResult result = renderer.draw(whole, offscreen->framebuffer());
  view.cut = result.visible.tiles.size();
  EXPECT_EQ(view.cut + result.visible.beyondVisibility, result.tilesInCut) << describe(r);
  view.owners = owners();
  if (withPicture) {
    view.picture = renderer.readPixels(r.view.widthPx, r.view.heightPx);
    // Frozen where it stands nothing is left out for facing away either.
    const LocalFrame& frame = database->index().frame;
    whole.frozenEye = EyePose{frame.fromGeodetic(r.eye), eyeAxes(frame, r.eye, r.attitude)};
    renderer.draw(whole, offscreen->framebuffer());
    for (const auto& [node, pixels] : owners())
      view.pixelsFromBehind +=
          std::none_of(view.owners.begin(), view.owners.end(), [&](const auto& o) { return o.first == node; })
              ? pixels
              : 0;
  }

  scene::FrameRequest frustum = r;
  frustum.method = CullingCase::view_frustum;
  frustum.backFaces = false;
  frustum.decision.depthMap.reset();
  result = renderer.draw(frustum, offscreen->framebuffer());
  view.frustum = view.hidden = result.visible.tiles.size();
  const auto drawn = nodesOf(result.visible);
  for (const auto& [node, pixels] : view.owners) view.hidden -= contains(drawn, node);
  return view;
}

void CullingTruth::compare(const View& view, CullingCase culling, OcclusionMethod method, DepthMapSize band,
                           Tally& tally) {
  scene::FrameRequest r = view.request;
  r.method = culling;
  r.occlusion = method;
  r.decision.depthMap = band;
  const auto result = renderer.draw(r, offscreen->framebuffer());
  const auto drawn = nodesOf(result.visible);
  std::size_t nodes = 0, pixels = 0;
  for (const auto& [node, count] : view.owners)
    if (!contains(drawn, node)) ++nodes, pixels += count;
  if (nodes > 0 && tally.told++ < 3)
    std::printf("    set %zu, %dx%d: %zu nodes with %zu pixels culled wrongly; %s\n", tally.sets,
                band.widthPx, band.heightPx, nodes, pixels, describe(r).c_str());
  ++tally.sets;
  tally.occluded += view.frustum - std::min(view.frustum, result.visible.tiles.size());
  tally.hidden += view.hidden;
  tally.wrongNodes += nodes;
  tally.wrongPixels += pixels;
  if (view.picture.empty()) return;
  ++tally.pictures;
  tally.differing += differing(view.picture, renderer.readPixels(r.view.widthPx, r.view.heightPx));
}

void CullingTruth::tell(const char* what, const std::string& method, const Tally& t) {
  std::printf(
      "    %-24s %6zu sets, %4.1f %% of the hidden left out, %zu wrong; %zu pictures, %zu pixels differ\n",
      method.c_str(), t.sets, t.hidden > 0 ? 100.0 * double(t.occluded) / double(t.hidden) : 0.0,
      t.wrongNodes, t.pictures, t.differing);
  std::fflush(stdout);
  EXPECT_EQ(t.wrongNodes, 0u) << what << ", " << method;
  EXPECT_EQ(t.differing, 0u) << what << ", " << method;
}

void CullingTruth::proveViews(const std::vector<scene::FrameRequest>& requests) {
  const auto methods = occlusionChoices();
  const bool everyBand = soak() > 1;
  std::size_t cut = 0, frustum = 0, hidden = 0, fromBehind = 0;
  Tally plain;
  std::vector<std::array<Tally, kBands.size()>> tallies(methods.size());
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const View view = truthOf(requests[i], i % 20 == 0);
    cut += view.cut, frustum += view.frustum, hidden += view.hidden;
    fromBehind += view.pixelsFromBehind;
    const std::size_t own = i % kBands.size();
    compare(view, CullingCase::view_frustum, OcclusionMethod::depth_map, kBands[own], plain);
    for (std::size_t m = 0; m < methods.size(); ++m)
      for (std::size_t b = 0; b < kBands.size(); ++b)
        if (everyBand || b == own)
          compare(view, CullingCase::proposed, methods[m].method, kBands[b], tallies[m][everyBand ? b : 0]);
  }
  std::printf(
      "  %zu views: %zu nodes in their cuts, %zu in the frustum, %zu of these without a pixel; %zu pixels "
      "are of nodes that show their backs alone\n",
      requests.size(), cut, frustum, hidden, fromBehind);
  tell("views", "view_frustum", plain);
  for (std::size_t m = 0; m < methods.size(); ++m)
    for (std::size_t b = 0; b < (everyBand ? kBands.size() : 1); ++b)
      tell("views",
           methods[m].name +
               (everyBand ? ' ' + std::to_string(kBands[b].widthPx) + 'x' + std::to_string(kBands[b].heightPx)
                          : std::string()),
           tallies[m][b]);
}

void CullingTruth::proveFlight(const std::vector<scene::FrameRequest>& requests) {
  std::vector<View> views;
  for (const auto& r : requests) views.push_back(truthOf(r, views.size() % 20 == 0));
  std::size_t hidden = 0;
  for (const View& view : views) hidden += view.hidden;
  std::printf("  %zu frames of flight: %zu nodes in the frustum without a pixel\n", views.size(), hidden);
  const auto follow = [&](OcclusionMethod method, const std::string& name) {
    Tally tally;
    // The band changes in flight too.
    for (std::size_t i = 0; i < views.size(); ++i)
      compare(views[i], CullingCase::proposed, method, kBands[i / 32 % kBands.size()], tally);
    tell("flight", name, tally);
  };
  for (const auto& [method, name] : occlusionChoices()) follow(method, name);
  // As on a GPU, whose maps come late.
  for (const int lag : {1, 3}) {
    scene::DepthReadBack::force({.lag = lag});
    follow(OcclusionMethod::read_back, "read_back, late by " + std::to_string(lag));
  }
  scene::DepthReadBack::force({});
}

void CullingTruth::prove(TerrainForm form, int count, unsigned seed) {
  useForm(form);
  std::printf("%s, %s\n", database->info().name.c_str(),
              table::ChoicesOf<TerrainForm>::options[static_cast<std::size_t>(form)].name.data());
  proveViews(anyViews(count * soak(), seed));
  proveFlight(flight(std::max(16, count * soak() / 2), seed + 1));
}

std::string CullingTruth::describe(const scene::FrameRequest& r) {
  char text[400];
  std::snprintf(
      text, sizeof text,
      "eye %.9f %.9f %.4f, attitude %.6f %.6f %.6f, %dx%d, tangents %g %g %g %g, error %g, scale %g, "
      "far %g",
      r.eye.latitude.value(), r.eye.longitude.value(), r.eye.height.value(), r.attitude.heading.value(),
      r.attitude.pitch.value(), r.attitude.roll.value(), r.view.widthPx, r.view.heightPx, r.view.left,
      r.view.right, r.view.bottom, r.view.top, r.lod.screenSpaceError.value(), r.decision.lodScale,
      r.decision.weather.farM);
  return text;
}

}  // namespace trimtab::test
