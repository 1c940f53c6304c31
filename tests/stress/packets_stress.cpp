#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "core/host/cigi3.h"
#include "core/host/limits.h"
#include "core/host/native_fdm.h"
#include "quad.h"
#include "table.h"
#include "trimtab/decision/decide.h"
#include "trimtab/host/decoder.h"
#include "trimtab/host/encoder.h"
#include "trimtab/units/not_finite.h"

/// What hosts must not be able to do: put something that is no number into a decision or an eye.
namespace trimtab::stress {
namespace {

constexpr double kMax = std::numeric_limits<double>::max();

std::vector<double> extremes() {
  std::vector<double> all{0,   5e-324, 1e-310, 2.3e-308, 1e-45,  1.5e-38, 1e-6, 0.5,
                          1,   89.9,   90,     90.00005, 180,    360,     361,  1e3,
                          1e4, 1e6,    1e7,    1e15,     3.4e38, 1e39,    kMax, kInfinity};
  for (const double x : std::vector<double>(all)) all.push_back(-x);
  all.push_back(std::nan(""));
  return all;
}

bool isPlace(const AircraftState& s) {
  const Vec3 ecef = toEcef(s.position);
  const Mat3 axes = eyeAxes(LocalFrame(s.position), s.position, s.attitude);
  double sum = ecef.x + ecef.y + ecef.z + s.time;
  for (const Vec3& row : axes.row) sum += row.x + row.y + row.z;
  return std::isfinite(sum) && std::abs(s.position.latitude.value()) <= 90 &&
         std::abs(s.position.longitude.value()) <= 180 && std::abs(s.attitude.pitch.value()) <= 90;
}

bool isDecided(const FrameDecision& d) {
  const WeatherDecision& w = d.weather;
  return std::isfinite(d.altitudeFt + d.pitchDeg + d.motion.lodScale + d.motion.rateDegPerS +
                       d.motion.blur.remainingMs) &&
         d.altitudeMembership >= 0 && d.altitudeMembership <= 1 && d.pitchMembership >= 0 &&
         d.pitchMembership <= 1 && d.totalMembership >= 0 && d.totalMembership <= 2 &&
         d.reason != SchemeReason::invalid_input && w.density >= 0 && w.density <= 1 && w.visibilityM > 0 &&
         w.extinctionPerM >= 0 && std::isfinite(w.extinctionPerM) && w.farM > 0 && w.nearFarRatio >= 0;
}

/// Decoder, decision and view behind one link, with every mechanism on.
class Link {
 public:
  Link() {
    TuningParameters p;
    p.weather.source = WeatherSource::host;
    p.view.source = ViewSource::host;
    parameters_ = *validate(p);
  }
  /// Whether the datagram was refused, or what came of it is all numbers.
  bool survives(std::span<const std::byte> bytes) {
    now_ += 1.0 / 60;
    const auto state = decoder_.accept({bytes, now_, "a"});
    if (!state) return true;
    ++accepted;
    FrameInput input;
    input.state = *state;
    input.aboveGround = state->aboveGround;
    const FrameDecision d = decide(input, parameters_, memory_);
    const ViewShape v = viewShape(parameters_->view, 1280, 720, state->view);
    const bool view = v.left < v.right && v.bottom < v.top && v.nearM > 0 &&
                      std::isfinite(v.left + v.right + v.bottom + v.top + v.nearM);
    extrapolator_.push(*state);
    const bool motion =
        !state->velocity || std::isfinite(state->velocity->north.value() + state->velocity->east.value() +
                                          state->velocity->down.value());
    return isPlace(*state) && isPlace(extrapolator_.at(state->time + 0.1, 0.5)) && isDecided(d) && view &&
           motion;
  }
  std::size_t accepted = 0;

