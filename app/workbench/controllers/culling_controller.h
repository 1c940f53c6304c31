// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QImage>
#include <QObject>
#include <cstdint>
#include <optional>
#include <vector>

#include "trimtab/frame/overlays.h"
#include "trimtab/frame/terrain_index.h"
#include "workplace.h"

class QDockWidget;

namespace trimtab::views {
class CullingPanel;
}  // namespace trimtab::views

namespace trimtab::workbench {

class FrameController;
class TerrainController;

/// Shows what culling does: overlays in the image, what the occlusion method saw, and what a
/// picked node is.
class CullingController : public QObject {
  Q_OBJECT

 public:
  CullingController(const Workplace& workplace, FrameController& frame, const TerrainController& terrain,
                    views::CullingPanel& panel);

  void setOverlay(bool Overlays::*flag, bool on);
  /// Static trees: draws one level by itself (-1: each node by its distance), and document E's picture.
  /// The numbers of a picked node are those of one frame. They say nothing about the frames after it.
  void forgetPicked();
  void setTreeOverlay(int depth, bool picture);

 private:
  void showDepthMap(const QImage& grey);
  void showHorizon(const std::vector<float>& elevationDeg);
  void showPicked(std::uint32_t node, std::uint32_t object);
  void outline(const std::optional<Box>& box);

  Workplace at_;
  FrameController& frame_;
  const TerrainController& terrain_;
  views::CullingPanel& panel_;
  std::optional<Box> picked_;
};

}  // namespace trimtab::workbench
