// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/eventfd.h>
#include <unistd.h>

#include <QApplication>
#include <QIcon>
#include <QSocketNotifier>
#include <QSurfaceFormat>
#include <clocale>
#include <cstdio>
#include <cstdlib>

#include "app/link/stop_signals.h"
#include "app/workbench/viewport/gl_setup.h"
#include "app/workbench/window/main_window.h"
#include "app/workbench/window/options.h"
#include "trimtab/preset/file_io.h"

namespace {

/// A request to stop ends the event loop, at its start if it came before.
void endOnSignals(QApplication& app, trimtab::workbench::MainWindow& window) {
  const int asked = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (asked < 0) return trimtab::endAtStopSignals();
  auto* notifier = new QSocketNotifier(asked, QSocketNotifier::Read, &app);
  QObject::connect(notifier, &QSocketNotifier::activated, &app, [&app, &window] {
    window.keepUnsavedEdits();
    app.exit(0);
  });
  trimtab::countStopSignals(asked);
}

/// While QApplication is made: Qt would abort where there is no display to be had.
void endOnFatal(QtMsgType type, const QMessageLogContext&, const QString& text) {
  if (type != QtFatalMsg && type != QtWarningMsg) return;
  std::fprintf(stderr, "trimtab: %s\n", qPrintable(text.section('\n', 0, 0)));
  if (type == QtFatalMsg) _exit(1);
}

bool displayNamed() {
  const char* platform = std::getenv("QT_QPA_PLATFORM");
  return platform != nullptr || std::getenv("DISPLAY") != nullptr ||
         std::getenv("WAYLAND_DISPLAY") != nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  trimtab::handleStopSignals();
  using namespace trimtab::workbench;
  trimtab::failLargeWrites();
  QStringList arguments;
  for (int i = 0; i < argc; ++i) arguments << QString::fromLocal8Bit(argv[i]);
  const Parsed parsed = parseOptions(arguments);
  if (parsed.exitCode) return *parsed.exitCode;
  if (!displayNamed()) {
    std::fputs(
        "trimtab: no display: neither DISPLAY nor WAYLAND_DISPLAY is set (without one, run: xvfb-run trimtab "
        "...)\n",
        stderr);
    return 1;
  }

  prepareGl();
  qInstallMessageHandler(endOnFatal);
  QApplication app(argc, argv);
  qInstallMessageHandler(nullptr);
  // Numbers in files and reasons are written with a point, whatever the desktop speaks; widgets go by
  // QLocale.
  std::setlocale(LC_NUMERIC, "C");
  nameApplication();
  if (const QString missing = checkGl(); !missing.isEmpty()) {
    std::fprintf(stderr, "trimtab: this display has no OpenGL that can draw the terrain: %s\n",
                 qPrintable(missing));
    return 1;
  }
  MainWindow window;
  endOnSignals(app, window);
  window.start(parsed.options);
  return app.exec();
}
