#include "trimtab/frame/overlay_colours.h"

namespace trimtab {

std::array<std::uint8_t, 3> reasonColour(CullReason reason) {
  switch (reason) {
    case CullReason::drawn:
      return {0, 158, 115};
    case CullReason::outside_frustum:
      return {230, 159, 0};
    case CullReason::occluded:
      return {204, 121, 167};
    case CullReason::beyond_visibility:
      return {86, 180, 233};
    case CullReason::back_facing:
      return {0, 114, 178};
    case CullReason::other_level:
      break;
  }
  return {153, 153, 153};
}

std::array<std::uint8_t, 3> levelColour(int level) {
  constexpr std::array<std::array<std::uint8_t, 3>, 7> kColours{{{213, 94, 0},
                                                                 {230, 159, 0},
                                                                 {240, 228, 66},
                                                                 {0, 158, 115},
                                                                 {86, 180, 233},
                                                                 {0, 114, 178},
                                                                 {204, 121, 167}}};
  return kColours[static_cast<std::size_t>(level < 0 ? 0 : level) % kColours.size()];
}

}  // namespace trimtab
