// SPDX-License-Identifier: GPL-3.0-or-later
#include "culling_controller.h"

#include <algorithm>
#include <cmath>

#include "app/workbench/docks/dock_of.h"
#include "app/workbench/viewport/viewport.h"
#include "frame_controller.h"
#include "terrain_controller.h"
#include "trimtab/scene/distance_image.h"
#include "trimtab/scene/node_description.h"
#include "trimtab/scene/renderer.h"
#include "views/model/theme.h"
#include "views/panels/culling_panel.h"

namespace trimtab::workbench {
namespace {

constexpr double kDegreesPerRadian = 57.29577951308232;

bool isWhiteAllOver(const QImage& grey) {
  for (int y = 0; y < grey.height(); ++y) {
    const uchar* const row = grey.constScanLine(y);
    if (std::any_of(row, row + grey.width(), [](uchar pixel) { return pixel != 255; })) return false;
  }
  return true;
}

}  // namespace

CullingController::CullingController(const Workplace& workplace, FrameController& frame,
                                     const TerrainController& terrain, views::CullingPanel& panel)
    : at_(workplace), frame_(frame), terrain_(terrain), panel_(panel) {
  connect(&panel_, &views::CullingPanel::pickingChanged, &at_.viewport, &Viewport::setPicking);
  connect(&at_.viewport, &Viewport::picked, this, &CullingController::showPicked);
  connect(&at_.viewport, &Viewport::depthMapRead, this, &CullingController::showDepthMap);
  connect(&at_.viewport, &Viewport::horizonRead, this, &CullingController::showHorizon);
  connect(&terrain_, &TerrainController::opened, this, &CullingController::forgetPicked);
  // The outline draws what the dock says, so it shows while the dock does. Reading a map back
  // from GL costs time, so it is read only while it is seen.
  whenSeen(panel_, this, [this](bool seen) {
    frame_.setOutline(seen ? picked_ : std::nullopt);
    at_.viewport.setDepthMapWanted(seen);
  });
}

void CullingController::setOverlay(bool Overlays::*flag, bool on) {
  Overlays overlays = frame_.overlays();
  overlays.*flag = on;
  frame_.setOverlays(overlays);
}

void CullingController::setTreeOverlay(int depth, bool picture) {
  Overlays overlays = frame_.overlays();
  overlays.treeDepth = depth;
  overlays.treePicture = picture;
  frame_.setOverlays(overlays);
}

void CullingController::showHorizon(const std::vector<float>& elevationDeg) {
  if (!frame_.shown()) return;
  const ViewShape& view = frame_.shown()->view;
  panel_.showHorizon(elevationDeg, frame_.shown()->attitude.heading.value(),
                     (std::atan(view.right) - std::atan(view.left)) * kDegreesPerRadian);
}

void CullingController::showDepthMap(const QImage& grey) {
  if (grey.isNull()) return panel_.showMap({}, {});
  const auto& last = at_.viewport.lastResult();
  const bool horizon = last && last->horizon && !last->depthMap;
  const QString size = tr("%1 × %2 px").arg(grey.width()).arg(grey.height());
  const QString caption =
      isWhiteAllOver(grey) ? tr("%1: nothing in this view is covered").arg(size)
      : horizon ? tr("No depth map: the horizon serves. What it covers of the view, %1, is grey").arg(size)
                : tr("Depth map %1: black is at %2 m, white at %3 km")
                      .arg(size)
                      .arg(scene::DistanceImage::kNearestM)
                      .arg(scene::DistanceImage::kFarthestM / 1000);
  panel_.showMap(grey, caption);
}

void CullingController::forgetPicked() {
  outline(std::nullopt);
  panel_.showPicked(std::nullopt);
}

void CullingController::outline(const std::optional<Box>& box) {
  picked_ = box;
  frame_.setOutline(box);
}

void CullingController::showPicked(std::uint32_t node, std::uint32_t object) {
  panel_.endPicking();
  outline(std::nullopt);
  const auto& last = at_.viewport.lastResult();
  if (!terrain_.database() || !last || !frame_.shown()) return panel_.showPicked(std::nullopt);
  const bool ofObject = object != scene::Renderer::kNoNode;
  const auto found = ofObject ? scene::describeObject(object, *terrain_.database(), *frame_.shown())
                              : scene::describeNode(node, *terrain_.database(), *frame_.shown(), *last);
  if (!found) return panel_.showPicked(std::nullopt);
  outline(found->bounds);
  panel_.showPicked(views::PickedNode{.form = views::fromView(found->form),
                                      .model = QString::fromStdString(found->model),
                                      .number = ofObject ? object : node,
                                      .level = found->level,
                                      .triangles = found->triangles,
                                      .errorM = found->errorM,
                                      .distanceM = found->distanceM,
                                      .errorPx = found->errorPx,
                                      .widthPx = found->widthPx,
                                      .heightPx = found->heightPx,
                                      .reason = views::fromView(scene::inWords(found->reason))});
}

}  // namespace trimtab::workbench
