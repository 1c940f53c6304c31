#include <optional>
#include <string>

#include "trimtab/host/flight.h"
#include "trimtab/units/number.h"

namespace trimtab {
namespace {

void append(std::string& text, std::optional<double> value) {
  text += ',';
  if (value) text += numberText(*value);
}

template <class Q>
void append(std::string& text, const std::optional<Q>& quantity) {
  append(text, quantity ? std::optional(quantity->value()) : std::nullopt);
}

}  // namespace

std::string flightCsv(const Flight& flight) {
  bool packets = false, heads = false, grounds = false, visibilities = false, weathers = false, views = false,
       winds = false;
  for (std::size_t i = 0; i < flight.states.size(); ++i) {
    const AircraftState& s = flight.states[i];
    packets |= s.packet != i;
    heads |= s.head.has_value();
    grounds |= s.aboveGround.has_value();
    visibilities |= s.visibility.has_value();
    weathers |= s.weather.has_value();
    winds |= s.wind.has_value();
    views |= s.view.has_value();
  }
  std::string text = "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg,height_m";
  if (packets) text += ",packet";
  if (heads) text += ",head_heading_deg,head_pitch_deg,head_roll_deg";
  if (grounds) text += ",above_ground_m";
  if (visibilities) text += ",visibility_m";
  if (weathers) text += ",precipitation,precipitation_severity,precipitation_visibility_m";
  if (winds) text += ",wind_speed_mps,wind_from_deg,wind_up_mps";
  if (views) text += ",view_near_m,view_left_deg,view_right_deg,view_bottom_deg,view_top_deg";
  text += '\n';
  text.reserve(text.size() + flight.states.size() * 160);
  for (const AircraftState& s : flight.states) {
    text += numberText(s.time);
    append(text, s.position.latitude.value());
    append(text, s.position.longitude.value());
    append(text, s.position.height.in<Feet>());
    append(text, s.attitude.pitch.value());
    append(text, s.attitude.roll.value());
    append(text, s.attitude.heading.value());
    append(text, s.position.height.value());
    if (packets) text += ',' + std::to_string(s.packet);
    if (heads) {
      append(text, s.head ? std::optional(s.head->heading) : std::nullopt);
      append(text, s.head ? std::optional(s.head->pitch) : std::nullopt);
      append(text, s.head ? std::optional(s.head->roll) : std::nullopt);
    }
    if (grounds) append(text, s.aboveGround);
    if (visibilities) append(text, s.visibility);
    if (weathers) {
      text += ',';
      if (s.weather) text += toText(s.weather->precipitation);
      append(text, s.weather ? std::optional(double(s.weather->severity)) : std::nullopt);
      append(text, s.weather ? s.weather->visibility : std::nullopt);
    }
    if (winds) {
      append(text, s.wind ? std::optional(s.wind->speed) : std::nullopt);
      append(text, s.wind ? std::optional(s.wind->from) : std::nullopt);
      append(text, s.wind ? std::optional(s.wind->up) : std::nullopt);
    }
    if (views) {
      const HostView view = s.view.value_or(HostView{});
      append(text, view.nearDistance);
      append(text, view.left);
      append(text, view.right);
      append(text, view.bottom);
      append(text, view.top);
    }
    text += '\n';
  }
  return text;
}

}  // namespace trimtab
