#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/decision/decide.h"
#include "trimtab/frame/frame.h"
#include "trimtab/units/result.h"

/// The decision trace: a CSV with one row a decided packet. Its first columns are those of a flight, so that
/// a trace flies again; every number reads back bit for bit, so that what was decided can be decided again
/// and compared exactly.
namespace trimtab {

/// What a frame drew and left out.
struct TraceCounts {
  std::uint64_t triangles = 0, vertices = 0;
  std::uint64_t tilesDrawn = 0, culledFrustum = 0, culledOccluded = 0, culledBeyondVisibility = 0,
                culledBackFacing = 0;

  friend bool operator==(const TraceCounts&, const TraceCounts&) = default;
};

/// The frame that showed a decision. A packet that another one overtook before it was drawn has none.
struct TraceFrame {
  TraceCounts counts;
  FrameCost cost;
};

/// `input.aboveGround` is the height above ground that the decision used; the reader gives it to
/// `input.state` too, so that a replay does not ask the terrain. `before` is the memory that decide() was
/// called with.
struct TraceRow {
  FrameInput input;
  DecisionMemory before;
  FrameDecision decision;
  std::optional<TraceFrame> frame;
};

/// The column names, comma-separated, without a line end.
std::string traceHeader();
/// Appends one line with its line end. Allocates only what `text` needs to grow.
void appendTraceRow(std::string& text, const TraceRow& row);

/// Writes rows to a file as they come; what was written stays when the program dies. `close` tells whether
/// all of it reached the disk.
class TraceWriter {
 public:
  static Result<TraceWriter> open(const std::filesystem::path& file);
  void write(const TraceRow& row);
  Result<Done> close();

 private:
  TraceWriter(std::filesystem::path file, std::ofstream stream);
  std::filesystem::path file_;
  std::ofstream stream_;
  std::string line_;
};

/// Columns by name, in any order; columns this version does not know are passed over. Every bad cell is a
/// finding with its line and column (at most 50 are listed).
Result<std::vector<TraceRow>> readTrace(const std::filesystem::path& file);
Result<std::vector<TraceRow>> parseTrace(std::string_view text, const std::string& where);
/// Whether a text's first line is a trace's header: told from a flight's by its columns `packet` and
/// `total_membership`.
bool isTrace(std::string_view text);

/// A row whose decision comes out differently when it is decided again.
struct TraceDifference {
  std::size_t row = 0;
  FrameDecision recorded, decided;
};
/// Decides every row again from the memory it was decided with; exact comparison. Empty when all agree.
std::vector<TraceDifference> decideAgain(const std::vector<TraceRow>& trace,
                                         const ValidatedParameters& parameters);

/// Names as trace, command line and docks spell them.
std::string_view toText(Scheme scheme);
std::string_view toText(SchemeReason reason);

}  // namespace trimtab
