#include <cmath>
#include <cstdlib>

#include "trimtab/host/placement_list.h"

/// A list of placements is read or refused with reasons; what is read can be placed.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  const auto list = readPlacementList({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!list) {
    if (list.findings().empty()) std::abort();
    return 0;
  }
  if (list->placements.empty()) std::abort();
  for (const ListedPlacement& p : list->placements) {
    if (p.model >= list->models.size() || list->models[p.model].empty()) std::abort();
    if (!(std::abs(p.latitude.value()) <= 90 && std::abs(p.longitude.value()) <= 360)) std::abort();
    if (!(p.scale >= PlacementLimits::kLeastScale && p.scale <= PlacementLimits::kMostScale)) std::abort();
    if (!(std::abs(p.heading.value()) <= PlacementLimits::kHeadingDeg)) std::abort();
    if (p.height && !(std::abs(p.height->value()) <= PlacementLimits::kHeightM)) std::abort();
  }
  return 0;
}
