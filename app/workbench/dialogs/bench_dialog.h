// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>
#include <QStringList>
#include <array>

class QCheckBox;
class QLabel;
class QLineEdit;
class QListWidget;
class QPushButton;
class QSpinBox;

namespace trimtab::workbench {

class SweepChoice;

/// What `trimtab-cli bench` should measure.
struct BenchChoice {
  static const QString kDraft;  ///< the name that means the preset that is being edited

  QStringList presets{QStringLiteral("default"), kDraft};  ///< shipped names, files, or kDraft
  QStringList cases{QStringLiteral("view_frustum"), QStringLiteral("proposed")};
  QString size = QStringLiteral("1280x720");
  int frames = 60, repeats = 5;
  bool whole = false;  ///< draws every image of presets that decide by their own images
  QStringList sweeps;  ///< "KEY=A,B,...": each preset is measured at each of these values; at most two
  QString folder;      ///< for the results; a measurement that was stopped there is resumed

  /// Returns the command line that measures this over a terrain and along a flight, which are files, as is
  /// the draft.
  QStringList arguments(const QString& terrain, const QString& flight, const QString& draft) const;
};

/// Asks a person what to measure. It begins with what was measured last.
class BenchDialog : public QDialog {
  Q_OBJECT

 public:
  explicit BenchDialog(const QString& folder, QWidget* parent = nullptr);
  BenchChoice choice() const;
  void accept() override;
  SweepChoice& sweep() { return *sweep_; }

 private:
  void check();

  QListWidget* presets_;
  std::array<QCheckBox*, 3> cases_;
  QLineEdit *size_, *folder_;
  QSpinBox *frames_, *repeats_;
  QCheckBox* whole_;
  SweepChoice* sweep_;
  QLabel* amount_;
  QPushButton* measure_;
};

}  // namespace trimtab::workbench
