// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QFrame>
#include <functional>
#include <utility>
#include <vector>

class QLabel;
class QHBoxLayout;
class QPushButton;

namespace trimtab::workbench {

/// Asks a question without stopping the work: whether to recover edits, or to reload a file that changed on
/// disk. It lies over the top of its parent, the viewport's place, so that it moves nothing. It shows one
/// question at a time; further ones wait.
class NoticeBar : public QFrame {
  Q_OBJECT

 public:
  struct Answer {
    QString text;
    std::function<void()> act;
  };

  explicit NoticeBar(QWidget* parent);
  /// Asks a question. `id` names it: asking again under the same name replaces it. Any answer closes it.
  void ask(const QString& id, const QString& text, std::vector<Answer> answers);
  void withdraw(const QString& id);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  struct Question {
    QString id, text;
    std::vector<Answer> answers;
  };
  void showFirst();
  void place();

  std::vector<Question> questions_;
  QLabel* label_;
  QHBoxLayout* buttons_;
};

}  // namespace trimtab::workbench
