#include <cmath>
#include <cstdlib>
#include <string>

#include "tests/support.h"
#include "trimtab/terrain/scenery/objects.h"
#include "trimtab/terrain/scenery/scenery.h"

/// A list of scenery names files of its own folder or is refused with reasons: nothing outside is opened.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  static const test::ScratchDir dir;
  static const bool made = [] {
    std::filesystem::create_directory(dir / "inside");
    for (const char* name : {"1.btg", "2.btg.gz", "EDDF.btg"}) test::writeFile(dir / "inside" / name, "");
    test::writeFile(dir / "outside.btg", "");
    test::writeFile(dir / "inside/house.ac", "");
    return true;
  }();
  if (!made) return 0;
  test::writeFile(dir / "inside/list.stg", std::string(reinterpret_cast<const char*>(data), size));
  const auto list = terrain::listScenery(dir / "inside/list.stg");
  if (!list) {
    if (list.findings().empty()) std::abort();
    return 0;
  }
  for (const auto& file : list->files)
    if (file.path.parent_path() != dir / "inside") std::abort();
  Findings findings;
  const auto objects = terrain::readSceneryObjects(dir / "inside/list.stg", {}, findings);
  if (objects.models.size() != objects.list.models.size()) std::abort();
  for (const ModelFile& model : objects.models)
    if (!model.file.starts_with((dir / "inside").string())) std::abort();
  for (const ListedPlacement& p : objects.list.placements) {
    if (p.model >= objects.models.size() || !(std::abs(p.latitude.value()) <= 90)) std::abort();
    if (!(std::abs(p.heading.value()) <= PlacementLimits::kHeadingDeg)) std::abort();
    if (!(std::abs(p.height.value_or(p.aboveGround).value()) <= PlacementLimits::kHeightM)) std::abort();
  }
  return 0;
}
