// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <QCommandLineParser>
#include <QFileInfo>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "app/manual/command.h"
#include "trimtab/scene/osg_database.h"

namespace trimtab::workbench {
namespace {

constexpr int kDone = 0, kRefused = 1, kUsage = 2;

int print(const QString& text) {
  if (std::fputs(qPrintable(text), stdout) >= 0 && std::fflush(stdout) == 0) return kDone;
  std::fprintf(stderr, "trimtab: standard output cannot be written: %s\n", std::strerror(errno));
  return kRefused;
}

int complain(const QString& text) {
  std::fprintf(stderr, "trimtab: %s\n", qPrintable(text));
  return kUsage;
}

/// The command line as the manual writes it.
manual::Command commandOf(const QString& text, const QList<QCommandLineOption>& options,
                          const QString& file) {
  manual::Command command{"trimtab", text.toStdString(), {}, {}};
  if (command.text.ends_with('.')) command.text.pop_back();
  manual::Argument& files = command.arguments.emplace_back();
  files.names = {"FILE"};
  files.text = file.toStdString();
  files.repeats = true;
  for (const QCommandLineOption& option : options) {
    manual::Argument& a = command.arguments.emplace_back();
    for (const QString& name : option.names())
      a.names.push_back((name.size() == 1 ? "-" : "--") + name.toStdString());
    a.value = option.valueName().toStdString();
    a.text = option.description().toStdString();
    for (const QString& value : option.defaultValues()) a.unset = value.toStdString();
  }
  return command;
}

}  // namespace

Parsed parseOptions(const QStringList& arguments) {
  QCommandLineParser parser;
  parser.setApplicationDescription(
      "Tune culling and level of detail while you watch terrain, decisions and cost.");
  const QCommandLineOption help({"h", "help"}, "Show this text.");
  const QCommandLineOption version({"v", "version"}, "Show the version.");
  const QCommandLineOption preset("preset", "Open this preset: a file, or the name of a shipped preset.",
                                  "P");
  const QCommandLineOption terrain("terrain",
                                   "Open this terrain: an elevation file, a folder, scenery, a CDB, a "
                                   "database, or a scene of OpenSceneGraph or OpenFlight.",
                                   "DB");
  const QCommandLineOption origin("origin", scene::kOriginHelp, "LAT,LON");
  const QCommandLineOption listen("listen", "Listen for a host on this UDP port.", "PORT");
  const QCommandLineOption bind("bind", "Listen on the interface of this address; 0.0.0.0: every one.",
                                "ADDRESS");
  const QCommandLineOption from("from", "Who may send: any, first, or an address.", "SENDER");
  const QCommandLineOption fly("fly", "Play this flight in the workbench.", "FLIGHT");
  const QCommandLineOption head(
      "head", "Line of sight: a head log, or sweep:DEG/S[/WAIT] or nod:DEG/S[/WAIT].", "LOG");
  const QCommandLineOption screenshot("screenshot", "Save a screenshot of the whole window and end.",
                                      "OUT.png");
  const QCommandLineOption after(
      "after-s", "Take the screenshot this many seconds after the first image of the terrain.", "S", "0");
  const QCommandLineOption exportTo(
      "export", "Write an export (.json, .xml or .ini), together with the screenshot if there is one.",
      "OUT");
  const QCommandLineOption size("size", "Size of the window.", "WxH");
  QCommandLineOption writeManual("write-manual", {}, "DIR");
  writeManual.setFlags(QCommandLineOption::HiddenFromHelp);
  const QString file = "Open it: a session, preset, terrain, flight, head log, rules or results.";
  parser.addPositionalArgument("FILE", file, "[FILE...]");
  const QList<QCommandLineOption> shown{help, version, preset, terrain,    origin, listen,   bind,
                                        from, fly,     head,   screenshot, after,  exportTo, size};
  parser.addOptions(shown);
  parser.addOption(writeManual);

  Parsed parsed;
  Options& options = parsed.options;
  if (!parser.parse(arguments)) {
    parsed.exitCode = complain(parser.errorText());
    return parsed;
  }
  if (parser.isSet(help)) {
    parsed.exitCode = print(parser.helpText().replace("<executable_name>", "trimtab"));
    return parsed;
  }
  if (parser.isSet(version)) {
    parsed.exitCode = print(QStringLiteral("trimtab " TRIMTAB_VERSION "\n"));
    return parsed;
  }
  if (parser.isSet(writeManual)) {
    const auto written = manual::writeManual(commandOf(parser.applicationDescription(), shown, file),
                                             parser.value(writeManual).toStdString());
    parsed.exitCode = written ? kDone : complain(QString::fromStdString(toString(written.findings())));
    return parsed;
  }
  for (const QString& name : parser.positionalArguments()) {
    if (QFileInfo::exists(name)) {
      options.files << name;
      continue;
    }
    parsed.exitCode = complain("no such file or folder: " + name);
    return parsed;
  }
  options.preset = parser.value(preset);
  options.terrain = parser.value(terrain);
  options.origin = parser.value(origin);
  options.bind = parser.value(bind);
  options.from = parser.value(from);
  if ((!options.bind.isEmpty() || !options.from.isEmpty()) && !parser.isSet(listen))
    parsed.exitCode = complain("--bind and --from: expected --listen too");
  options.flight = parser.value(fly);
  options.head = parser.value(head);
  options.screenshot = parser.value(screenshot);
  options.exportFile = parser.value(exportTo);
  bool good = true;
  options.afterS = parser.value(after).toDouble(&good);
  if (!good || !(options.afterS >= 0))
    parsed.exitCode = complain("--after-s: expected seconds, found " + parser.value(after));
  if (parser.isSet(listen)) {
    const int port = parser.value(listen).toInt(&good);
    if (good && port >= 0 && port <= 65535)
      options.listenPort = static_cast<std::uint16_t>(port);
    else
      parsed.exitCode = complain("--listen: expected a port, 0 to 65535, found " + parser.value(listen));
  }
  if (parser.isSet(size)) {
    const QStringList sides = parser.value(size).split('x');
    const QSize wanted = sides.size() == 2 ? QSize(sides[0].toInt(), sides[1].toInt()) : QSize();
    if (wanted.width() >= 320 && wanted.height() >= 200)
      options.window = wanted;
    else
      parsed.exitCode = complain("--size: expected WxH of at least 320x200, found " + parser.value(size));
  }
  options.welcome = arguments.size() < 2;
  return parsed;
}

}  // namespace trimtab::workbench
