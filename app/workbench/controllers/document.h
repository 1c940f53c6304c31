// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QFileSystemWatcher>
#include <QObject>
#include <QString>
#include <QTimer>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab::views {
class Draft;
}

namespace trimtab::workbench {

/// The preset file behind the draft. It opens, saves and watches the file, and keeps a copy of unsaved edits
/// in case the program crashes.
class Document : public QObject {
  Q_OBJECT

 public:
  explicit Document(views::Draft& draft, QObject* parent = nullptr);
  ~Document() override;

  /// The preset's file; empty if it was never saved.
  const QString& file() const { return file_; }
  /// The file's name, or the preset's name if there is no file: for the title bar.
  QString title() const;

  /// Opens a shipped preset or a file. Failure changes nothing. Success can carry findings too: warnings, and
  /// broken rules, which the draft shows.
  Result<Done> open(const QString& nameOrFile);
  void startFrom(const QString& shipped);
  /// Opens what edits were made on, a file or a shipped preset, and makes them one step that can be undone,
  /// so that they count as changed against it. `text` is the edited preset, as presetText() writes it;
  /// findings call it `where`. If nothing can be opened, the edits begin a new preset on the one that the
  /// text names.
  Result<Done> openEdits(const QString& nameOrFile, const QString& text, const QString& where,
                         const QString& step);
  /// Returns the preset as `openEdits` takes it: all that differs from the shipped preset that it began as,
  /// or from the defaults, so that it does not depend on a file of its own.
  Result<std::string> editsText() const;
  Result<Done> save(const QString& file);
  Result<Done> reload() { return open(file_); }

  struct Recovered {
    QString copy;  ///< the file that holds the edits
    QString file;  ///< the preset's own file; empty if it had none
    QString savedAt;
    QString text;
  };
  /// Returns the edits that were left behind by programs which no longer run.
  static std::vector<Recovered> abandoned();
  Result<Done> recover(const Recovered& recovered);
  static void discard(const Recovered& recovered);
  /// Writes the copy at once instead of some seconds after an edit.
  void keepCopyNow();
  /// Removes the copy, because the person discarded the edits.
  void dropCopy();

 signals:
  void fileChanged();  ///< file() or title() has changed
  void changedOnDisk(bool gone);

 private:
  void become(const QString& file, std::string bytes);
  void checkDisk();
  void compareWithDisk(bool gone, std::string now);

  views::Draft& draft_;
  QString file_;
  std::string bytes_;              ///< the file's content as it was last read or written
  std::uint64_t becameTimes_ = 0;  ///< how often a file was opened or saved
  QFileSystemWatcher watcher_;
  QTimer copySoon_, lookSoon_;
  int lock_ = -1;      ///< a file lock, held from the first copy on; -1: none
  std::jthread disk_;  ///< reads the file that changed: no window waits for a disk; the last member, so that
                       ///< it ends first
};

}  // namespace trimtab::workbench
