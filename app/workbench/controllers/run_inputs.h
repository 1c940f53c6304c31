// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <optional>

#include "app/workbench/docks/leverage_page.h"
#include "workplace.h"

namespace trimtab::workbench {

class Document;
class FlightDock;
class TerrainController;

/// Writes what the window shows into files, for experiments and benchmarks that run as programs of their own.
class RunInputs {
 public:
  RunInputs(const Workplace& workplace, const Document& document, const TerrainController& terrain,
            const FlightDock& flight);

  /// Writes the active parameters, and the flight unless its own file still holds it, into the folder.
  /// Returns nothing if no terrain is open, or if writing fails, which is reported in the Messages dock.
  std::optional<ExperimentInputs> write(const QString& folder) const;
  /// Does so with a preset that is limited to the image generator, for a fit, which needs no terrain.
  std::optional<ExperimentInputs> writeForFit(const QString& folder) const;

 private:
  std::optional<QString> writeFlight(const QString& folder) const;
  bool write(const QString& file, const std::string& text) const;

  Workplace at_;
  const Document& document_;
  const TerrainController& terrain_;
  const FlightDock& flight_;
};

}  // namespace trimtab::workbench
