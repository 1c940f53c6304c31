// SPDX-License-Identifier: GPL-3.0-or-later
#include "status_strip.h"

#include <QHBoxLayout>
#include <QLabel>
#include <cmath>

#include "app/link/link.h"
#include "app/workbench/jobs/feed.h"
#include "trimtab/rig/ig_profile.h"
#include "views/model/draft.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

constexpr int kAgesMs = 500, kNameLetters = 16;

}  // namespace

StatusStrip::StatusStrip(const Feed& feed, const views::Draft& draft, QWidget* parent)
    : QWidget(parent), feed_(feed), draft_(draft) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(14);
  workspace_ = addPlace(tr("Workspace"), tr("Connect"), tr("Workspace; Ctrl+1 to Ctrl+5 show others"));
  budget_ = addPlace(tr("Frame time and budget"), tr("over: 8,888.8 of 88.8 ms"),
                     tr("Time of the last image, as the line at its foot has it, and the budget "
                        "(measure.budget_ms)"));
  recording_ = addPlace(tr("Recording"), tr("● trace"), tr("A trace is being recorded (Ctrl+R)"));
  views::setInk(*recording_, views::Ink::error);
  source_ = addPlace(tr("Who moves the aircraft"), tr("host on port 88888 is SILENT, 888.8 s ago"),
                     tr("Who moves the aircraft, and when a host was heard last"));
  ig_ = addPlace(tr("Image generator"), {}, {});
  connect(&draft_, &views::Draft::imageGeneratorChanged, this, &StatusStrip::showImageGenerator);
  showImageGenerator();
  source_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  ages_.setInterval(kAgesMs);
  connect(&ages_, &QTimer::timeout, this, &StatusStrip::showAge);
  connect(&feed_, &Feed::linkChanged, this, &StatusStrip::showAge);
}

QLabel* StatusStrip::addPlace(const QString& name, const QString& widest, const QString& toolTip) {
  auto* label = new QLabel(this);
  label->setAccessibleName(name);
  label->setToolTip(toolTip);
  label->setMinimumWidth(label->fontMetrics().horizontalAdvance(widest) + 4);
  layout()->addWidget(label);
  return label;
}

void StatusStrip::showFrame(const views::LiveFrame& frame) {
  if (!frame.newImage || !std::isfinite(frame.cost.total)) return;
  const double ms = draft_.active()->measure.budget.value();
  const bool over = frame.cost.total > ms;
  // Words say it too, not the colour alone.
  budget_->setText((over ? tr("over: %1 of %2 ms") : tr("%1 of %2 ms"))
                       .arg(views::numberText(frame.cost.total, 1), views::numberText(ms, 1)));
  views::setInk(*budget_, over ? views::Ink::error : views::Ink::plain);
}

/// It has no place while there is none, which is how most people work.
void StatusStrip::showImageGenerator() {
  const IgProfile* const ig = draft_.imageGenerator();
  ig_->setVisible(ig != nullptr);
  if (ig == nullptr) return;
  const QString name = QString::fromStdString(ig->name);
  const int width = ig_->fontMetrics().averageCharWidth() * kNameLetters;
  ig_->setText(tr("for %1").arg(ig_->fontMetrics().elidedText(name, Qt::ElideRight, width)));
  ig_->setToolTip(tr("The preset is tuned for the image generator %1: levers that it does not have are grey, "
                     "and exports are limited to it (File > Image generator)\n%2")
                      .arg(name, draft_.imageGeneratorFile()));
}

void StatusStrip::showWorkspace(const QString& name) {
  workspace_->setText(name);
}

void StatusStrip::showRecording(bool recording) {
  recording_->setText(recording ? tr("● trace") : QString());
}

void StatusStrip::showSource(const QString& text) {
  sourceText_ = text;
  showAge();
}

void StatusStrip::showAge() {
  const bool open = feed_.receiver() != nullptr;
  if (open && !ages_.isActive()) ages_.start();
  if (!open) ages_.stop();
  const double now = link::now(), age = open ? feed_.session().packetAge(now) : NAN;
  source_->setText(std::isfinite(age) ? tr("%1, %2 s ago").arg(sourceText_, views::numberText(age, 1))
                                      : sourceText_);
  const bool silent = open && feed_.session().linkState(now) == LinkState::silent;
  views::setInk(*source_, silent ? views::Ink::error : views::Ink::plain);
}

}  // namespace trimtab::workbench
