// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>
#include <QTimer>
#include <functional>
#include <vector>

#include "trimtab/host/column_map.h"
#include "trimtab/host/log_look.h"
#include "trimtab/units/result.h"

class QButtonGroup;
class QGroupBox;
class QLabel;
class QPlainTextEdit;
class QPushButton;
class QTableWidget;
class QVBoxLayout;

namespace trimtab::workbench {

class ColumnLines;

/// Asks which column of a log is which quantity. It shows the first rows, the readings between which the file
/// leaves the choice, a line for each quantity, and what the log would be with them, or why it is refused:
/// the reader that opens the log says so, with the map that the lines make.
class ColumnDialog : public QDialog {
  Q_OBJECT

 public:
  /// Opens the log with a map; an error among the findings means that it was not opened.
  using Open = std::function<Findings(const ColumnMap& map)>;

  /// `map` is what the lines say at first. Opening a log remembers the map by the log's header.
  ColumnDialog(LogKind kind, const QString& file, LogBeginning log, const ColumnMap& map, Open open,
               QWidget* parent = nullptr);

  /// Shows the dialog over the parent and returns at once. Returns why the file has no columns to choose, if
  /// so.
  static Findings ask(LogKind kind, const QString& file, const ColumnMap& map, Open open, QWidget& parent);

  /// Waits no longer for more edits before it says what the reading would be.
  void readNow();

 private:
  /// A choice that the file leaves, as one button for each of its readings.
  struct Choice {
    std::vector<ColumnMap> maps;
    QGroupBox* box;
    QButtonGroup* buttons;
  };
  QTableWidget* makeRows();
  QWidget* makeReading();
  void addChoices(const Findings& findings);
  void showChoices();
  void say(const QString& reading, const Findings& findings);
  void openLog();

  LogKind kind_;
  QString file_;
  LogBeginning log_;
  Open open_;
  ColumnLines* lines_;
  QVBoxLayout* choicesColumn_;
  std::vector<Choice> choices_;
  QLabel* reading_;
  QPlainTextEdit* findings_;
  QPushButton* ok_ = nullptr;
  QTimer soon_;
};

}  // namespace trimtab::workbench
