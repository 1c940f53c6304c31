#pragma once

#include <cstdint>
#include <optional>

namespace trimtab {

/// Tracks order and loss of a host's 32-bit frame numbers.
class FrameOrder {
 public:
  enum class Verdict {
    next,        ///< newer than all before; skipped numbers are lost until they arrive
    repeated,    ///< seen before
    reordered,   ///< older than one already seen, but new
    restarted,   ///< the host counts anew
    uncounted,   ///< the number has stood still for too long: the host does not count
    implausible  ///< far from all others: damaged, or the first of a new count, which the next one confirms
  };
  /// If `mayRestart` (after a silence), any older number restarts, and one far away is believed at
  /// once.
  Verdict accept(std::uint32_t frame, bool mayRestart);
  std::optional<std::uint32_t> last() const { return last_; }
  std::uint64_t lost() const { return lost_; }
  /// Returns how many numbers were implausible and were not confirmed by a later one.
  std::uint64_t implausible() const { return implausible_; }
  /// Returns how far ahead the last `next` was: 1 without loss.
  std::uint32_t step() const { return step_; }

 private:
  Verdict judge(std::uint32_t frame, bool mayRestart);
  Verdict restart(std::uint32_t frame);
  Verdict advance(std::uint32_t frame, std::int64_t ahead);
  /// Judges a number that is far from the last one. One damaged number must neither count as thousands of
  /// lost frames nor as a new count, so it needs a second one that follows it.
  Verdict judgeFar(std::uint32_t frame, std::int64_t ahead, bool mayRestart);

  std::optional<std::uint32_t> last_;
  std::optional<std::uint32_t> newest_;  ///< the last number that came, whatever it was
  int still_ = 0;                        ///< how often it has come again, in a row
  std::uint64_t seen_ = 0;               ///< bit n: frame last_ - n has come
  std::uint32_t step_ = 1;
  std::uint64_t lost_ = 0, implausible_ = 0;
  std::optional<std::uint32_t> doubted_;  ///< the last implausible number, until one follows it
  std::uint32_t older_ = 0;               ///< the last older number that came
  int olderInARow_ = 0;                   ///< older numbers that rise one by one: a host that counts anew
};

}  // namespace trimtab
