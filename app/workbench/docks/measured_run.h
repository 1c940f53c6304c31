// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QVector>

#include "app/harness/results.h"
#include "views/model/error_run.h"

namespace trimtab::workbench {

/// Returns the errors that a benchmark measures, in the order in which all lists of their values have them.
QVector<views::ErrorRun::Error> measuredErrors();
QVector<double> errorsOf(const FrameError& error);
/// Returns the results of a benchmark as plots show them.
views::ErrorRun measuredRun(const harness::Results& results);

}  // namespace trimtab::workbench
