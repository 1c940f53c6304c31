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

/// One row of the parameter panel: changed mark and label, editor by kind, default, reset, and what is wrong
/// with it.
class ParameterLine : public QObject {
  Q_OBJECT
 public:
  /// Fills two grid rows from `gridRow` on; its widgets belong to the grid's widget.
  ParameterLine(Draft& draft, const ParameterRow& row, QGridLayout& grid, int gridRow);

  const ParameterRow& row() const { return row_; }
  QWidget* editor() const { return editor_; }
  QToolButton* resetButton() const { return reset_; }
  QString problem() const;
  bool matches(const QString& search) const;
  void setVisible(bool visible);
  /// In a narrow dock the default is left to the tool tips.
  void setCompact(bool compact);
  bool isVisible() const { return visible_; }
  void refresh();
  void clearRefusal() { refusal_.clear(); }

 signals:
  void editorAsked(const QString& key);  ///< of a curve, bands or rules

 private:
  QWidget* makeEditor();
  void refuse(const QString& why);

  Draft& draft_;
  const ParameterRow& row_;
  QLabel *label_, *default_, *problem_;
  QWidget *editor_, *field_;  ///< the editor itself; what stands in the grid (editor and slider or button)
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
