#include "trimtab/frame/visible_set.h"

#include <algorithm>

namespace trimtab {

CullReason VisibleSet::reasonOf(std::uint32_t node) const {
  if (!nodes) return CullReason::other_level;
  const auto found = std::find(nodes->begin(), nodes->end(), node);
  return found == nodes->end() ? CullReason::other_level
                               : reason[static_cast<std::size_t>(found - nodes->begin())];
}

std::vector<CullReason> VisibleSet::reasons(std::size_t ofNodes) const {
  std::vector<CullReason> all(ofNodes, CullReason::other_level);
  for (std::size_t i = 0; nodes && i < nodes->size(); ++i)
    if ((*nodes)[i] < ofNodes) all[(*nodes)[i]] = reason[i];
  return all;
}

}  // namespace trimtab
