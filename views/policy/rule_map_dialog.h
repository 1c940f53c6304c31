// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>
#include <functional>
#include <vector>

#include "trimtab/policy/policy.h"
#include "trimtab/policy/rule_file.h"

class QCheckBox;
class QGridLayout;
class QLabel;
class QPlainTextEdit;
class QPushButton;

namespace trimtab::views {

class Chooser;
class ConversionEdit;

/// Asks which signal each input of a rule file is, and which lever each output, with a scale and an offset.
/// It shows how far a policy's surface would be from the file's, whether that is to be accepted, and what the
/// reader of rule files says of it.
class RuleMapDialog : public QDialog {
  Q_OBJECT

 public:
  using Import = std::function<void(const Policy& policy, const Findings& notes)>;

  /// `name` is the file's, for people.
  RuleMapDialog(RuleFile file, const QString& name, Import import, QWidget* parent = nullptr);

  /// Returns what the lines say, without those that say what the variable's name says.
  std::vector<RuleVariable> mapping() const;

 private:
  /// One variable of the file.
  struct Line {
    RuleFile::Variable variable;
    bool input;
    Chooser* key;
    ConversionEdit* conversion;
    QLabel* range;
  };
  void addLines(QGridLayout& grid, const std::vector<RuleFile::Variable>& variables, bool input);
  void showRange(const Line& line) const;
  void refresh();

  RuleFile file_;
  Import import_;
  std::vector<Line> lines_;
  QLabel *differences_, *result_;
  QCheckBox* accept_;
  QPlainTextEdit* findings_;
  QPushButton* ok_ = nullptr;
};

}  // namespace trimtab::views
