#include "trimtab/scene/error_meter.h"
#include "trimtab/scene/renderer.h"

#include <algorithm>
#include <array>

#include "core/scene/gl/frame_buffer.h"
#include "core/scene/gl/gl_api.h"
#include "core/scene/passes/blur_pass.h"
#include "core/scene/passes/node_pass.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/measure/geometric_error.h"
#include "trimtab/measure/image_error.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab::scene {
namespace {

/// The error is so small that the finest level is chosen wherever levels differ at all.
constexpr Pixels kFinest{1e-6};
/// Patches are drawn at the finest level wherever an image could show the difference, and not over a whole
/// country.
constexpr Pixels kFinestPatches{0.125};
constexpr Megabytes kReferenceCache{8192};
/// An earlier image at this weight is a quarter of a grey level of the mix.
constexpr double kNoTrace = 1.0 / 1024;

/// Returns a request without what both images leave out.
FrameRequest withoutEngineer(const FrameRequest& request) {
  FrameRequest r = request;
  if (asksForTrees(request)) r.terrain.form = TerrainForm::static_trees;
  r.overlays = {};
  r.overlays.treeDepth = request.overlays.treeDepth;
  r.frozenEye.reset();
  r.separateStages = false;
  r.waitForPages = r.reproducible = r.exactSlivers = true;
  // It depends on what was drawn before, and so would the share of nodes drawn in vain.
  r.skips.littleHidden = false;
  return r;
}

/// Returns the first of `frames` that has a trace in the image of frames[last].
std::size_t firstTraceIn(std::span<const FrameRequest> frames, std::size_t last) {
  double weight = 1;
  std::size_t first = last;
  while (first > 0) {
    const double step = frames[first].time - frames[first - 1].time;
    const double keep = BlurPass::keptAfter(frames[first].levers.drawn.blurStrength, step);
    // A frame of the same time takes the place of the one before.
    if (step != 0) weight *= keep;
    if (!(weight >= kNoTrace)) break;
    --first;
  }
  return first;
}

/// Counts the pixels that a node would own which was left out.
std::uint64_t wronglyCulled(const std::vector<std::uint32_t>& unculled, const VisibleSet& visible) {
  std::uint64_t pixels = 0;
  std::uint32_t last = 0;
  for (const std::uint32_t node : unculled)
    if (node != NodeTarget::kNone) last = std::max(last, node);
  const std::vector<CullReason> reason = visible.reasons(last + std::size_t{1});
  for (const std::uint32_t node : unculled)
    pixels += node != NodeTarget::kNone && reason[node] != CullReason::drawn;
  return pixels;
}

/// Returns the share of the nodes drawn that own no pixel.
double hiddenShare(const std::vector<std::uint32_t>& nodes, const VisibleSet& visible) {
  if (visible.tiles.empty()) return FrameError::kNotMeasured;
  std::uint32_t last = 0;
  for (const TileDraw& tile : visible.tiles) last = std::max(last, tile.node);
  std::vector<std::uint8_t> owns(last + std::size_t{1});
  for (const std::uint32_t node : nodes)
    if (node < owns.size()) owns[node] = 1;
  const auto hidden = std::count_if(visible.tiles.begin(), visible.tiles.end(),
                                    [&](const TileDraw& tile) { return owns[tile.node] == 0; });
  return static_cast<double>(hidden) / static_cast<double>(visible.tiles.size());
}

}  // namespace

FrameRequest referenceOf(const FrameRequest& request) {
  FrameRequest r = withoutEngineer(request);
  r.cullingCase = CullingCase::view_frustum;
  r.overlays.treeDepth = -1;
  r.terrain.cache = std::max(r.terrain.cache, kReferenceCache);
  r.staticLod.error = ErrorMeasure::maximum;
  r.staticLod.rule = StaticDistanceRule::picture;
  r.levers.drawn = {};
  r.levers.drawn.errorPx = (r.terrain.form == TerrainForm::patches ? kFinestPatches : kFinest).value();
  r.levers.drawn.treeErrorPx = r.levers.drawn.objectErrorPx = kFinest.value();
  return r;
}

