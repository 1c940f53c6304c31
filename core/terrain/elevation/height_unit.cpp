#include "height_unit.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

struct Unit {
  std::string_view name;
  double metres;
};

constexpr double kFoot = 0.3048, kSurveyFoot = 1200.0 / 3937;

/// Names as plainName writes them: the first of each unit is the one that messages offer.
constexpr std::array kUnits = {
    Unit{"metre", 1},
    Unit{"m", 1},
    Unit{"foot", kFoot},
    Unit{"ft", kFoot},
    Unit{"'", kFoot},
    Unit{"internationalfoot", kFoot},
    Unit{"footinternational", kFoot},
    Unit{"intlfoot", kFoot},
    Unit{"footintl", kFoot},
    Unit{"ftint", kFoot},
    Unit{"ftintl", kFoot},
    Unit{"ussurveyfoot", kSurveyFoot},
    Unit{"surveyfoot", kSurveyFoot},
    Unit{"footussurvey", kSurveyFoot},
    Unit{"ussurveyft", kSurveyFoot},
    Unit{"footus", kSurveyFoot},
    Unit{"usfoot", kSurveyFoot},
    Unit{"ftus", kSurveyFoot},
    Unit{"usft", kSurveyFoot},
    Unit{"sfoot", kSurveyFoot},
    Unit{"kilometre", 1000},
    Unit{"km", 1000},
    Unit{"decimetre", 0.1},
    Unit{"dm", 0.1},
    Unit{"centimetre", 0.01},
    Unit{"cm", 0.01},
    Unit{"millimetre", 0.001},
    Unit{"mm", 0.001},
    Unit{"yard", 0.9144},
    Unit{"yd", 0.9144},
    Unit{"internationalyard", 0.9144},
    Unit{"fathom", 1.8288},
    Unit{"internationalfathom", 1.8288},
};

/// Returns a name in lower case, singular, in British spelling, without spaces and signs.
std::string plainName(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) != 0 || c == '\'') plain += static_cast<char>(std::tolower(letter));
  }
  const auto replace = [&](std::string_view from, std::string_view to) {
    if (const std::size_t at = plain.find(from); at != std::string::npos) plain.replace(at, from.size(), to);
  };
  replace("feet", "foot");
  replace("meter", "metre");
  if (plain.size() > 4 && plain.back() == 's' && !plain.ends_with("us")) plain.pop_back();
  return plain;
}

bool differ(double a, double b) {
  // The two feet are nearly the same: a file that names one here and the other there contradicts nothing.
  constexpr double kSame = 1e-5;
  return std::abs(a - b) > kSame * b;
}

/// Tells whether a unit is a metre or a power of ten of it.
bool isMetric(double metres) {
  const double power = std::log10(metres);
  return std::abs(power - std::round(power)) < 1e-9;
}

std::string inMetres(double metres) {
  return numberText(metres, 9) + " m";
}

Finding ask(const std::string& file, std::string expected, std::string found) {
  return {Severity::error, file, "unit",
          std::move(expected) + "; say it with --height-unit NAME, where NAME is " + unitsOfHeight(),
          std::move(found)};
}

}  // namespace

std::optional<double> metresPerUnit(std::string_view name) {
  while (!name.empty() && std::isspace(static_cast<unsigned char>(name.front())) != 0) name.remove_prefix(1);
  // UDUNITS allows a factor before the name.
  double factor = 1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), factor);
  if (error == std::errc{}) name.remove_prefix(static_cast<std::size_t>(end - name.data()));
  if (!(factor > 0) || !std::isfinite(factor)) return {};
  const std::string plain = plainName(name);
  const auto* const unit =
      std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& u) { return u.name == plain; });
  if (unit == kUnits.end()) return {};
  return factor * unit->metres;
}

std::string unitsOfHeight() {
  return "metre, decimetre, centimetre, kilometre, foot, us_survey_foot, yard or fathom";
}

Result<double> heightUnitOf(const PlacedRaster& raster, const std::string& file, const Vertical& vertical,
                            std::optional<double> told) {
  const std::string name = raster.data->GetRasterBand(1)->GetUnitType();
  const std::optional<double> ofBand = metresPerUnit(name);
  std::optional<double> ofFile = ofBand ? ofBand : vertical.unit;
  if (ofBand && vertical.unit && differ(*ofBand, *vertical.unit)) {
    if (!told)
      return ask(file, "one unit of heights",
                 "\"" + name + "\" of the band and " + inMetres(*vertical.unit) + " of the vertical CRS");
    ofFile.reset();
  }
  if (ofFile) {
    Findings notes;
    if (told && differ(*told, *ofFile))
      notes.push_back({Severity::warning, file, "unit", inMetres(*told) + ", as --height-unit says",
                       (ofBand ? "\"" + name + "\"" : inMetres(*ofFile) + " of the vertical CRS") +
                           ": kept, as the option is for files that name no unit"});
    return Result<double>(*ofFile, std::move(notes));
  }
  if (told)
    return Result<double>(*told, {{Severity::note, file, "unit", "a unit of heights in the file",
                                   (name.empty() ? "none" : "\"" + name + "\"") + ": " + inMetres(*told) +
                                       " taken, as --height-unit says"}});
  if (!name.empty()) return ask(file, "a unit of heights that is known", "\"" + name + "\"");
  const char* places = nullptr;
  const double across = raster.crs.IsProjected() ? raster.crs.GetLinearUnits(&places) : 1;
  if (isMetric(across)) return 1.0;
  return ask(file,
             std::string("a unit of heights: places are in ") + (places ? places : inMetres(across)) +
                 ", heights may be in the same unit or in metres",
             "none");
}

}  // namespace trimtab::terrain
