#include "culling_truth.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>

#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/preset/choices.h"
#include "trimtab/scene/renderer.h"
#include "undrawn.h"

namespace trimtab::test {
namespace {

constexpr std::uint32_t kNoNode = scene::Renderer::kNoNode;

bool contains(const std::vector<std::uint32_t>& nodes, std::uint32_t node) {
  return std::binary_search(nodes.begin(), nodes.end(), node);
}

/// One view in twenty, of all kinds in turn.
bool hasPicture(std::size_t view) {
  return view % 20 == view / 20 * 7 % 20;
}

/// Pixels that show something much farther than `truth` does: more than steps between two triangles at a
/// ridge.
std::size_t farther(const std::vector<float>& distances, const std::vector<float>& truth) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) n += distances[i] > 1.2f * truth[i];
  return n;
}

/// Whether this process looks at a view or leg, of many: TRIMTAB_SHARD=2/5 is the third of five processes.
bool inShard(std::size_t index) {
  static const std::pair<std::size_t, std::size_t> shard = [] {
    unsigned which = 0, of = 1;
    const char* text = std::getenv("TRIMTAB_SHARD");
    if (text && (std::sscanf(text, "%u/%u", &which, &of) != 2 || which >= of)) std::abort();
    return std::pair<std::size_t, std::size_t>(which, of);
  }();
  return index % shard.second == shard.first;
}

}  // namespace

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

