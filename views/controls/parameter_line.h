// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QColor>
#include <QObject>
#include <QString>
#include <array>

#include "views/model/draft.h"
#include "views/model/theme.h"

class QGridLayout;
class QLabel;
class QPoint;
class QToolButton;
class QWidget;

namespace trimtab::views {

class NoteBubble;

/// One row of a parameter panel: changed mark and label, editor for its kind, the values that it can go back
/// to, and findings. A click on one of these values goes back to it. What was refused is shown until the
/// parameter has another value.
class ParameterLine : public QObject {
  Q_OBJECT
 public:
  /// Fills one row of the grid. Its widgets belong to the grid's widget.
  ParameterLine(Draft& draft, const ParameterRow& row, QGridLayout& grid, int gridRow);

  const ParameterRow& row() const { return row_; }
  const QLabel& label() const { return *label_; }
  QWidget* editor() const { return editor_; }
  /// Goes back to what the line is compared with.
  QToolButton* resetButton() const { return reset_; }
  /// Shows the value of a reference and goes back to it: the file, the base or the defaults.
  QToolButton* valueButton(Reference of) const { return values_[static_cast<std::size_t>(of)]; }
  /// Chooses what the changed mark compares with and the reset button goes back to; at first the file.
  void compareWith(Reference reference);
  QString problem() const;
  void setVisible(bool visible);
  /// In a compact line, for a narrow dock, only tool tips and the context menu show these values.
  void setCompact(bool compact);
  bool isVisible() const { return visible_; }
  /// Reads the draft's value and findings again. Call it on Draft::findingsChanged.
  void refresh();

 signals:
  void editorAsked(const QString& key);  ///< the person wants the editor of a curve, bands or rules

 private:
  static constexpr std::size_t kValues = 3;  ///< file, base and defaults

  QWidget* makeEditor();
  void makeValues();
  void readValues();
  void showValues();
  void showLists(const std::array<bool, kValues>& differs);
  void showResets(const QPoint& at);
  void refuse(const QString& why);

  Draft& draft_;
  const ParameterRow& row_;
  QLabel* label_;
  NoteBubble* problem_;
  std::array<QToolButton*, kValues> values_{};
  QWidget *editor_,
      *field_;  ///< the editor, and the widget in the grid that holds it and its slider or button
  QToolButton* reset_;
  QString refusal_;
  struct State {
    bool changed = false;
    std::array<bool, kValues> differs{};
    QString problem;
    Ink ink = Ink::error;
    QColor mark;
    friend bool operator==(const State&, const State&) = default;
  };
  State shown_;
  Reference reference_ = Reference::file;
  bool visible_ = true, compact_ = false;
};

}  // namespace trimtab::views
