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

/// A question above the viewport that does not stop the work: recovered edits, a file changed on disk. One at
/// a time; further ones wait.
class NoticeBar : public QFrame {
  Q_OBJECT

 public:
  struct Answer {
    QString text;
    std::function<void()> act;
  };

  explicit NoticeBar(QWidget* parent = nullptr);
  /// `id` names the question: asking it again replaces it. The bar goes away with any answer.
  void ask(const QString& id, const QString& text, std::vector<Answer> answers);
  void withdraw(const QString& id);

 private:
  struct Question {
    QString id, text;
    std::vector<Answer> answers;
  };
  void showFirst();

  std::vector<Question> questions_;
  QLabel* label_;
  QHBoxLayout* buttons_;
};

}  // namespace trimtab::workbench
