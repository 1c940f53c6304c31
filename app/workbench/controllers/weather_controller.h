// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>

#include "workplace.h"

namespace trimtab::views {
class WeatherPanel;
}

namespace trimtab::workbench {

class FrameController;
class TerrainController;

/// Runs the weather calibration over the view that the viewport shows.
class WeatherController : public QObject {
  Q_OBJECT

 public:
  WeatherController(const Workplace& workplace, const FrameController& frame,
                    const TerrainController& terrain, views::WeatherPanel& panel);

 private:
  void calibrate();

  Workplace at_;
  const FrameController& frame_;
  const TerrainController& terrain_;
};

}  // namespace trimtab::workbench
