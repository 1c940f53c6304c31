#include <cmath>
#include <cstdlib>

#include "core/terrain/format/manifest_checksum.h"
#include "tests/support.h"
#include "trimtab/terrain/format/database.h"

/// A manifest, its checksum made right so that its lies are believed, beside the files of a real database:
/// refused with reasons, or all of it can be used.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  static const test::ScratchDir dir;
  static const bool copied = [] {
    std::filesystem::copy(test::sourceDir() / "tests/data/terrain/version-1", dir / "1");
    std::filesystem::copy(test::sourceDir() / "tests/data/terrain/version-2", dir / "2");
    return true;
  }();
  std::string text(reinterpret_cast<const char*>(data), size);
  const std::filesystem::path folder = dir / (text.find("heights.sums") == std::string::npos ? "1" : "2");
  const std::size_t place = terrain::manifestChecksumPlace(text);
  if (copied && place != std::string::npos) text.replace(place, 16, terrain::manifestChecksum(text, place));
  test::writeFile(folder / "manifest.json", text);
  const auto database = terrain::Database::open(folder);
  if (!database && database.findings().empty()) std::abort();
  if (!database) return 0;
  terrain::TileMesh mesh;
  for (std::uint32_t node = 0; node < (*database)->index().size(); ++node) (*database)->buildTile(node, mesh);
  const auto height = (*database)->heightAt(Degrees{50.01}, Degrees{10.01});
  if (height && !std::isfinite(height->value())) std::abort();
  (*database)->highestWithin(Degrees{50.01}, Degrees{10.01}, Metres{1000});
  return 0;
}
