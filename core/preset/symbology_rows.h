#pragma once

#include "rows.h"

/// Rows of the helmet-mounted display's symbols.
namespace trimtab::table {

/// Makes the five rows of one symbol. `placeHelp` says what x and y mean for it.
template <auto Group, Literal Name, Literal Label>
consteval std::array<CheckedRow, 5> symbolRows(std::string_view whatItShows, std::string_view placeHelp) {
  constexpr std::string_view kSource = "C: symbols of the HMD, set by the user";
  return {
      row<Group, &SymbolElement::show>({.key = Concatenated<Name, ".show">::kView,
                                        .label = Concatenated<Label, "">::kView,
                                        .help = whatItShows,
                                        .source = kSource}),
      row<Group, &SymbolElement::colour>({.key = Concatenated<Name, ".colour">::kView,
                                          .label = Concatenated<Label, ": colour">::kView,
                                          .help = "Colour of the symbol's lines; the rim is dark, and "
                                                  "bright where the symbol is black.",
                                          .source = kSource}),
      row<Group, &SymbolElement::x>({.key = Concatenated<Name, ".x">::kView,
                                     .label = Concatenated<Label, ": x">::kView,
                                     .help = placeHelp,
                                     .source = kSource,
                                     .hard = {-1, 1},
                                     .usual = {-1, 1},
                                     .step = 0.01,
                                     .decimals = 3}),
      row<Group, &SymbolElement::y>({.key = Concatenated<Name, ".y">::kView,
                                     .label = Concatenated<Label, ": y">::kView,
                                     .help = placeHelp,
                                     .source = kSource,
                                     .hard = {-1, 1},
                                     .usual = {-1, 1},
                                     .step = 0.01,
                                     .decimals = 3}),
      row<Group, &SymbolElement::size>(
          {.key = Concatenated<Name, ".size">::kView,
           .label = Concatenated<Label, ": size">::kView,
           .help = "Multiplies the symbol's size; line widths stay. Symbols grow with the picture's height.",
           .source = kSource,
           .hard = {0.1, 10},
           .usual = {0.25, 4},
           .step = 0.05,
           .decimals = 2,
           .logarithmic = true})};
}

inline constexpr std::string_view kFreePlace =
    "Where the middle of the symbol is: fractions of half the picture from its middle, right and up "
    "positive.";
inline constexpr std::string_view kWorldPlace =
    "0 is where the world says; anything else moves the symbol away from there, by fractions of half the "
    "picture, right and up positive.";

inline constexpr std::string_view kHostPlace =
    "0 is where the host puts its symbols; anything else moves all of them away from there, by fractions of "
    "half the picture, right and up positive.";

inline constexpr auto kSymbologyRows = joined(
    std::array{
        row<&TuningParameters::symbology, &SymbologyParameters::enabled>(
            {.key = "symbology.enabled",
             .label = "Symbols of the helmet display",
             .help = "Draws flight symbols over the picture, as the pilot's helmet-mounted display does.",
             .source = "C: symbol generation module"}),
        row<&TuningParameters::symbology, &SymbologyParameters::frame>(
            {.key = "symbology.frame",
             .label = "Fixed to",
             .help = "What the heading tape and the readouts are fixed to: to the helmet they stay where "
                     "they are in "
                     "the picture, and the tape tells the line of sight's heading; to the aircraft they "
                     "leave the "
                     "picture when the head turns, and the tape tells the aircraft's. The pitch ladder is "
                     "centred on "
                     "the same heading."}),
        row<&TuningParameters::symbology, &SymbologyParameters::lineWidth>(
            {.key = "symbology.line_width_px",
             .label = "Line width",
             .help = "Width of the symbols' lines, without the rim.",
             .hard = {0.5, 16},
             .usual = {1, 6},
             .step = 0.1,
             .decimals = 1}),
        row<&TuningParameters::symbology, &SymbologyParameters::outline>(
            {.key = "symbology.outline_px",
             .label = "Rim",
             .help = "Width of a dark rim on both sides of each line, which keeps bright symbols readable "
                     "over snow "
                     "and sky.",
             .hard = {0, 8},
             .usual = {0, 4},
             .step = 0.1,
             .decimals = 1})},
    symbolRows<&TuningParameters::symbolPitchLadder, "symbology.pitch_ladder", "Pitch ladder">(
        "Bars at every 5 degrees of elevation and the true horizontal, which lies above the visible horizon "
        "by its "
        "dip.",
        kWorldPlace),
    symbolRows<&TuningParameters::symbolAircraftReference, "symbology.aircraft_reference",
               "Aircraft reference">("Marks where the aircraft's nose points.", kWorldPlace),
    symbolRows<&TuningParameters::symbolFlightPath, "symbology.flight_path", "Flight path marker">(
        "Marks where the aircraft flies to. Not drawn at rest, when there is no such direction.",
        kWorldPlace),
    symbolRows<&TuningParameters::symbolLineOfSight, "symbology.line_of_sight", "Line-of-sight cue">(
        "Marks the line of sight, points the way back to the aircraft's nose, and tells the angles between "
        "the two.",
        kWorldPlace),
    symbolRows<&TuningParameters::symbolHeadingTape, "symbology.heading_tape", "Heading tape">(
        "A tape of 40 degrees of true heading with its value above.", kFreePlace),
    symbolRows<&TuningParameters::symbolAirspeed, "symbology.airspeed", "Airspeed">(
        "Calibrated airspeed (CAS) where the host sends it; else ground speed from successive positions, "
        "labelled "
        "GS.",
        kFreePlace),
    symbolRows<&TuningParameters::symbolAltitude, "symbology.altitude", "Altitude">(
        "Height above mean sea level, to 10 ft.", kFreePlace),
    symbolRows<&TuningParameters::symbolHost, "symbology.host", "Symbols of the host">(
        "Draws the radar, weapon and navigation symbols that a CIGI host defines, over all others.",
        kHostPlace),
    std::array{row<&TuningParameters::symbology, &SymbologyParameters::recolourHost>(
        {.key = "symbology.host.recolour",
         .label = "Symbols of the host: this colour",
         .help = "Draws all symbols of the host in the colour that is set here. If off, each has the colour "
                 "that the host sends."})});

}  // namespace trimtab::table
