#include "report.h"

#include <array>
#include <cmath>

#include "app/experiment/page.h"
#include "front.h"
#include "results_json.h"
#include "trimtab/measure/statistics.h"
#include "trimtab/preset/preset.h"
#include "worst_pictures.h"

namespace trimtab::harness {
namespace {

Json quantityJson(const Quantity& quantity) {
  const auto stageOf = [](StageKind kind) {
    return kind == StageKind::total    ? "total"
           : kind == StageKind::part   ? "part"
           : kind == StageKind::beside ? "beside"
                                       : "of_frame";
  };
  constexpr std::array kKinds{"cost", "count", "error", "lever"};
  return {{"key", quantity.key},
          {"label", quantity.label},
          {"unit", quantity.unit},
          {"kind", kKinds[static_cast<std::size_t>(quantity.kind)]},
          {"whole", quantity.whole},
          {"larger_is_worse", quantity.largerIsWorse},
          {"stage", stageOf(quantity.stage)}};
}

/// `low` and `high` are the 5th and 95th percentile of the frames. `median_of_all` counts a frame that leaves
/// a stage out as 0, because it spends nothing on it; it is NaN if no frame ran the stage.
Json numbersJson(const Unit& unit) {
  Json json = Json::object();
  for (const Quantity& quantity : quantities()) {
    const Summary s = summarise(unit, quantity);
    std::vector<double> all;
    for (const MeasuredFrame& frame : unit.frames)
      all.push_back(std::isfinite(quantity.of(frame)) ? quantity.of(frame) : 0);
    const std::vector<double> finite = finiteOf(unit, quantity);
    json[std::string(quantity.key)] = {
        {"median", numberJson(s.median)},
        {"mean", numberJson(s.mean)},
        {"p95", numberJson(s.p95)},
        {"p99", numberJson(s.p99)},
        {"worst", numberJson(s.worst)},
        {"low", numberJson(quantileOf(finite, 0.05))},
        {"high", numberJson(quantileOf(finite, 0.95))},
        {"median_of_all", numberJson(std::isnan(s.median) ? s.median : quantileOf(all, 0.5))}};
  }
  return json;
}

}  // namespace

std::string pageJson(const Results& results, const std::filesystem::path& folder) {
  Json json = documentOf(results);
  json["quantities"] = Json::array();
  for (const Quantity& quantity : quantities()) json["quantities"].push_back(quantityJson(quantity));
  json["fronts"] = Json::array();
  for (const Front& front : frontsOf(results))
    json["fronts"].push_back({{"flight", front.flight},
                              {"error", front.error->key},
                              {"known", front.known},
                              {"units", front.units}});
  const WorstPictures pictures(results, folder);
  json["pictures_width_px"] = pictures.widthPx();
  json["pictures"] = Json::array();
  for (const WorstPictures::Picture& p : pictures.all())
    json["pictures"].push_back(
        {{"png", p.base64}, {"problem", p.problem}, {"width", p.widthPx}, {"height", p.heightPx}});
  for (std::size_t u = 0; u < results.units.size(); ++u) {
    const Unit& unit = results.units[u];
    Json& unitJson = json["units"][u];
    unitJson["numbers"] = numbersJson(unit);
    for (std::size_t w = 0; w < unit.worst.size(); ++w)
      unitJson["worst"][w]["pictures"] = {pictures.indexOf(unit.worst[w].reference),
                                          pictures.indexOf(unit.worst[w].ours),
                                          pictures.indexOf(unit.worst[w].difference)};
  }
  return textOf(json);
}

std::string htmlReport(const Results& results, const std::filesystem::path& folder) {
  return experiment::pageWith(pageJson(results, folder));
}

Result<Done> writeReport(const Results& results, const std::filesystem::path& folder) {
  return writeAtomically(folder / "report.html", htmlReport(results, folder));
}

}  // namespace trimtab::harness
