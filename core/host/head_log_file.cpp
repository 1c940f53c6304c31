#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "limits.h"
#include "trimtab/host/head_log.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

/// Bad rows that findings name one by one; the rest are counted.
constexpr std::size_t kNamedRows = 10;
constexpr double kQuarterDeg = 90 + 1e-4;
constexpr double kLargestDeg = 1e6, kLargestS = 1e12;
constexpr double kTurnRad = 2 * 3.14159265358979323846;

enum class Unit { unknown, degrees, radians };

struct Column {
  std::size_t place = 0;
  std::string name;
  Unit unit = Unit::unknown;
};

constexpr std::array<std::string_view, 6> kTimes{"time_s", "timestamp_s", "timestamp",
                                                 "time",   "seconds",     "t"};
constexpr std::array<std::string_view, 2> kTimesMs{"time_ms", "timestamp_ms"};
constexpr std::array<std::string_view, 4> kHeadings{"head_heading", "head_yaw", "heading", "yaw"};
constexpr std::array<std::string_view, 2> kPitches{"head_pitch", "pitch"};
constexpr std::array<std::string_view, 2> kRolls{"head_roll", "roll"};

bool separates(char c) {
  return c == ',' || c == ';' || c == '\t' || c == ' ';
}

/// Blanks around a comma belong to it; blanks alone separate.
void split(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  const bool blanks = line.find_first_of(",;") == std::string_view::npos;
  std::size_t at = 0;
  while (at <= line.size()) {
    std::size_t end = at;
    while (end < line.size() && !(blanks ? separates(line[end]) : line[end] == ',' || line[end] == ';'))
      ++end;
    std::string_view cell = line.substr(at, end - at);
    while (!cell.empty() && separates(cell.front())) cell.remove_prefix(1);
    while (!cell.empty() && separates(cell.back())) cell.remove_suffix(1);
    if (!blanks || !cell.empty()) cells.push_back(cell);
    at = end + 1;
  }
}

std::string lowered(std::string_view name) {
  std::string text(name);
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

template <std::size_t N>
std::optional<Column> findColumn(const std::vector<std::string_view>& header,
                                 const std::array<std::string_view, N>& names, bool angle) {
  struct Suffix {
    const char* text;
    Unit unit;
  };
  for (const std::string_view name : names)
    for (std::size_t i = 0; i < header.size(); ++i)
      for (const Suffix& suffix :
           {Suffix{"_deg", Unit::degrees}, Suffix{"_rad", Unit::radians}, Suffix{"", Unit::unknown}}) {
        if (!angle && suffix.unit != Unit::unknown) continue;
        if (lowered(header[i]) == std::string(name) + suffix.text)
          return Column{i, std::string(header[i]), suffix.unit};
      }
  return std::nullopt;
}

std::string quoted(std::string_view cell) {
  return cell.empty() ? "nothing" : '"' + std::string(cell.substr(0, 40)) + '"';
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& where, BadRows badRows)
      : text_(text), where_(where), badRows_(badRows) {}

  Result<HeadLog> read() {
    if (!readHeader()) return findings_;
    readRows();
    if (rows_.empty() && bad_ == 0) return refusal("at least one row below the header", "none");
    toDegrees();
    sort();
    unwind();
    exchangeMisnamedColumns();
    // A row beyond a quarter turn may have wound those behind it: without it they are unwound once more.
    while (dropRowsBeyondQuarter()) unwind();
    if (!badRowsAccepted()) return findings_;
    return finished();
  }

 private:
  static constexpr std::size_t kHeading = 0, kPitch = 1, kRoll = 2, kAngles = 3;

  struct Row {
    double time = 0;
    std::array<double, kAngles> angle{};
    std::size_t line = 0;
    std::array<std::string_view, kAngles> cell;  ///< as the file spells them
  };

  void note(std::string text) { findings_.push_back({Severity::note, where_, "", "", std::move(text)}); }
  Findings refusal(std::string expected, std::string found) {
    findings_.push_back({Severity::error, where_, "", std::move(expected), std::move(found)});
    return findings_;
  }

  std::string_view takeLine() {
    const std::size_t end = text_.find('\n');
    std::string_view line = text_.substr(0, end);
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    ++line_;
    while (!line.empty() && (line.back() == '\r' || separates(line.back()))) line.remove_suffix(1);
    while (!line.empty() && separates(line.front())) line.remove_prefix(1);
    return line;
  }

  bool readHeader();
  void readRows();
  std::string_view readCell(const std::vector<std::string_view>& cells, const Column& column, double most,
                            double& value, bool& good);
  void nameBadCell(std::size_t line, const std::string& column, const char* expected, std::string_view cell);
  void toDegrees();
  void sort();
  void unwind();
  std::size_t rowsBeyondQuarter(std::size_t angle) const;
  void exchangeMisnamedColumns();
  bool dropRowsBeyondQuarter();
  bool badRowsAccepted();
  Result<HeadLog> finished();

  std::string_view text_;
  const std::string& where_;
  const BadRows badRows_;
  std::size_t line_ = 0, bad_ = 0;
  Findings findings_;
  Column time_;
  double timeScale_ = 1;
  std::array<std::optional<Column>, kAngles> columns_;
  std::size_t pitchColumn_ = kPitch;  ///< the column that holds the pitch, whatever its name
  std::vector<Row> rows_;
};

