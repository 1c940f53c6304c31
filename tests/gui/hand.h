// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QtWidgets>
#include <array>
#include <deque>
#include <functional>

#include "gui_support.h"

namespace trimtab::test {

/// Returns the text of a button, tab or menu as a person would say it.
inline QString plain(QString text) {
  return text.remove(QLatin1Char('&')).remove(QStringLiteral("...")).remove(QChar(0x2026));
}

/// Does what the hand of a person does. Each click, drag, typed text and chord of keys is one step. It
/// reaches only what a person could: it fails where a widget is hidden, scrolled away, covered, or behind a
/// dialog.
class Hand {
 public:
  explicit Hand(QWidget& window) : window_(window) {
    // A timer does not fire within its own slot; the second one notices a dialog over a dialog.
    for (QTimer& timer : timers_) {
      QObject::connect(&timer, &QTimer::timeout, &timer, [this] { answer(); });
      timer.start(20);
    }
  }
  /// Forgets the steps of the task before, and what a failed one left open.
  void begin() {
    steps_.clear();
    awaited_.clear();
    if (QWidget* const popup = QApplication::activePopupWidget()) popup->close();
  }
  const QStringList& steps() const { return steps_; }
  bool answered() const { return awaited_.empty() && current_ == nullptr; }
  /// Presses the button of the mouse, moves it in steps if it is to go anywhere, and lets it go.
  void drag(QWidget& on, QPoint from, QPoint to, const QString& what) {
    steps_ << what;
    if (!inReach(on, from)) return fail(what);
    QTest::mousePress(&on, Qt::LeftButton, {}, from);
    for (int i = 1; i <= 8 && from != to; ++i) QTest::mouseMove(&on, from + (to - from) * i / 8, kMoveMs);
    QTest::mouseRelease(&on, Qt::LeftButton, {}, to);
    QCoreApplication::processEvents();
  }
  /// Drags by the system's drag and drop, which keeps the program in it from the first moves to the drop.
  void carry(QWidget& on, QPoint from, QPoint to, const QString& what) {
    steps_ << what;
    if (!inReach(on, from)) return fail(what);
    for (int i = 2; i <= 10; ++i)
      QTimer::singleShot(40 * i, &on,
                         [&on, from, to, i] { QTest::mouseMove(&on, from + (to - from) * i / 10); });
    QTimer::singleShot(440, &on, [&on, to] { QTest::mouseRelease(&on, Qt::LeftButton, {}, to); });
    QTest::mousePress(&on, Qt::LeftButton, {}, from);
    QTest::mouseMove(&on, from + (to - from) / 10);
    QTest::qWait(600);
  }
  void click(QWidget& on, QPoint at, const QString& what) { drag(on, at, at, what); }
  /// Clicks the button, tab, list of choices (by its accessible name) or entry of the open menu.
  void press(QWidget& within, const QString& text) {
    QWidget* on = nullptr;
    QPoint place;
    const auto look = [&](QWidget& widget, const QString& says, QPoint at) {
      if (plain(says) != text || !inReach(widget, at)) return;
      on = &widget;
      place = at;
    };
    const auto found = [&] {
      for (auto* each : within.findChildren<QAbstractButton*>())
        look(*each, each->text(), each->rect().center());
      for (auto* each : within.findChildren<QComboBox*>())
        look(*each, each->accessibleName(), each->rect().center());
      for (auto* each : within.findChildren<QTabBar*>())
        for (int i = 0; i < each->count(); ++i) look(*each, each->tabText(i), each->tabRect(i).center());
      if (auto* const menu = qobject_cast<QMenu*>(QApplication::activePopupWidget()))
        for (QAction* each : menu->actions()) look(*menu, each->text(), menu->actionGeometry(each).center());
      return on != nullptr;
    };
    if (!waitFor(found)) return fail(text);
    click(*on, place, text);
  }
  /// Opens the menu of a button, which keeps the program in it, and clicks one of its entries.
  void pressInMenu(QWidget& within, const QString& button, const QString& entry) {
    QTimer::singleShot(50, &window_, [&] { press(within, entry); });
    press(within, button);
  }
  /// Opens a list of choices and clicks one.
  void choose(QWidget& within, const QString& name, const QString& text) {
    press(within, name);
    auto* const popup = QApplication::activePopupWidget();
    auto* const list = popup != nullptr ? popup->findChild<QAbstractItemView*>() : nullptr;
    if (list == nullptr) return fail(text);
    steps_ << text;
    const auto rows =
        list->model()->match(list->model()->index(0, 0), Qt::DisplayRole, text, 1, Qt::MatchExactly);
    const auto chosen = [&] {
      const QPoint at = list->visualRect(rows.value(0)).center();
      if (inReach(*list->viewport(), at)) QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, at);
      return !list->isVisible();
    };
    // A list takes no click so soon after the one that opened it as a program can give it.
    if (!waitFor(chosen)) fail(text);
  }
  void key(QKeyCombination keys) {
    steps_ << QKeySequence(keys).toString();
    if (!takesKeys()) return fail(steps_.last());
    QTest::keyClick(QGuiApplication::focusWindow(), keys.key(), keys.keyboardModifiers());
    QCoreApplication::processEvents();
  }
  void type(const QString& text) {
    steps_ << text;
    for (const QChar letter : text)
      if (takesKeys()) QTest::keyClick(QGuiApplication::focusWindow(), letter.toLatin1());
  }
  /// Does this in the next dialog, which a later step opens and waits for.
  void inDialog(std::function<void(QWidget&)> act) { awaited_.push_back(std::move(act)); }
  /// Lets dialogs of these object names stay open: they do not keep the program in them, and the steps after
  /// this one are done in them.
  void workIn(const QStringList& dialogs) { staying_ = dialogs; }
  /// Types the name of a file into the next dialog, and Enter.
  void inFileDialog(const std::filesystem::path& file) {
    inDialog([this, name = QString::fromStdString(file.string())](QWidget& dialog) {
      auto* const line = dialog.findChild<QLineEdit*>(QStringLiteral("fileNameEdit"));
      if (line == nullptr) return fail(dialog.windowTitle());
      steps_ << "name of a file";
      // Pasted at once: letters that are typed one by one open Qt's list of completions, which takes the
      // Return.
      line->setText(name);
      steps_ << "Return";
      QTest::keyClick(line, Qt::Key_Return);
    });
  }

