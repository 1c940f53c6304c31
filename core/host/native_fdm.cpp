#include "native_fdm.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "limits.h"
#include "trimtab/host/encoder.h"

namespace trimtab {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

// Speeds are for symbols only: what is nonsense in them is not known, and the rest of the packet holds.
// Feeders that know positions alone leave zeros, which a host at rest would send as well: nobody knows,
// either.

constexpr double kFastestKt = 10e3, kFastestFps = 16e3;

std::optional<Knots> airspeedOf(const FieldReader& read) {
  const auto knots = static_cast<double>(read.raw<float>(native_fdm::kAirspeed));
  return knots > 0 && knots < kFastestKt ? std::optional(Knots{knots}) : std::nullopt;
}

std::optional<Velocity> velocityOf(const FieldReader& read) {
  const auto part = [&read](std::size_t offset) {
    const auto fps = static_cast<double>(read.raw<float>(offset));
    return MetresPerSecond{std::abs(fps) < kFastestFps ? fps * unit::Foot::size : std::nan("")};
  };
  const Velocity v{part(native_fdm::kNorth), part(native_fdm::kEast), part(native_fdm::kDown)};
  const double sum = v.north.value() + v.east.value() + v.down.value();
  if (!std::isfinite(sum) || v == Velocity{}) return std::nullopt;
  return v;
}

}  // namespace

namespace native_fdm {

bool matches(std::span<const std::byte> bytes) {
  return bytes.size() == kSize && wire::get<std::uint32_t>(bytes, kVersionAt, ByteOrder::big) == kVersion;
}

std::optional<PacketFault> parse(std::span<const std::byte> bytes, AircraftState& state) {
  if (bytes.size() >= 4) {
    const auto version = wire::get<std::uint32_t>(bytes, kVersionAt, ByteOrder::big);
    if (version != kVersion)
      return PacketFault{kVersionAt, "native-fdm version", std::to_string(kVersion), std::to_string(version)};
  }
  if (bytes.size() != kSize)
    return PacketFault{bytes.size(), "native-fdm length", std::to_string(kSize) + " bytes",
                       std::to_string(bytes.size()) + " bytes",
                       "let the host send the structure with its padding, as FlightGear does"};

  FieldReader read(bytes, ByteOrder::big);
  const double longitude =
      read.number<double>(kLongitude, "longitude", -limits::kTurn, limits::kTurn, "deg", kDegreesPerRadian);
  const double latitude = read.number<double>(kLatitude, "latitude", -limits::kLatitude, limits::kLatitude,
                                              "deg", kDegreesPerRadian);
  const double height = read.number<double>(kAltitude, "altitude", limits::kLowest, limits::kHighest, "m");
  const double aboveGround =
      read.number<float>(kAboveGround, "agl", -limits::kHighest, limits::kHighest, "m");
  const double roll =
      read.number<float>(kRoll, "phi (roll)", -limits::kTurn, limits::kTurn, "deg", kDegreesPerRadian);
  const double pitch =
      read.number<float>(kPitch, "theta (pitch)", -limits::kPitch, limits::kPitch, "deg", kDegreesPerRadian);
  const double heading =
      read.number<float>(kHeading, "psi (heading)", -limits::kTurn, limits::kTurn, "deg", kDegreesPerRadian);
  const double visibility = read.number<float>(kVisibility, "visibility", 0, limits::kVisibility, "m");
  if (read.fault()) return read.fault();

  state.position = {Degrees{limits::clampedLatitude(latitude)}, wrapped180(Degrees{longitude}),
                    Metres{height}};
  state.attitude = {wrapped360(Degrees{heading}), Degrees{limits::clampedPitch(pitch)},
                    wrapped180(Degrees{roll})};
  // FlightGear sends agl 0 while its scene loads; zero means that nobody knows.
  state.aboveGround = aboveGround > 0 ? std::optional(Metres{aboveGround}) : std::nullopt;
  state.visibility = visibility > 0 ? std::optional(Metres{visibility}) : std::nullopt;
  state.airspeed = airspeedOf(read);
  state.velocity = velocityOf(read);
  state.weather.reset();
  state.wind.reset();
  state.head.reset();
  state.view.reset();
  return std::nullopt;
}

}  // namespace native_fdm

std::vector<std::byte> encodeNativeFdm(const AircraftState& state) {
  using namespace native_fdm;
  std::vector<std::byte> bytes(kSize);
  const auto put = [&bytes]<class T>(std::size_t offset, T value) {
    wire::put<T>(bytes, offset, ByteOrder::big, value);
  };
  const auto putRadians = [&put](std::size_t offset, Degrees angle) {
    put(offset, static_cast<float>(angle.in<Radians>()));
  };
  put(kVersionAt, kVersion);
  put(kLongitude, state.position.longitude.in<Radians>());
  put(kLatitude, state.position.latitude.in<Radians>());
  put(kAltitude, state.position.height.value());
  put(kAboveGround, static_cast<float>(state.aboveGround.value_or(Metres{0}).value()));
  putRadians(kRoll, state.attitude.roll);
  putRadians(kPitch, state.attitude.pitch);
  putRadians(kHeading, state.attitude.heading);
  if (state.time >= 0 && state.time < 4294967296.0) put(kUnixTime, static_cast<std::uint32_t>(state.time));
  put(kAirspeed, static_cast<float>(state.airspeed.value_or(Knots{0}).value()));
  const Velocity velocity = state.velocity.value_or(Velocity{});
  const auto putFeet = [&put](std::size_t offset, MetresPerSecond v) {
    put(offset, static_cast<float>(v.value() / unit::Foot::size));
  };
  putFeet(kNorth, velocity.north);
  putFeet(kEast, velocity.east);
  putFeet(kDown, velocity.down);
  put(kVisibility, static_cast<float>(state.visibility.value_or(Metres{0}).value()));
  return bytes;
}

}  // namespace trimtab
