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

/// A node or an object that was picked in the image.
struct PickedNode {
  QString form;   ///< "patch", "tile", "tree node" or "object"
  QString model;  ///< of an object
  std::uint32_t number = 0;
  int level = 0;
  std::uint64_t triangles = 0;
  double errorM = 0, distanceM = 0,
         errorPx = 0;  ///< stated error, distance of the nearest point of its box, error in the image there
  double widthPx = 0, heightPx = 0;  ///< of its box in the image
  QString reason;
};

/// The Culling dock: the case and the method in use, how much each reason culls, what the method sees, and
/// what a picked node is.
class CullingPanel : public QWidget {
  Q_OBJECT
 public:
  explicit CullingPanel(Draft& draft, QWidget* parent = nullptr);

  /// Sets the recording of frames from which it shows the times of the stages. It must outlive this panel.
  void showStages(const TraceBuffer& frames);
  TimePlot* stages() const { return stages_; }  ///< null until showStages
  /// Shows the overlays of the menus as buttons.
  void setActions(const QList<QAction*>& overlays);
  void showFrame(const LiveFrame& frame);
  /// Shows what the method in use saw; if the image is null, `caption` says why.
  void showMap(const QImage& image, const QString& caption);
  /// Shows the horizon as HorizonInset::setProfile does; empty if there is none.
  void showHorizon(std::vector<float> elevationDeg, double headingDeg, double fovDeg);
  /// Shows the picked node; nothing if the sky was picked, or nothing.
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
  QLabel* objects_;  ///< hidden where nothing stands on the ground
  BarList* reasons_;
  DepthMapInset* map_;
  HorizonInset* horizon_;
  TimePlot* stages_ = nullptr;
  QVBoxLayout* layout_;
  QHBoxLayout* overlayRow_;
  QPushButton* pick_;
  LiveFrame frame_;
  bool hasHorizon_ = false, hasMap_ = false;
  Throttle throttle_;
};

}  // namespace trimtab::views
