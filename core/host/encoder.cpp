#include "trimtab/host/encoder.h"

#include <cmath>

#include "cigi3.h"
#include "packet_writer.h"

namespace trimtab {
namespace {

constexpr std::uint8_t kMajor = 3, kHostMinor = 3, kIgMinor = 2;

std::uint32_t ticks(double timeS) {
  if (!std::isfinite(timeS)) return 0;
  const double wrapped = std::fmod(std::round(timeS / cigi3::kTickS), 4294967296.0);
  return static_cast<std::uint32_t>(wrapped < 0 ? wrapped + 4294967296.0 : wrapped);
}

void putEntityControl(PacketWriter& w, const AircraftState& state) {
  constexpr unsigned kActive = 1;
  w.begin(cigi3::kEntityControl, cigi3::kEntityControlSize);
  w.put(2, cigi3::kOwnship);
  w.put(4, bits(kActive | static_cast<unsigned>(state.clamp) << 5U));
  w.put(6, bits(255));  // opaque
  w.putFloat(12, state.attitude.roll.value());
  w.putFloat(16, state.attitude.pitch.value());
  w.putFloat(20, state.attitude.heading.value());
  w.put(24, state.position.latitude.value());
  w.put(32, state.position.longitude.value());
  w.put(40, state.position.height.value());
}

void putViewControl(PacketWriter& w, const Attitude& head) {
  constexpr unsigned kRollPitchYaw = 0x38;
  w.begin(cigi3::kViewControl, cigi3::kViewControlSize);
  w.put(5, bits(kRollPitchYaw));
  w.put(6, cigi3::kOwnship);
  w.putFloat(20, head.roll.value());
  w.putFloat(24, head.pitch.value());
  w.putFloat(28, head.heading.value());
}

void putViewDefinition(PacketWriter& w, const HostView& view) {
  w.begin(cigi3::kViewDefinition, cigi3::kViewDefinitionSize);
  unsigned enabled = 0;
  const auto put = [&](unsigned bit, std::size_t offset, const auto& value) {
    if (!value) return;
    enabled |= 1U << bit;
    w.putFloat(offset, value->value());
  };
  put(0, 8, view.nearDistance);
  put(2, 16, view.left);
  put(3, 20, view.right);
  put(4, 24, view.top);
  put(5, 28, view.bottom);
  w.put(5, bits(enabled));
}

void putWind(PacketWriter& w, std::size_t offset, const std::optional<Wind>& wind) {
  if (!wind) return;
  w.putFloat(offset, wind->speed.value());
  w.putFloat(offset + 4, wind->up.value());
  w.putFloat(offset + 8, wind->from.value());
}

void putAtmosphereControl(PacketWriter& w, Metres visibility, const std::optional<Wind>& wind) {
  w.begin(cigi3::kAtmosphereControl, cigi3::kAtmosphereControlSize);
  w.put(2, bits(1));  // atmospheric model on
  w.putFloat(4, 15);  // standard atmosphere at sea level
  w.putFloat(8, visibility.value());
  putWind(w, 12, wind);
  w.putFloat(24, 1013.25);
}

/// Writes one layer of global scope.
void putWeatherControl(PacketWriter& w, std::uint8_t layer, bool enabled, const HostWeather& weather,
                       const std::optional<Wind>& wind) {
  w.begin(cigi3::kWeatherControl, cigi3::kWeatherControlSize);
  w.put(4, layer);
  if (!enabled) return;
  w.put(6, bits(1));
  w.put(7, bits(static_cast<unsigned>(weather.severity) << 2U));
  if (weather.visibility) w.putFloat(12, weather.visibility->value());
  w.putFloat(20, 100);  // coverage
  putWind(w, 36, wind);
}

}  // namespace

std::vector<std::byte> encodeCigiHost(const AircraftState& state, std::uint32_t frame,
                                      std::uint32_t lastIgFrame, ByteOrder order) {
  constexpr unsigned kOperate = 1, kTimestampValid = 4;
  PacketWriter w(order);
  w.begin(cigi3::kIgControl, cigi3::kIgControlSize);
  w.put(2, kMajor);
  w.put(4, bits(kOperate | kTimestampValid | (kHostMinor << 4U)));
  w.put(6, cigi3::kByteSwapMagic);
  w.put(8, frame);
  w.put(12, ticks(state.time));
  w.put(16, lastIgFrame);
  putEntityControl(w, state);
  if (state.head) putViewControl(w, *state.head);
  if (state.view) putViewDefinition(w, *state.view);
  if (state.visibility) putAtmosphereControl(w, *state.visibility, state.wind);
  if (state.weather) {
    // Both, so that the one that fell before stops.
    const Precipitation falls = state.weather->precipitation;
    putWeatherControl(w, cigi3::kRainLayer, falls == Precipitation::rain, *state.weather, state.wind);
    putWeatherControl(w, cigi3::kSnowLayer, falls == Precipitation::snow, *state.weather, state.wind);
  }
  return w.take();
}

std::vector<std::byte> encodeCigiStartOfFrame(std::uint32_t igFrame, std::uint32_t lastHostFrame,
                                              double timeS, ByteOrder order) {
  constexpr unsigned kOperate = 1, kTimestampValid = 4;
  PacketWriter w(order);
  w.begin(cigi3::kStartOfFrame, cigi3::kStartOfFrameSize);
  w.put(2, kMajor);
  w.put(5, bits(kOperate | kTimestampValid | (kIgMinor << 4U)));
  w.put(6, cigi3::kByteSwapMagic);
  w.put(8, igFrame);
  w.put(12, ticks(timeS));
  w.put(16, lastHostFrame);
  return w.take();
}

}  // namespace trimtab