 private:
  HostDecoder decoder_;
  Extrapolator extrapolator_;
  ValidatedParameters parameters_ = defaultParameters();
  DecisionMemory memory_;
  double now_ = 1000;
};

AircraftState fullState() {
  AircraftState s;
  s.position = {Degrees{47.3}, Degrees{9.6}, Metres{2500}};
  s.attitude = {Degrees{275}, Degrees{-4}, Degrees{12}};
  s.aboveGround = Metres{1200};
  s.head = Attitude{Degrees{20}, Degrees{5}, Degrees{0}};
  s.visibility = Metres{20000};
  s.weather = HostWeather{Precipitation::rain, 3, Metres{4000}};
  s.view = HostView{Metres{1}, Degrees{-30}, Degrees{30}, Degrees{-18}, Degrees{18}};
  s.airspeed = Knots{250};
  s.velocity = Velocity{MetresPerSecond{100}, MetresPerSecond{50}, MetresPerSecond{-3}};
  return s;
}

template <class T>
void put(std::vector<std::byte>& bytes, std::size_t at, ByteOrder order, double value) {
  wire::put<T>(bytes, at, order, static_cast<T>(value));
}

TEST(PacketStress, nativeFdmFieldsMayHoldAnything) {
  Case fields("packets", "native-fdm: every field extreme, as float and as double", 0, "survivals broken",
              "refused or defined: never a NaN in a decision or an eye");
  Case taken("packets", "native-fdm: extremes that are in range are taken", 0, "refused",
             "0 and 1 are numbers in every field");
  Link link;
  const auto whole = encodeNativeFdm(fullState());
  for (std::size_t at = 4; at + 4 <= whole.size(); at += 4)
    for (const double value : extremes()) {
      auto bytes = whole;
      put<float>(bytes, at, ByteOrder::big, value);
      const std::size_t before = link.accepted;
      fields.require(link.survives(bytes),
                     [&] { return "byte " + std::to_string(at) + ": float " + digits(value); });
      // The halves of a double are no fields of their own.
      if (value == 0 && at >= 32)
        taken.require(link.accepted > before, [&] { return "byte " + std::to_string(at); });
      if (at + 8 > whole.size()) continue;
      bytes = whole;
      put<double>(bytes, at, ByteOrder::big, value);
      fields.require(link.survives(bytes),
                     [&] { return "byte " + std::to_string(at) + ": double " + digits(value); });
    }
}

TEST(PacketStress, cigiFieldsMayHoldAnything) {
  Case fields("packets", "CIGI 3: every field extreme, both byte orders", 0, "survivals broken",
              "refused or defined: never a NaN in a decision or an eye");
  Case random("packets", "CIGI 3 and native-fdm: several fields at once, and any bits", 0, "survivals broken",
              "the same");
  std::mt19937_64 dice(41);
  const auto below = [&dice](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(dice);
  };
  const std::vector<double> values = extremes();
  std::uint32_t frame = 0;
  for (const ByteOrder order : {ByteOrder::big, ByteOrder::little}) {
    Link link;
    for (std::size_t at = 12;; at += 4) {
      const auto size = encodeCigiHost(fullState(), 0, 0, order).size();
      if (at + 4 > size) break;
      for (const double value : values) {
        auto bytes = encodeCigiHost(fullState(), ++frame, 0, order);
        put<float>(bytes, at, order, value);
        fields.require(link.survives(bytes),
                       [&] { return "byte " + std::to_string(at) + ": float " + digits(value); });
        if (at + 8 > size) continue;
        bytes = encodeCigiHost(fullState(), ++frame, 0, order);
        put<double>(bytes, at, order, value);
        fields.require(link.survives(bytes),
                       [&] { return "byte " + std::to_string(at) + ": double " + digits(value); });
      }
    }
    EXPECT_GT(link.accepted, 1000u);
    for (std::size_t i = 0; i < samples(100000); ++i) {
      auto bytes = i % 2 == 0 ? encodeCigiHost(fullState(), ++frame, 0, order) : encodeNativeFdm(fullState());
      for (std::size_t n = 1 + below(6); n > 0; --n) {
        const std::size_t at = 4 * (2 + below(bytes.size() / 4 - 3));
        const ByteOrder wire = i % 2 == 0 ? order : ByteOrder::big;
        if (below(3) == 0)
          wire::put<std::uint32_t>(bytes, at, wire, static_cast<std::uint32_t>(dice()));
        else if (below(2) == 0)
          put<double>(bytes, at, wire, values[below(values.size())]);
        else
          put<float>(bytes, at, wire, values[below(values.size())]);
      }
      random.require(link.survives(bytes));
    }
  }
}

AircraftState randomState(std::mt19937_64& dice) {
  std::uniform_real_distribution<double> unit(-1, 1);
  AircraftState s = fullState();
  s.position = {Degrees{90 * unit(dice)}, Degrees{180 * unit(dice)},
                Metres{-300 + 50000 * std::abs(unit(dice))}};
  if (unit(dice) > 0.9) s.position = {Degrees{90}, Degrees{-180}, Metres{0}};
  s.attitude = {Degrees{359.9999 * std::abs(unit(dice))}, Degrees{90 * unit(dice)},
                Degrees{180 * unit(dice)}};
  s.head = Attitude{Degrees{180 * unit(dice)}, Degrees{90 * unit(dice)}, Degrees{180 * unit(dice)}};
  s.visibility = Metres{1 + 1e6 * std::abs(unit(dice))};
  s.aboveGround = Metres{1 + 20000 * std::abs(unit(dice))};
  return s;
}
double apart(Degrees a, Degrees b) {
  return std::abs(wrapped180(a - b).value());
}
double apart(const Attitude& a, const Attitude& b) {
  return std::max({apart(a.heading, b.heading), apart(a.pitch, b.pitch), apart(a.roll, b.roll)});
}
double asFloat(double x) {
  // Volatile: g++ 12 at -O3 vectorises three of these and leaves the rounding out.
  const volatile float rounded = static_cast<float>(x);
  return rounded;
}
Attitude asFloats(const Attitude& a) {
  return {Degrees{asFloat(a.heading.value())}, Degrees{asFloat(a.pitch.value())},
          Degrees{asFloat(a.roll.value())}};
}

TEST(PacketStress, whatIsSentIsReceived) {
  std::mt19937_64 dice(42);
  Case places("packets", "CIGI 3: latitude, longitude, altitude", 0, "",
              "sent and read as the doubles they are");
  Case angles("packets", "CIGI 3: angles", 0, "deg", "sent as floats: the angle rounded once");
  Case native("packets", "native-fdm: latitude and longitude", 6 * kU * 180, "deg",
              "to radians and back: the constants and products of both ways, six roundings of 180");
  Case nativeHeight("packets", "native-fdm: altitude", 0, "m", "sent and read as the double it is");
  Case nativeAngles("packets", "native-fdm: angles", 360 * (kFloatU + 6 * kU), "deg",
                    "a float of radians is off by 2^-24 of itself, of at most 360");
  Case floats("packets", "visibility and height above ground", 0, "m",
              "sent as floats: the distance rounded once");
  HostDecoder cigi;
  std::uint32_t frame = 0;
  for (std::size_t i = 0; i < samples(50000); ++i) {
    const AircraftState s = randomState(dice);
    const auto order = i % 2 == 0 ? ByteOrder::big : ByteOrder::little;
    const auto got =
        cigi.accept({encodeCigiHost(s, ++frame, 0, order), 1 + 0.01 * static_cast<double>(i), "a"});
    ASSERT_TRUE(got) << cigi.statistics().firstBadReason;
    places.require(got->position == s.position);
    angles.see(apart(got->attitude, asFloats(s.attitude)), [&] {
      const Attitude &g = got->attitude, &a = s.attitude;
      return digits(a.heading.value()) + ' ' + digits(a.pitch.value()) + ' ' + digits(a.roll.value()) +
             " as " + digits(g.heading.value()) + ' ' + digits(g.pitch.value()) + ' ' +
             digits(g.roll.value());
    });
    angles.see(apart(*got->head, asFloats(*s.head)));
    floats.see(std::abs(got->visibility->value() - asFloat(s.visibility->value())));
    AircraftState n;
    ASSERT_FALSE(native_fdm::parse(encodeNativeFdm(s), n));
    native.see(std::max(apart(n.position.latitude, s.position.latitude),
                        apart(n.position.longitude, s.position.longitude)));
    nativeHeight.see(distance(n.position.height.value(), s.position.height.value()));
    nativeAngles.see(apart(n.attitude, s.attitude));
    floats.see(std::abs(n.aboveGround->value() - asFloat(s.aboveGround->value())));
  }
}

TEST(PacketStress, stateByHandMayHoldAnything) {
  Case states("packets", "a state of NaN, infinities and extremes, decided", 0, "violations",
              "frustum for what is no number, and no membership, scale or far plane that is none");
  TuningParameters p;
  p.weather.source = WeatherSource::host;
  const ValidatedParameters parameters = *validate(p);
  DecisionMemory memory;
  const std::vector<double> values = extremes();
  for (const double a : values)
    for (const double b : values) {
      FrameInput in;
      in.state = fullState();
      in.state.time = a;
      in.state.position.height = Metres{b};
      in.state.attitude = {Degrees{b}, Degrees{a}, Degrees{a}};
      in.state.head = Attitude{Degrees{a}, Degrees{b}, Degrees{a}};
      in.state.visibility = Metres{a};
      in.state.weather =
          HostWeather{Precipitation::snow, static_cast<int>(std::clamp(b, -1e9, 1e9)), Metres{b}};
      const FrameDecision d = decide(in, parameters, memory);
      const auto usable = [](double x) { return std::isfinite(x); };
      const bool numbers = usable(in.state.position.height.in<Feet>()) && usable(a);
      states.require(numbers ? isDecided(d)
                             : d.reason == SchemeReason::invalid_input && d.scheme == Scheme::frustum &&
                                   d.totalMembership == 0,
                     [&] { return digits(a) + " and " + digits(b) + ": " + explain(d, parameters); });
      states.require(std::isfinite(memory.motion.timeS + memory.motion.headingDeg + memory.motion.pitchDeg +
                                   memory.motion.blurRemainingMs) &&
                     d.weather.visibilityM >= 10 && d.weather.farM > 0);
    }
}

}  // namespace
}  // namespace trimtab::stress
