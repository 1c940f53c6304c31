#include "trimtab/terrain/format/patch_store.h"

#include <cmath>
#include <cstring>
#include <span>

#include "trimtab/terrain/format/patch_bytes.h"
#include "trimtab/terrain/format/patch_layout.h"

namespace trimtab::terrain {

std::size_t PatchPage::bytes() const {
  std::size_t sum = 0;
  for (const PatchMesh& patch : patches)
    sum += patch.vertices.size() * sizeof(PatchVertex) + patch.indices.size() * sizeof(std::uint16_t);
  return sum;
}

namespace {

constexpr std::uint64_t kIndexKey = std::uint64_t{1} << 32, kFactsKey = kIndexKey + 1,
                        kConesKey = kIndexKey + 2;

/// This version counts the forms of what the index and the pages store of a patch.
constexpr std::uint64_t kVersion = 5;

/// Says what a file of patches was made for.
struct GridHeader {
  std::uint64_t version = kVersion;
  PostGrid posts;
  std::uint32_t patches = 0, pages = 0;
  std::uint32_t leafCells = 0, variants = 0;
};
static_assert(sizeof(GridHeader) == 64);

bool isSound(const Box& b, std::span<const float> errorM) {
  if (!(b.minX <= b.maxX && b.minY <= b.maxY && b.minZ <= b.maxZ)) return false;
  for (const float f : {b.minX, b.minY, b.minZ, b.maxX, b.maxY, b.maxZ})
    if (!std::isfinite(f)) return false;
  for (const float e : errorM)
    if (!(e >= 0) || !std::isfinite(e)) return false;
  return true;
}

/// Returns a number of patches that no grid is below: halves of the smallest squares that lie wholly in it,
/// quarters of those twice as wide. It is known at once, so that a header that lies does not cost the index
/// of another size.
std::uint64_t leastPatches(const PostGrid& posts, std::uint32_t leafCells) {
  const auto squares = [&](std::uint32_t cells) {
    return std::uint64_t{(posts.columns - 1) / cells} * ((posts.rows - 1) / cells);
  };
  return 2 * squares(leafCells) + 4 * squares(2 * leafCells);
}

class StoredPatches final : public PatchTerrain {
 public:
  StoredPatches(std::shared_ptr<const PageFile> pages, std::filesystem::path file, const PostGrid& posts)
      : pages_(std::move(pages)), file_(std::move(file)), geometry_(posts) {}

  const PatchIndex& index() const override { return index_; }
  const std::vector<PatchFacts>& facts() const override { return facts_; }
  std::uint64_t pageBytes(std::uint32_t page) const override { return pages_->bytesOf(page); }
  Result<PatchPage> readPage(std::uint32_t page) const override {
    if (page >= index_.pages.size())
      return wrong("page " + std::to_string(page), "less than " + std::to_string(index_.pages.size()),
                   std::to_string(page));
    const auto blob = pages_->read(page);
    if (!blob) return blob.findings();
    return decodePage(*blob, index_, page, geometry_, file_.string());
  }

