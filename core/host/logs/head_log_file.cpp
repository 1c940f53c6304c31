#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "core/host/limits.h"
#include "delimited_text.h"
#include "head_columns.h"
#include "log_angles.h"
#include "log_time.h"
#include "trimtab/host/head_log.h"
#include "trimtab/preset/file_io.h"

namespace trimtab {
namespace {

/// Bad rows that findings name one by one; the rest are counted.
constexpr std::size_t kNamedRows = 10;
constexpr double kQuarterDeg = 90 + 1e-4;
constexpr double kLargestDeg = 1e6;
/// Trackers give 2,000 samples a second to one in two seconds. A head may rest, and turns at most so fast.
constexpr LogMotion kHeadMotion{0.0005, 2, 0, 3000};

class Reader {
 public:
  Reader(std::string_view text, const std::string& where, BadRows badRows, const ColumnMap& map)
      : table_(text, where), where_(where), badRows_(badRows), map_(map) {}

  Result<HeadLog> read() {
    if (!table_.open(findings_)) return findings_;
    columns_ = headColumns(table_, map_, findings_);
    if (hasError(findings_)) return findings_;
    readRows();
    if (rows_.empty() && bad_ == 0) return refusal("at least one row below the header", "none");
    if (!toDegrees()) return findings_;
    sort();
    unwind();
    exchangeMisnamedColumns();
    // A row beyond a quarter turn may have wound those behind it: without it they are unwound once more.
    while (dropRowsBeyondQuarter()) unwind();
    if (!badRowsAccepted() || !toSeconds()) return findings_;
    return finished();
  }

 private:
  static constexpr std::size_t kHeading = HeadColumns::kHeading, kPitch = HeadColumns::kPitch,
                               kRoll = HeadColumns::kRoll, kAngles = HeadColumns::kAngles;

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

  void readRows();
  void readTime(Row& row, bool& good);
  void readQuaternion(Row& row, bool& good);
  std::string_view readCell(const LogColumn& column, double most, double& value, bool& good);
  void nameBadCell(std::size_t line, const std::string& column, std::string expected, std::string found);
  bool toDegrees();
  bool toSeconds();
  void sort();
  void unwind();
  std::size_t rowsBeyondQuarter(std::size_t angle) const;
  void exchangeMisnamedColumns();
  bool dropRowsBeyondQuarter();
  bool badRowsAccepted();
  Result<HeadLog> finished();

