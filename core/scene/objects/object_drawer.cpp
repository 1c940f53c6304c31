#include "object_drawer.h"

#include <algorithm>

#include "core/scene/gl/gl_api.h"
#include "trimtab/culling/cut_rule.h"
#include "trimtab/frame/overlay_colours.h"
#include "trimtab/frame/overlays.h"

namespace trimtab::scene {

void ObjectDrawer::setTerrain(const std::shared_ptr<const terrain::Database>& database) {
  objects_ = database ? database->objects() : nullptr;
  lights_.setTerrain(objects_);
  if (objects_ && objects_->index.cells.empty()) objects_ = nullptr;
  key_.reset();
  visible_ = {};
  all_ = {};
  if (layer_) layer_->setObjects(objects_.get());
}

void ObjectDrawer::initialize() {
  key_.reset();
  layer_ = std::make_unique<ObjectLayer>();
  layer_->setObjects(objects_.get());
}

void ObjectDrawer::prepare(const FrameInProgress& frame, std::span<const std::uint8_t> hidden) {
  lights_.prepare(frame);
  if (!objects_ || !layer_) return;
  const FrameRequest& r = frame.request;
  const EyePose eye = r.frozenEye.value_or(frame.eye);
  if (r.cullingCase != CullingCase::proposed) hidden = {};
  Key key{.eye = eye,
          .view = r.view,
          .cullingCase = r.cullingCase,
          .rule = objectRuleOf(r),
          .leastPx = r.levers.drawn.smallFeaturePx,
          .farM = r.levers.drawn.objectFarM,
          .airM = farCutM(r),
          .seenFrom = frame.eye.position,
          .byReason = r.overlays.colourByReason,
          .byLevel = r.overlays.colourByLevel};
  if (r.skips.sameVisible && key_ == key && std::ranges::equal(hidden_, hidden)) return;
  hidden_.assign(hidden.begin(), hidden.end());
  ObjectQuery query{.eye = eye,
                    .view = r.view,
                    .cull = r.cullingCase != CullingCase::none,
                    .rule = key.rule,
                    .leastPx = key.leastPx,
                    .farM = key.farM,
                    .airM = key.airM,
                    .hidden = hidden_};
  selectObjects(objects_->index, query, visible_);
  if (key.byReason) {
    query.cull = false;
    selectObjects(objects_->index, query, all_);
  }
  key_ = key;
  VisibleObjects& drawn = key.byReason ? all_ : visible_;
  // A frozen eye selects what another one sees.
  if (const Vec3 shift = eye.position - key.seenFrom; shift != Vec3{})
    for (DrawnObject& object : drawn.drawn) {
      object.x = static_cast<float>(object.x + shift.x);
      object.y = static_cast<float>(object.y + shift.y);
      object.z = static_cast<float>(object.z + shift.z);
    }
  layer_->setInstances(drawn, tintsOf(drawn));
  frame.clock.lap(&FrameCost::select);
}

std::vector<std::uint32_t> ObjectDrawer::tintsOf(const VisibleObjects& drawn) const {
  std::vector<std::uint32_t> tints;
  if (!key_->byReason && !key_->byLevel) return tints;
  tints.reserve(drawn.drawn.size());
  const ObjectIndex& index = objects_->index;
  std::size_t level = 0;
  for (std::uint32_t i = 0; i < drawn.drawn.size(); ++i) {
    while (i >= drawn.firstOfLevel[level + 1]) ++level;
    const DrawnObject& object = drawn.drawn[i];
    const std::uint32_t first = index.models[index.instances[object.instance].model].firstLevel;
    tints.push_back(overlayTint(key_->byReason ? reasonColour(visible_.reason[object.cell])
                                               : levelColour(static_cast<int>(level - first))));
  }
  return tints;
}

void ObjectDrawer::draw(ScenePrograms& programs, bool wire) {
  if (wire) glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  drawWith(programs, SceneShaders::objects, wire);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  if (!wire) lights_.draw(programs);
}

void ObjectDrawer::drawNumbers(ScenePrograms& programs) {
  if (shown().drawn.empty()) return;
  std::vector<std::uint32_t> numbers;
  for (const DrawnObject& object : shown().drawn) numbers.push_back(object.instance);
  layer_->setInstances(shown(), numbers);
  drawWith(programs, SceneShaders::object_numbers, false);
  layer_->setInstances(shown(), tintsOf(shown()));
}

/// Draws with the shaders for what has no texture, and with those that follow for what has one.
void ObjectDrawer::drawWith(ScenePrograms& programs, SceneShaders plain, bool wire) {
  for (const bool textured : {false, true}) {
    if (!layer_->draws(textured)) continue;
    programs.use(SceneShaders{static_cast<int>(plain) + textured}, wire);
    if (textured) layer_->bindTextures();
    layer_->draw(textured);
  }
}

ObjectFrame ObjectDrawer::frame() const {
  return {.drawn = visible_.drawn.size(),
          .outsideFrustum = visible_.outsideFrustum,
          .occluded = visible_.occluded,
          .tooFar = visible_.tooFar,
          .tooSmall = visible_.tooSmall,
          .triangles = visible_.triangles,
          .vertices = visible_.vertices};
}

}  // namespace trimtab::scene
