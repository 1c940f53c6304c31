// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>
#include <QString>
#include <functional>
#include <vector>

namespace trimtab::workbench {

/// What a person can begin with. Each way is a button; taking one closes the page.
class Welcome : public QDialog {
  Q_OBJECT

 public:
  struct Way {
    QString text, detail;  ///< what it does, and with what
    std::function<void()> take;
  };
  struct Group {
    QString title;
    std::vector<Way> ways;
  };
  explicit Welcome(const std::vector<Group>& groups, QWidget* parent = nullptr);

  /// Whether a start of the program without anything to open shows the page; kept in the user's settings.
  static bool shownAtStart();
};

}  // namespace trimtab::workbench
