#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/host/frame_order.h"
#include "core/host/rate_meter.h"
#include "core/measure/trace_cells.h"
#include "quad.h"
#include "table.h"
#include "trimtab/host/decoder.h"
#include "trimtab/host/encoder.h"
#include "trimtab/measure/statistics.h"
#include "trimtab/motion/head_motion.h"

/// A day at 60 Hz: 5.2 million frames, begun at 0 and at the clocks that hosts have (seconds since 1970).
namespace trimtab::stress {
namespace {

constexpr double kEpoch = 1.7e9;
/// Half an ulp of a time since 1970: how far a double's time stamp is off by itself.
constexpr double kEpochU = 0x1p-23;

std::uint64_t frames() {
  return 60ull * 3600 * 24;
}
double timeOf(double begin, std::uint64_t frame) {
  return begin + static_cast<double>(frame) / 60;
}

TEST(DayStress, theRateMeterStaysAtSixty) {
  Case early("24 h", "rate of a 60 Hz host, clock from 0", 60 * 2 * 0x1p-36, "Hz",
             "a second between two stamps below 2^17 s, each off by 2^-36 s: 60 times their relative error");
  Case late("24 h", "rate of a 60 Hz host, clock since 1970", 60 * 2 * kEpochU * 60 / 59, "Hz",
            "the same with stamps off by 2^-23 s, over the 59 intervals of a second");
  Case jitter("24 h", "jitter of an even host, clock since 1970", 2 * kEpochU, "s",
              "a mean of deviations of which none exceeds two stamps' rounding");
  for (const double begin : {0.0, kEpoch}) {
    RateMeter meter;
    double before = begin;
    for (std::uint64_t i = 0; i < frames(); ++i) {
      const double t = timeOf(begin, i);
      meter.arrived(t);
      if (i > 0) meter.deviated(t - before - 1.0 / 60);
      before = t;
      if (i < 60 || i % 997 != 0) continue;
      (begin == 0 ? early : late).see(std::abs(meter.rateAt(t) - 60));
      jitter.see(meter.jitterS());
    }
  }
}

TEST(DayStress, headMotionDoesNotDrift) {
  Case drift("24 h", "head motion after a day against one begun ten seconds ago", 0, "differences",
             "what it remembers is younger than that: nothing is summed over the day");
  Case blur("24 h", "age of a blur, clock since 1970", 64 * 400 * kU, "ms",
            "32 steps of a product and a difference of at most 400 ms; neighbouring stamps differ exactly");
  const MotionParameters p;
  for (const double begin : {0.0, kEpoch}) {
    MotionMemory day, fresh;
    const std::uint64_t last = frames(), anew = last - 600;
    double started = -1;
    for (std::uint64_t i = 0; i < last; ++i) {
      // Sweeps of 180 degrees in a second, two seconds' rest: document C's head.
      const auto phase = static_cast<double>(i % 180) / 60;
      AircraftState s;
      s.time = timeOf(begin, i);
      s.attitude.heading = Degrees{phase < 1 ? 180 * phase : 180};
      if (i / 180 % 2 == 1) s.attitude.heading = Degrees{180} - s.attitude.heading;
      const MotionDecision d = decideMotion(s, p, day);
      if (i >= anew) decideMotion(s, p, fresh);
      if (d.reason == MotionReason::lowered || d.reason == MotionReason::lowest) started = s.time;
      if (day.blurRemainingMs > 0)
        blur.see(std::abs(day.blurRemainingMs - (p.blurDuration.value() - (s.time - started) * 1e3)));
    }
    drift.require(day == fresh);
  }
}

TEST(DayStress, timesReadBackFromATrace) {
  Case cells("24 h", "trace times, written and read", 0, "s",
             "the shortest text that reads back to the same bits");
  Case order("24 h", "trace times that do not rise", 0, "violations",
             "a sixtieth of a second is far above a stamp's rounding");
  std::string text;
  for (const double begin : {0.0, kEpoch}) {
    double before = -1;
    for (std::uint64_t i = 0; i < frames(); i += 1 + (isLong() ? 0 : i % 7)) {
      const double t = timeOf(begin, i);
      text.clear();
      trace::print(text, t);
      double again = 0;
      trace::Expected expected;
      order.require(trace::parse(text, again, expected) && again > before);
      cells.see(std::abs(again - t));
      before = again;
    }
  }
}

TEST(DayStress, meansDoNotDrift) {
  constexpr std::size_t kWindow = 600;
  Case mean("24 h", "mean of the last 600 frames, relative", (kWindow + 1) * kU, "",
            "600 sums of positive terms and the quotient, however long it has run");
  SampleWindow window(kWindow);
  std::array<double, kWindow> last{};
  for (std::uint64_t i = 0; i < frames(); ++i) {
    const double cost = 16.7 + 1e-9 * static_cast<double>(i % 1009) + (i % 4001 == 0 ? 1e6 : 0);
    window.add(cost);
    last[i % kWindow] = cost;
    if (i < kWindow || i % 99991 != 0) continue;
    Quad sum = 0;
    for (const double x : last) sum += x;
    mean.see(relative(window.mean(), sum / kWindow));
  }
}

TEST(DayStress, hostClocksAndFrameNumbersWrapUnseen) {
  Case clock("24 h", "CIGI time over two wraps of its ticks", 2 * kU * 172800, "s",
             "ticks are counted whole: the tick and its product round once each, below two days");
  Case lost("24 h", "frames taken for lost, repeated or restarted across the wrap of frame numbers", 0,
            "frames", "differences of 32-bit numbers do not know where the count begins");
  HostDecoder decoder;
  AircraftState state;
  state.position = {Degrees{64}, Degrees{-22}, Metres{1000}};
  const std::uint32_t first = 0xffffffffu - 2000000;
  std::uint64_t got = 0;
  const std::uint64_t every = isLong() ? 1 : 6;  // ten frames a second, or all sixty
  for (std::uint64_t i = 0; i < frames(); i += every) {
    state.time = timeOf(0, i);
    const auto bytes = encodeCigiHost(state, first + static_cast<std::uint32_t>(i / every), 0);
    const auto decoded = decoder.accept({bytes, timeOf(kEpoch, i), "a"});
    if (!decoded) continue;
    ++got;
    const std::uint64_t ticks = (i * 200000 + 60) / 120;  // of 10 microseconds, to the nearest
    clock.see(distance(decoded->time, Quad(ticks) / 100000));
  }
  const HostStatistics& s = decoder.statistics();
  lost.see(static_cast<double>(s.lost.value_or(1) + s.repeated + s.reordered + s.restarts + s.bad + s.jumps +
                               (s.states - got)));
  lost.require(got == (frames() + every - 1) / every);

  FrameOrder order;
  for (std::uint64_t i = 0; i < frames(); ++i)
    lost.require(order.accept(first + static_cast<std::uint32_t>(i), false) == FrameOrder::Verdict::next);
}

}  // namespace
}  // namespace trimtab::stress
