// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <optional>

class QLineEdit;

namespace trimtab::views {

/// How numbers of a file become a quantity, in two lines: "× 3.28084 + 10". Numbers are typed in the person's
/// locale or in that of C, as 0.0000001 or 1e-7; what is none is shown in the colour of errors.
class ConversionEdit : public QWidget {
  Q_OBJECT
 public:
  /// `name` is that of the quantity, for screen readers.
  explicit ConversionEdit(const QString& name, QWidget* parent = nullptr);

  /// Shows these numbers, without emitting a signal.
  void set(double scale, double offset);
  /// Returns nothing if the text is no finite number, or if the scale is 0.
  std::optional<double> scale() const;
  std::optional<double> offset() const;

 signals:
  /// The person has typed in one of the lines.
  void edited();

 private:
  void show();

  QLineEdit *scale_, *offset_;
};

}  // namespace trimtab::views