bool Reader::readHeader() {
  std::string_view line;
  do {
    if (text_.empty()) {
      refusal("a header that names its columns", "an empty file");
      return false;
    }
    line = takeLine();
  } while (line.empty() || line.front() == '#');
  std::vector<std::string_view> header;
  split(line, header);
  const auto missing = [&](const char* key, const char* expected) {
    findings_.push_back({Severity::error, where_ + ':' + std::to_string(line_), key, expected, quoted(line)});
  };
  if (const auto ms = findColumn(header, kTimesMs, false)) {
    time_ = *ms;
    timeScale_ = 1e-3;
  } else if (const auto s = findColumn(header, kTimes, false)) {
    time_ = *s;
  } else {
    missing("time", "a column time_s, timestamp or time_ms");
  }
  columns_ = {findColumn(header, kHeadings, true), findColumn(header, kPitches, true),
              findColumn(header, kRolls, true)};
  if (!columns_[kHeading]) missing("heading", "a column head_heading_deg, heading or yaw");
  if (!columns_[kPitch]) missing("pitch", "a column head_pitch_deg or pitch");
  return findings_.empty();
}

/// Names the cells of the first bad rows.
void Reader::nameBadCell(std::size_t line, const std::string& column, const char* expected,
                         std::string_view cell) {
  if (bad_ >= kNamedRows) return;
  const Severity severity = badRows_ == BadRows::refuse ? Severity::error : Severity::note;
  findings_.push_back({severity, where_ + ':' + std::to_string(line), column, expected, quoted(cell)});
}

std::string_view Reader::readCell(const std::vector<std::string_view>& cells, const Column& column,
                                  double most, double& value, bool& good) {
  const std::string_view whole = column.place < cells.size() ? cells[column.place] : std::string_view{};
  std::string_view cell = whole;
  if (cell.starts_with('+')) cell.remove_prefix(1);
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  const bool number = error == std::errc{} && end == cell.data() + cell.size() && std::abs(value) <= most;
  if (!number) nameBadCell(line_, column.name, "a finite number", whole);
  good = good && number;
  return whole;
}

void Reader::readRows() {
  std::vector<std::string_view> cells;
  while (!text_.empty()) {
    const std::string_view line = takeLine();
    if (line.empty() || line.front() == '#') continue;
    split(line, cells);
    Row row;
    row.line = line_;
    bool good = true;
    readCell(cells, time_, kLargestS, row.time, good);
    for (std::size_t i = 0; i < kAngles; ++i)
      if (columns_[i]) row.cell[i] = readCell(cells, *columns_[i], kLargestDeg, row.angle[i], good);
    row.time *= timeScale_;
    if (good)
      rows_.push_back(row);
    else
      ++bad_;
  }
}

void Reader::toDegrees() {
  bool unnamed = false, withinTurn = true;
  for (std::size_t i = 0; i < kAngles; ++i) {
    if (!columns_[i] || columns_[i]->unit != Unit::unknown) continue;
    unnamed = true;
    for (const Row& row : rows_) withinTurn = withinTurn && std::abs(row.angle[i]) <= kTurnRad + 1e-3;
  }
  if (unnamed)
    note(withinTurn ? "angles name no unit and none leaves one turn of radians: read as radians"
                    : "angles name no unit and leave a turn of radians: read as degrees");
  for (std::size_t i = 0; i < kAngles; ++i) {
    if (!columns_[i]) continue;
    const Unit unit = columns_[i]->unit;
    if (unit == Unit::degrees || (unit == Unit::unknown && !withinTurn)) continue;
    for (Row& row : rows_) row.angle[i] = Radians{row.angle[i]}.in<Degrees>();
  }
}

