#include "x_plane.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "limits.h"

namespace trimtab::x_plane {
namespace {

constexpr std::size_t kHeader = 5, kNameSize = 4, kRowSize = 36, kPositionSize = 64;
/// A cell of DATA that X-Plane leaves out.
constexpr float kUnused = -999;

bool begins(std::span<const std::byte> bytes, std::string_view name) {
  return bytes.size() >= name.size() &&
         std::equal(name.begin(), name.end(), bytes.begin(),
                    [](char c, std::byte b) { return std::to_integer<char>(b) == c; });
}

/// RPOS comes after a header of five bytes, or of four in the newer description.
bool isPosition(std::span<const std::byte> bytes) {
  return begins(bytes, "RPOS") &&
         (bytes.size() == kHeader + kPositionSize || bytes.size() == kNameSize + kPositionSize);
}

bool isData(std::span<const std::byte> bytes) {
  return begins(bytes, "DATA") && bytes.size() > kHeader && (bytes.size() - kHeader) % kRowSize == 0;
}

Attitude attitudeFrom(double heading, double pitch, double roll) {
  return {wrapped360(Degrees{heading}), Degrees{limits::clampedPitch(pitch)}, wrapped180(Degrees{roll})};
}

std::optional<PacketFault> parsePosition(std::span<const std::byte> bytes, AircraftState& state) {
  const std::size_t at = bytes.size() - kPositionSize;
  FieldReader read(bytes, ByteOrder::little);
  const double longitude = read.number<double>(at, "longitude", -limits::kTurn, limits::kTurn, "deg");
  const double latitude =
      read.number<double>(at + 8, "latitude", -limits::kLatitude, limits::kLatitude, "deg");
  const double height = read.number<double>(at + 16, "elevation", limits::kLowest, limits::kHighest, "m");
  const double ground =
      read.number<float>(at + 24, "height above ground", -limits::kHighest, limits::kHighest, "m");
  const double pitch = read.number<float>(at + 28, "pitch", -limits::kPitch, limits::kPitch, "deg");
  const double heading = read.number<float>(at + 32, "true heading", -limits::kTurn, limits::kTurn, "deg");
  const double roll = read.number<float>(at + 36, "roll", -limits::kTurn, limits::kTurn, "deg");
  if (read.fault()) return read.fault();
  state.position = {Degrees{limits::clampedLatitude(latitude)}, wrapped180(Degrees{longitude}),
                    Metres{height}};
  state.attitude = attitudeFrom(heading, pitch, roll);
  if (ground > 0) state.aboveGround = Metres{ground};
  constexpr double kFastest = 20e3;  // m/s
  const double east = read.raw<float>(at + 40), up = read.raw<float>(at + 44),
               south = read.raw<float>(at + 48);
  if (std::abs(east) <= kFastest && std::abs(up) <= kFastest && std::abs(south) <= kFastest)
    state.velocity = Velocity{MetresPerSecond{-south}, MetresPerSecond{east}, MetresPerSecond{-up}};
  return std::nullopt;
}

std::optional<PacketFault> parseRow(std::span<const std::byte> bytes, std::size_t at, Session& session) {
  FieldReader read(bytes, ByteOrder::little);
  const auto row = read.raw<std::uint32_t>(at);
  const std::size_t first = at + 4;
  const bool used = (row == kAttitudeRow || row == kPositionRow) && read.raw<float>(first) != kUnused;
  if (!used) return std::nullopt;
  if (row == kAttitudeRow) {
    const double pitch = read.number<float>(first, "pitch", -limits::kPitch, limits::kPitch, "deg");
    const double roll = read.number<float>(first + 4, "roll", -limits::kTurn, limits::kTurn, "deg");
    const double heading =
        read.number<float>(first + 8, "true heading", -limits::kTurn, limits::kTurn, "deg");
    session.attitude = attitudeFrom(heading, pitch, roll);
    return read.fault();
  }
  constexpr double kFoot = unit::Foot::size;
  const double latitude = read.number<float>(first, "latitude", -limits::kLatitude, limits::kLatitude, "deg");
  const double longitude = read.number<float>(first + 4, "longitude", -limits::kTurn, limits::kTurn, "deg");
  const double height =
      read.number<float>(first + 8, "altitude", limits::kLowest, limits::kHighest, "m", kFoot);
  session.position = {Degrees{limits::clampedLatitude(latitude)}, wrapped180(Degrees{longitude}),
                      Metres{height}};
  const double ground = static_cast<double>(read.raw<float>(first + 12)) * kFoot;
  session.aboveGround =
      ground > 0 && ground <= limits::kHighest ? std::optional(Metres{ground}) : std::nullopt;
  return read.fault();
}

}  // namespace

bool matches(std::span<const std::byte> bytes) {
  return isPosition(bytes) || isData(bytes);
}

std::optional<PacketFault> parse(std::span<const std::byte> bytes, Session& session, AircraftState& state,
                                 bool& complete) {
  state = {};
  complete = false;
  if (isPosition(bytes)) {
    complete = true;
    return parsePosition(bytes, state);
  }
  if (!isData(bytes))
    return PacketFault{bytes.size(), "X-Plane packet", "RPOS of 69 bytes, or DATA of 5 bytes and 36 a row",
                       std::to_string(bytes.size()) + " bytes",
                       "let X-Plane send RPOS, or rows 17 and 20 of Data Output"};
  bool position = false;
  Session candidate = session;
  for (std::size_t at = kHeader; at < bytes.size(); at += kRowSize) {
    if (auto fault = parseRow(bytes, at, candidate)) return fault;
    position |= wire::get<std::uint32_t>(bytes, at, ByteOrder::little) == kPositionRow;
  }
  session = candidate;
  if (!position || !session.position || !session.attitude) return std::nullopt;
  complete = true;
  state.position = *session.position;
  state.attitude = *session.attitude;
  state.aboveGround = session.aboveGround;
  return std::nullopt;
}

}  // namespace trimtab::x_plane
