// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTabWidget>

#include "views/model/draft.h"
#include "views/model/live.h"

namespace trimtab::views {

class MembershipEditor;
class SurfacePlot;

/// Shows the scheme of documents A and B in tabs. `draft` must outlive it.
class SchemePage : public QTabWidget {
  Q_OBJECT
 public:
  explicit SchemePage(Draft& draft, QWidget* parent = nullptr);
  MembershipEditor& memberships() { return *memberships_; }
  SurfacePlot& surface() { return *surface_; }
  void showFrame(const LiveFrame& frame);
  void showMemberships();
  void showSurface();

 private:
  MembershipEditor* memberships_;
  SurfacePlot* surface_;
};

}  // namespace trimtab::views
