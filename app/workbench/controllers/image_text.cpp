// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_text.h"

#include <QObject>
#include <QStringList>
#include <cmath>

#include "trimtab/frame/overlay_colours.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

QColor colourOf(const std::array<std::uint8_t, 3>& c) {
  return {c[0], c[1], c[2]};
}

QList<LegendEntry> reasonLegend() {
  const auto entry = [](const QString& text, CullReason reason) {
    return LegendEntry{text, colourOf(reasonColour(reason))};
  };
  return {entry(QObject::tr("drawn"), CullReason::drawn),
          entry(QObject::tr("outside the frustum"), CullReason::outside_frustum),
          entry(QObject::tr("occluded"), CullReason::occluded),
          entry(QObject::tr("beyond visibility"), CullReason::beyond_visibility),
          entry(QObject::tr("facing away"), CullReason::back_facing)};
}

QList<LegendEntry> levelLegend(std::size_t levels) {
  QList<LegendEntry> entries;
  for (int level = 0; level < static_cast<int>(levels); ++level)
    entries.append({QObject::tr("level %1").arg(level), colourOf(levelColour(level))});
  return entries;
}

QList<LegendEntry> treePictureLegend() {
  return {{QObject::tr("face"), QColor(214, 214, 214)},
          {QObject::tr("edge"), QColor(217, 0, 0)},
          {QObject::tr("locked edge"), QColor(0, 0, 0)}};
}

}  // namespace

Legend legendOf(const FrameRequest& request, bool patches, const terrain::Database& terrain) {
  const Overlays& overlays = request.overlays;
  const auto trees = terrain.staticLod();
  if (overlays.treePicture && trees)
    return {QObject::tr("As in the published picture of static LOD"), treePictureLegend()};
  if (overlays.textureSquares && trees && !terrain::hasTexture(*trees))
    return {QObject::tr("This terrain kept no texture coordinates: bake it with --keep-texture"), {}};
  if (overlays.colourByReason) return {QObject::tr("Why a tile is drawn or not"), reasonLegend()};
  if (!overlays.colourByLevel) return {};
  if (trees && asksForTrees(request))
    return {QObject::tr("Depth in the static trees, 0 is the root"), levelLegend(trees->counts.levels)};
  if (patches) {
    // Patches are sorted by depth, so the last one is the deepest.
    const auto& depth = terrain.patches()->index().depth;
    return {QObject::tr("Depth of the patches, 0 is the coarsest"),
            levelLegend(depth.empty() ? 0 : depth.back() + std::size_t{1})};
  }
  return {QObject::tr("Level of detail, 0 is finest"), levelLegend(terrain.index().levels.size())};
}

QString hudText(const HudFacts& facts) {
  const AircraftState& eye = facts.eye;
  QStringList parts;
  parts << QObject::tr("%L1 ft").arg(eye.position.height.in<Feet>(), 0, 'f', 0);
  parts << QObject::tr("heading %1°")
               .arg(std::fmod(std::round(eye.attitude.heading.value()) + 360, 360.0), 3, 'f', 0,
                    QLatin1Char('0'));
  parts << QObject::tr("pitch %1°").arg(eye.attitude.pitch.value(), 0, 'f', 1);
  if (facts.result != nullptr) {
    parts << QObject::tr("%L1 triangles").arg(facts.result->visible.triangles);
    parts << QObject::tr("%1 ms").arg(views::numberText(facts.frameMs, 1));
  }
  if (facts.terrain != nullptr && !facts.terrain->heightAt(eye.position.latitude, eye.position.longitude))
    parts << QObject::tr("not over the terrain");
  if (std::isfinite(facts.fps)) parts << QObject::tr("%1 fps").arg(facts.fps, 0, 'f', 0);
  if (facts.cameraSpeed)
    parts << QObject::tr("camera, %L1 kt by keys").arg(facts.cameraSpeed->in<Knots>(), 0, 'f', 0);
  return parts.join(QStringLiteral("   "));
}

}  // namespace trimtab::workbench
