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
  if (!drawn.occlusion) return QObject::tr("No depth map: finding hidden ground was not worth its cost.");
  return QObject::tr("No depth map: the horizon serves, because Occlusion culling is “%1”.")
      .arg(labelOf(parameters.culling.occlusion));
}

}  // namespace trimtab::views
