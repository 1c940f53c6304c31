#include "tiles.h"

#include "mapped_heights.h"

namespace trimtab::terrain {

namespace {

template <class T>
Result<Done> putFile(const WorkFolder& work, const char* name, std::span<const T> values,
                     std::vector<FileEntry>& files) {
  const auto file =
      writeFile(work.database(), name, {reinterpret_cast<const char*>(values.data()), values.size_bytes()});
  if (!file) return file.findings();
  files.push_back(*file);
  return Done{};
}

}  // namespace

Result<Done> TileBake::measure(const Progress& progress) {
  if (posts_.size() > kMostTiledPosts || levels_) return Done{};
  const auto heights = MappedHeights::open(work_.database() / kHeightsName, posts_.size());
  if (!heights) return heights.findings();
  TerrainIndex index = makeLevels(posts_);
  CellSlopes slopes(index);
  if (!measureLevels(posts_, (*heights).span(), geometry_, index, slopes,
                     [&](double f) { return progress(f, "measuring levels"); }))
    return cancelled("measuring levels");
  levels_ = {std::move(index), std::move(slopes)};
  return Done{};
}

Result<std::vector<FileEntry>> TileBake::write() {
  std::vector<FileEntry> files;
  const auto& [index, slopes] = *levels_;
  const std::vector<float> nodes = nodeNumbers(index);
  if (auto done = putFile<float>(work_, kNodesName, nodes, files); !done) return done.findings();
  if (auto done = putFile<std::uint8_t>(work_, kSlopesName, slopes.cells, files); !done)
    return done.findings();
  if (auto done = putFile<NormalCone>(work_, kConesName, index.cones, files); !done) return done.findings();
  levels_.reset();
  return files;
}

Result<std::vector<FileEntry>> TileBake::writeImage(std::span<const std::uint8_t> image) const {
  std::vector<FileEntry> files;
  if (auto done = putFile(work_, kImageName, image, files); !done) return done.findings();
  CheckedRows::Sums rows(std::size_t{posts_.columns} * 4);
  rows.add(std::as_bytes(image));
  const std::vector<std::uint64_t> sums = rows.finish();
  if (auto done = putFile<std::uint64_t>(work_, kImageSumsName, sums, files); !done) return done.findings();
  // The manifest has the checksum of the sums for both.
  files.front().sum = files.back().sum;
  return files;
}

}  // namespace trimtab::terrain
