#pragma once

#include <cstdint>
#include <optional>

namespace trimtab {

/// Order and loss from a host's frame numbers, which wrap at 2^32.
class FrameOrder {
 public:
  enum class Verdict {
    next,       ///< newer than all before; what lies between is lost until it turns up
    repeated,   ///< seen before
    reordered,  ///< older than one already seen, but new
    restarted   ///< the host counts anew
  };
  /// `mayRestart`: the sender changed or was silent, so an older number means a new count at once.
  Verdict accept(std::uint32_t frame, bool mayRestart);
  std::optional<std::uint32_t> last() const { return last_; }
  std::uint64_t lost() const { return lost_; }
  /// Frames from the one before the last `next` to it: 1 without loss.
  std::uint32_t step() const { return step_; }

 private:
  Verdict restart(std::uint32_t frame);

  std::optional<std::uint32_t> last_;
  std::uint64_t seen_ = 0;  ///< bit n: frame last_ - n has come
  std::uint32_t step_ = 1;
  std::uint64_t lost_ = 0;
  std::uint32_t older_ = 0;  ///< the last older number that came
  int olderInARow_ = 0;      ///< older numbers that rise one by one: a host that counts anew
};

}  // namespace trimtab
