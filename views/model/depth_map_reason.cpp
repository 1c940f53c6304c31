// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth_map_reason.h"

#include <QObject>

#include "theme.h"
#include "trimtab/preset/choices.h"

namespace trimtab::views {
namespace {

/// What people call an option of an enumeration that is a parameter.
template <class E>
QString labelOf(E option) {
  return fromView(table::ChoicesOf<E>::options[static_cast<std::size_t>(option)].label);
}

QString whoServes(OcclusionMethod method, const CullingParameters& culling) {
  if (method != OcclusionMethod::horizon)
    return QObject::tr("No depth map: near here one hid next to nothing, so that it is left out.");
  return culling.occlusion == OcclusionMethod::automatic
             ? QObject::tr(
                   "No depth map: the horizon serves, because Occlusion culling is automatic and it costs "
                   "less here.")
             : QObject::tr("No depth map: the horizon serves, because Occlusion culling is “%1”.")
                   .arg(labelOf(culling.occlusion));
}

}  // namespace

QString whyNoDepthMap(const LiveFrame& frame, const TuningParameters& parameters) {
  const FrameResult& drawn = frame.drawn();
  if (drawn.depthMap) return {};
  if (parameters.culling.cullingCase != CullingCase::proposed)
    return QObject::tr("No depth map: the Culling case is “%1”, which looks for nothing behind the ground.")
        .arg(labelOf(parameters.culling.cullingCase));
  if (frame.decision.scheme == Scheme::frustum) return QObject::tr("No depth map: scheme is frustum");
  if (!frame.result) return QObject::tr("No depth map yet: nothing has been drawn");
  if (!drawn.note.empty()) return QObject::tr("No depth map: %1").arg(QString::fromStdString(drawn.note));
  if (drawn.occlusion) return whoServes(*drawn.occlusion, parameters.culling);
  return QObject::tr("No depth map: no occlusion method was worth its cost in the last frame.");
}

}  // namespace trimtab::views
