// SPDX-License-Identifier: GPL-3.0-or-later
#include "job_bar.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <algorithm>

#include "app/workbench/jobs/terrain_job.h"

namespace trimtab::workbench {

JobBar::JobBar(TerrainJob& job, QWidget* parent)
    : QWidget(parent), what_(new QLabel), progress_(new QProgressBar) {
  progress_->setMaximumWidth(220);
  progress_->setRange(0, 100);
  auto* cancel = new QPushButton(tr("Cancel"));
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  for (QWidget* part :
       {static_cast<QWidget*>(what_), static_cast<QWidget*>(progress_), static_cast<QWidget*>(cancel)})
    layout->addWidget(part);
  hide();
  connect(cancel, &QPushButton::clicked, &job, &TerrainJob::cancel);
  connect(&job, &TerrainJob::started, this, [this](const QString& what) {
    say(what);
    progress_->setValue(0);
    show();
  });
  connect(&job, &TerrainJob::progressed, this, [this](double fraction, const QString& what) {
    progress_->setValue(static_cast<int>(fraction * 100));
    if (!what.isEmpty()) say(what);
  });
  connect(&job, &TerrainJob::cancelled, this, &JobBar::end);
  connect(&job, &TerrainJob::failed, this, &JobBar::end);
  connect(&job, &TerrainJob::opened, this, &JobBar::end);
}

/// The label only grows while a job runs: a status bar lays out late, and would cut a longer text meanwhile.
void JobBar::say(const QString& what) {
  what_->setText(what);
  what_->setMinimumWidth(std::max(what_->minimumWidth(), what_->sizeHint().width()));
}

void JobBar::end() {
  hide();
  what_->setMinimumWidth(0);
}

}  // namespace trimtab::workbench