double temporalPop(std::span<const std::uint8_t> referenceBefore, std::span<const std::uint8_t> reference,
                   std::span<const std::uint8_t> oursBefore, std::span<const std::uint8_t> ours) {
  const std::size_t bytes = ours.size();
  if (bytes == 0 || bytes % 4 != 0 || referenceBefore.size() != bytes || reference.size() != bytes ||
      oursBefore.size() != bytes)
    return FrameError::kNotMeasured;
  std::uint64_t sum = 0;
  constexpr std::size_t kRun = 1 << 16;  // whose sum is a 32-bit integer: the loop is vector instructions
  for (std::size_t from = 0; from < bytes; from += kRun) {
    std::uint32_t ofRun = 0;
    for (std::size_t i = from, end = std::min(from + kRun, bytes); i < end; ++i) {
      const int change = ours[i] - oursBefore[i], shown = reference[i] - referenceBefore[i];
      const int outside = std::max({change - std::max(shown, 0), std::min(shown, 0) - change, 0});
      ofRun += i % 4 == 3 ? 0u : static_cast<std::uint32_t>(outside);
    }
    sum += ofRun;
  }
  return static_cast<double>(sum) / (static_cast<double>(bytes) / 4 * 3);
}

namespace {

/// Holds all that the image of a reference depends on.
struct ReferenceKey {
  GeodeticPosition eye;
  Attitude attitude;
  ViewShape view;
  WeatherDecision weather;
  double time = 0;                                                  ///< only where something falls
  std::optional<Velocity> velocity;                                 ///< likewise
  Wind wind;                                                        ///< likewise
  Vec3 airDrift;                                                    ///< likewise
  PrecipitationLook rain, snow;                                     ///< likewise
  PrecipitationForm precipitationForm = PrecipitationForm::effect;  ///< likewise
  std::optional<FadingPrecipitation> fading;
  std::optional<SymbologyRequest> symbology;
  TerrainForm form = TerrainForm::tiles;
  friend bool operator==(const ReferenceKey&, const ReferenceKey&) = default;
};

ReferenceKey keyOf(const FrameRequest& r) {
  const WeatherDecision& w = r.decision.weather;
  ReferenceKey key;
  key.eye = r.eye;
  key.attitude = r.attitude;
  key.view = r.view;
  key.fading = r.fading;
  key.symbology = r.symbology;
  key.form = asksForTrees(r) ? TerrainForm::static_trees : r.terrain.form;
  if (w.fogged) {
    key.weather.fogged = true;
    key.weather.extinctionPerM = w.extinctionPerM;
    key.weather.layerTopM = w.layerTopM;
  }
  if (r.fading || (w.density > 0 && w.precipitation != Precipitation::none)) {
    key.precipitationForm = r.precipitationForm;
    key.weather.precipitation = w.precipitation;
    key.weather.density = w.density;
    key.time = r.time;
    key.velocity = r.velocity;
    key.wind = r.wind;
    key.airDrift = r.airDrift;
    key.rain = r.rain;
    key.snow = r.snow;
  }
  return key;
}

/// So many references are enough for a frame and the one before it in two kinds of weather.
constexpr std::size_t kKeptReferences = 4;

/// Keeps the framebuffers that are bound, and the viewport.
class BoundTarget {
 public:
  BoundTarget() {
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &draw_);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read_);
    glGetIntegerv(GL_VIEWPORT, viewport_.data());
  }
  void restore() const {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(draw_));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read_));
    glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  }

 private:
  GLint draw_ = 0, read_ = 0;
  std::array<GLint, 4> viewport_{};
};

}  // namespace

struct ErrorMeter::Impl {
  struct Reference {
    ReferenceKey key;
    std::vector<std::uint8_t> pixels;
    std::vector<float> distances;
    FrameResult drawn;
    std::uint64_t lastUse = 0;
  };

  std::shared_ptr<const terrain::Database> database;
  Renderer renderer;
  FrameBuffer target;
  Defects defects;
  bool usable = false;
  std::vector<std::unique_ptr<Reference>> references;
  std::uint64_t uses = 0;

  FrameResult draw(const FrameRequest& r) { return renderer.draw(r, target.id()); }
  std::vector<std::uint8_t> pixels(const ViewShape& view) {
    return renderer.readPixels(view.widthPx, view.heightPx);
  }
  const Reference& reference(const FrameRequest& request);
  /// Asking for the form that it is drawn in.
  FrameRequest asDrawn(FrameRequest request) const {
    if (const auto form = formDrawn(request, database.get())) request.terrain.form = *form;
    return request;
  }
};

