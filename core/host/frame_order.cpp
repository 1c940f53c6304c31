#include "frame_order.h"

namespace trimtab {
namespace {

constexpr std::int64_t kWindow = 64;  // how far back a late packet can still be told from a repeated one
constexpr std::int64_t kLongestOutage = 36000;  // ten minutes at 60 Hz; more is another count, not loss
constexpr int kRestartAfterSeen = 5, kRestartAfterNew = 15;

}  // namespace

FrameOrder::Verdict FrameOrder::restart(std::uint32_t frame) {
  last_ = frame;
  seen_ = 1;
  step_ = 1;
  olderInARow_ = 0;
  return Verdict::restarted;
}

FrameOrder::Verdict FrameOrder::accept(std::uint32_t frame, bool mayRestart) {
  if (!last_) {
    restart(frame);
    return Verdict::next;
  }
  const std::int64_t ahead = static_cast<std::int32_t>(frame - *last_);
  if (ahead > kLongestOutage) return restart(frame);
  if (ahead > 0) {
    seen_ = ahead < kWindow ? (seen_ << ahead) | 1 : 1;
    lost_ += static_cast<std::uint64_t>(ahead - 1);
    step_ = static_cast<std::uint32_t>(ahead);
    last_ = frame;
    olderInARow_ = 0;
    return Verdict::next;
  }
  if (ahead <= -kWindow || (mayRestart && ahead < 0)) return restart(frame);
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
