#include "frame_order.h"

namespace trimtab {
namespace {

constexpr std::int64_t kWindow = 64;  // how far back a late packet can still be told from a repeated one, and
                                      // how far ahead a number is believed without another one
constexpr std::int64_t kLongestOutage = 36000;  // ten minutes at 60 Hz; more is another count, not loss
constexpr int kRestartAfterSeen = 5, kRestartAfterNew = 15;
// Networks repeat a datagram once or twice. A number that comes so often again is no count.
constexpr int kStandsAfter = 5;

}  // namespace

FrameOrder::Verdict FrameOrder::restart(std::uint32_t frame) {
  last_ = frame;
  seen_ = 1;
  step_ = 1;
  olderInARow_ = 0;
  doubted_.reset();
  return Verdict::restarted;
}

FrameOrder::Verdict FrameOrder::advance(std::uint32_t frame, std::int64_t ahead) {
  seen_ = ahead < kWindow ? (seen_ << ahead) | 1 : 1;
  lost_ += static_cast<std::uint64_t>(ahead - 1);
  step_ = static_cast<std::uint32_t>(ahead);
  last_ = frame;
  olderInARow_ = 0;
  doubted_.reset();
  return Verdict::next;
}

FrameOrder::Verdict FrameOrder::judgeFar(std::uint32_t frame, std::int64_t ahead, bool mayRestart) {
  const bool outage = ahead > 0 && ahead <= kLongestOutage;
  if (mayRestart) return outage ? advance(frame, ahead) : restart(frame);
  if (doubted_) {
    const std::int64_t after = static_cast<std::int32_t>(frame - *doubted_);
    if (after == 0) return Verdict::repeated;
    if (after > 0 && after < kWindow) {
      --implausible_;
      if (!outage) return restart(frame);
      // The doubted one came, though it was not used.
      const Verdict verdict = advance(frame, ahead);
      seen_ |= std::uint64_t{1} << after;
      --lost_;
      return verdict;
    }
  }
  doubted_ = frame;
  ++implausible_;
  return Verdict::implausible;
}

FrameOrder::Verdict FrameOrder::accept(std::uint32_t frame, bool mayRestart) {
  still_ = newest_ == frame ? still_ + 1 : 0;
  newest_ = frame;
  if (still_ < kStandsAfter) return judge(frame, mayRestart);
  // The first one after a count that was left is a new beginning.
  if (last_ == frame) return Verdict::uncounted;
  if (doubted_ == frame) --implausible_;
  return restart(frame);
}

FrameOrder::Verdict FrameOrder::judge(std::uint32_t frame, bool mayRestart) {
  if (!last_) {
    restart(frame);
    return Verdict::next;
  }
  const std::int64_t ahead = static_cast<std::int32_t>(frame - *last_);
  if (ahead >= kWindow || ahead <= -kWindow) return judgeFar(frame, ahead, mayRestart);
  if (ahead > 0) return advance(frame, ahead);
  if (mayRestart && ahead < 0) return restart(frame);
  const std::uint64_t bit = std::uint64_t{1} << -ahead;
  const bool repeated = (seen_ & bit) != 0;
  if (ahead < 0) {
    olderInARow_ = olderInARow_ > 0 && frame - older_ == 1 ? olderInARow_ + 1 : 1;
    older_ = frame;
    // Late packets come alone or fill a hole; numbers that rise and rise again are a new count.
    if (olderInARow_ >= (repeated ? kRestartAfterSeen : kRestartAfterNew)) return restart(frame);
  }
  if (repeated) return Verdict::repeated;
  seen_ |= bit;
  if (lost_ > 0) --lost_;
  return Verdict::reordered;
}

}  // namespace trimtab
