#include <algorithm>
#include <mutex>

#include "trimtab/terrain/grid/parallel.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/ground/image.h"
#include "trimtab/terrain/ground/imagery.h"

namespace trimtab::terrain {

Result<std::vector<std::uint8_t>> readImagery(const std::filesystem::path& file, const PostGrid& posts,
                                              const Progress& progress) {
  const auto picture = GroundImage::open(file);
  if (!picture) return picture.findings();
  std::vector<std::uint8_t> image(posts.size() * 4);
  constexpr std::uint32_t kRows = 256;
  std::mutex mutex;
  Findings findings;
  const auto band = [&](std::uint32_t i) {
    PostGrid rows = posts;
    rows.south = posts.latitude(i * kRows);
    rows.rows = std::min(kRows, posts.rows - i * kRows);
    const auto read = (*picture)->read(rows);
    if (read) {
      std::copy(read->begin(), read->end(), &image[std::size_t{i} * kRows * posts.columns * 4]);
    } else {
      const std::lock_guard lock(mutex);
      findings.insert(findings.end(), read.findings().begin(), read.findings().end());
    }
  };
  const std::string what = "reading " + file.filename().string();
  if (!forEachParallel((posts.rows + kRows - 1) / kRows, band,
                       [&](double f) { return !progress || progress(f, what); }))
    return cancelled(file.string());
  if (!findings.empty()) return findings;
  std::size_t covered = 0;
  for (std::size_t i = 3; i < image.size(); i += 4) covered += image[i] != 0;
  Findings notes = picture.findings();
  if (covered == 0)
    return Finding{Severity::error, file.string(), "georeference", "an image over the terrain",
                   "none of its posts covered"};
  if (covered < posts.size())
    notes.push_back({Severity::note, file.string(), "georeference", "an image over the whole terrain",
                     std::to_string(posts.size() - covered) + " posts without"});
  return Result<std::vector<std::uint8_t>>(std::move(image), std::move(notes));
}

}  // namespace trimtab::terrain
