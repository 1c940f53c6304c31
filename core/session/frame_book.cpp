#include "trimtab/session/frame_book.h"

#include <iterator>
#include <utility>

namespace trimtab {

void FrameBook::restart() {
  FrameBook fresh;
  fresh.keepRows_ = keepRows_;
  fresh.rows_ = std::move(rows_);
  fresh.completeRows_ = fresh.requestedRows_ = fresh.rows_.size();
  *this = std::move(fresh);
}

void FrameBook::takeRows(std::vector<TraceRow>& rows, bool all) {
  if (all) completeRows_ = requestedRows_ = rows_.size();
  const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(completeRows_);
  rows.insert(rows.end(), std::make_move_iterator(rows_.begin()), std::make_move_iterator(end));
  rows_.erase(rows_.begin(), end);
  requestedRows_ -= completeRows_;
  completeRows_ = 0;
}

void FrameBook::requested(double now) {
  latency_.requested(now);
  requestedDecideMs_ += std::exchange(decideMs_, 0);
  requestedRows_ = rows_.size();
}

FrameCost FrameBook::costOf(const FrameResult& result) const {
  FrameCost cost = result.cost;
  cost.decide = requestedDecideMs_;
  cost.total += requestedDecideMs_;
  return cost;
}

void FrameBook::finished(const FrameResult& result, double now, double budgetMs) {
  lastCost_ = costOf(result);
  requestedDecideMs_ = 0;
  lastVertices_ = result.visible.vertices;
  overBudget_ += lastCost_.total > budgetMs;
  latency_.finished(now);
  if (requestedRows_ > completeRows_) {
    rows_[requestedRows_ - 1].frame = TraceFrame{countsOf(result), lastCost_};
    completeRows_ = requestedRows_;
  }
}

void FrameBook::dropped() {
  latency_.dropped();
  decideMs_ = requestedDecideMs_ = 0;
  completeRows_ = requestedRows_ = rows_.size();
}

}  // namespace trimtab