void Reader::sort() {
  const auto earlier = [](const Row& a, const Row& b) { return a.time < b.time; };
  std::size_t out = 0;
  for (std::size_t i = 1; i < rows_.size(); ++i) out += rows_[i].time < rows_[i - 1].time;
  if (out > 0) {
    std::stable_sort(rows_.begin(), rows_.end(), earlier);
    findings_.push_back({Severity::warning, where_, "", "times that rise",
                         std::to_string(out) + " rows before the row above them; sorted by time"});
  }
  std::size_t kept = 0;
  for (const Row& row : rows_) {
    if (kept > 0 && rows_[kept - 1].time == row.time) --kept;
    rows_[kept++] = row;
  }
  if (kept < rows_.size())
    note(std::to_string(rows_.size() - kept) + " rows with the time of another: the last of each counts");
  rows_.resize(kept);
}

void Reader::unwind() {
  for (std::size_t angle = 0; angle < kAngles; ++angle) {
    double last = 0;
    for (Row& row : rows_) {
      last += wrapped180(Degrees{row.angle[angle]} - Degrees{last}).value();
      row.angle[angle] = last;
    }
  }
}

std::size_t Reader::rowsBeyondQuarter(std::size_t angle) const {
  return static_cast<std::size_t>(std::count_if(rows_.begin(), rows_.end(), [angle](const Row& row) {
    return std::abs(row.angle[angle]) > kQuarterDeg;
  }));
}

void Reader::exchangeMisnamedColumns() {
  const bool unnamed = columns_[kHeading]->unit == Unit::unknown && columns_[kPitch]->unit == Unit::unknown;
  if (!unnamed || rowsBeyondQuarter(kPitch) <= rowsBeyondQuarter(kHeading)) return;
  for (Row& row : rows_) std::swap(row.angle[kHeading], row.angle[kPitch]);
  pitchColumn_ = kHeading;
  findings_.push_back(
      {Severity::warning, where_, "", "a pitch of -90 to 90 deg in column " + columns_[kPitch]->name,
       "a column that winds further than " + columns_[kHeading]->name + ": the two are exchanged"});
}

bool Reader::dropRowsBeyondQuarter() {
  const std::size_t before = rows_.size();
  std::erase_if(rows_, [this](const Row& row) {
    if (std::abs(row.angle[kPitch]) <= kQuarterDeg) return false;
    nameBadCell(row.line, columns_[pitchColumn_]->name, "a pitch of -90 to 90 deg", row.cell[pitchColumn_]);
    ++bad_;
    return true;
  });
  return rows_.size() < before;
}

bool Reader::badRowsAccepted() {
  if (bad_ == 0) return true;
  const std::string all = std::to_string(rows_.size() + bad_);
  if (bad_ > kNamedRows) note("and " + std::to_string(bad_ - kNamedRows) + " more rows like these");
  if (badRows_ == BadRows::refuse) {
    refusal("rows that can all be used", std::to_string(bad_) + " bad rows of " + all);
    return false;
  }
  if (bad_ >= rows_.size()) {
    refusal("more rows that can be used than bad ones", std::to_string(bad_) + " bad rows of " + all);
    return false;
  }
  findings_.push_back({Severity::warning, where_, "", "rows that can all be used",
                       std::to_string(bad_) + " bad rows of " + all + ": they are left out"});
  return true;
}

Result<HeadLog> Reader::finished() {
  HeadLog log;
  log.name = std::filesystem::path(where_).filename().string();
  log.gapS = kHeadLogGapS;
  log.rowsLeftOut = bad_;
  double longest = 0;
  std::size_t gaps = 0;
  for (const Row& row : rows_) {
    // Radians and unwinding round, so that a pitch of a quarter turn may pass it by a little.
    const HeadSample sample{row.time - rows_.front().time, row.angle[kHeading],
                            limits::clampedPitch(row.angle[kPitch]), row.angle[kRoll]};
    if (!log.samples.empty() && sample.timeS - log.samples.back().timeS > log.gapS) {
      ++gaps;
      longest = std::max(longest, sample.timeS - log.samples.back().timeS);
    }
    log.samples.push_back(sample);
  }
  if (gaps > 0) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "%zu gaps of more than %.0f ms, the longest of %.0f ms: the head is held in them", gaps,
                  log.gapS * 1e3, longest * 1e3);
    note(text);
  }
  return {std::move(log), std::move(findings_)};
}

}  // namespace

Result<HeadLog> parseHeadLog(std::string_view text, const std::string& where, BadRows badRows) {
  return Reader(withoutByteOrderMark(text), where, badRows).read();
}

Result<HeadLog> readHeadLog(const std::filesystem::path& file, BadRows badRows) {
  return withinMemory(file, [&]() -> Result<HeadLog> {
    const Result<std::string> text = readWhole(file, kLargestRecording);
    if (!text) return text.findings();
    return parseHeadLog(*text, file.string(), badRows);
  });
}

}  // namespace trimtab
