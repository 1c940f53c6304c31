// SPDX-License-Identifier: GPL-3.0-or-later
#include "log_reading.h"

#include <QCoreApplication>
#include <QStringList>
#include <algorithm>
#include <functional>
#include <optional>

#include "trimtab/host/flight.h"
#include "trimtab/host/head_log.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

QString tr(const char* text) {
  return QCoreApplication::translate("LogReading", text);
}

/// Returns a text such as "latitude 46.5 to 46.6°", which is empty if no row has the quantity.
template <class Rows, class Value>
QString rangeText(const QString& name, const Rows& rows, const QString& unit, int decimals,
                  const Value& value) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const auto& row : rows)
    if (const std::optional<double> number = value(row)) {
      low = std::min(low, *number);
      high = std::max(high, *number);
    }
  if (low > high) return {};
  return tr("%1 %2 to %3%4")
      .arg(name, views::numberText(low, decimals), views::numberText(high, decimals), unit);
}

QString rowsText(std::size_t rows, double durationS, QStringList ranges) {
  ranges.removeAll(QString());
  return tr("%1 rows over %2 s: %3")
      .arg(views::numberText(static_cast<double>(rows), 0), views::numberText(durationS, 3),
           ranges.join(QStringLiteral(", ")));
}

QString textOf(const Flight& flight) {
  const QString deg = QStringLiteral("°"), feet = tr(" ft");
  const auto range = [&](const QString& name, const QString& unit, int decimals,
                         const std::function<std::optional<double>(const AircraftState&)>& value) {
    return rangeText(name, flight.states, unit, decimals, value);
  };
  const auto ofHead = [](Degrees Attitude::*angle) {
    return [angle](const AircraftState& s) {
      return s.head ? std::optional((*s.head.*angle).value()) : std::nullopt;
    };
  };
  return rowsText(
      flight.states.size(), flight.durationS(),
      {range(tr("latitude"), deg, 4, [](const AircraftState& s) { return s.position.latitude.value(); }),
       range(tr("longitude"), deg, 4, [](const AircraftState& s) { return s.position.longitude.value(); }),
       range(tr("altitude"), feet, 0, [](const AircraftState& s) { return s.position.height.in<Feet>(); }),
       range(tr("heading"), deg, 1, [](const AircraftState& s) { return s.attitude.heading.value(); }),
       range(tr("pitch"), deg, 1, [](const AircraftState& s) { return s.attitude.pitch.value(); }),
       range(tr("roll"), deg, 1, [](const AircraftState& s) { return s.attitude.roll.value(); }),
       range(tr("above ground"), feet, 0,
             [](const AircraftState& s) {
               return s.aboveGround ? std::optional(s.aboveGround->in<Feet>()) : std::nullopt;
             }),
       range(tr("heading of the head"), deg, 1, ofHead(&Attitude::heading)),
       range(tr("pitch of the head"), deg, 1, ofHead(&Attitude::pitch)),
       range(tr("roll of the head"), deg, 1, ofHead(&Attitude::roll))});
}

QString textOf(const HeadLog& log) {
  const auto range = [&](const QString& name, double HeadSample::*angle) {
    return rangeText(name, log.samples, QStringLiteral("°"), 1,
                     [angle](const HeadSample& s) { return std::optional(s.*angle); });
  };
  return rowsText(log.samples.size(), log.durationS(),
                  {range(tr("heading"), &HeadSample::headingDeg), range(tr("pitch"), &HeadSample::pitchDeg),
                   range(tr("roll"), &HeadSample::rollDeg)});
}

}  // namespace

LogReading readingOf(LogKind kind, const std::string& text, const std::string& file, const ColumnMap& map) {
  const auto reading = [](const auto& log) {
    return LogReading{log ? textOf(*log) : QString(), log.findings()};
  };
  if (kind == LogKind::flight) return reading(parseFlightCsv(text, file, 0.1, map));
  const Result<HeadLog> log = parseHeadLog(text, file, BadRows::refuse, map);
  if (log) return reading(log);
  const Result<HeadLog> rest = parseHeadLog(text, file, BadRows::leave_out, map);
  return rest ? reading(rest) : reading(log);
}

}  // namespace trimtab::workbench
