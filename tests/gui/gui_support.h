// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <QAction>
#include <QApplication>
#include <QDockWidget>
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QMimeData>
#include <QScreen>
#include <QTest>
#include <QTimer>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>

#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/window/main_window.h"
#include "tests/core/terrain/baked_sample.h"
#include "tests/support.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/synthetic/sample.h"

namespace trimtab::test {

/// Runs the event loop until the condition holds. Returns false if it does not hold within the limit.
inline bool waitFor(const std::function<bool()>& condition, int limitMs = 60000) {
  return QTest::qWaitFor(condition, limitMs);
}

/// Returns what the display shows in the place of a widget, of its window or what lies over it.
inline QImage onDisplay(const QWidget& widget) {
  const QRect at(widget.mapTo(widget.window(), QPoint()), widget.size());
  return widget.screen()
      ->grabWindow(widget.window()->winId(), at.x(), at.y(), at.width(), at.height())
      .toImage()
      .convertToFormat(QImage::Format_RGB32);
}

/// Returns the label that screen readers call by this name, or null.
inline QLabel* labelNamed(const QWidget& within, const QString& name) {
  for (QLabel* label : within.findChildren<QLabel*>())
    if (label->accessibleName() == name) return label;
  return nullptr;
}
/// Reports whether a label has this in its text.
inline bool labelSays(const QWidget& within, const QString& text) {
  for (const QLabel* label : within.findChildren<QLabel*>())
    if (label->text().contains(text)) return true;
  return false;
}

/// Closes every modal dialog that opens while it lives. A test that expects none cannot hang on one, and a
/// test that expects one need not know how long it takes to open.
class DialogCloser {
 public:
  DialogCloser() {
    QObject::connect(&timer_, &QTimer::timeout, &timer_, [this] {
      QWidget* const dialog = QApplication::activeModalWidget();
      if (dialog == nullptr) return;
      ++closed_;
      dialog->close();
    });
    timer_.start(20);
  }
  int closed() const { return closed_; }

 private:
  QTimer timer_;
  int closed_ = 0;
};

/// The sample terrain, 60 km wide with posts 120 m apart: the shipped flight stays over it. It is baked once
/// per test program. For screenshots, TRIMTAB_SHOT_TERRAIN names another database, such as the sample with
/// its objects.
inline const std::filesystem::path& sampleTerrain() {
  static const ScratchDir dir;
  static const std::filesystem::path database = [] {
    if (const char* other = std::getenv("TRIMTAB_SHOT_TERRAIN")) return std::filesystem::path(other);
    return bakedSample(dir.path(), {1, 60, 120, {}}) != nullptr ? dir / "terrain" : std::filesystem::path();
  }();
  return database;
}

inline std::string sampleFlight() {
  return (sourceDir() / "resources/flights/yecheon-circuit.csv").string();
}

/// Returns the seconds into the flight at which it first climbs through an altitude.
inline double climbsThrough(const Flight& flight, double altitudeFt) {
  for (const AircraftState& state : flight.states)
    if (state.position.height.in<Feet>() >= altitudeFt) return state.time - flight.states.front().time;
  return 0;
}

/// A test with the real window, the sample terrain open and its first image drawn.
class Bench : public ::testing::Test {
 protected:
  void SetUp() override {
    open(QSize(1400, 900));
    window->showEveryDock();
    ASSERT_TRUE(waitFor([this] { return window->viewport().lastResult() != nullptr; }))
        << window->messages().text().toStdString();
  }
  void TearDown() override {
    if (window) window->draft().undoStack().setClean();
    window.reset();
  }
  /// Opens the window over the sample terrain, in this size or in the one that was kept.
  void open(std::optional<QSize> size) {
    window = std::make_unique<workbench::MainWindow>();
    workbench::Options options;
    options.terrain = QString::fromStdString(sampleTerrain().string());
    options.window = size;
    window->start(options);
  }
  /// Closes the window as a person does, and opens another one as the next run of the program would. Its
  /// terrain may still be opening when this returns.
  void restart(std::optional<QSize> size = {}) {
    window->draft().undoStack().setClean();
    ASSERT_TRUE(window->close());
    window.reset();
    open(size);
    ASSERT_TRUE(QTest::qWaitForWindowExposed(window.get(), 60000));
  }
  workbench::MainWindow& w() { return *window; }
  /// Makes the window the one that hears the keys.
  void activate() {
    window->activateWindow();
    ASSERT_TRUE(QTest::qWaitForWindowActive(window.get(), 60000));
    ASSERT_TRUE(waitFor([this] { return QApplication::activeWindow() == window.get(); }));
  }
  /// Waits until a person can see the dock, or a page of one.
  bool comesToFront(const char* dock) { return comesToFront(*window->dock(QString::fromLatin1(dock))); }
  bool comesToFront(const QWidget& content) {
    return waitFor([&content] { return workbench::isInFront(content); });
  }
  /// Returns the commands of all menus.
  QList<QAction*> commands() const {
    QList<QAction*> all;
    for (const QMenu* menu : window->menuBar()->findChildren<QMenu*>()) all += menu->actions();
    return all;
  }
  /// Returns the command whose text begins so. If there is none, the test fails, and this returns null.
  QAction* command(const QString& text) const {
    for (QAction* action : commands())
      if (action->text().remove('&').startsWith(text)) return action;
    ADD_FAILURE() << "no command " << text.toStdString();
    return nullptr;
  }
  /// Runs a command of the menus.
  void trigger(const QString& text) const {
    QAction* const action = command(text);
    ASSERT_NE(action, nullptr);
    action->trigger();
  }
  /// The result of the newest image, or an empty one while a terrain just opened has no image yet.
  const FrameResult& last() const {
    static const FrameResult none;
    const auto& result = window->viewport().lastResult();
    return result != nullptr ? *result : none;
  }
  Session& session() { return window->feed().session(); }
  std::uint64_t paints() const { return window->viewport().paints(); }
  /// Opens a link for a host on any free port and returns the port.
  std::uint16_t listen() {
    const Findings findings = window->feed().openHost({});
    EXPECT_TRUE(findings.empty()) << toString(findings);
    return window->feed().receiver()->port();
  }
  /// Turns the free camera up or down.
  void look(double pitchDeg) {
    workbench::FreeCamera& camera = w().viewport().camera();
    Attitude attitude = camera.attitude();
    attitude.pitch = Degrees{pitchDeg};
    camera.place(camera.position(), attitude);
    w().feed().look(camera);
  }
  /// Waits until nothing is painted for a while.
  bool settle() {
    for (int i = 0; i < 200; ++i) {
      const std::uint64_t before = paints();
      QTest::qWait(250);
      if (paints() == before) return true;
    }
    return false;
  }
  void drop(const std::filesystem::path& file) {
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(QString::fromStdString(file.string()))});
    const QPoint middle = window->rect().center();
    QDragEnterEvent enter(middle, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(window.get(), &enter);
    EXPECT_TRUE(enter.isAccepted());
    QDropEvent event(middle, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(window.get(), &event);
  }

  std::unique_ptr<workbench::MainWindow> window;
};

}  // namespace trimtab::test
