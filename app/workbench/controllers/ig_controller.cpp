// SPDX-License-Identifier: GPL-3.0-or-later
#include "ig_controller.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QMenu>

#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/message_panel.h"
#include "document.h"
#include "trimtab/rig/limited_preset.h"
#include "views/model/draft.h"

namespace trimtab::workbench {

IgController::IgController(const Workplace& workplace, const Document& document)
    : at_(workplace), document_(document) {}

bool IgController::open(const QString& file) {
  const QString path = QFileInfo(file).absoluteFilePath();
  const Result<IgProfile> profile = loadIgProfile(path.toStdString());
  if (!profile) {
    at_.messages.add(tr("The profile cannot be opened: %1").arg(file), profile.findings());
    return false;
  }
  if (!profile.findings().empty()) at_.messages.add(tr("Opened %1").arg(file), profile.findings());
  at_.draft.setImageGenerator(std::make_shared<const IgProfile>(*profile), path);
  return true;
}

void IgController::askOpen() {
  const QString file =
      QFileDialog::getOpenFileName(&at_.window, tr("Image generator's profile"),
                                   at_.draft.imageGeneratorFile(), tr("Profiles (*.json);;All files (*)"));
  if (!file.isEmpty()) open(file);
}

void IgController::takeAway() {
  at_.draft.setImageGenerator(nullptr, {});
}

void IgController::fillMenu(QMenu& menu) {
  const auto add = [&](const QString& text, const QString& tip, auto run) {
    QAction* const action = menu.addAction(text, this, run);
    action->setToolTip(tip);
    return action;
  };
  add(tr("Image generator's &profile..."),
      tr("Opens a JSON file that says which levers an image generator has, and how it calls them"),
      [this] { askOpen(); });
  QAction* const none = add(tr("&None: this program's own image generator"),
                            tr("Takes the profile away; every lever is there again"), [this] { takeAway(); });
  menu.addSeparator();
  QAction* const limit =
      add(tr("&Limit preset to the image generator"),
          tr("Removes what the image generator cannot follow, as one step that Undo takes back"),
          [this] { limitPreset(); });
  add(tr("&Fit to this image generator..."),
      tr("Flies it with one lever moved at a time, and learns what each is worth there"),
      [this] { emit fitAsked(); });
  menu.setToolTipsVisible(true);
  const auto enable = [this, none, limit] {
    for (QAction* action : {none, limit}) action->setEnabled(at_.draft.imageGenerator() != nullptr);
  };
  connect(&at_.draft, &views::Draft::imageGeneratorChanged, this, enable);
  enable();
}

void IgController::limitPreset() {
  const IgProfile* const ig = at_.draft.imageGenerator();
  if (ig == nullptr)
    return at_.messages.note(
        tr("There is no image generator to limit the preset to: open its profile first"));
  const Result<TuningParameters> limited =
      limitedTo(*ig, at_.draft.parameters(), document_.title().toStdString());
  take(*limited, limited.findings(), tr("Limit to %1").arg(QString::fromStdString(ig->name)));
}

void IgController::take(const TuningParameters& values, const Findings& notes, const QString& undoText) {
  at_.draft.takeParameters(values, undoText);
  at_.messages.add(
      notes.empty() ? tr("%1: nothing had to change").arg(undoText) : tr("%1: what changed").arg(undoText),
      notes);
  raiseDock(at_.messages);
}

Result<ValidatedParameters> limitedActive(const views::Draft& draft, const std::string& name) {
  const IgProfile* const ig = draft.imageGenerator();
  if (ig == nullptr) return draft.active();
  const Result<TuningParameters> limited = limitedTo(*ig, *draft.active(), name);
  const Result<ValidatedParameters> valid = validate(*limited);
  if (!valid) return valid.findings();
  return {*valid, limited.findings()};
}

}  // namespace trimtab::workbench
