#pragma once

#include <cstdint>
#include <optional>

namespace trimtab {

/// Tracks order and loss of a host's 32-bit frame numbers.
class FrameOrder {
 public:
  enum class Verdict {
    next,       ///< newer than all before; skipped numbers are lost until they arrive
    repeated,   ///< seen before
    reordered,  ///< older than one already seen, but new
    restarted   ///< the host counts anew
  };
  /// If `mayRestart` (other sender, or silence), any older number restarts; else one 64 back does.
  Verdict accept(std::uint32_t frame, bool mayRestart);
  std::optional<std::uint32_t> last() const { return last_; }
  std::uint64_t lost() const { return lost_; }
  /// Returns how far ahead the last `next` was: 1 without loss.
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
