// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "culling_controller.h"
#include "document_controller.h"
#include "errors_controller.h"
#include "flight_controller.h"
#include "frame_controller.h"
#include "head_controller.h"
#include "ig_controller.h"
#include "observer_controller.h"
#include "run_inputs.h"
#include "symbology_controller.h"
#include "terrain_controller.h"
#include "trace_controller.h"
#include "weather_controller.h"

namespace trimtab::workbench {

/// All controllers of a window. Each uses only those above it; what goes the other way goes by signals.
struct Controllers {
  std::unique_ptr<DocumentController> document;
  std::unique_ptr<IgController> ig;
  std::unique_ptr<TerrainController> terrain;
  std::unique_ptr<ObserverController> observer;
  std::unique_ptr<FrameController> frame;
  std::unique_ptr<CullingController> culling;
  std::unique_ptr<FlightController> flight;
  std::unique_ptr<HeadController> head;
  std::unique_ptr<SymbologyController> symbology;
  std::unique_ptr<WeatherController> weather;
  std::unique_ptr<TraceController> trace;
  std::unique_ptr<RunInputs> inputs;
  std::unique_ptr<ErrorsController> errors;
};

}  // namespace trimtab::workbench
