// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>

class QLineEdit;
class QPushButton;

namespace trimtab::workbench {

/// Asks where on the earth the coordinates of a flat OpenSceneGraph scene are 0. It proposes what a person
/// said of this file before.
class OriginDialog : public QDialog {
  Q_OBJECT

 public:
  OriginDialog(const QString& file, QWidget* parent);

 signals:
  /// The place was given, as "LAT,LON" in degrees.
  void given(const QString& origin);

 private:
  QString text() const;
  void check();

  QString file_;
  QLineEdit *latitude_, *longitude_;
  QPushButton* open_;
};

}  // namespace trimtab::workbench
