// SPDX-License-Identifier: GPL-3.0-or-later
#include <QDockWidget>
#include <algorithm>
#include <array>
#include <cmath>

#include "main_window.h"
#include "trimtab/culling/box_distance.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/static_lod/static_lod.h"
#include "views/editors/bands_editor.h"
#include "views/panels/culling_panel.h"

// The Culling dock: what the methods see, and what a picked node is.
namespace trimtab::workbench {
namespace {

QString reasonText(CullReason reason) {
  switch (reason) {
    case CullReason::drawn:
      return MainWindow::tr("drawn");
    case CullReason::outside_frustum:
      return MainWindow::tr("outside the frustum");
    case CullReason::occluded:
      return MainWindow::tr("hidden by the ground before it");
    case CullReason::beyond_visibility:
      return MainWindow::tr("beyond visibility");
    case CullReason::back_facing:
      return MainWindow::tr("all of it faces away");
    default:
      return MainWindow::tr("another level stands for it");
  }
}

/// Pixels that a box spans, cut off at the picture's edges; corners behind the eye reach over them.
QSizeF spanOf(const Box& box, const EyePose& eye, const ViewShape& view) {
  double left = 1e9, right = -1e9, low = 1e9, high = -1e9;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 place{corner & 1 ? box.maxX : box.minX, corner & 2 ? box.maxY : box.minY,
                     corner & 4 ? box.maxZ : box.minZ};
    const Vec3 seen = eye.axes * (place - eye.position);
    const double depth = -seen.z;
    const bool behind = !(depth > view.nearM);
    left = std::min(left, behind ? view.left : seen.x / depth);
    right = std::max(right, behind ? view.right : seen.x / depth);
    low = std::min(low, behind ? view.bottom : seen.y / depth);
    high = std::max(high, behind ? view.top : seen.y / depth);
  }
  const double width = std::min(right, view.right) - std::max(left, view.left),
               height = std::min(high, view.top) - std::max(low, view.bottom);
  return {std::max(0.0, width) * view.widthPx / (view.right - view.left),
          std::max(0.0, height) * view.heightPx / (view.top - view.bottom)};
}

/// White all over.
bool coversNothing(const QImage& grey) {
  for (int y = 0; y < grey.height(); ++y) {
    const uchar* const row = grey.constScanLine(y);
    if (std::any_of(row, row + grey.width(), [](uchar pixel) { return pixel != 255; })) return false;
  }
  return true;
}

}  // namespace

views::CullingPanel* MainWindow::makeCullingPanel() {
  auto* panel = new views::CullingPanel(draft_);
  connect(panel, &views::CullingPanel::pickingChanged, viewport_, &Viewport::setPicking);
  connect(viewport_, &Viewport::nodePicked, this, &MainWindow::showPicked);
  return panel;
}

/// The picture of what a method saw is read while a dock shows it.
void MainWindow::connectCulling() {
  connect(viewport_, &Viewport::depthMapRead, this, &MainWindow::showDepthMap);
  connect(viewport_, &Viewport::horizonRead, this, [this](const std::vector<float>& elevationDeg) {
    if (!shown_) return;
    const ViewShape& view = shown_->view;
    constexpr double kDegrees = 57.29577951308232;
    culling_->showHorizon(elevationDeg, shown_->attitude.heading.value(),
                          (std::atan(view.right) - std::atan(view.left)) * kDegrees);
  });
  for (const QString& name : {QStringLiteral("depth_map"), QStringLiteral("culling")}) {
    QDockWidget* const widget = dock(name);
    connect(widget, &QDockWidget::visibilityChanged, viewport_,
            [this, widget](bool visible) { viewport_->setDepthMapWanted(widget, visible); });
  }
}

void MainWindow::showDepthMap(const QImage& grey) {
  if (grey.isNull()) {
    bands_->clearDepthMap();
    return culling_->showMap({}, tr("Neither a depth map nor a horizon served in this frame."));
  }
  const auto& last = viewport_->lastResult();
  const bool horizon = last && last->horizon && !last->depthMap;
  const QString size = tr("%1 × %2 px").arg(grey.width()).arg(grey.height());
  const QString caption = coversNothing(grey) ? tr("%1: nothing of this view is covered").arg(size)
                          : horizon
                              ? tr("The view as the horizon covers it, %1: grey is proven covered").arg(size)
                              : tr("Depth map %1; black %2 m, white %3 km")
                                    .arg(size)
                                    .arg(scene::DistanceImage::kNearestM)
                                    .arg(scene::DistanceImage::kFarthestM / 1000);
  bands_->showDepthMap(grey, caption);
  culling_->showMap(grey, caption);
}

void MainWindow::showPicked(std::uint32_t node) {
  culling_->endPicking();
  const auto& last = viewport_->lastResult();
  if (node == scene::Renderer::kNoNode || !terrain_ || !last || !shown_)
    return culling_->showPicked(std::nullopt);
  views::PickedNode picked;
  picked.number = node;
  Box box;
  if (last->staticLod.drawn) {
    const StaticLodIndex& index = terrain_->staticLod()->index;
    if (node >= index.size()) return culling_->showPicked(std::nullopt);
    picked.form = tr("tree node");
    picked.level = index.nodes[node].depth;
    picked.triangles = index.nodes[node].triangles;
    picked.errorM = index.maxErrorM[node];
    box = index.bounds[node];
  } else if (last->patches) {
    const PatchIndex& index = terrain_->patches()->index();
    if (node >= index.size()) return culling_->showPicked(std::nullopt);
    const auto drawn = std::find_if(last->visible.tiles.begin(), last->visible.tiles.end(),
                                    [node](const TileDraw& d) { return d.node == node; });
    const std::size_t variant = drawn == last->visible.tiles.end() ? 0 : drawn->variant.number;
    picked.form = tr("patch");
    picked.level = index.depth[node];
    picked.triangles = index.triangles[node][variant];
    picked.errorM = index.errorM[node][variant];
    box = index.bounds[node];
  } else {
    const TerrainIndex& index = terrain_->index();
    if (node >= index.size()) return culling_->showPicked(std::nullopt);
    picked.form = tr("tile");
    picked.level = index.level[node];
    picked.triangles = 2 * TerrainIndex::kTileCells * TerrainIndex::kTileCells;
    picked.errorM = index.errorM[node];
    box = index.bounds[node];
  }
  const LocalFrame& frame = terrain_->index().frame;
  const EyePose eye{frame.fromGeodetic(shown_->eye), eyeAxes(frame, shown_->eye, shown_->attitude)};
  const ViewShape& view = shown_->view;
  const double perRadian =
      std::max(view.widthPx / (view.right - view.left), view.heightPx / (view.top - view.bottom));
  picked.distanceM = std::sqrt(distanceSquared(box, eye.position));
  picked.errorPx = picked.errorM / std::max(picked.distanceM, view.nearM) * perRadian;
  const QSizeF span = spanOf(box, eye, view);
  picked.widthPx = span.width();
  picked.heightPx = span.height();
  picked.reason = reasonText(last->visible.reasonOf(node));
  culling_->showPicked(picked);
}

}  // namespace trimtab::workbench
