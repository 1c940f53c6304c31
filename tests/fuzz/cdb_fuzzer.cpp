#include <cmath>
#include <cstdlib>
#include <string>

#include "tests/support.h"
#include "trimtab/terrain/cdb/features.h"
#include "trimtab/terrain/cdb/models.h"

/// A CDB of which one file is replaced, by its first bytes: a table, places, an archive, a version; or a
/// name.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  static const test::ScratchDir dir;
  const std::filesystem::path from = test::sourceDir() / "tests/data/cdb", root = dir / "Root";
  const std::string bytes(reinterpret_cast<const char*>(data), size),
      cell = "Tiles/N32/W118/", name = "/L00/U0/N32W118_D", end = "_L00_U0_R0";
  const auto put = [&](const char* base, const std::string& to, bool replaced) {
    std::filesystem::create_directories((root / to).parent_path());
    test::writeFile(root / to, replaced ? bytes : test::readFile(from / base));
  };
  const char first = size > 0 ? static_cast<char>(data[0]) : 'x';
  put("instances.shp", cell + "100_F" + name + "100_S001_T001" + end + ".shp", first == '\0');
  put("instances.shx", cell + "100_F" + name + "100_S001_T001" + end + ".shx",
      first == '\0' && size % 2 == 0);
  put("instances.dbf", cell + "100_F" + name + "100_S001_T001" + end + ".dbf", first == 3 && size % 2 == 0);
  put("classes.dbf", cell + "100_F" + name + "100_S001_T002" + end + ".dbf", first == 3 && size % 2 == 1);
  put("models.zip", cell + "300_M" + name + "300_S001_T001" + end + ".zip", first == 'P');
  put("version.xml", "Metadata/Version.xml", first == '<');
  if (const auto read = terrain::cdbNameOf(bytes.substr(0, bytes.find('\n'))))
    if (terrain::cdbNameOf(read->tile.name())->tile != read->tile) std::abort();
  const auto cdb = terrain::openCdb(root);
  if (!cdb) std::abort();
  Findings findings;
  const terrain::CdbFeatures features = terrain::readCdbFeatures(*cdb, findings);
  for (const ListedPlacement& p : features.list.placements) {
    if (p.model >= features.models.size() || features.models.size() != features.list.models.size())
      std::abort();
    if (!(std::abs(p.latitude.value()) <= 90 && std::abs(p.heading.value()) <= 360)) std::abort();
    if (!(p.scale >= PlacementLimits::kLeastScale && p.scale <= PlacementLimits::kMostScale)) std::abort();
    if (!(std::abs(p.aboveGround.value()) <= PlacementLimits::kHeightM)) std::abort();
  }
  for (const ModelFile& model : features.models)
    if (!terrain::bytesOfFile(model.file, 1 << 20) && first != 'P') std::abort();
  return 0;
}
