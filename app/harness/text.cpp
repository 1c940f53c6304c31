#include "text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "answer.h"

namespace trimtab::harness {
namespace {

using Row = std::vector<std::string>;

std::string fixed(double value, int decimals) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

/// Names to the left, numbers to the right.
void append(std::string& text, const std::vector<Row>& rows, std::size_t names) {
  std::vector<std::size_t> width;
  for (const Row& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c >= width.size()) width.push_back(0);
      width[c] = std::max(width[c], row[c].size());
    }
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string blanks(width[c] - row[c].size(), ' ');
      line += (c == 0 ? "" : "  ") + (c < names ? row[c] + blanks : blanks + row[c]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
}

Row ratioRow(Row names, const PairedRatio& ratio) {
  names.insert(names.end(), {fixed(ratio.median, 3), fixed(ratio.low, 3) + " to " + fixed(ratio.high, 3),
                             std::to_string(ratio.pairs), inWords(ratio)});
  return names;
}

void appendRows(std::vector<Row>& rows, const Results& results, const Answer& answer) {
  std::size_t at = 0;
  for (const Unit& unit : results.units) {
    if (unit.name.flight != answer.flight) continue;
    const AnswerRow& row = answer.rows[at];
    const auto of = [&unit](const char* key) { return summarise(unit, *quantityOf(key)); };
    double wrong = 0;
    for (const MeasuredFrame& frame : unit.frames)
      wrong += static_cast<double>(frame.error.wronglyCulledPixels);
    rows.push_back({unit.name.flight, unit.name.preset, unit.name.method, std::to_string(unit.frames.size()),
                    fixed(row.medianMs, 2), fixed(row.p95Ms, 2), boundsText(row.p95BoundsMs),
                    fixed(row.p99Ms, 2), fixed(row.overShare * 100, 1), fixed(of("triangles").mean, 0),
                    fixed(row.flip, 5), fixed(of("flip").worst, 5), fixed(row.geometricPx, 2),
                    fixed(row.pop, 2), fixed(wrong, 0), verdictText(answer, at)});
    ++at;
  }
}

/// Appends a line for each skip, over all units; the document has each unit's.
void appendSkips(std::string& text, const std::vector<Unit>& units) {
  struct Total {
    std::string name;
    std::uint64_t skipped = 0, frames = 0;
    std::vector<double> savedMs;
  };
  std::vector<Total> totals;
  for (const Unit& unit : units)
    for (const SkipSaving& skip : unit.skips) {
      auto at = std::find_if(totals.begin(), totals.end(),
                             [&skip](const Total& total) { return total.name == skip.name; });
      if (at == totals.end()) at = totals.insert(at, {skip.name, 0, 0, {}});
      at->skipped += skip.skipped;
      at->frames += skip.frames;
      if (std::isfinite(skip.savedMs)) at->savedMs.push_back(skip.savedMs);
    }
  std::vector<Row> rows{{"skipped work", "frames", "saved ms (median of units)"}};
  for (Total& total : totals) {
    if (total.skipped == 0) continue;
    std::sort(total.savedMs.begin(), total.savedMs.end());
    rows.push_back({total.name, std::to_string(total.skipped) + " of " + std::to_string(total.frames),
                    total.savedMs.empty() ? "-" : fixed(total.savedMs[(total.savedMs.size() - 1) / 2], 3)});
  }
  if (rows.size() == 1) return;
  text += '\n';
  append(text, rows, 1);
}

}  // namespace

std::string toText(const Results& results) {
  std::string text = results.terrain + ", " + std::to_string(results.widthPx) + "x" +
                     std::to_string(results.heightPx) + ", " + std::to_string(results.repeats) +
                     (results.repeats == 1 ? " draw" : " draws") + " a frame; " + results.machine + "\n\n";
  std::vector<Row> rows{{"flight", "preset", "case", "frames", "median ms", "p95 ms", "of the flight",
                         "p99 ms", "over budget %", "triangles", "FLIP", "worst FLIP", "geometric px", "pop",
                         "wrongly culled px", "verdict"}};
  const std::vector<Answer> answers = answersOf(results);
  for (const Answer& answer : answers) appendRows(rows, results, answer);
  append(text, rows, 3);
  text +=
      "Triangles and FLIP are means, geometric px the largest of all frames, pop (of 255) its p95, wrongly "
      "culled px their sum. A p95 needs 20 frames and a p99 100. Each bound of the flight's p95 is sure by "
      "95 %; "
      "a preset fits if that p95 is surely within the budget.\n";
  for (const Answer& answer : answers) text += '\n' + answer.flight + ": " + answer.why + '\n';
  if (!results.comparisons.empty()) {
    rows = {{"flight", "this", "", "over that", "", "frame time", "95 %", "frames", "so it is"}};
    for (const Comparison& c : results.comparisons)
      rows.push_back(ratioRow({c.b.flight, c.b.preset, c.b.method, c.a.preset, c.a.method}, c.frameTime));
    text += '\n';
    append(text, rows, 5);
  }
  appendSkips(text, results.units);
  for (const std::string& note : results.notes) text += "\n* " + note;
  return text + '\n';
}

}  // namespace trimtab::harness
