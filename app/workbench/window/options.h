// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QSize>
#include <QString>
#include <QStringList>
#include <cstdint>
#include <optional>

namespace trimtab::workbench {

/// What the command line asks for.
struct Options {
  QString preset;   ///< a file or the name of a shipped preset; empty: "default"
  QString terrain;  ///< an elevation file, a folder, a database or a scene; empty: the sample
  QString origin;   ///< of a flat OpenSceneGraph scene
  std::optional<std::uint16_t> listenPort;
  QString bind,
      from;        ///< of that port: interface and sender; empty: as they were chosen last in the dock Host
  QString head;    ///< a head log, or a sweep such as sweep:60
  QString flight;  ///< played in this program from the start
  QStringList files;     ///< opened by what they are (fileKindOf), after all of the above
  bool welcome = false;  ///< nothing is asked for, so the welcome page may be shown
  QString screenshot;    ///< the file for an image of the whole window; the program ends after it
  QString exportFile;    ///< written with the screenshot, or at once without one; its ending gives the format
  double afterS = 0;     ///< seconds from the first image to the screenshot
  std::optional<QSize> window;
};

/// The options; or an exit code if the program must end, because help, the version or a usage error was
/// printed.
struct Parsed {
  Options options;
  std::optional<int> exitCode;
};
/// Parses the command line. It needs no QApplication, because help and version work without a display.
Parsed parseOptions(const QStringList& arguments);

}  // namespace trimtab::workbench
