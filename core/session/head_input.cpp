#include "trimtab/session/head_input.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trimtab {
namespace {

/// A pointer that rested longer than this starts to move when its event comes, not when the one before came.
constexpr double kRestS = 0.1, kStartS = 1.0 / 60;
/// States go on for so long after the pointer's last event, so that every stack sees the rest.
constexpr double kSettleS = 1.5;

}  // namespace

void HeadInput::useLog(HeadLog log) {
  log_ = std::move(log);
  source_ = Source::log;
  begin_.reset();
}

void HeadInput::usePointer() {
  source_ = Source::pointer;
  count_ = 0;
}

void HeadInput::point(double right, double up, double now) {
  const auto inside = [](double place) { return std::isfinite(place) ? std::clamp(place, -1.0, 1.0) : 0.0; };
  const Place place{now, inside(right), inside(up)};
  if (count_ > 0) {
    const Place& last = nth(0);
    if (!(now > last.time)) return;
    if (now - last.time > kRestS) remember({now - kStartS, last.right, last.up});
  }
  remember(place);
}

void HeadInput::remember(const Place& place) {
  places_[next_] = place;
  next_ = (next_ + 1) % kPlaces;
  count_ = std::min(count_ + 1, kPlaces);
}

HeadInput::Place HeadInput::placeAt(double time) const {
  if (count_ == 0) return {};
  for (std::size_t i = 0; i < count_; ++i) {
    const Place& before = nth(i);
    if (!(before.time <= time)) continue;
    if (i == 0) return before;
    const Place& after = nth(i - 1);
    const double share = (time - before.time) / (after.time - before.time);
    return {time, before.right + (after.right - before.right) * share,
            before.up + (after.up - before.up) * share};
  }
  return nth(count_ - 1);
}

Attitude HeadInput::attitudeOf(const Place& place) {
  return {Degrees{place.right * kPointerHeadingDeg}, Degrees{place.up * kPointerPitchDeg}, Degrees{0}};
}

void HeadInput::apply(AircraftState& state, double now) const {
  switch (source_) {
    case Source::host:
      return;
    case Source::none:
      state.head.reset();
      return;
    case Source::log:
      if (!begin_ && std::isfinite(state.time)) begin_ = state.time;
      state.head = headAt(log_, logTime(state.time));
      return;
    case Source::pointer:
      state.head = attitudeOf(std::isfinite(now) || count_ == 0 ? placeAt(now - kPointerDelayS) : nth(0));
      return;
  }
}

void HeadInput::applyToEye(AircraftState& eye) const {
  if (source_ == Source::pointer) eye.head = attitudeOf(count_ > 0 ? nth(0) : Place{});
}

bool HeadInput::moves(double now) const {
  switch (source_) {
    case Source::host:
    case Source::none:
      return false;
    case Source::log:
      return log_.repeats || !begin_ || now - *begin_ < log_.durationS() + kSettleS;
    case Source::pointer:
      return count_ > 0 && now - nth(0).time < kSettleS;
  }
  return false;
}

}  // namespace trimtab
