// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_inputs.h"

#include <QObject>

#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/jobs/feed.h"
#include "document.h"
#include "ig_controller.h"
#include "terrain_controller.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "views/model/draft.h"

namespace trimtab::workbench {

RunInputs::RunInputs(const Workplace& workplace, const Document& document, const TerrainController& terrain,
                     const FlightDock& flight)
    : at_(workplace), document_(document), terrain_(terrain), flight_(flight) {}

bool RunInputs::write(const QString& file, const std::string& text) const {
  const auto written = writeAtomically(file.toStdString(), text);
  if (!written) at_.messages.add(QObject::tr("The experiment's input cannot be written"), written.findings());
  return written.ok();
}

std::optional<ExperimentInputs> RunInputs::write(const QString& folder) const {
  if (!terrain_.database()) return std::nullopt;
  ExperimentInputs inputs{terrain_.openedFrom(), {}, folder + "/preset.json"};
  const std::string name = document_.title().toStdString();
  if (!write(inputs.preset, exportText(at_.draft.active(), name, {}, ExportFormat::json)))
    return std::nullopt;
  const std::optional<QString> flight = writeFlight(folder);
  if (!flight) return std::nullopt;
  inputs.flight = *flight;
  return inputs;
}

std::optional<ExperimentInputs> RunInputs::writeForFit(const QString& folder) const {
  const Result<ValidatedParameters> limited = limitedActive(at_.draft, document_.title().toStdString());
  if (!limited) {
    at_.messages.add(QObject::tr("The preset cannot be limited to the image generator"), limited.findings());
    return std::nullopt;
  }
  const std::optional<QString> flight = writeFlight(folder);
  const QString preset = folder + "/preset.json";
  if (!flight ||
      !write(preset, exportText(*limited, document_.title().toStdString(), {}, ExportFormat::json)))
    return std::nullopt;
  return ExperimentInputs{{}, *flight, preset};
}

/// Returns the file of the flight; an empty name if none is open.
std::optional<QString> RunInputs::writeFlight(const QString& folder) const {
  const Flight& flight = at_.feed.playback().flight();
  if (flight.states.empty()) return QString();
  // The file holds more than the states: a trace has its cost, and a capture what CSV has no columns for. It
  // is read there without its map of columns, which the states have passed already.
  if (flight_.columns().empty() && !flight_.file().isEmpty()) return flight_.file();
  const QString file = folder + "/flight.csv";
  if (!write(file, flightCsv(flight))) return std::nullopt;
  return file;
}

}  // namespace trimtab::workbench
