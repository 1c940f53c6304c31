// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "policy_draft.h"
#include "policy_live.h"
#include "views/model/throttle.h"
#include "views/plots/plot.h"

class QComboBox;

namespace trimtab {
struct IgProfile;
}

namespace trimtab::views {

/// A lever's target as a surface over two signals, with the flight's track on it. The other signals have
/// their live values, or the middle of what their terms cover while nobody knows them. It is left blank where
/// no rule fires.
class LeverSurface : public Plot {
  Q_OBJECT
 public:
  LeverSurface(PolicyDraft& policy, const PolicyTrack& track, QWidget* parent = nullptr);

  void choose(Lever lever, Signal x, Signal y);
  void showLive(const PolicyLive& live);
  /// Returns the target that is drawn at a place; NaN if no rule fires there.
  double targetAt(double x, double y) const;
  /// Returns how often the surface was computed.
  int computed() const { return computed_; }
  int trackPoints() const { return static_cast<int>(trackLine_->data()->size()); }

  QSize sizeHint() const override { return {420, 260}; }
  QSize minimumSizeHint() const override { return {240, 110}; }

 public slots:
  void fitView();

 protected:
  void mouseMoveEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void restyle() override;
  bool zoomByKey(double factor) override;

 private:
  void makePlottables();
  void compute();
  void drawLive();

  PolicyDraft& policy_;
  const PolicyTrack& track_;
  Lever lever_ = Lever::screen_space_error;
  Signal x_ = Signal::above_ground, y_ = Signal::speed;
  Policy drawn_;
  CompiledPolicy compiled_;
  SignalValues flight_, around_;  ///< live; and those that the surface was computed at
  QCPColorMap* map_ = nullptr;
  QCPColorScale* scale_ = nullptr;
  QCPCurve *trackHalo_ = nullptr, *trackLine_ = nullptr;
  QCPGraph* live_ = nullptr;
  QCPItemText *hover_ = nullptr, *empty_ = nullptr;
  std::uint64_t drawnTrack_ = 0;
  int computed_ = 0;
  bool fitted_ = true;  ///< the view follows the terms until a person moves it
  Throttle throttle_;
};

/// The surface below combo boxes for its lever and signals.
class SurfacePage : public QWidget {
  Q_OBJECT
 public:
  SurfacePage(PolicyDraft& policy, const PolicyTrack& track, QWidget* parent = nullptr);
  LeverSurface& surface() { return *surface_; }
  void showLive(const PolicyLive& live) { surface_->showLive(live); }

 private:
  void choose();
  void greyLevers(const IgProfile* ig);

  LeverSurface* surface_;
  QComboBox *lever_, *x_, *y_;
};

}  // namespace trimtab::views
