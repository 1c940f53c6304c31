#include <cmath>
#include <limits>

#include "core/interface/handles.h"

namespace trimtab::c {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

template <class Quantity>
std::optional<Quantity> known(double value) {
  if (std::isnan(value)) return std::nullopt;
  return Quantity{value};
}

bool allKnown(double a, double b, double c) {
  return !std::isnan(a) && !std::isnan(b) && !std::isnan(c);
}

}  // namespace

trimtab_state unknownState() {
  trimtab_state s{};
  for (double* optional :
       {&s.above_ground_m, &s.head_heading_deg, &s.head_pitch_deg, &s.head_roll_deg, &s.airspeed_kt,
        &s.velocity_north_mps, &s.velocity_east_mps, &s.velocity_down_mps, &s.visibility_m, &s.wind_mps,
        &s.wind_from_deg, &s.wind_up_mps, &s.precipitation_visibility_m, &s.view_near_m, &s.view_left_deg,
        &s.view_right_deg, &s.view_bottom_deg, &s.view_top_deg})
    *optional = kUnknown;
  s.precipitation = -1;
  return s;
}

AircraftState toState(const trimtab_state& s) {
  AircraftState state;
  state.time = s.time_s;
  state.packet = s.packet;
  state.position = {Degrees{s.latitude_deg}, Degrees{s.longitude_deg}, Metres{s.height_m}};
  state.attitude = {Degrees{s.heading_deg}, Degrees{s.pitch_deg}, Degrees{s.roll_deg}};
  if (s.ground_clamp == 1) state.clamp = GroundClamp::level;
  if (s.ground_clamp == 2) state.clamp = GroundClamp::conformal;
  state.aboveGround = known<Metres>(s.above_ground_m);
  if (allKnown(s.head_heading_deg, s.head_pitch_deg, s.head_roll_deg))
    state.head = Attitude{Degrees{s.head_heading_deg}, Degrees{s.head_pitch_deg}, Degrees{s.head_roll_deg}};
  state.visibility = known<Metres>(s.visibility_m);
  if (s.precipitation >= 0 && s.precipitation <= 2)
    state.weather = HostWeather{static_cast<Precipitation>(s.precipitation),
                                std::clamp(s.severity, 0, HostWeather::kMostSevere),
                                known<Metres>(s.precipitation_visibility_m)};
  if (allKnown(s.wind_mps, s.wind_from_deg, s.wind_up_mps))
    state.wind = Wind{MetresPerSecond{s.wind_mps}, Degrees{s.wind_from_deg}, MetresPerSecond{s.wind_up_mps}};
  if (s.has_view != 0)
    state.view = HostView{known<Metres>(s.view_near_m), known<Degrees>(s.view_left_deg),
                          known<Degrees>(s.view_right_deg), known<Degrees>(s.view_bottom_deg),
                          known<Degrees>(s.view_top_deg)};
  state.airspeed = known<Knots>(s.airspeed_kt);
  if (allKnown(s.velocity_north_mps, s.velocity_east_mps, s.velocity_down_mps))
    state.velocity = Velocity{MetresPerSecond{s.velocity_north_mps}, MetresPerSecond{s.velocity_east_mps},
                              MetresPerSecond{s.velocity_down_mps}};
  return state;
}

}  // namespace trimtab::c

trimtab_status trimtab_state_clear(trimtab_state* state) {
  using namespace trimtab::c;
  return copyOut(state, unknownState(), kStateSize) ? TRIMTAB_OK : TRIMTAB_MISUSE;
}
