#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "trimtab/frame/frame_result.h"
#include "trimtab/measure/trace.h"
#include "trimtab/session/latency.h"

namespace trimtab {

/// Keeps the books of the images: the rows of the trace that each image shows, the latencies of the packets
/// in it, and what it cost, which the next decision uses. Each image is requested, then finished, before the
/// next one is requested. Times are seconds of CLOCK_REALTIME.
class FrameBook {
 public:
  /// Begins anew, but keeps all rows, as complete ones.
  void restart();

  void keepRows(bool keep) { keepRows_ = keep; }
  bool keepsRows() const { return keepRows_; }
  /// Adds a row, which the next image that is requested completes.
  void add(TraceRow row) { rows_.push_back(std::move(row)); }
  /// Moves the complete rows to the end of `rows`, in order; with `all`, also those that no image has shown.
  void takeRows(std::vector<TraceRow>& rows, bool all);

  /// Adds to what the next image pays for decisions, milliseconds.
  void decisionTook(double ms) { decideMs_ += ms; }
  void packetDecoded(double kernelTime, double decodedTime) { latency_.decoded(kernelTime, decodedTime); }
  void packetArrived(double kernelTime) { latency_.arrived(kernelTime); }

  /// Returns the row that the image being requested will show; null if none is kept.
  TraceRow* nextRow() { return rows_.size() > completeRows_ ? &rows_.back() : nullptr; }
  /// Notes that the image requested at `now` shows all rows and packets so far.
  void requested(double now);
  /// Returns what the image that was requested last costs, with `decide` filled in.
  FrameCost costOf(const FrameResult& result) const;
  /// Completes the row, the latencies and the cost of the image that was requested last.
  void finished(const FrameResult& result, double now, double budgetMs);
  /// Notes that no image will show what has arrived and was decided.
  void dropped();

  const Latency& latency() const { return latency_.latency(); }
  const FrameCost& lastCost() const { return lastCost_; }
  std::optional<std::uint64_t> lastVertices() const { return lastVertices_; }
  /// Returns how many finished images took longer than their budget.
  std::uint64_t overBudget() const { return overBudget_; }

 private:
  bool keepRows_ = false;
  std::vector<TraceRow> rows_;
  std::size_t completeRows_ = 0, requestedRows_ = 0;
  LatencyMeter latency_;
  FrameCost lastCost_;
  std::optional<std::uint64_t> lastVertices_;    ///< of the last finished image
  double decideMs_ = 0, requestedDecideMs_ = 0;  ///< spent since the last request, and on the image requested
  std::uint64_t overBudget_ = 0;
};

}  // namespace trimtab
