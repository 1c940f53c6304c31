// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QColor>
#include <QObject>
#include <QString>

#include "views/model/draft.h"

class QGridLayout;
class QLabel;
class QToolButton;
class QWidget;

namespace trimtab::views {

/// One row of a parameter panel: changed mark and label, editor for its kind, default, reset button and
/// findings.
class ParameterLine : public QObject {
  Q_OBJECT
 public:
  /// Fills two rows of the grid from `gridRow` on. Its widgets belong to the grid's widget.
  ParameterLine(Draft& draft, const ParameterRow& row, QGridLayout& grid, int gridRow);

  const ParameterRow& row() const { return row_; }
  QWidget* editor() const { return editor_; }
  QToolButton* resetButton() const { return reset_; }
  QString problem() const;
  bool matches(const QString& search) const;
  void setVisible(bool visible);
  /// In a compact line, for a narrow dock, only the tool tips show the default.
  void setCompact(bool compact);
  bool isVisible() const { return visible_; }
  void refresh();
  void clearRefusal() { refusal_.clear(); }

 signals:
  void editorAsked(const QString& key);  ///< the person wants the editor of a curve, bands or rules

 private:
  QWidget* makeEditor();
  void refuse(const QString& why);

  Draft& draft_;
  const ParameterRow& row_;
  QLabel *label_, *default_, *problem_;
  QWidget *editor_,
      *field_;  ///< the editor, and the widget in the grid that holds it and its slider or button
  QToolButton* reset_;
  QString refusal_;
  struct State {
    bool changed = false;
    QString baseline, problem;
    QColor colour;
    friend bool operator==(const State&, const State&) = default;
  };
  State shown_;
  bool visible_ = true, compact_ = false;
};

}  // namespace trimtab::views
