#include <cmath>
#include <cstdlib>
#include <cstring>

#include "core/terrain/format/manifest_checksum.h"
#include "tests/support.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/ground_pyramid.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/format/store.h"

/// One file of a real database is another one: the first byte says which, and whether its checksums are made
/// right, so that its lies are believed. The database is refused with reasons, or all of it can be used.
namespace {

using namespace trimtab;
namespace fs = std::filesystem;

const char* const kFiles[] = {terrain::kHeightsName,  terrain::kHeightSumsName, terrain::kNodesName,
                              terrain::kSlopesName,   terrain::kConesName,      terrain::kPatchesName,
                              terrain::kGroundName,   terrain::kManifestName,   terrain::kImageName,
                              terrain::kImageSumsName};
constexpr std::size_t kRowBytes = 20 * 4;  // heights and colours of tests/data/terrain/version-2

/// Makes the sums of a page file right.
void sealPages(std::string& bytes) {
  if (bytes.size() < 64) return;
  std::uint64_t tableAt = 0;
  std::memcpy(&tableAt, &bytes[24], 8);
  if (tableAt <= bytes.size()) {
    const std::uint64_t sum = terrain::checksum(std::string_view(bytes).substr(tableAt));
    std::memcpy(&bytes[40], &sum, 8);
  }
  const std::uint64_t sum = terrain::checksum(std::string_view(bytes).substr(0, 56));
  std::memcpy(&bytes[56], &sum, 8);
}

void setSum(std::string& manifest, const std::string& name, std::uint64_t sum) {
  const std::size_t entry = manifest.find("\"" + name + "\": {"), at = manifest.find("\"fnv64\": \"", entry);
  if (at != std::string::npos) manifest.replace(at + 10, 16, terrain::hexadecimal(sum));
}

/// Writes a file with the sums that it needs to be believed.
void believe(const fs::path& folder, const std::string& name, std::string bytes) {
  std::string manifest = test::readFile(folder / terrain::kManifestName);
  if (name == terrain::kHeightsName || name == terrain::kImageName) {
    const char* const sumsName =
        name == terrain::kImageName ? terrain::kImageSumsName : terrain::kHeightSumsName;
    terrain::CheckedRows::Sums sums(kRowBytes);
    sums.add(std::as_bytes(std::span(bytes)));
    const std::vector<std::uint64_t> all = sums.finish();
    const std::string text(reinterpret_cast<const char*>(all.data()), all.size() * 8);
    test::writeFile(folder / sumsName, text);
    setSum(manifest, name, terrain::checksum(text));
    setSum(manifest, sumsName, terrain::checksum(text));
  } else if (name == terrain::kPatchesName || name == terrain::kGroundName) {
    sealPages(bytes);
    std::uint64_t sum = 0;
    if (bytes.size() >= 64) std::memcpy(&sum, &bytes[56], 8);
    setSum(manifest, name, sum);
  } else {
    setSum(manifest, name, terrain::checksum(bytes));
  }
  test::writeFile(folder / name, bytes);
  if (name == terrain::kManifestName) manifest = bytes;
  if (const std::size_t place = terrain::manifestChecksumPlace(manifest); place != std::string::npos)
    manifest.replace(place, 16, terrain::manifestChecksum(manifest, place));
  test::writeFile(folder / terrain::kManifestName, manifest);
}

void use(const terrain::Database& database) {
  terrain::TileMesh mesh;
  for (std::uint32_t node = 0; node < database.index().size(); ++node) database.buildTile(node, mesh);
  const GeodeticPosition a = database.info().southWest;
  if (const auto height = database.heightAt(a.latitude, a.longitude))
    if (!std::isfinite(height->value())) std::abort();
  database.highestWithin(a.latitude, a.longitude, Metres{1000});
  if (const auto patches = database.patches())
    for (std::uint32_t page = 0; page < patches->index().pages.size(); ++page)
      if (const auto read = patches->readPage(page); !read && read.findings().empty()) std::abort();
  if (const auto ground = database.ground())
    for (std::uint32_t level = 0; level < ground->shape().levels.size(); ++level)
      if (const auto read = ground->readTile(level, 0, 0); !read && read.findings().empty()) std::abort();
  static_cast<void>(database.checkAll());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const test::ScratchDir dir;
  if (size == 0) return 0;
  for (const char* name : kFiles)
    fs::copy_file(test::sourceDir() / "tests/data/terrain/version-2" / name, dir / name,
                  fs::copy_options::overwrite_existing);
  const std::string name = kFiles[data[0] % std::size(kFiles)];
  const std::string bytes(reinterpret_cast<const char*>(data + 1), size - 1);
  if (data[0] < 128)
    believe(dir.path(), name, bytes);
  else
    test::writeFile(dir / name, bytes);
  const auto database = terrain::Database::open(dir.path());
  if (!database && database.findings().empty()) std::abort();
  if (database) use(**database);
  return 0;
}
