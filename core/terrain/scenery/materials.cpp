#include <algorithm>
#include <cctype>
#include <map>
#include <string>

#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::terrain {

namespace {

using Rgb = std::array<std::uint8_t, 3>;

constexpr Rgb kSea{38, 78, 112}, kFreshWater{52, 98, 128}, kConifers{44, 76, 46}, kBroadleaves{66, 100, 50},
    kMixed{56, 88, 48}, kScrub{112, 122, 76}, kHeath{134, 122, 86}, kGrass{116, 140, 74}, kCrop{152, 154, 88},
    kRice{128, 152, 84}, kBuilt{150, 142, 134}, kDenseBuilt{134, 128, 124}, kIndustry{146, 140, 146},
    kRoad{98, 96, 96}, kRail{92, 80, 74}, kRock{128, 120, 112}, kLava{64, 58, 58}, kSand{206, 190, 146},
    kIce{236, 242, 248}, kBog{92, 108, 82}, kAsphalt{84, 84, 88}, kConcrete{166, 164, 158},
    kPaintWhite{226, 226, 222}, kPaintYellow{216, 182, 62}, kUnknown{140, 140, 140};

/// Lower case, as the lists of the world's two generations of scenery spell them.
const std::map<std::string, Rgb, std::less<>>& byName() {
  static const std::map<std::string, Rgb, std::less<>> kColours = {
      {"default", kGrass},
      // Water.
      {"ocean", kSea},
      {"lake", kFreshWater},
      {"pond", kFreshWater},
      {"reservoir", kFreshWater},
      {"stream", kFreshWater},
      {"intermittentstream", {88, 116, 118}},
      {"intermittentlake", {88, 116, 118}},
      {"watercourse", kFreshWater},
      {"canal", kFreshWater},
      {"lagoon", {60, 112, 132}},
      {"estuary", {56, 96, 118}},
      {"littoral", {150, 150, 124}},
      {"drylake", {190, 178, 150}},
      {"drylakebed", {190, 178, 150}},
      // Woods.
      {"evergreenforest", kConifers},
      {"evergreenneedlecover", kConifers},
      {"evergreenbroadcover", {48, 88, 44}},
      {"deciduousforest", kBroadleaves},
      {"deciduousbroadcover", kBroadleaves},
      {"deciduousneedlecover", {84, 104, 56}},
      {"mixedforest", kMixed},
      {"mixedforestcover", kMixed},
      {"rainforest", {36, 82, 42}},
      {"cropwood", {104, 124, 68}},
      {"cropwoodcover", {104, 124, 68}},
      {"agroforest", {100, 122, 66}},
      {"orchard", {108, 130, 62}},
      {"olives", {124, 132, 88}},
      {"vineyard", {132, 132, 76}},
      // Low plants.
      {"scrub", kScrub},
      {"scrubcover", kScrub},
      {"shrubcover", kScrub},
      {"shrubgrasscover", {122, 132, 78}},
      {"sclerophyllous", {104, 118, 70}},
      {"heath", kHeath},
      {"savannacover", {164, 154, 92}},
      {"savanna", {164, 154, 92}},
      {"grassland", kGrass},
      {"grasscover", {128, 144, 80}},
      {"grass", {108, 142, 68}},
      {"greenspace", {98, 138, 66}},
      {"golfcourse", {94, 148, 62}},
      {"herbtundra", {132, 132, 96}},
      {"herbtundracover", {132, 132, 96}},
      {"woodedtundracover", {104, 114, 78}},
      {"mixedtundracover", {124, 124, 94}},
      {"baretundracover", {146, 138, 114}},
      {"marsh", kBog},
      {"bog", {104, 104, 76}},
      {"floodland", {112, 122, 100}},
      {"saltmarsh", {112, 120, 96}},
      {"herbwetlandcover", kBog},
      {"woodedwetlandcover", {70, 94, 66}},
      // Farmland.
      {"drycrop", kCrop},
      {"drycroppasturecover", kCrop},
      {"irrcrop", {124, 156, 74}},
      {"irrcroppasturecover", {124, 156, 74}},
      {"mixedcroppasturecover", {138, 152, 80}},
      {"complexcrop", {144, 148, 86}},
      {"naturalcrop", {128, 138, 78}},
      {"cropgrass", {132, 150, 78}},
      {"cropgrasscover", {132, 150, 78}},
      {"rice", kRice},
      // Bare ground.
      {"barrencover", {164, 148, 122}},
      {"rock", kRock},
      {"lava", kLava},
      {"sand", kSand},
      {"dirt", {146, 120, 90}},
      {"gravel", {162, 154, 142}},
      {"burnt", {72, 64, 56}},
      {"polarice", kIce},
      {"glacier", kIce},
      {"packice", {214, 228, 238}},
      {"snowcover", kIce},
      {"snow", kIce},
      {"saline", {214, 208, 194}},
      {"openmining", {170, 150, 126}},
      {"dump", {136, 124, 106}},
      // Built.
      {"builtupcover", kBuilt},
      {"urban", kDenseBuilt},
      {"town", kBuilt},
      {"suburban", {146, 148, 126}},
      {"industrial", kIndustry},
      {"construction", {172, 154, 130}},
      {"port", {136, 134, 134}},
      {"transport", {118, 114, 112}},
      {"road", kRoad},
      {"freeway", {86, 84, 86}},
      {"railroad", kRail},
      {"railway", kRail},
      // Airports.
      {"airport", {112, 140, 76}},
      {"airportkeep", {112, 140, 76}},
      {"asphalt", kAsphalt},
      {"concrete", kConcrete},
      {"dirt_rwy", {150, 128, 98}},
      {"gravel_rwy", {162, 154, 142}},
      {"grass_rwy", {120, 150, 78}},
      {"lakebed_taxiway", {190, 178, 150}},
      {"water_rwy", kFreshWater},
  };
  return kColours;
}

}  // namespace

Rgb materialColour(std::string_view material) {
  std::string name;
  for (const char c : material) name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (const auto known = byName().find(name); known != byName().end()) return known->second;
  const auto holds = [&](std::string_view part) { return name.find(part) != std::string::npos; };
  // Pieces of runways and taxiways come in asphalt, concrete and with their markings; lines are paint.
  if (name.starts_with("lf_")) return holds("yellow") || holds("hold") ? kPaintYellow : kPaintWhite;
  if (name.starts_with("pa_")) return kAsphalt;
  if (name.starts_with("pc_")) return kConcrete;
  if (holds("forest") || holds("wood")) return kMixed;
  if (holds("water") || holds("river")) return kFreshWater;
  if (holds("crop")) return kCrop;
  if (holds("grass") || holds("pasture")) return kGrass;
  if (holds("road") || holds("highway")) return kRoad;
  if (holds("city") || holds("urban")) return kDenseBuilt;
  return kUnknown;
}

}  // namespace trimtab::terrain
