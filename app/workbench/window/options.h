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
  QString preset;   ///< file or shipped name; empty: "default"
  QString terrain;  ///< file, folder or database; empty: the sample
  std::optional<std::uint16_t> listenPort;
  QString head;        ///< a head log, or a sweep
  QString flight;      ///< played here from the first picture on
  QString screenshot;  ///< of the whole window; the program ends then
  QString exportFile;  ///< written when the screenshot is, else at once; format by its ending
  double afterS = 0;   ///< seconds from the first picture
  std::optional<QSize> window;
};

/// Options, or an exit code after the text was printed (help, version, wrong usage).
struct Parsed {
  Options options;
  std::optional<int> exitCode;
};
/// Without a QApplication: help and version need no display.
Parsed parseOptions(const QStringList& arguments);

}  // namespace trimtab::workbench
