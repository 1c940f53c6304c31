#pragma once

#include "rows.h"

/// Rows of the weather: where it comes from, what each step is, and the cut.
namespace trimtab::table {

/// Shorter than anything that flies needs, and longer than any planet's horizon from below 60 km.
inline constexpr Range kVisibilityRange{10, 1e6};

consteval RowText visibilityShare(std::string_view key, std::string_view label) {
  return {.key = key,
          .label = label,
          .help = "Share of the clear-day distance that one sees in this weather.",
          .source = "D: step 2",
          .hard = {1e-4, 1},
          .usual = {0.005, 1},
          .step = 0.01,
          .decimals = 3,
          .logarithmic = true};
}

consteval RowText density(std::string_view key, std::string_view label) {
  return {.key = key,
          .label = label,
          .help = "Intensity of the particles. What it costs grows with it.",
          .source = "D: light, medium, heavy",
          .hard = {0, 1},
          .usual = {0, 1},
          .step = 0.01,
          .decimals = 3};
}

consteval RowText farStretch(std::string_view key, std::string_view label) {
  return {.key = key,
          .label = label,
          .help =
              "Far plane over visibility with the adaptive ratio: 1 cuts most without cutting what is seen. "
              "Calibration pushes it out where the cut would win more than the weather costs.",
          .source = "D: step 4",
          .hard = {1, 1e5},
          .usual = {1, 100},
          .step = 0.1,
          .decimals = 3,
          .logarithmic = true};
}

/// Makes the rows of one kind's look.
template <auto Group, Literal Name, Literal Label>
consteval std::array<CheckedRow, 5> lookRows() {
  constexpr std::string_view kSource = "D: section 4, colour and fall speed of the particles";
  constexpr auto share = [](std::string_view key, std::string_view label, std::string_view help) {
    return RowText{.key = key,
                   .label = label,
                   .help = help,
                   .source = kSource,
                   .hard = {0, 1},
                   .usual = {0, 1},
                   .step = 0.01,
                   .decimals = 3,
                   .tier = Tier::advanced};
  };
  return {
      row<Group, &PrecipitationLook::size>(
          {.key = Concatenated<Name, ".size">::kView,
           .label = Concatenated<Label, ": size">::kView,
           .help = "Multiplies the size of drops or flakes, which grows with the density.",
           .source = kSource,
           .hard = {0.05, 20},
           .usual = {0.25, 4},
           .step = 0.05,
           .decimals = 2,
           .logarithmic = true}),
      row<Group, &PrecipitationLook::fallSpeed>(
          {.key = Concatenated<Name, ".fall_speed">::kView,
           .label = Concatenated<Label, ": fall speed">::kView,
           .help = "Multiplies the fall speed: rain falls at 2 + 5 times its density, snow at 0.75 + 0.25 "
                   "times its density, in metres per second.",
           .source = kSource,
           .hard = {0.01, 20},
           .usual = {0.25, 4},
           .step = 0.05,
           .decimals = 2,
           .logarithmic = true}),
      row<Group, &PrecipitationLook::red>(share(Concatenated<Name, ".red">::kView,
                                                Concatenated<Label, ": red">::kView,
                                                "Red part of the particles' colour.")),
      row<Group, &PrecipitationLook::green>(share(Concatenated<Name, ".green">::kView,
                                                  Concatenated<Label, ": green">::kView,
                                                  "Green part of the particles' colour.")),
      row<Group, &PrecipitationLook::blue>(share(Concatenated<Name, ".blue">::kView,
                                                 Concatenated<Label, ": blue">::kView,
                                                 "Blue part of the particles' colour."))};
}

inline constexpr auto kWeatherRows = joined(
    std::array{
        row<&TuningParameters::weather, &WeatherParameters::source>(
            {.key = "weather.source",
             .label = "Weather comes from",
             .help = "Whether precipitation and visibility are this preset's or those of the host, where it "
                     "sends "
                     "any."}),
        row<&TuningParameters::weather, &WeatherParameters::step>(
            {.key = "weather.step",
             .label = "Weather",
             .help = "What falls and how densely. Used where the weather comes from this preset, and until a "
                     "host has "
                     "spoken of it.",
             .source = "D: step 1"}),
        row<&TuningParameters::weather, &WeatherParameters::visibilityFrom>(
            {.key = "weather.visibility_from",
             .label = "Visibility comes from",
             .help = "Whether each weather step has its share of the clear-day distance or one typed number "
                     "holds for "
                     "all."}),
        row<&TuningParameters::weather, &WeatherParameters::typedVisibility>(
            {.key = "weather.typed_visibility_m",
             .label = "Typed visibility",
             .help = "How far one sees, whatever the step.",
             .hard = kVisibilityRange,
             .usual = {50, 100e3},
             .step = 100,
             .decimals = 1,
             .logarithmic = true}),
        row<&TuningParameters::weather, &WeatherParameters::clearVisibility>(
            {.key = "weather.clear_visibility_m",
             .label = "Clear-day visibility",
             .help = "How far one sees when nothing falls; the steps have shares of it.",
             .source = "D: step 2",
             .hard = kVisibilityRange,
             .usual = {1000, 200e3},
             .step = 1000,
             .decimals = 1,
             .logarithmic = true}),
        row<&TuningParameters::weather, &WeatherParameters::haze>(
            {.key = "weather.haze",
             .label = "Haze on clear days",
             .help =
                 "Draw haze of the clear-day visibility while nothing falls, and let the adaptive ratio cut "
                 "there."}),
        row<&TuningParameters::weather, &WeatherParameters::air>(
            {.key = "weather.air",
             .label = "Air",
             .help =
                 "Whether the fog has one extinction everywhere, or is a layer of haze under a top in which "
                 "the visibility is the meteorological optical range (5 % of the contrast is left)."}),
        row<&TuningParameters::weather, &WeatherParameters::layerTop>(
            {.key = "weather.layer_top_m",
             .label = "Top of the haze",
             .help =
                 "Height above mean sea level up to which the haze layer reaches. The air above is clear.",
             .hard = {-500, 100e3},
             .usual = {0, 10e3},
             .step = 100,
             .decimals = 1}),
        row<&TuningParameters::weather, &WeatherParameters::contrastThreshold>(
            {.key = "weather.contrast_threshold",
             .label = "Contrast at visibility",
             .help =
                 "What is left of an object's contrast at the visibility, from which the fog's extinction "
                 "follows. "
                 "0.02 is Koschmieder's visual range, 0.05 the meteorological optical range. The haze layer "
                 "always has 0.05.",
             .hard = {0.001, 0.5},
             .usual = {0.005, 0.1},
             .step = 0.005,
             .decimals = 3,
             .tier = Tier::advanced}),
        row<&TuningParameters::weather, &WeatherParameters::ratioMode>(
            {.key = "weather.ratio_mode",
             .label = "Near-far ratio",
             .help =
                 "What cuts the far terrain: nothing; one ratio in all weather, clear air too, where what "
                 "it cuts is missed; or, in fog alone, the ratio of default near to visibility.",
             .source = "D: Eq. 1, Table 1"}),
        row<&TuningParameters::weather, &WeatherParameters::fixedRatio>(
            {.key = "weather.fixed_ratio",
             .label = "Fixed ratio",
             .help = "Default near over far plane, for the fixed mode.",
             .source = "D: Table 1, fixed ratio",
             .hard = {1e-7, 0.1},
             .usual = {1e-6, 0.01},
             .step = 1e-6,
             .decimals = 7,
             .logarithmic = true}),
        row<&TuningParameters::weather, &WeatherParameters::defaultNear>(
            {.key = "weather.default_near_m",
             .label = "Default near",
             .help = "The near distance that ratios refer to. It does not move the view's near plane.",
             .source = "D: Eq. 1",
             .hard = {0.001, 1000},
             .usual = {0.1, 100},
             .step = 0.1,
             .decimals = 2,
             .tier = Tier::advanced,
             .logarithmic = true}),
        row<&TuningParameters::weather, &WeatherParameters::tolerance>(
            {.key = "weather.tolerance",
             .label = "Tolerance of calibration",
             .help =
                 "Gain and loss match when the frame in weather takes as long as the clear one, within this "
                 "share.",
             .source = "D: step 4",
             .hard = {0.001, 1},
             .usual = {0.01, 0.5},
             .step = 0.01,
             .decimals = 3,
             .tier = Tier::advanced}),
        row<&TuningParameters::weather, &WeatherParameters::severityDensity>(
            {.key = "weather.severity_density",
             .label = "Density by severity",
             .help = "Intensity of the particles for the severity that a host sends with rain or snow.",
             .hard = {0, 5},
             .usual = {0, 5},
             .step = 0.5,
             .decimals = 1,
             .tier = Tier::advanced}),
        row<&TuningParameters::weather, &WeatherParameters::precipitationForm>(
            {.key = "weather.precipitation_form",
             .label = "Rain and snow",
             .help =
                 "How rain and snow are drawn. The published effect draws every particle around the eye. The "
                 "bounded form draws those that are wider than a pixel and bundles of the others, never more "
                 "than an image can show, and fades when the host changes the weather.",
             .source = "D: osgParticle::PrecipitationEffect"}),
        row<&TuningParameters::weather, &WeatherParameters::windSpeed>(
            {.key = "weather.wind_speed_mps",
             .label = "Wind",
             .help =
                 "Speed of the wind, with which rain and snow drift. Used where the weather comes from this "
                 "preset, and until a host has sent a wind.",
             .hard = {0, 200},
             .usual = {0, 40},
             .step = 1,
             .decimals = 1}),
        row<&TuningParameters::weather, &WeatherParameters::windFrom>(
            {.key = "weather.wind_from_deg",
             .label = "Wind from",
             .help = "Where the wind comes from, clockwise from true north.",
             .hard = {0, 360},
             .usual = {0, 360},
             .step = 5,
             .decimals = 1}),
        row<&TuningParameters::rainLight, &WeatherStepParameters::visibilityShare>(
            visibilityShare("weather.rain_light.visibility_share", "Light rain: share of visibility")),
        row<&TuningParameters::rainLight, &WeatherStepParameters::density>(
            density("weather.rain_light.density", "Light rain: density")),
        row<&TuningParameters::rainLight, &WeatherStepParameters::farStretch>(
            farStretch("weather.rain_light.far_stretch", "Light rain: far plane")),
        row<&TuningParameters::rainMedium, &WeatherStepParameters::visibilityShare>(
            visibilityShare("weather.rain_medium.visibility_share", "Medium rain: share of visibility")),
        row<&TuningParameters::rainMedium, &WeatherStepParameters::density>(
            density("weather.rain_medium.density", "Medium rain: density")),
        row<&TuningParameters::rainMedium, &WeatherStepParameters::farStretch>(
            farStretch("weather.rain_medium.far_stretch", "Medium rain: far plane")),
        row<&TuningParameters::rainHeavy, &WeatherStepParameters::visibilityShare>(
            visibilityShare("weather.rain_heavy.visibility_share", "Heavy rain: share of visibility")),
        row<&TuningParameters::rainHeavy, &WeatherStepParameters::density>(
            density("weather.rain_heavy.density", "Heavy rain: density")),
        row<&TuningParameters::rainHeavy, &WeatherStepParameters::farStretch>(
            farStretch("weather.rain_heavy.far_stretch", "Heavy rain: far plane")),
        row<&TuningParameters::snowLight, &WeatherStepParameters::visibilityShare>(
            visibilityShare("weather.snow_light.visibility_share", "Light snow: share of visibility")),
        row<&TuningParameters::snowLight, &WeatherStepParameters::density>(
            density("weather.snow_light.density", "Light snow: density")),
        row<&TuningParameters::snowLight, &WeatherStepParameters::farStretch>(
            farStretch("weather.snow_light.far_stretch", "Light snow: far plane")),
        row<&TuningParameters::snowMedium, &WeatherStepParameters::visibilityShare>(
            visibilityShare("weather.snow_medium.visibility_share", "Medium snow: share of visibility")),
        row<&TuningParameters::snowMedium, &WeatherStepParameters::density>(
            density("weather.snow_medium.density", "Medium snow: density")),
        row<&TuningParameters::snowMedium, &WeatherStepParameters::farStretch>(
            farStretch("weather.snow_medium.far_stretch", "Medium snow: far plane")),
        row<&TuningParameters::snowHeavy, &WeatherStepParameters::visibilityShare>(
            visibilityShare("weather.snow_heavy.visibility_share", "Heavy snow: share of visibility")),
        row<&TuningParameters::snowHeavy, &WeatherStepParameters::density>(
            density("weather.snow_heavy.density", "Heavy snow: density")),
        row<&TuningParameters::snowHeavy, &WeatherStepParameters::farStretch>(
            farStretch("weather.snow_heavy.far_stretch", "Heavy snow: far plane"))},
    lookRows<&TuningParameters::rainLook, "weather.rain", "Rain">(),
    lookRows<&TuningParameters::snowLook, "weather.snow", "Snow">());

}  // namespace trimtab::table
