// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <optional>
#include <span>
#include <vector>

#include "trace_buffer.h"

namespace trimtab::views {

/// A recorded value that a person may put into a plot, as people read it.
struct PlotSignal {
  Trace trace;
  const char* label;
  const char* unit;  ///< of what is shown: the recorded value times `scale`; empty for a pure number
  double scale = 1;
  int decimals = 0;
  bool rare = false;  ///< not in every frame: in a legend only once it was measured

  QString name() const { return QString::fromUtf8(label); }
  /// The name, with its unit if it has one.
  QString fullName() const;
};
/// Returns all signals, grouped by subject.
std::span<const PlotSignal> plotSignals();
/// Returns the signal that plots this trace, which must be a column of the CSV.
const PlotSignal& signalOf(Trace trace);
/// Returns the value that a person reads for this signal in a frame.
inline double shownValue(const TraceBuffer& buffer, const PlotSignal& signal, std::uint64_t frame) {
  return static_cast<double>(buffer.value(signal.trace, frame)) * signal.scale;
}

/// One plot of several under one time axis. In `stages` the stages that sum to a frame are stacked, with what
/// runs beside them as lines; `traces` come on top.
struct PlotLane {
  std::vector<Trace> traces;
  bool stages = false;
  friend bool operator==(const PlotLane&, const PlotLane&) = default;
};
using PlotLanes = std::vector<PlotLane>;
/// Returns memberships, triangles and vertices, frame time and rate, and stages.
PlotLanes standardLanes();
/// Returns lanes as the text that settings keep: names of traces (traceName), separated by blanks, and lanes
/// by semicolons.
QString toText(const PlotLanes& lanes);
/// Reads such a text. It ignores unknown names, and returns nothing if no lane is left.
std::optional<PlotLanes> lanesOf(const QString& text);
/// Returns the trace with this name, if it is a signal.
std::optional<Trace> traceOf(const QString& name);

}  // namespace trimtab::views