/// Presets and cases are measured on one frame in turn, and it costs more than all else: the last few are
/// kept. Stands until as many others were asked for.
const ErrorMeter::Impl::Reference& ErrorMeter::Impl::reference(const FrameRequest& asked) {
  const FrameRequest request = asDrawn(asked);
  const ReferenceKey key = keyOf(request);
  const auto found =
      std::find_if(references.begin(), references.end(), [&](const auto& r) { return r->key == key; });
  if (found != references.end()) {
    (*found)->lastUse = ++uses;
    return **found;
  }
  if (references.size() >= kKeptReferences)
    references.erase(std::min_element(references.begin(), references.end(),
                                      [](const auto& a, const auto& b) { return a->lastUse < b->lastUse; }));
  FrameResult drawn = draw(referenceOf(request));
  references.push_back(std::make_unique<Reference>(
      Reference{key, pixels(request.view), renderer.readDistances(), std::move(drawn), ++uses}));
  return *references.back();
}

ErrorMeter::ErrorMeter() : impl_(std::make_unique<Impl>()) {}
ErrorMeter::~ErrorMeter() = default;

GlReport ErrorMeter::initialize() {
  release();
  const GlReport report = impl_->renderer.initialize();
  impl_->usable = report.usable;
  return report;
}

void ErrorMeter::release() {
  impl_->renderer.release();
  impl_->target.release();
  impl_->references.clear();
  impl_->usable = false;
}

void ErrorMeter::setTerrain(std::shared_ptr<const terrain::Database> database) {
  impl_->references.clear();
  impl_->database = database;
  impl_->renderer.setTerrain(std::move(database));
}

void plant(ErrorMeter& meter, const Defects& defects) {
  meter.impl_->defects = defects;
}

FrameResult ErrorMeter::draw(const FrameRequest& request) {
  const ViewShape& v = request.view;
  if (!impl_->usable || v.widthPx <= 0 || v.heightPx <= 0) return {};
  const BoundTarget bound;
  impl_->target.resize(v.widthPx, v.heightPx);
  FrameResult result = impl_->draw(impl_->asDrawn(withoutEngineer(request)));
  bound.restore();
  return result;
}

FrameError ErrorMeter::measure(const FrameRequest& request, std::span<const FrameRequest> before,
                               ErrorPictures* pictures) {
  FrameError error;
  const ViewShape& v = request.view;
  if (!impl_->usable || v.widthPx <= 0 || v.heightPx <= 0) return error;
  Impl& m = *impl_;
  const BoundTarget bound;
  m.target.resize(v.widthPx, v.heightPx);

  const bool pops =
      !before.empty() && before.back().view.widthPx == v.widthPx && before.back().view.heightPx == v.heightPx;
  plant(m.renderer, {});
  const Impl::Reference* referenceBefore = pops ? &m.reference(before.back()) : nullptr;
  const Impl::Reference& reference = m.reference(request);

  plant(m.renderer, m.defects);
  m.renderer.forgetPictures();
  std::vector<FrameRequest> frames;
  for (const FrameRequest& r : before) frames.push_back(m.asDrawn(withoutEngineer(r)));
  frames.push_back(m.asDrawn(withoutEngineer(request)));
  const std::size_t last = frames.size() - 1;
  std::size_t first = firstTraceIn(frames, last);
  if (pops) first = std::min(first, firstTraceIn(frames, last - 1));
  for (std::size_t i = first; i < last; ++i) m.draw(frames[i]);
  std::vector<std::uint8_t> oursBefore;
  if (pops) oursBefore = m.pixels(v);
  FrameResult result = m.draw(frames[last]);
  std::vector<std::uint8_t> ours = m.pixels(v);
  const std::vector<float> distances = m.renderer.readDistances();
  error.hiddenDrawnShare = hiddenShare(m.renderer.readNodes(), result.visible);
  error.wronglyCulledPixels = wronglyCulled(m.renderer.readNodes(true), result.visible);
  plant(m.renderer, {});
  bound.restore();

  const GeometricError geometric =
      geometricError(distancesUpTo(farCutM(request), reference.distances), distances, v);
  error.geometricMaxPx = geometric.maxPx;
  error.geometricMeanPx = geometric.meanPx;
  error.psnrDb = psnrDb(reference.pixels, ours, v.widthPx, v.heightPx);
  error.ssim = ssimOfLuma(reference.pixels, ours, v.widthPx, v.heightPx);
  std::vector<float> map;
  if (pictures) map.resize(ours.size() / 4);
  error.flip = flip(reference.pixels, ours, v.widthPx, v.heightPx, map);
  if (pops) error.pop = temporalPop(referenceBefore->pixels, reference.pixels, oursBefore, ours);
  if (pictures)
    *pictures = {v.widthPx,      v.heightPx,      reference.pixels, std::move(ours),
                 std::move(map), reference.drawn, std::move(result)};
  return error;
}

}  // namespace trimtab::scene
