// SPDX-License-Identifier: GPL-3.0-or-later
#include <signal.h>
#include <sys/socket.h>
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

int signalPipe[2] = {-1, -1};

void onSignal(int) {
  const char byte = 1;
  if (::write(signalPipe[1], &byte, 1) < 0) _exit(130);
}

/// A request to stop ends the event loop; the handler itself does no more than one write.
void endOnSignals(QApplication& app, trimtab::workbench::MainWindow& window) {
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, signalPipe) != 0) return;
  auto* notifier = new QSocketNotifier(signalPipe[0], QSocketNotifier::Read, &app);
  QObject::connect(notifier, &QSocketNotifier::activated, &app, [&app, &window] {
    window.keepUnsavedEdits();
    app.exit(0);
  });
  trimtab::onStopSignals(onSignal, SA_RESTART);
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
