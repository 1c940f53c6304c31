// SPDX-License-Identifier: GPL-3.0-or-later
#include <QComboBox>
#include <QFileDialog>
#include <QFileInfo>

#include "split_view.h"
#include "trimtab/preset/preset.h"
#include "views/model/theme.h"

// Which presets the split view compares.
namespace trimtab::workbench {
namespace {

const QString kOpenFile = QStringLiteral("open…");

}  // namespace

QComboBox* SplitView::makeChoice(Side side, const QString& name) {
  auto* box = new QComboBox(this);
  box->addItem(tr("the draft"), kDraft);
  for (const std::string_view shipped : shippedPresets()) {
    const QString text = views::fromView(shipped);
    box->addItem(text, text);
  }
  box->addItem(tr("reference"), kReference);
  box->addItem(tr("Open a preset..."), kOpenFile);
  box->setCurrentIndex(box->findData(name));
  box->setAccessibleName(side == left ? tr("Preset on the left") : tr("Preset on the right"));
  box->setItemData(box->findData(kReference), tr("No culling, finest levels, no blur, no early far plane"),
                   Qt::ToolTipRole);
  connect(box, &QComboBox::activated, this, [this, side, box] {
    const QString chosen = box->currentData().toString();
    if (chosen == kOpenFile)
      askFile(side);
    else
      choose(side, chosen);
  });
  return box;
}

void SplitView::askFile(Side side) {
  const QString file = QFileDialog::getOpenFileName(this, tr("Open preset"), {}, tr("Presets (*.json)"));
  if (file.isEmpty() || !choose(side, file))
    choices_[side]->setCurrentIndex(choices_[side]->findData(sides_[side].name));
}

void SplitView::addFileChoice(const QString& file) {
  for (QComboBox* box : choices_)
    if (box->findData(file) < 0) box->insertItem(box->count() - 1, QFileInfo(file).completeBaseName(), file);
}

bool SplitView::choose(Side side, const QString& name) {
  Chosen& chosen = sides_[side];
  std::optional<ValidatedParameters> parameters;
  if (name == kDraft) {
    parameters = draft_.active();
  } else if (name != kReference) {
    const Result<Preset> preset = loadPreset(name.toStdString());
    Findings findings = preset.findings();
    if (preset) {
      Result<ValidatedParameters> valid = validate(preset->parameters);
      findings = valid.findings();
      if (valid) parameters = std::move(valid).value();
    }
    if (!parameters) {
      emit refused(tr("The preset cannot be compared: %1").arg(name), findings);
      return false;
    }
    if (choices_[side]->findData(name) < 0) addFileChoice(name);
  }
  // An edit of the draft leaves what is under way in use: shown late, but while the slider moves.
  if (name != kDraft || chosen.name != kDraft) ++generation_;
  chosen.name = name;
  chosen.parameters = parameters;
  choices_[side]->setCurrentIndex(choices_[side]->findData(name));
  chosen.label = choices_[side]->currentText();
  // Both begin anew, so that equal presets have equal memories.
  restart(left);
  restart(right);
  return true;
}

}  // namespace trimtab::workbench
