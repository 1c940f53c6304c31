#include "published.h"

namespace trimtab::experiment {

Table publishedCulling() {
  return {{"altitude_ft", "case", "triangles", "vertices_paper_a", "vertices_paper_b", "fps"},
          {{2000.0, "none", 11079.0, 204100.0, 204100.0, 16.53},
           {4000.0, "none", 11079.0, 204100.0, 204100.0, 16.63},
           {6000.0, "none", 11079.0, 204100.0, 204100.0, 16.58},
           {8000.0, "none", 11079.0, 204100.0, 204100.0, 16.66},
           {2000.0, "view_frustum", 2560.0, 106126.0, 106126.0, 60.0},
           {4000.0, "view_frustum", 2634.0, 107310.0, 107310.0, 58.12},
           {6000.0, "view_frustum", 2724.0, 108750.0, 108750.0, 55.37},
           {8000.0, "view_frustum", 2854.0, 110980.0, 110980.0, 50.72},
           {2000.0, "proposed", 2176.0, 99782.0, 99982.0, 60.0},
           {4000.0, "proposed", 2304.0, 101654.0, 102030.0, 60.0},
           {6000.0, "proposed", 2412.0, 102159.0, 103758.0, 60.0},
           {8000.0, "proposed", 2526.0, 104256.0, 105732.0, 60.0}}};
}

Table publishedHeadMotion() {
  return {{"quantity", "before", "lod_scale_and_blur", "with_restoration"},
          {{"fps_max", 450.0, 450.0, Cell()},
           {"fps_min", 100.0, 170.0, Cell()},
           {"vertices_in_view", 44000.0, 31000.0, 36000.0}}};
}

Table publishedWeather() {
  return {{"vertices", "density", "fps_fixed_ratio", "fps_adaptive"},
          {{100000.0, "clear", 60.0, 60.0},
           {100000.0, "light", 49.0, 53.0},
           {100000.0, "medium", 45.0, 50.0},
           {100000.0, "heavy", 43.0, 50.0},
           {120000.0, "clear", 47.0, 47.0},
           {120000.0, "light", 40.0, 45.0},
           {120000.0, "medium", 38.0, 47.0},
           {120000.0, "heavy", 36.0, 46.0},
           {140000.0, "clear", 44.0, 44.0},
           {140000.0, "light", 39.0, 44.0},
           {140000.0, "medium", 36.0, 44.0},
           {140000.0, "heavy", 35.0, 44.0}}};
}

Table publishedStaticLod() {
  return {{"quantity", "value"},
          {{"triangles_original", 30987.0}, {"n", 2000.0}, {"levels", 4.0}, {"faces_all_levels", 126520.0}}};
}

}  // namespace trimtab::experiment