  Finding wrong(const std::string& key, const std::string& expected, const std::string& found) const {
    return {Severity::error, file_.string(), key, expected, found};
  }
  Result<Done> load(const PostGrid& posts) {
    const auto measured = pages_->read(kIndexKey);
    if (!measured) return measured.findings();
    GridHeader header;
    if (measured->size() < sizeof header) return wrong("index", "a header", "less");
    std::memcpy(&header, measured->data(), sizeof header);
    if (header.version != kVersion)
      return wrong("index", "version " + std::to_string(kVersion) + " (bake it again)",
                   "version " + std::to_string(header.version));
    if (!(header.posts == posts)) return wrong("index", "the grid of the manifest", "another one");
    if (header.leafCells != kFineLeafCells && header.leafCells != kCoarseLeafCells)
      return wrong("index",
                   "squares of " + std::to_string(kFineLeafCells) + " or " +
                       std::to_string(kCoarseLeafCells) + " cells",
                   std::to_string(header.leafCells));
    const std::size_t variants = variantsOf(header.leafCells).count;
    if (header.variants != variants)
      return wrong("index",
                   std::to_string(variants) + " meshes a patch with squares of " +
                       std::to_string(header.leafCells) + " cells",
                   std::to_string(header.variants));
    if (const std::uint64_t least = leastPatches(posts, header.leafCells); header.patches < least)
      return wrong("index",
                   "at least " + std::to_string(least) + " patches with squares of " +
                       std::to_string(header.leafCells) + " cells",
                   std::to_string(header.patches));
    index_ = makePatchIndex(posts, geometry_, header.leafCells);
    const std::size_t count = index_.size();
    const std::span<const std::byte> bytes(*measured);
    PatchBytesReader in(bytes.subspan(sizeof header));
    in.take(std::span(index_.bounds));
    in.take(index_.errorM.values(0, count));
    in.take(index_.triangles.values(0, count));
    if (header.patches != count || header.pages != index_.pages.size() || !in.isWhole())
      return wrong("index",
                   std::to_string(count) + " patches in " + std::to_string(index_.pages.size()) + " pages",
                   std::to_string(header.patches) + " in " + std::to_string(header.pages) + ", " +
                       std::to_string(measured->size()) + " bytes");
    for (std::size_t i = 0; i < count; ++i)
      if (!isSound(index_.bounds[i], index_.errorM[i]))
        return wrong("patch " + std::to_string(i), "bounds and errors", "no such numbers");
    const auto facts = pages_->read(kFactsKey);
    if (!facts) return facts.findings();
    if (facts->size() != count * factBytes(variants))
      return wrong("facts", std::to_string(count * factBytes(variants)) + " bytes",
                   std::to_string(facts->size()) + " bytes");
    facts_.resize(count);
    PatchBytesReader(*facts).take(facts_, variants);
    if (auto read = readCones(); !read) return read;
    for (std::uint32_t page = 0; page < index_.pages.size(); ++page)
      if (!pages_->has(page)) return wrong("page " + std::to_string(page), "one in the table", "nothing");
    return Done{};
  }

 private:
  /// Files of earlier bakes have none.
  Result<Done> readCones() {
    if (!pages_->has(kConesKey)) return Done{};
    const auto cones = pages_->read(kConesKey);
    if (!cones) return cones.findings();
    if (cones->size() != index_.size() * sizeof(NormalCone))
      return wrong("cones", std::to_string(index_.size() * sizeof(NormalCone)) + " bytes",
                   std::to_string(cones->size()) + " bytes");
    index_.cones.resize(index_.size());
    std::memcpy(index_.cones.data(), cones->data(), cones->size());
    return Done{};
  }

  std::shared_ptr<const PageFile> pages_;
  std::filesystem::path file_;
  PostGeometry geometry_;
  PatchIndex index_;
  std::vector<PatchFacts> facts_;
};

}  // namespace

Result<Done> finishPatchFile(PageFileWriter& writer, const PostGrid& posts, const PatchIndex& index,
                             const std::vector<PatchFacts>& facts) {
  GridHeader header;
  header.posts = posts;
  header.patches = static_cast<std::uint32_t>(index.size());
  header.pages = static_cast<std::uint32_t>(index.pages.size());
  header.leafCells = index.leafCells;
  header.variants = static_cast<std::uint32_t>(index.variants());
  const std::size_t variants = index.variants();
  PatchBytesWriter measured(
      sizeof header + index.size() * (sizeof(Box) + variants * (sizeof(float) + sizeof(std::uint16_t))));
  measured.add(std::span<const GridHeader>(&header, 1));
  measured.add(std::span<const Box>(index.bounds));
  measured.add(index.errorM.values());
  measured.add(index.triangles.values());
  if (auto done = writer.add(kIndexKey, measured.bytes()); !done) return done;
  PatchBytesWriter told(facts.size() * factBytes(variants));
  told.add(facts, variants);
  if (auto done = writer.add(kFactsKey, told.bytes()); !done) return done;
  if (index.cones.size() == index.size())
    if (auto done = writer.add(kConesKey, std::as_bytes(std::span(index.cones))); !done) return done;
  return writer.finish();
}

Result<std::shared_ptr<const PatchTerrain>> openPatches(std::shared_ptr<const PageFile> pages,
                                                        const std::filesystem::path& file,
                                                        const PostGrid& posts) {
  const auto opened = std::make_shared<StoredPatches>(std::move(pages), file, posts);
  if (const auto loaded = opened->load(posts); !loaded) return loaded.findings();
  return std::shared_ptr<const PatchTerrain>(opened);
}

}  // namespace trimtab::terrain