std::vector<std::uint32_t> CullingTruth::nodesOf(const VisibleSet& visible) {
  std::vector<std::uint32_t> nodes;
  for (const TileDraw& tile : visible.tiles) nodes.push_back(tile.node);
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

CullingTruth::Owners CullingTruth::owners() {
  std::map<std::uint32_t, std::uint32_t> owned;
  for (const std::uint32_t node : renderer.readNodes())
    if (node != kNoNode) ++owned[node];
  return {owned.begin(), owned.end()};
}

CullingTruth::View CullingTruth::truthOf(const FrameRequest& r, bool withPicture, bool bothSides) {
  View view;
  view.request = r;
  FrameRequest whole = r;
  whole.cullingCase = CullingCase::none;
  whole.levers.drawn.occlusion.reset();
  FrameResult result = draw(whole, withPicture);
  view.cut = result.visible.tiles.size();
  EXPECT_EQ(view.cut + result.visible.beyondVisibility, result.tilesInCut) << describe(r);
  view.owners = owners();
  if (withPicture) {
    view.picture = renderer.readPixels(r.view.widthPx, r.view.heightPx);
    const auto distances = renderer.readDistances();
    whole.backFaces = false;
    draw(whole, true);
    view.ridges = differing(view.picture, renderer.readPixels(r.view.widthPx, r.view.heightPx));
    view.open = farther(distances, renderer.readDistances());
    whole.backFaces = true;
    // Frozen where it stands nothing is left out for facing away either.
    const LocalFrame& frame = database->index().frame;
    whole.frozenEye = EyePose{frame.fromGeodetic(r.eye), eyeAxes(frame, r.eye, r.attitude)};
    draw(whole, false);
    for (const auto& [node, pixels] : owners())
      view.pixelsFromBehind +=
          std::none_of(view.owners.begin(), view.owners.end(), [&](const auto& o) { return o.first == node; })
              ? pixels
              : 0;
    whole.frozenEye.reset();
  }
  if (bothSides) {
    whole.backFaces = false;
    draw(whole, false);
    view.owners = owners();
  }

  FrameRequest frustum = r;
  frustum.cullingCase = CullingCase::view_frustum;
  frustum.backFaces = false;
  frustum.levers.drawn.occlusion.reset();
  result = draw(frustum, false);
  view.frustum = view.hidden = result.visible.tiles.size();
  const auto drawn = nodesOf(result.visible);
  for (const auto& [node, pixels] : view.owners) view.hidden -= contains(drawn, node);
  return view;
}

FrameResult CullingTruth::draw(const FrameRequest& r, bool wholly) {
  std::optional<Undrawn> undrawn;
  if (!wholly) undrawn.emplace(r.view.widthPx, r.view.heightPx);
  return renderer.draw(r, offscreen->framebuffer());
}

void CullingTruth::compare(const View& view, CullingCase culling, OcclusionMethod method,
                           OcclusionResolution band, Tally& tally, bool wholly) {
  FrameRequest r = view.request;
  r.cullingCase = culling;
  r.occlusion = method;
  r.levers.drawn.occlusion = band;
  const auto result = draw(r, wholly);
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
  if (!wholly || view.picture.empty()) return;
  ++tally.pictures;
  tally.differing += differing(view.picture, renderer.readPixels(r.view.widthPx, r.view.heightPx));
}

void CullingTruth::Tally::add(const Tally& other) {
  sets += other.sets, occluded += other.occluded, hidden += other.hidden;
  wrongNodes += other.wrongNodes, wrongPixels += other.wrongPixels, told += other.told;
  pictures += other.pictures, differing += other.differing;
}

void CullingTruth::tell(const char* what, const std::string& method, const Tally& t) {
  std::printf(
      "    %-29s %6zu sets, %4.1f %% of the hidden left out, %zu wrong; %zu pictures, %zu pixels differ\n",
      method.c_str(), t.sets, shareOf(t), t.wrongNodes, t.pictures, t.differing);
  std::fflush(stdout);
  EXPECT_EQ(t.wrongNodes, 0u) << what << ", " << method;
  EXPECT_EQ(t.differing, 0u) << what << ", " << method;
}

void CullingTruth::proveViews(const std::vector<FrameRequest>& requests, Sum& sum) {
  const auto methods = occlusionChoices();
  const bool everyBand = soak() > 1;
  std::size_t views = 0, cut = 0, frustum = 0, hidden = 0, fromBehind = 0, both = 0, ridges = 0, open = 0;
  Tally plain;
  std::vector<std::array<Tally, kBands.size()>> tallies(methods.size());
  for (std::size_t i = 0; i < requests.size(); ++i) {
    if (!inShard(i / 20)) continue;
    const bool bothSides = i % 4 == 3;
    const View view = truthOf(requests[i], hasPicture(i), bothSides);
    both += bothSides, ridges += view.ridges, open += view.open;
    const bool pictured = !view.picture.empty();
    cut += view.cut, frustum += view.frustum, hidden += view.hidden;
    fromBehind += view.pixelsFromBehind;
    sum.kinds.add(requests[i], *database);
    const std::size_t own = (i + i / 20) % kBands.size();
    compare(view, CullingCase::view_frustum, OcclusionMethod::depth_map, kBands[own], plain, pictured);
    // A horizon serves all methods of its band.
    for (std::size_t b = 0; b < kBands.size(); ++b)
      for (std::size_t m = 0; m < methods.size(); ++m) {
        if (!everyBand && b != own) continue;
        // What frames cost is what it chooses by.
        const bool costs = methods[m].method == OcclusionMethod::automatic;
        compare(view, CullingCase::proposed, methods[m].method, kBands[b], tallies[m][everyBand ? b : 0],
                costs || (pictured && b == own));
      }
    if (++views % 100 == 0) std::printf("  %zu views\n", views), std::fflush(stdout);
  }
  std::printf(
      "  %zu views: %zu nodes in their cuts, %zu in the frustum, %zu of these without a pixel; %zu pixels "
      "are of nodes that show their backs alone\n",
      views, cut, frustum, hidden, fromBehind);
  std::printf(
      "  owners of both sides in %zu of them; GL's face culling changes %zu pixels of the pictures, %zu show "
      "what lies behind\n",
      both, ridges, open);
  EXPECT_EQ(open, 0u);
  sum.views += views;
  sum.all.add(plain);
  tell("views", "view_frustum", plain);
  for (std::size_t m = 0; m < methods.size(); ++m)
    for (std::size_t b = 0; b < (everyBand ? kBands.size() : 1); ++b) {
      std::string name = methods[m].name;
      sum.all.add(tallies[m][b]);
      sum.methods[name].add(tallies[m][b]);
      if (everyBand)
        name += ' ' + std::to_string(kBands[b].widthPx) + 'x' + std::to_string(kBands[b].heightPx);
      tell("views", name, tallies[m][b]);
    }
}

void CullingTruth::proveFlight(const std::vector<FrameRequest>& requests, Sum& sum) {
  std::vector<View> views;
  for (std::size_t i = 0; i < requests.size(); ++i)
    if (inShard(i / static_cast<std::size_t>(legFrames())))
      views.push_back(truthOf(requests[i], hasPicture(i), i % 4 == 3));
  std::size_t hidden = 0, open = 0;
  for (const View& view : views) hidden += view.hidden, open += view.open;
  EXPECT_EQ(open, 0u);
  std::printf("  %zu frames of flight: %zu nodes in the frustum without a pixel\n", views.size(), hidden);
  sum.frames += views.size();
  const auto follow = [&](OcclusionMethod method, const std::string& name) {
    const bool costs = method == OcclusionMethod::automatic;
    Tally tally;
    // The band changes in flight too.
    for (std::size_t i = 0; i < views.size(); ++i)
      compare(views[i], CullingCase::proposed, method, kBands[i / 32 % kBands.size()], tally,
              costs || !views[i].picture.empty());
    tell("flight", name, tally);
    sum.all.add(tally);
  };
  for (const auto& [method, name] : occlusionChoices()) follow(method, name);
  // From nothing, surfaces made some a frame. Levels alone are the same without waiting for pages.
  if (form_ != TerrainForm::tiles) return;
  for (View& view : views) view.request.waitForPages = false;
  for (const auto& [method, name] : occlusionChoices()) {
    if (method == OcclusionMethod::depth_map) continue;
    renderer.setTerrain(database);
    follow(method, std::string(name) + ", from nothing");
  }
}

void CullingTruth::prove(std::initializer_list<Part> parts, unsigned seed) {
  Sum sum;
  for (const auto& [form, count] : parts) {
    useForm(form);
    std::printf("%s, %s\n", database->info().name.c_str(),
                table::ChoicesOf<TerrainForm>::options[static_cast<std::size_t>(form)].name.data());
    proveViews(anyViews(count * soak(), seed), sum);
    proveFlight(flight(std::max(16, count * soak() / 2), seed + 1), sum);
    ++seed;
  }
  tellSum(sum);
}

void CullingTruth::tellSum(const Sum& sum) const {
  std::string shares;
  for (const auto& [name, tally] : sum.methods) {
    char share[80];
    std::snprintf(share, sizeof share, "%s%s %.1f %%", shares.empty() ? "" : ", ", name.c_str(),
                  shareOf(tally));
    shares += share;
  }
  std::printf(
      "%s: %zu views and %zu frames of flight, %zu sets: %zu nodes culled wrongly; %zu pictures, %zu pixels "
      "differ; of the nodes without a pixel in these views are left out by %s; the views are %s\n",
      database->info().name.c_str(), sum.views, sum.frames, sum.all.sets, sum.all.wrongNodes,
      sum.all.pictures, sum.all.differing, shares.c_str(), sum.kinds.text().c_str());
  std::fflush(stdout);
}

}  // namespace trimtab::test
