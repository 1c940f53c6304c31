#include "foreign_file.h"

#include <algorithm>

#include "log_columns.h"
#include "trimtab/units/text.h"

namespace trimtab {

std::string seemsToBe(const std::vector<std::string>& header) {
  std::vector<std::string> bases;
  for (const std::string& cell : header) bases.push_back(columnName(cell).base);
  const auto any = [&](std::initializer_list<std::string_view> names) {
    return std::any_of(names.begin(), names.end(), [&](std::string_view name) {
      return std::find(bases.begin(), bases.end(), name) != bases.end();
    });
  };
  const auto contains = [&](std::string_view part) {
    return std::any_of(bases.begin(), bases.end(),
                       [&](const std::string& base) { return base.find(part) != std::string::npos; });
  };
  std::string what;
  if (any({"latitude", "lat"}))
    what = "a flight";
  else if (any({"qw", "qx", "quat_w", "rot_w"}) || contains("quaternion"))
    what =
        "a head log of quaternions, whose axes a map has to name, as head_qw=W,head_qx=FORWARD,"
        "head_qy=RIGHT,head_qz=DOWN (times *-1 where an axis points the other way)";
  else if (any({"eulerx", "euler_x"}))
    what =
        "a head log of a game engine, whose axes a map has to name, as "
        "head_heading_deg=EulerY,head_pitch_deg=EulerX (EulerX*-1 where up is negative)";
  else if (any({"yaw", "head_heading", "head_yaw"}))
    what = "a head log";
  return what.empty() ? what : "what seems to be " + what + ": ";
}

std::string notATable(std::string_view text) {
  text = trimmed(withoutByteOrderMark(text).substr(0, 4096));
  const auto has = [&](std::string_view part) { return text.find(part) != std::string_view::npos; };
  if (text.starts_with('<')) {
    if (has("<gpx")) return "GPX";
    if (has("<kml")) return "KML";
    if (has("<html") || has("<HTML") || has("<!DOCTYPE html")) return "a page of the web (HTML)";
    return "XML";
  }
  if (text.starts_with('{') || text.starts_with('[')) return "JSON";
  if (text.starts_with("PK\x03\x04")) return "a ZIP archive or an Excel workbook";
  if (text.starts_with("FileType=text/acmi")) return "a Tacview recording (ACMI)";
  if (text.starts_with("$GP") || text.starts_with("$GN")) return "NMEA 0183";
  return {};
}

}  // namespace trimtab
