// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QByteArray>
#include <QObject>
#include <QSize>
#include <QString>
#include <QStringList>
#include <vector>

#include "trimtab/units/result.h"

class QMainWindow;

namespace trimtab::workbench {

class DockLayout;

/// Layouts of the docks with names, one for each job. The first ones ship and can be reset; a person adds
/// others. Each keeps how it was left, over restarts too.
class Workspaces : public QObject {
  Q_OBJECT

 public:
  Workspaces(QMainWindow& window, DockLayout& docks);

  static constexpr int kMeasure = 2;  ///< the one that ships for measuring

  QStringList names() const;
  int current() const { return current_; }
  bool ships(int index) const { return std::size_t(index) < shipped(); }
  /// Keeps how the docks stand for the workspace that is left, and shows another one.
  void show(int index);
  /// Shows the current workspace as it ships, or as it was saved.
  void reset();
  /// Makes a workspace of how the docks stand now, or replaces the own one of that name. A name that ships is
  /// refused.
  Findings saveAs(const QString& name);
  /// Removes an own workspace and shows the first one instead.
  void remove(int index);
  /// Writes how the docks stand now as a file for others (JSON).
  Findings writeTo(const QString& file) const;
  /// Adds a workspace from such a file and shows it. Changes nothing if the file is not one.
  Findings readFrom(const QString& file);

  /// Puts the docks as the last session left them. Call it once the window has its size.
  void begin();
  /// Keeps all of it for the next session.
  void keep();

 signals:
  void listChanged();
  void currentChanged(int index);

 private:
  struct Workspace {
    QString name;
    QByteArray saved;  ///< empty for those that ship
    QByteArray left;   ///< how the docks stood last; empty: as they ship, or as saved
    QSize leftAt;      ///< the window's size then
  };
  static std::size_t shipped();
  void leave();
  void apply(int index);
  /// Puts the docks as this or an earlier version of the program saved them. Returns false if it is no
  /// layout.
  bool restore(const QByteArray& state);
  QString keptName(std::size_t index) const;
  void add(const QString& name, const QByteArray& state);

  QMainWindow& window_;
  DockLayout& docks_;
  std::vector<Workspace> all_;
  int current_ = 1;
};

}  // namespace trimtab::workbench
