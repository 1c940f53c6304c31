#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/host/column_map.h"
#include "trimtab/units/geodesy.h"
#include "trimtab/units/result.h"

/// The motion of the pilot's head over time: a recording or a scripted sweep.
namespace trimtab {

/// Angles in degrees. The heading is unwound, so it may pass 180 and 360; the pitch lies within -90 to 90.
struct HeadSample {
  double timeS = 0, headingDeg = 0, pitchDeg = 0, rollDeg = 0;

  friend bool operator==(const HeadSample&, const HeadSample&) = default;
};

struct HeadLog {
  std::string name;
  std::vector<HeadSample> samples;  ///< times rise from 0
  bool repeats = false;             ///< whether it begins again at its end; if not, the last sample is held
  /// During a longer step between samples the earlier sample is held, because nothing says how the head
  /// moved.
  double gapS = std::numeric_limits<double>::infinity();
  std::size_t rowsLeftOut = 0;  ///< rows of the file that could not be used

  double durationS() const { return samples.empty() ? 0 : samples.back().timeS; }
};

/// The longest gap, in seconds, over which a recorded log is interpolated.
inline constexpr double kHeadLogGapS = 0.25;

/// Says what a reader does with rows that it cannot use.
enum class BadRows {
  refuse,    ///< the log is refused; findings name the first of them by line, column and value, and count the
             ///< rest
  leave_out  ///< the log is read without them, and a warning counts them; refused if they are the greater
             ///< part
};

/// Reads a head log: a table of text with a time (time_s, timestamp, time_ms ..), a heading
/// (head_heading_deg, heading, yaw ..), a pitch, and a roll if there is one. resources/docs/logs.md has the
/// names, units and formats that are read; `columns` says where quantities are, if the names do not. Names
/// give units; without them the values do, and a log is refused if two units fit. If names carry no unit and
/// the column named pitch winds beyond a quarter turn in more rows than the one named yaw, the two are
/// exchanged: the headers of MV360's logs are wrong so. A row is bad if it has not as many cells as the
/// header, if a cell is no finite number, or if its pitch lies beyond a quarter turn. Rows out of order are
/// sorted; of rows with one time the last counts. Findings report all of this, and gaps.
Result<HeadLog> readHeadLog(const std::filesystem::path& file, BadRows badRows = BadRows::refuse,
                            const ColumnMap& columns = {});
Result<HeadLog> parseHeadLog(std::string_view text, const std::string& where,
                             BadRows badRows = BadRows::refuse, const ColumnMap& columns = {});

/// Parses a scripted sweep. "sweep:DEG/S[/WAIT]" waits (2 s by default), turns the head through so many
/// degrees, half to either side of straight ahead, in so many seconds, waits, turns back, and so on.
/// "nod:DEG/S[/WAIT]" does the same up and down. Units may be written: "sweep:180deg/1s/2s".
Result<HeadLog> parseSweep(std::string_view text);
bool isSweep(std::string_view text);
/// Opens a sweep or, if the text is none, a log file.
Result<HeadLog> openHead(const std::string& text, BadRows badRows = BadRows::refuse,
                         const ColumnMap& columns = {});

/// Returns the head so many seconds into the log, interpolated between samples, heading in -180..180. A time
/// that is not a number counts as the beginning.
Attitude headAt(const HeadLog& log, double timeS);

}  // namespace trimtab
