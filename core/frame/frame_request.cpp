#include "trimtab/frame/frame_request.h"

namespace trimtab {

FadingPrecipitation fallsNow(const FrameRequest& request) {
  if (request.fading && request.precipitationForm == PrecipitationForm::bounded) return *request.fading;
  const WeatherDecision& weather = request.decision.weather;
  return {weather.precipitation, weather.density, weather.density};
}

std::optional<TerrainForm> formDrawn(const FrameRequest& request, const FormsOfTerrain& forms) {
  if (asksForTrees(request) && forms.trees) return TerrainForm::static_trees;
  const bool patches = request.terrain.form == TerrainForm::patches || !forms.tiles;
  if (forms.patches && patches) return TerrainForm::patches;
  if (forms.tiles) return TerrainForm::tiles;
  return {};
}

}  // namespace trimtab
