#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace trimtab::scene {

/// Measures spans of a frame on the GPU by time stamps, which it reads some frames later without waiting.
/// Spans may lie in one another. The context must be current for all of its life.
class GpuTimer {
 public:
  explicit GpuTimer(std::size_t spans);
  ~GpuTimer();
  GpuTimer(const GpuTimer&) = delete;
  GpuTimer& operator=(const GpuTimer&) = delete;

  void beginFrame();
  void begin(std::size_t span);
  void end(std::size_t span);
  void endFrame();
  /// Returns the milliseconds of a span in the newest frame whose stamps have arrived; NaN if that frame had
  /// no such span, and before the first.
  double milliseconds(std::size_t span) const { return milliseconds_[span]; }
  /// Reads the stamps that have arrived; beginFrame() calls it.
  void collect();

 private:
  struct Span {
    unsigned begin = 0, end = 0;
    bool ended = false;
  };
  struct Frame {
    std::vector<Span> spans;
    unsigned last = 0;  ///< query; 0: nothing was stamped
    bool pending = false;
  };
  std::array<Frame, 4> frames_;
  std::size_t next_ = 0;
  std::vector<double> milliseconds_;
  bool open_ = false;
};

}  // namespace trimtab::scene
