// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <string>
#include <vector>

#include "trimtab/host/column_map.h"
#include "trimtab/host/log_look.h"
#include "trimtab/units/result.h"

namespace trimtab::views {
class Chooser;
class ConversionEdit;
}  // namespace trimtab::views

namespace trimtab::workbench {

/// One line for each quantity of a log: the column that it is read from, its unit, a scale and an offset. A
/// line that nobody touches says nothing: the reader finds that quantity by itself.
class ColumnLines : public QWidget {
  Q_OBJECT

 public:
  ColumnLines(LogKind kind, const LogBeginning& log, QWidget* parent = nullptr);

  /// Shows this map and nothing else.
  void setMap(const ColumnMap& map);
  /// Puts what a map says into its lines and leaves the others as they are.
  void take(const ColumnMap& map);
  /// Returns what the lines say. Findings name those that are not complete.
  Result<ColumnMap> map() const;
  /// Reports whether the lines say what this map says.
  bool hold(const ColumnMap& map) const;
  /// Reports whether the quantities of a map are found in, or read from, the columns that it names.
  bool readFrom(const ColumnMap& map) const;
  /// Returns a map in the words that the dialog shows, such as "Time = t in ms".
  QString textOf(const ColumnMap& map) const;

 signals:
  /// The person, or take(), has changed a line.
  void changed();

 private:
  struct Line {
    const LogQuantity* quantity;
    QString found;  ///< the column that the reader finds by its name; empty: none
    std::size_t foundKey = 0;
    double foundScale = 1, foundOffset = 0;  ///< of a known program's column in another unit
    views::Chooser *column, *unit;
    views::ConversionEdit* conversion;
  };
  Line makeLine(const LogQuantity& quantity, const ColumnMap& found);
  /// Returns the line and the unit that a key belongs to; null and 0 if no line has it.
  std::pair<const Line*, std::size_t> lineOf(const std::string& key) const;
  ColumnSource sourceOf(const QString& column, double scale, double offset) const;
  static void chooseColumn(const Line& line, const QString& column);
  void setLine(const Line& line, const QString& column, std::size_t key, double scale, double offset);
  void leave(const Line& line);
  void touch(const Line& line);
  void chose(const Line& line);

  const std::vector<std::string>& header_;
  std::vector<Line> lines_;
  ColumnMap others_;  ///< what a map says of quantities that have no line
};

}  // namespace trimtab::workbench
