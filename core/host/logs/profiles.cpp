#include "profiles.h"

#include <algorithm>
#include <span>

#include "trimtab/units/text.h"

namespace trimtab {
namespace {

const LogProfile kFlightProfiles[] = {
    {"an X-Plane Data.txt",
     {"__lat,__deg", "__lon,__deg"},
     "time_s=\"_totl,_time\",latitude_deg=\"__lat,__deg\",longitude_deg=\"__lon,__deg\","
     "altitude_ft=\"__alt,ftmsl\",pitch_deg=\"pitch,__deg\",roll_deg=\"_roll,__deg\","
     "heading_deg=\"hding,_true\",above_ground_m=\"__alt,ftagl\"*0.3048",
     "times are the simulator's total time; X-Plane has to write times, attitude and position"},
    {"a Garmin G1000's log",
     {"Lcl Time", "Latitude", "Longitude", "AltMSL"},
     "time_s=Lcl Time,latitude_deg=Latitude,longitude_deg=Longitude,altitude_ft=AltMSL,pitch_deg=Pitch,"
     "roll_deg=Roll,heading_deg=HDG",
     "HDG is the magnetic heading"},
    {"a JSBSim output",
     {"Time", "Altitude ASL (ft)", "Latitude (deg)", "Longitude (deg)"},
     "time_s=Time,latitude_deg=Latitude (deg),longitude_deg=Longitude (deg),"
     "altitude_ft=Altitude ASL (ft),pitch_deg=Theta (deg),roll_deg=Phi (deg),heading_deg=Psi (deg),"
     "above_ground_m=Altitude AGL (ft)*0.3048",
     ""},
    {"a Flightradar24 track",
     {"Timestamp", "UTC", "Callsign", "Position", "Altitude", "Direction"},
     "time_s=Timestamp,latitude_deg=Position[1],longitude_deg=Position[2],altitude_ft=Altitude,"
     "heading_deg=Direction",
     "Direction is the course, and altitudes are of pressure"},
    {"a PlotJuggler export", {"__time"}, "time=__time", ""},
};

const LogProfile kHeadProfiles[] = {
    {"an opentrack log",
     {"dt", "rawYaw", "rawPitch"},
     "time_step_s=dt,head_heading_deg=rawYaw,head_pitch_deg=rawPitch,head_roll_deg=rawRoll",
     "the raw angles are the head's; a map chooses mappedYaw and mappedPitch"},
    {"a PlotJuggler export", {"__time"}, "time=__time", ""},
};

const LogProfile* profileOf(std::span<const LogProfile> profiles, const std::vector<std::string>& header) {
  const auto has = [&](const char* sign) {
    return std::any_of(header.begin(), header.end(),
                       [&](const std::string& cell) { return trimmed(cell) == sign; });
  };
  for (const LogProfile& profile : profiles)
    if (std::all_of(profile.signs.begin(), profile.signs.end(), has)) return &profile;
  return nullptr;
}

}  // namespace

const LogProfile* flightProfile(const std::vector<std::string>& header) {
  return profileOf(kFlightProfiles, header);
}

const LogProfile* headProfile(const std::vector<std::string>& header) {
  return profileOf(kHeadProfiles, header);
}

std::string profileText(const LogProfile& profile) {
  const std::string remark = profile.remark;
  return std::string("the columns of ") + profile.name + (remark.empty() ? "" : ": " + remark);
}

}  // namespace trimtab
