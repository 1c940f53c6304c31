#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/decision/decide.h"
#include "trimtab/frame/frame.h"
#include "trimtab/frame/hold_decision.h"
#include "trimtab/units/result.h"

/// Writes and reads decision traces: CSV with one row per decided packet. The first columns are those of a
/// flight, so that a trace can be flown again. Every number reads back bit for bit, so that a row can be
/// decided again and compared exactly.
namespace trimtab {

/// Counts what a frame drew and left out.
struct TraceCounts {
  std::uint64_t triangles = 0, vertices = 0;
  std::uint64_t tilesDrawn = 0, culledFrustum = 0, culledOccluded = 0, culledBeyondVisibility = 0,
                culledBackFacing = 0;
  std::uint64_t objectsDrawn = 0, objectsOccluded = 0;  ///< instances of what stands on the ground

  friend bool operator==(const TraceCounts&, const TraceCounts&) = default;
};

struct FrameResult;
/// Returns the counts of an image.
TraceCounts countsOf(const FrameResult& drawn);

/// The frame that showed a decision. A packet that another one overtook before the image has none.
struct TraceFrame {
  TraceCounts counts;
  FrameCost cost;
};

/// One decision. `input.aboveGround` is the height above ground that it used; the reader puts it into
/// `input.state` too, so that a replay does not ask the terrain. `before` is the memory that decide() was
/// called with.
struct TraceRow {
  FrameInput input;
  DecisionMemory before;
  FrameDecision decision;
  LeverChain levers{};  ///< of that frame, or of the decision if no frame showed it
  std::optional<TraceFrame> frame{};
  std::optional<HoldDecision> hold{};  ///< of that frame, if its budget was held
};

/// Returns the column names, separated by commas, without a line end.
std::string traceHeader();
/// Appends one row with its line end. It allocates only what `text` needs to grow.
void appendTraceRow(std::string& text, const TraceRow& row);

/// Reads a trace. Columns are found by name, in any order, and unknown ones are ignored. Every bad cell is a
/// finding with its line and column; at most 50 are listed.
Result<std::vector<TraceRow>> readTrace(const std::filesystem::path& file);
Result<std::vector<TraceRow>> parseTrace(std::string_view text, const std::string& where);
/// Reports whether the first line of a text is the header of a trace; unlike a flight's it has the columns
/// `packet` and `total_membership`.
bool isTrace(std::string_view text);
/// Reports the same of a file; false if it cannot be read.
bool isTraceFile(const std::filesystem::path& file);

/// A row that is decided differently when it is decided again.
struct TraceDifference {
  std::size_t row = 0;
  FrameDecision recorded, decided;
};
/// Decides every row again from the memory that it was decided with, and compares exactly. Returns the rows
/// that differ. What the budget lowered depended on the machine, so that is replayed and not decided again.
std::vector<TraceDifference> decideAgain(const std::vector<TraceRow>& trace,
                                         const ValidatedParameters& parameters);

/// Return the names as traces, the command line and docks spell them.
std::string_view toText(Scheme scheme);
std::string_view toText(SchemeReason reason);

}  // namespace trimtab
