#include "culling_horizon.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "rough_ground.h"
#include "trimtab/culling/frustum.h"
#include "trimtab/culling/horizon.h"

namespace trimtab::bench {

void horizonRows(Report& report) {
  const RoughGround ground;
  struct Goal {
    double aboveM, share, quoted;
  };
  Horizon horizon;
  const Horizon::Settings settings{.columns = 800, .slack = 0.02 * 1.1547 / 1280};
  for (const Goal goal : {Goal{100, 0.90, 0.86}, Goal{400, 0.88, 0.81}, Goal{1500, 0.60, 0.28}}) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(0.3, 0.7), circle(0, 6.283185307);
    double seconds = 0;
    std::size_t hidden = 0, culled = 0, wrong = 0, inView = 0;
    const int views = report.quick() ? 4 : 20;
    for (int i = 0; i < views; ++i) {
      const double side = (RoughGround::kPosts - 1) * RoughGround::kPostM;
      Vec3 p{side * place(random), side * place(random), 0};
      p.z = ground.heightAt(p.x, p.y) + goal.aboveM;
      const double heading = circle(random);
      const EyePose eye{p,
                        {{Vec3{std::cos(heading), -std::sin(heading), 0}, Vec3{0, 0, 1},
                          Vec3{-std::sin(heading), -std::cos(heading), 0}}}};
      seconds += leastSeconds(5, [&] { horizon.build(p, ground.tiles(), settings); });
      const ViewShape view;
      const std::vector<std::uint8_t> owns = ground.owners(eye, view);
      const Frustum frustum(eye, view);
      for (std::size_t t = 0; t < owns.size(); ++t) {
        if (!frustum.mayShow(ground.boxOf(t))) continue;
        ++inView;
        hidden += owns[t] == 0;
        culled += horizon.hidden()[t] != 0 && owns[t] == 0;
        wrong += horizon.hidden()[t] != 0 && owns[t] != 0;
      }
    }
    const std::string above = std::to_string(static_cast<int>(goal.aboveM));
    report.add(valueAtMost(2, {.id = "culling.horizon_" + above + "m",
                               .what = "Horizon over the whole circle from scratch, 6,400 tiles tested, " +
                                       above + " m above fractal ground",
                               .value = 1e3 * seconds / views,
                               .unit = "ms",
                               .peer = "masked occlusion culling, one view of 60 degrees",
                               .peerValue = 0.97,
                               .peerFrom = "quoted"}));
    report.add(valueAtLeast(
        100 * goal.share, {.id = "culling.horizon_share_" + above + "m",
                           .what = "Of the tiles in view that own no pixel, left out by the horizon (" +
                                   std::to_string(hidden) + " hidden of " + std::to_string(inView) + " in " +
                                   std::to_string(views) + " views)",
                           .value = 100.0 * static_cast<double>(culled) / static_cast<double>(hidden),
                           .unit = "%",
                           .peer = "a horizon against boxes",
                           .peerValue = 100 * goal.quoted,
                           .peerFrom = "quoted"}));
    report.add(valueAtMost(0, {.id = "culling.horizon_wrong_" + above + "m",
                               .what = "Tiles that own a pixel and are left out",
                               .value = static_cast<double>(wrong),
                               .unit = "tiles"}));
  }
}

}  // namespace trimtab::bench
