#include "log_options.h"

namespace trimtab::link {
namespace {

/// Appends that a map of columns helps, if the file was refused for its columns.
Findings withHint(Findings findings, const std::string& file, const char* option, const char* example) {
  if (mapMayHelp(findings))
    findings.push_back(
        {Severity::note, file, option, std::string("a map of columns, as ") + example, "none"});
  return findings;
}

}  // namespace

Result<Flight> openFlightOption(const std::string& file, const std::string& columns) {
  const Result<ColumnMap> map = parseColumnMap(columns);
  if (!map) return map.findings();
  Result<Flight> flight = readFlight(file, 0.1, *map);
  if (flight || !columns.empty()) return flight;
  return withHint(flight.findings(), file, "--columns", "latitude_deg=Lat,altitude_ft=Alt*3.28084");
}

Result<HeadLog> openHeadOption(const std::string& head, bool skipBadRows, const std::string& columns) {
  const Result<ColumnMap> map = parseColumnMap(columns);
  if (!map) return map.findings();
  Result<HeadLog> log = openHead(head, skipBadRows ? BadRows::leave_out : BadRows::refuse, *map);
  if (log) return log;
  Findings findings = log.findings();
  if (columns.empty())
    findings =
        withHint(std::move(findings), head, "--head-columns", "head_heading_deg=Yaw,head_pitch_deg=Pitch");
  if (skipBadRows) return findings;
  const Result<HeadLog> rest = openHead(head, BadRows::leave_out, *map);
  if (!rest) return findings;
  const std::string rows = std::to_string(rest->rowsLeftOut) + (rest->rowsLeftOut == 1 ? " row" : " rows");
  findings.push_back(
      {Severity::note, head, "--skip-bad-rows", "this option, to leave " + rows + " out", "none"});
  return findings;
}

}  // namespace trimtab::link
