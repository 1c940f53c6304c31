// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>
#include <optional>

#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"

class QCheckBox;
class QDoubleSpinBox;
class QFormLayout;
class QLabel;
class QLineEdit;
class QListWidget;
class QPushButton;
class QSpinBox;

namespace trimtab::workbench {

/// Asks what to bake into a terrain database, and into which folder.
class BakeDialog : public QDialog {
  Q_OBJECT

 public:
  explicit BakeDialog(QWidget* parent = nullptr);

  /// Adds files and folders to the list of sources.
  void addSources(const QStringList& paths);
  /// Returns what the person asked for. The caller sets how progress is reported.
  terrain::BakeOptions options() const;

 private:
  void addFiles();
  void addFolder();
  void removeChosen();
  QWidget* makeImagery();
  QWidget* makeSceneryModels();
  void makeReading();
  void check();
  /// Shows the rows about what stands on the ground where a source brings such.
  void showObjects();

  QFormLayout* form_;
  QWidget* modelsRow_;
  QListWidget* sources_;
  QLineEdit *imagery_, *heightUnit_, *sceneryModels_, *output_;
  QCheckBox *ignoreChecksums_, *ownObjects_, *ownError_;
  QDoubleSpinBox* error_;
  QSpinBox* memory_;
  QLabel* note_;
  QPushButton* bake_;
};

}  // namespace trimtab::workbench
