// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>
#include <map>

namespace trimtab::workbench {

/// Knows who measures times now. Meanwhile the live view draws nothing, because that would disturb them, and
/// says so.
class ViewPause : public QObject {
  Q_OBJECT

 public:
  /// `what` is measured, as in "presets are measured"; empty if whoever measures says it itself. A second
  /// call changes the text. It ends with `end`, or with the life of `who`.
  void begin(const QObject& who, const QString& what);
  void end(const QObject& who) { forget(&who); }
  /// Begins and ends as the signal `measuring` of `who` says.
  template <class Who>
  void follow(const Who& who, void (Who::*measuring)(bool), const QString& what) {
    connect(&who, measuring, this, [this, &who, what](bool on) {
      if (on)
        begin(who, what);
      else
        end(who);
    });
  }

  bool on() const { return !measuring_.empty(); }
  bool onBut(const QObject& who) const;
  /// Says for a person that the view is paused, and why. Empty if it is not, or if nobody wants it said.
  QString text() const;

 signals:
  void changed();

 private:
  void forget(const QObject* who);

  std::map<const QObject*, QString> measuring_;
};

}  // namespace trimtab::workbench
