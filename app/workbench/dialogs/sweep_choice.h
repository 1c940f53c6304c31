// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QStringList>
#include <QWidget>
#include <array>
#include <optional>

class QComboBox;
class QLineEdit;

namespace trimtab::workbench {

/// Asks for up to two parameters and the values at which presets are measured.
class SweepChoice : public QWidget {
  Q_OBJECT

 public:
  explicit SweepChoice(QWidget* parent = nullptr);

  /// Returns "KEY=A,B,..." for each parameter that is chosen.
  QStringList sweeps() const;
  /// Returns into how many presets one preset becomes; 1 without a sweep.
  int presets() const;
  /// Returns what is wrong with the parameters or their values; empty if nothing is.
  QString fault() const;
  /// Chooses a parameter as a person would; proposes values of its usual range unless some are given.
  void choose(std::size_t axis, const QString& key, const QString& values = {});

 signals:
  void changed();

 private:
  struct Axis {
    QComboBox* key;
    QLineEdit* values;
    QString proposedFor{};  ///< the key to which the values belong
  };
  static std::optional<QString> keyOf(const Axis& axis);
  QStringList valuesOf(const Axis& axis) const;
  void readKey(Axis& axis);
  void propose(const Axis& axis);

  std::array<Axis, 2> axes_;
};

}  // namespace trimtab::workbench
