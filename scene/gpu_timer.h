#pragma once

#include <array>
#include <cstddef>

namespace trimtab::scene {

/// GPU milliseconds of a frame from time stamps, read some frames later: it never waits.
class GpuTimer {
 public:
  GpuTimer();
  ~GpuTimer();
  GpuTimer(const GpuTimer&) = delete;
  GpuTimer& operator=(const GpuTimer&) = delete;

  void begin();
  void end();
  /// Of the newest frame whose stamps have arrived; NaN before the first.
  double milliseconds() const { return milliseconds_; }

 private:
  void collect();
  struct Frame {
    unsigned begin = 0, end = 0;
    bool pending = false;
  };
  std::array<Frame, 4> frames_;
  std::size_t next_ = 0;
  double milliseconds_;
  bool open_ = false;
};

}  // namespace trimtab::scene
