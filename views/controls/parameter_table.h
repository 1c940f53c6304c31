// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <array>
#include <vector>

#include "search_field.h"
#include "views/model/draft.h"

class QComboBox;
class QCheckBox;
class QGridLayout;
class QLabel;
class QPushButton;
class QToolButton;

namespace trimtab::views {

class ParameterLine;

/// The Preset dock: every parameter with its editor, made from the table alone.
class ParameterTable : public QWidget {
  Q_OBJECT
 public:
  explicit ParameterTable(Draft& draft, QWidget* parent = nullptr);

  QLineEdit& search() { return *search_; }
  QComboBox& tier() { return *tier_; }
  QCheckBox& changedOnly() { return *changedOnly_; }
  /// Chooses what the marks, the filter "Changed" and "Reset all" compare with.
  QComboBox& comparedWith() { return *comparedWith_; }
  QString summary() const;
  /// Returns the line of a key; null if there is none.
  ParameterLine* line(std::string_view key) const;
  std::vector<std::string_view> visibleKeys() const;

 signals:
  void editorAsked(const QString& key);  ///< the person wants the editor of a curve, bands or rules

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  struct Group {
    QString name;
    QToolButton* header = nullptr;
    std::array<QLabel*, 3> columns{};  ///< the titles of the values that a line can go back to
    std::vector<ParameterLine*> lines;
  };
  void makeBar();
  void makeHeader(QGridLayout& grid, int gridRow, const QString& name);
  void fillReferences();
  Reference reference() const;
  void fitColumns();
  void showColumns();
  void makeLines(QGridLayout& grid);
  void filter();
  void summarise();

  Draft& draft_;
  SearchField* search_;
  QComboBox *tier_, *comparedWith_;
  QCheckBox* changedOnly_;
  QPushButton* resetAll_;
  QLabel *summary_, *nothing_;
  std::vector<Group> groups_;
  bool compact_ = false;
};

}  // namespace trimtab::views
