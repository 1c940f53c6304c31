// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QImage>
#include <QWidget>
#include <optional>
#include <vector>

#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

class QAction;
class QHBoxLayout;
class QVBoxLayout;
class QLabel;
class QPushButton;

namespace trimtab::views {

class BarList;
class DepthMapInset;
class HorizonInset;
class TimePlot;
class TraceBuffer;

/// A node that was picked in the picture.
struct PickedNode {
  QString form;  ///< "patch", "tile", "tree node"
  std::uint32_t number = 0;
  int level = 0;
  std::uint64_t triangles = 0;
  double errorM = 0, distanceM = 0,
         errorPx = 0;                ///< stated error, nearest point of its box, error seen there
  double widthPx = 0, heightPx = 0;  ///< of its box in the picture
  QString reason;
};

/// The Culling dock: which case and method work, how much each reason leaves out, what the method sees, and
/// what a picked node is.
class CullingPanel : public QWidget {
  Q_OBJECT
 public:
  explicit CullingPanel(Draft& draft, QWidget* parent = nullptr);

  /// What a frame's stages take, from a recording of frames that outlives this.
  void showStages(const TraceBuffer& frames);
  /// The menus' overlays as buttons.
  void setActions(const QList<QAction*>& overlays);
  void showFrame(const LiveFrame& frame);
  /// What the method in use saw: null with the reason in `caption`.
  void showMap(const QImage& image, const QString& caption);
  /// As HorizonInset::setProfile; empty: there is none.
  void showHorizon(std::vector<float> elevationDeg, double headingDeg, double fovDeg);
  /// None: the sky was picked, or nothing is.
  void showPicked(std::optional<PickedNode> node);
  bool picking() const;
  void endPicking();

 signals:
  void pickingChanged(bool on);

 private:
  void refresh();
  QString served() const;
  QString whyNoHorizon() const;

  Draft& draft_;
  QLabel *served_, *work_, *picked_;
  BarList* reasons_;
  DepthMapInset* map_;
  HorizonInset* horizon_;
  TimePlot* stages_ = nullptr;
  QVBoxLayout* layout_;
  QHBoxLayout* overlayRow_;
  QPushButton* pick_;
  LiveFrame frame_;
  bool hasHorizon_ = false;
  Throttle throttle_;
};

}  // namespace trimtab::views
