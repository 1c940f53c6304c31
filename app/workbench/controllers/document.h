// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QFileSystemWatcher>
#include <QObject>
#include <QString>
#include <QTimer>
#include <string>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab::views {
class Draft;
}

namespace trimtab::workbench {

/// The preset file behind the draft: open, save, watch, and keep a copy of unsaved edits in case the program
/// dies.
class Document : public QObject {
  Q_OBJECT

 public:
  explicit Document(views::Draft& draft, QObject* parent = nullptr);
  ~Document() override;

  /// Empty while it was never saved.
  const QString& file() const { return file_; }
  /// File name or preset name, for the title bar.
  QString title() const;

  /// A file that cannot be read leaves everything as it was. Findings come with success, too: warnings, and
  /// broken rules, which the draft shows.
  Result<Done> open(const QString& nameOrFile);
  void startFrom(const QString& shipped);
  Result<Done> save(const QString& file);
  Result<Done> reload() { return open(file_); }

  struct Recovered {
    QString copy;  ///< the file the edits are kept in
    QString file;  ///< of the preset; empty where it had none
    QString savedAt;
    QString text;
  };
  /// Edits that programs left which are no longer running.
  static std::vector<Recovered> abandoned();
  Result<Done> recover(const Recovered& recovered);
  static void discard(const Recovered& recovered);
  /// Writes the copy at once instead of some seconds after an edit.
  void keepCopyNow();
  /// The draft was given up on purpose.
  void dropCopy();

 signals:
  void fileChanged();  ///< file() or title() is another
  void changedOnDisk(bool gone);

 private:
  void become(const QString& file);
  void checkDisk();

  views::Draft& draft_;
  QString file_;
  std::string bytes_;  ///< as last read or written
  QFileSystemWatcher watcher_;
  QTimer copySoon_, lookSoon_;
  int lock_ = -1;  ///< held from the first copy on
};

}  // namespace trimtab::workbench
