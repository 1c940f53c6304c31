#include "trimtab/culling/select_lights.h"

#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/frustum.h"

namespace trimtab {

void selectLights(const LightIndex& lights, const LightQuery& query, std::vector<std::uint32_t>& cells) {
  cells.clear();
  if (!(query.sizePx > 0)) return;
  ViewShape wider = query.view;
  // A light's edge is rounded to the rasteriser's grid, a fraction of a pixel: one pixel covers that.
  const double marginPx = query.sizePx / 2 + 1;
  const double across = (wider.right - wider.left) / wider.widthPx * marginPx,
               upward = (wider.top - wider.bottom) / wider.heightPx * marginPx;
  wider.left -= across, wider.right += across;
  wider.bottom -= upward, wider.top += upward;
  const Frustum frustum(query.eye, wider);
  for (std::uint32_t i = 0; i < lights.cells.size(); ++i) {
    const Box& bounds = lights.cells[i].bounds;
    if (query.cull && (isBeyond(bounds, query.eye.position, query.airM) || !frustum.mayShow(bounds)))
      continue;
    cells.push_back(i);
  }
}

}  // namespace trimtab