  DelimitedText table_;
  const std::string& where_;
  const BadRows badRows_;
  const ColumnMap& map_;
  std::size_t bad_ = 0;
  Findings findings_;
  HeadColumns columns_;
  bool clock_ = false;
  double elapsed_ = 0;                ///< of time steps
  std::size_t pitchColumn_ = kPitch;  ///< the column that holds the pitch, whatever its name
  std::vector<Row> rows_;
};

/// Names the cells of the first bad rows.
void Reader::nameBadCell(std::size_t line, const std::string& column, std::string expected,
                         std::string found) {
  if (bad_ >= kNamedRows) return;
  const Severity severity = badRows_ == BadRows::refuse ? Severity::error : Severity::note;
  findings_.push_back(
      {severity, where_ + ':' + std::to_string(line), column, std::move(expected), std::move(found)});
}

std::string_view Reader::readCell(const LogColumn& column, double most, double& value, bool& good) {
  const std::string_view cell = column.cell(table_.cells());
  const auto number = table_.number(cell);
  value = column.quantity(number.value_or(0));
  const bool finite = number && std::abs(value) <= most;
  if (!finite) nameBadCell(table_.line(), column.name, "a finite number", cellText(cell));
  good = good && finite;
  return cell;
}

/// Reads a number, a clock, or the time since the row above.
void Reader::readTime(Row& row, bool& good) {
  const std::string_view cell = columns_.time->cell(table_.cells());
  if (rows_.empty() && bad_ == 0) clock_ = readClock(cell).has_value();
  if (clock_) {
    const auto time = readClock(cell);
    if (!time)
      nameBadCell(row.line, columns_.time->name, "a time of a clock, as in the first row", cellText(cell));
    good = good && time.has_value();
    row.time = time.value_or(0) + elapsed_;
    if (good && !rows_.empty()) elapsed_ += dayAfter(rows_.back().time, row.time);
    row.time = time.value_or(0) + elapsed_;
    return;
  }
  readCell(*columns_.time, kLargestTime, row.time, good);
  if (columns_.timeIsStep && good) row.time = elapsed_ += row.time;
}

/// Reads an attitude as a quaternion on the axes forward, right and down. Its length does not matter.
void Reader::readQuaternion(Row& row, bool& good) {
  std::array<double, 4> q{};
  for (std::size_t i = 0; i < q.size(); ++i) readCell(*columns_.quaternion[i], kLargestDeg, q[i], good);
  const auto [w, x, y, z] = q;
  const double square = w * w + x * x + y * y + z * z;
  if (good && !(square > 0)) {
    nameBadCell(row.line, columns_.quaternion[0]->name, "a rotation", "a quaternion of length 0");
    good = false;
  }
  if (!good) return;
  const auto degrees = [](double radians) { return Radians{radians}.in<Degrees>(); };
  row.angle[kHeading] = degrees(std::atan2(2 * (w * z + x * y), square - 2 * (y * y + z * z)));
  row.angle[kPitch] = degrees(std::asin(std::clamp(2 * (w * y - z * x) / square, -1.0, 1.0)));
  row.angle[kRoll] = degrees(std::atan2(2 * (w * x + y * z), square - 2 * (x * x + y * y)));
}

void Reader::readRows() {
  while (table_.nextRow()) {
    Row row;
    row.line = table_.line();
    bool good = table_.rowFits();
    if (good) {
      readTime(row, good);
      if (columns_.quaternion[0]) readQuaternion(row, good);
      for (std::size_t i = 0; i < kAngles && !columns_.quaternion[0]; ++i)
        if (columns_.angles[i]) row.cell[i] = readCell(*columns_.angles[i], kLargestDeg, row.angle[i], good);
    } else {
      nameBadCell(row.line, "", std::to_string(table_.header().size()) + " cells, as the header",
                  std::to_string(table_.cells().size()));
    }
    if (good)
      rows_.push_back(row);
    else
      ++bad_;
  }
}

bool Reader::toDegrees() {
  if (columns_.quaternion[0]) return true;
  UnnamedAngles unnamed;
  for (std::size_t i = 0; i < kAngles; ++i) {
    if (!columns_.angles[i] || columns_.angles[i]->unit != Unit::none) continue;
    // Headers mislead: the heading may be the pitch.
    if (i != kRoll) unnamed.maybePitch.push_back(unnamed.names.size());
    unnamed.names.push_back(columns_.angles[i]->name);
    unnamed.quantities.emplace_back(HeadColumns::kAngleNames[i]);
    auto& column = unnamed.columns.emplace_back();
    for (const Row& row : rows_) column.push_back(row.angle[i]);
  }
  const Unit found = unnamed.names.empty() ? Unit::degrees : angleUnit(unnamed, where_, findings_);
  if (found == Unit::none) return false;
  for (std::size_t i = 0; i < kAngles; ++i) {
    if (!columns_.angles[i]) continue;
    const Unit unit = columns_.angles[i]->unit == Unit::none ? found : columns_.angles[i]->unit;
    if (unit != Unit::radians) continue;
    for (Row& row : rows_) row.angle[i] = Radians{row.angle[i]}.in<Degrees>();
  }
  return true;
}

/// Finds the unit of times from how far the head turns between rows.
bool Reader::toSeconds() {
  std::vector<double> times, moved;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    times.push_back(rows_[i].time);
    if (i == 0) continue;
    const auto& a = rows_[i - 1].angle;
    const auto& b = rows_[i].angle;
    moved.push_back(std::hypot(b[kHeading] - a[kHeading], b[kPitch] - a[kPitch]));
  }
  const TimeReading reading =
      timeReading({columns_.time->name, columns_.time->unit, clock_}, times, moved, kHeadMotion, where_);
  findings_.insert(findings_.end(), reading.findings.begin(), reading.findings.end());
  const double begin = reading.fromFirst && !times.empty() ? times.front() : 0;
  for (Row& row : rows_) row.time = (row.time - begin) * reading.scale;
  return !hasError(reading.findings);
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
  const bool unnamed = !columns_.quaternion[0] && columns_.angles[kHeading]->unit == Unit::none &&
                       columns_.angles[kPitch]->unit == Unit::none;
  if (!unnamed || rowsBeyondQuarter(kPitch) <= rowsBeyondQuarter(kHeading)) return;
  for (Row& row : rows_) std::swap(row.angle[kHeading], row.angle[kPitch]);
  pitchColumn_ = kHeading;
  findings_.push_back(
      {Severity::warning, where_, "", "a pitch of -90 to 90 deg in column " + columns_.angles[kPitch]->name,
       "a column that winds further than " + columns_.angles[kHeading]->name + ": the two are exchanged"});
}

bool Reader::dropRowsBeyondQuarter() {
  const std::size_t before = rows_.size();
  std::erase_if(rows_, [this](const Row& row) {
    if (std::abs(row.angle[kPitch]) <= kQuarterDeg) return false;
    nameBadCell(row.line,
                columns_.quaternion[0] ? columns_.quaternion[0]->name : columns_.angles[pitchColumn_]->name,
                "a pitch of -90 to 90 deg", cellText(row.cell[pitchColumn_]));
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

Result<HeadLog> parseHeadLog(std::string_view text, const std::string& where, BadRows badRows,
                             const ColumnMap& columns) {
  return Reader(text, where, badRows, columns).read();
}

Result<HeadLog> readHeadLog(const std::filesystem::path& file, BadRows badRows, const ColumnMap& columns) {
  return withinMemory(file, [&]() -> Result<HeadLog> {
    const Result<std::string> text = readWhole(file, kLargestRecording);
    if (!text) return text.findings();
    return parseHeadLog(*text, file.string(), badRows, columns);
  });
}

}  // namespace trimtab
