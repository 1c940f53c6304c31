// SPDX-License-Identifier: GPL-3.0-or-later
#include "head_controller.h"

#include <QFileDialog>
#include <QFileInfo>

#include "app/workbench/docks/message_panel.h"
#include "app/workbench/jobs/feed.h"
#include "app/workbench/viewport/viewport.h"
#include "views/panels/motion_panel.h"

namespace trimtab::workbench {

using Panel = views::MotionPanel;

HeadController::HeadController(const Workplace& workplace, Panel& panel) : at_(workplace), panel_(panel) {
  connect(&panel_, &Panel::openLogAsked, this, &HeadController::askOpen);
  connect(&panel_, &Panel::sourceAsked, this, &HeadController::use);
  connect(&at_.viewport, &Viewport::pointed, this,
          [this](QPointF place) { at_.feed.point(place.x(), place.y()); });
  connect(&at_.feed, &Feed::headChanged, this, &HeadController::showSource);
}

void HeadController::use(int source) {
  switch (source) {
    case Panel::sweep:
      open(panel_.sweepText());
      return;
    case Panel::pointer:
      return at_.feed.useHead(Feed::Head::pointer);
    case Panel::none:
      return at_.feed.useHead(Feed::Head::none);
    default:
      return at_.feed.useHead(Feed::Head::host);
  }
}

void HeadController::showSource() {
  const HeadInput& head = at_.feed.session().head();
  at_.viewport.setPointerWanted(head.source() == Feed::Head::pointer);
  switch (head.source()) {
    case Feed::Head::host:
      return panel_.setSource(Panel::host, {});
    case Feed::Head::pointer:
      return panel_.setSource(Panel::pointer, {});
    case Feed::Head::none:
      return panel_.setSource(Panel::none, {});
    case Feed::Head::log:
      break;
  }
  const QString name = QString::fromStdString(head.log().name);
  if (isSweep(head.log().name)) return panel_.setSource(Panel::sweep, name);
  panel_.setSource(Panel::log, tr("%1: %L2 samples, %3 s")
                                   .arg(name)
                                   .arg(head.log().samples.size())
                                   .arg(head.log().durationS(), 0, 'f', 1));
}

bool HeadController::open(const QString& fileOrSweep) {
  Result<HeadLog> head = openHead(fileOrSweep.toStdString());
  if (!head) {
    at_.messages.add(tr("The line of sight is unchanged: %1 cannot be used").arg(fileOrSweep),
                     head.findings());
    showSource();
    return false;
  }
  if (!head.findings().empty())
    at_.messages.add(tr("Head log %1").arg(QFileInfo(fileOrSweep).fileName()), head.findings());
  at_.feed.useHeadLog(std::move(head).value());
  return true;
}

void HeadController::askOpen() {
  const QString file = QFileDialog::getOpenFileName(&at_.window, tr("Open head log"), {},
                                                    tr("Head logs (*.csv *.txt);;All files (*)"));
  if (file.isEmpty())
    showSource();
  else
    open(file);
}

}  // namespace trimtab::workbench
