// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QListWidget>
#include <string>

namespace trimtab::views {

/// Lists the reasons of changes with their times, the newest last; the oldest are dropped beyond a limit. The
/// newest line stays in sight unless the person has scrolled up.
class ReasonList : public QListWidget {
  Q_OBJECT
 public:
  explicit ReasonList(QWidget* parent = nullptr);
  void add(double timeS, const std::string& reason);
};

}  // namespace trimtab::views
