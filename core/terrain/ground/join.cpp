#include <algorithm>

#include "texels.h"
#include "tree.h"
#include "trimtab/terrain/format/page_file.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/ground/build.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

std::vector<GroundPlace> tilesBelow(const std::vector<GroundShape::Level>& levels, const GroundPlace& place) {
  std::vector<GroundPlace> all;
  const GroundShape::Level& level = levels[place.level - 1];
  for (const std::uint32_t r : {2 * place.row, 2 * place.row + 1})
    for (const std::uint32_t c : {2 * place.column, 2 * place.column + 1})
      if (c < level.tileColumns() && r < level.tileRows()) all.push_back({place.level - 1, c, r});
  return all;
}

Result<GroundTile> halvedFrom(const std::vector<GroundShape::Level>& levels, const GroundPlace& place,
                              const ReadGroundTile& read) {
  std::array<GroundTile, 4> tiles;
  std::array<const GroundTile*, 4> pointers{};
  for (const GroundPlace& child : tilesBelow(levels, place)) {
    auto tile = read(child);
    if (!tile) return tile.findings();
    const std::size_t at = (child.row % 2) * 2 + child.column % 2;
    tiles[at] = std::move(tile).value();
    pointers[at] = &tiles[at];
  }
  return halvedGround(pointers, sizeOfGroundTile(levels[place.level], place.column, place.row));
}

Result<Done> joinGround(std::span<const std::filesystem::path> parts, const fs::path& file,
                        const Progress& progress) {
  const auto refused = [](const fs::path& where, std::string expected, std::string found) {
    return Finding{Severity::error, where.string(), "ground", std::move(expected), std::move(found)};
  };
  // A damaged part is made again next time.
  const auto damaged = [&](const fs::path& part, Findings findings) {
    std::error_code ignored;
    fs::remove(part, ignored);
    findings.push_back(refused(part, "a sound part", "a damaged one, removed: bake again"));
    return findings;
  };
  if (parts.empty()) return refused(file, "parts to join", "none");
  std::vector<std::shared_ptr<const PageFile>> files;
  std::optional<GroundShape> shape;
  for (const fs::path& part : parts) {
    auto opened = PageFile::open(part);
    if (!opened) return opened.findings();
    const auto blob = (*opened)->read(kGroundShapeKey);
    if (!blob) return damaged(part, blob.findings());
    auto own = unpackGroundShape(*blob);
    if (!own) return own.findings();
    if (!shape) shape = *own;
    if (*own != *shape || shape->levels.empty())
      return refused(part, "a part of the same ground as " + parts[0].string(), "another");
    files.push_back(std::move(opened).value());
  }
  auto writer = PageFileWriter::create(file);
  if (!writer) return writer.findings();
  if (auto done = (*writer)->add(kGroundShapeKey, packGroundShape(*shape)); !done) return done;
  double tiles = 0, written = 0;
  for (const GroundShape::Level& level : shape->levels)
    tiles += double{1} * level.tileColumns() * level.tileRows();
  // Children before their parents, as they are built.
  const std::function<Result<GroundTile>(const GroundPlace&, bool)> join =
      [&](const GroundPlace& place, bool wanted) -> Result<GroundTile> {
    const std::uint64_t key = groundKey(place.level, place.column, place.row);
    if (progress && !progress(std::min(written++ / tiles, 1.0), "joining the ground's colours"))
      return cancelled("joining the ground's colours");
    const auto part = std::find_if(files.begin(), files.end(), [&](const auto& f) { return f->has(key); });
    if (part == files.end() && place.level == 0)
      return refused(file, "all parts of the ground",
                     "none with tile " + std::to_string(place.column) + ", " + std::to_string(place.row));
    auto tile = Result<GroundTile>(GroundTile{});
    std::vector<std::byte> blob;
    if (part == files.end()) {
      tile = halvedFrom(shape->levels, place, [&](const GroundPlace& child) { return join(child, true); });
      if (!tile) return tile;
      blob = packGroundTile(*tile);
    } else {
      if (place.level > 0)
        for (const GroundPlace& child : tilesBelow(shape->levels, place))
          if (auto joined = join(child, false); !joined) return joined;
      auto bytes = (*part)->read(key);
      if (!bytes) return damaged(parts[static_cast<std::size_t>(part - files.begin())], bytes.findings());
      blob = std::move(bytes).value();
      if (wanted) tile = unpackGroundTile(blob);
      if (!tile) return tile;
    }
    if (auto done = (*writer)->add(key, blob); !done) return done.findings();
    return tile;
  };
  const GroundPlace root{static_cast<std::uint32_t>(shape->levels.size()) - 1, 0, 0};
  if (auto done = join(root, false); !done) return done.findings();
  return (*writer)->finish();
}

}  // namespace trimtab::terrain
