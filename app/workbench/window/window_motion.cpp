// SPDX-License-Identifier: GPL-3.0-or-later
#include <QFileDialog>
#include <QFileInfo>

#include "main_window.h"
#include "views/panels/motion_panel.h"

// The line of sight: where the Head motion dock takes it from.
namespace trimtab::workbench {

void MainWindow::connectMotion() {
  using Panel = views::MotionPanel;
  connect(motion_, &Panel::openLogAsked, this, &MainWindow::askOpenHead);
  connect(motion_, &Panel::sourceAsked, this, [this](int source) {
    switch (source) {
      case Panel::sweep:
        openHead(motion_->sweepText());
        return;
      case Panel::pointer:
        feed_.useHead(Feed::Head::pointer);
        return;
      case Panel::none:
        feed_.useHead(Feed::Head::none);
        return;
      default:
        feed_.useHead(Feed::Head::host);
    }
  });
  connect(viewport_, &Viewport::pointed, this, [this](QPointF place) { feed_.point(place.x(), place.y()); });
  connect(&feed_, &Feed::headChanged, this, &MainWindow::showHeadSource);
}

void MainWindow::showHeadSource() {
  using Panel = views::MotionPanel;
  const HeadInput& head = feed_.session().head();
  viewport_->setPointerWanted(head.source() == Feed::Head::pointer);
  switch (head.source()) {
    case Feed::Head::host:
      return motion_->setSource(Panel::host, {});
    case Feed::Head::pointer:
      return motion_->setSource(Panel::pointer, {});
    case Feed::Head::none:
      return motion_->setSource(Panel::none, {});
    case Feed::Head::log:
      break;
  }
  const QString name = QString::fromStdString(head.log().name);
  if (isSweep(head.log().name)) return motion_->setSource(Panel::sweep, name);
  motion_->setSource(Panel::log, tr("%1: %L2 samples, %3 s")
                                     .arg(name)
                                     .arg(head.log().samples.size())
                                     .arg(head.log().durationS(), 0, 'f', 1));
}

bool MainWindow::openHead(const QString& fileOrSweep) {
  Result<HeadLog> head = trimtab::openHead(fileOrSweep.toStdString());
  if (!head) {
    messages_->add(tr("The line of sight is as it was: %1").arg(fileOrSweep), head.findings());
    showHeadSource();
    return false;
  }
  if (!head.findings().empty())
    messages_->add(tr("Head log %1").arg(QFileInfo(fileOrSweep).fileName()), head.findings());
  feed_.useHeadLog(std::move(head).value());
  return true;
}

void MainWindow::askOpenHead() {
  const QString file = QFileDialog::getOpenFileName(this, tr("Open head log"), {},
                                                    tr("Head logs (*.csv *.txt);;All files (*)"));
  if (file.isEmpty())
    showHeadSource();
  else
    openHead(file);
}

}  // namespace trimtab::workbench
