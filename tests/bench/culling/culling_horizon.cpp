#include "culling_horizon.h"

#include <string>
#include <vector>

#include "hidden_share.h"
#include "rough_ground.h"
#include "trimtab/culling/frustum.h"
#include "trimtab/culling/horizon.h"

namespace trimtab::bench {

void horizonRows(Report& report) {
  const RoughGround ground;
  Horizon horizon;
  const Horizon::Settings settings{.columns = 800, .slack = 0.02 * 1.1547 / 1280};
  for (const ShareGoal goal :
       {ShareGoal{100, 0.90, 0.86}, ShareGoal{400, 0.88, 0.81}, ShareGoal{1500, 0.60, 0.28}}) {
    RoughViews eyes(ground, 1);
    double seconds = 0;
    HiddenShare share;
    const int views = report.quick() ? 4 : 20;
    for (int i = 0; i < views; ++i) {
      const EyePose eye = eyes.next(goal.aboveM);
      seconds += leastSeconds(5, [&] { horizon.build(eye.position, ground.tiles(), settings); });
      const ViewShape view;
      const std::vector<std::uint8_t> owns = ground.owners(eye, view);
      const Frustum frustum(eye, view);
      for (std::size_t t = 0; t < owns.size(); ++t)
        if (frustum.mayShow(ground.boxOf(t))) share.add(owns[t] != 0, horizon.hidden()[t] != 0);
    }
    report.add(valueAtMost(2, {.id = "culling.horizon_" + goal.above() + "m",
                               .what = "Horizon over the whole circle from scratch, 6,400 tiles tested, " +
                                       goal.above() + " m above fractal ground",
                               .value = 1e3 * seconds / views,
                               .unit = "ms",
                               .peer = "masked occlusion culling, one view of 60 degrees",
                               .peerValue = 0.97,
                               .peerFrom = "quoted"}));
    addShareRows(report, "culling.horizon", "horizon", goal, views, share, "a horizon against boxes");
  }
}

}  // namespace trimtab::bench