 private:
  /// A mouse reports some 100 times a second; faster moves would turn the view faster than anybody can.
  static constexpr int kMoveMs = 10;
  static void fail(const QString& what) { ADD_FAILURE() << "out of reach: " << what.toStdString(); }
  static bool inReach(const QWidget& on, QPoint at) {
    const QWidget *modal = QApplication::activeModalWidget(), *popup = QApplication::activePopupWidget();
    if (popup != nullptr ? popup != on.window() : modal != nullptr && modal != on.window()) return false;
    const QWidget* const hit = on.window()->childAt(on.mapTo(on.window(), at));
    return on.isVisible() && (hit == &on || on.isAncestorOf(hit) || (hit == nullptr && on.isWindow()));
  }
  /// Gives the keys to the window in front, as a window manager does: under a test there is none.
  bool takesKeys() {
    QWidget* front = QApplication::activeModalWidget();
    if (front == nullptr) front = QApplication::activeWindow();
    if (front == nullptr || !front->isVisible()) front = &window_;
    if (QApplication::activeWindow() != front) front->activateWindow();
    return waitFor([&] { return QApplication::activeWindow() == front && QGuiApplication::focusWindow(); });
  }
  /// Does in a dialog what was meant for it. One that stays open, or that nobody awaits, would keep the
  /// program in it for ever: it is closed, and the test fails.
  void answer() {
    const QPointer<QWidget> dialog = QApplication::activeModalWidget();
    if (dialog == nullptr || dialog == current_) return;
    if (staying_.contains(dialog->objectName())) return;
    if (current_ == nullptr && !awaited_.empty()) {
      const auto act = std::move(awaited_.front());
      awaited_.pop_front();
      current_ = dialog;
      act(*dialog);
      current_ = nullptr;
    }
    if (dialog == nullptr || !dialog->isVisible()) return;
    ADD_FAILURE() << "the dialog stays open: " << dialog->windowTitle().toStdString();
    dialog->close();
  }

  QWidget& window_;
  QStringList steps_;
  std::deque<std::function<void(QWidget&)>> awaited_;
  QWidget* current_ = nullptr;
  QStringList staying_;
  std::array<QTimer, 2> timers_;
};

}  // namespace trimtab::test
