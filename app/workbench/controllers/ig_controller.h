// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>
#include <string>

#include "trimtab/preset/preset.h"
#include "workplace.h"

class QMenu;

namespace trimtab::workbench {

class Document;

/// Opens the profile of the image generator for which the preset is tuned, and changes the preset to what
/// that image generator can do.
class IgController : public QObject {
  Q_OBJECT

 public:
  IgController(const Workplace& workplace, const Document& document);

  /// Returns false if the profile cannot be read; then the earlier one stays.
  bool open(const QString& file);
  void askOpen();
  void takeAway();
  /// Fills a menu with the commands of this class.
  void fillMenu(QMenu& menu);
  /// Applies limitedTo() as one step, and lists in the Messages dock what changed.
  void limitPreset();
  /// Applies values that were made for the image generator as one step; `notes` say what is different.
  void take(const TuningParameters& values, const Findings& notes, const QString& undoText);

 signals:
  void fitAsked();

 private:
  Workplace at_;
  const Document& document_;
};

/// Returns the parameters that run as the image generator of the draft can follow them, with notes of what it
/// cannot; as they are if there is none. `name` is the place in the notes.
Result<ValidatedParameters> limitedActive(const views::Draft& draft, const std::string& name);

}  // namespace trimtab::workbench
