#pragma once

#include <string>

#include "trimtab/host/flight.h"
#include "trimtab/host/head_log.h"
#include "trimtab/units/result.h"

/// The options by which every program names the files of flights and heads, and the columns in them.
namespace trimtab::link {

/// The help of the options `--columns` and `--head-columns`.
inline constexpr const char* kColumnsHelp =
    "Where the flight's quantities are, if names and units of its columns do not say: "
    "latitude_deg=Lat,altitude_ft=Alt*3.28084+10; resources/docs/logs.md lists quantities and formats";
inline constexpr const char* kHeadColumnsHelp =
    "Where the head log's quantities are, if names and units of its columns do not say: "
    "time_ms=t,head_heading_deg=Yaw,head_pitch_deg=Pitch*-1; resources/docs/logs.md lists them";

/// Opens what `--flight` names, with the map of `--columns`. If a map could help where there is none, the
/// last finding says so.
Result<Flight> openFlightOption(const std::string& file, const std::string& columns);

/// Opens what `--head` names, a log or a sweep, with the map of `--head-columns`, for a program that has the
/// option `--skip-bad-rows`. If the log is refused only because of rows that cannot be used, the last finding
/// says that the option leaves them out.
Result<HeadLog> openHeadOption(const std::string& head, bool skipBadRows, const std::string& columns);

}  // namespace trimtab::link
