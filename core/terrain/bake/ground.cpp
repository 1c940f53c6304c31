#include "ground.h"

#include <sstream>

#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/page_file.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/ground/image.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

fs::path GroundBake::shareFile(std::uint32_t part, std::uint32_t parts) const {
  return work_.pieces() / ("ground-" + std::to_string(part + 1) + "-of-" + std::to_string(parts) + ".pages");
}

std::map<std::string, GroundCover> GroundBake::covers() const {
  std::map<std::string, GroundCover> all;
  for (const std::string& line : work_.journal()) {
    std::istringstream words(line);
    std::string word, name;
    GroundCover cover;
    if (!(words >> word >> name >> cover.texels >> cover.coveredByAny) || word != "ground") continue;
    for (std::uint64_t covered; words >> covered;) cover.covered.push_back(covered);
    if (cover.covered.size() == sources_.images.size()) all[name] = std::move(cover);
  }
  return all;
}

Result<Done> GroundBake::make(std::uint32_t part, std::uint32_t parts, const Progress& progress) const {
  const fs::path file = shareFile(part, parts);
  if (PageFile::open(file) && covers().contains(file.filename().string())) return Done{};
  const auto made = buildGroundPart(sources_, part, parts, file, progress);
  if (!made) return made.findings();
  std::string line = "ground " + file.filename().string() + ' ' + std::to_string(made->texels) + ' ' +
                     std::to_string(made->coveredByAny);
  for (const std::uint64_t covered : made->covered) line += ' ' + std::to_string(covered);
  return work_.note(line);
}

std::uint32_t GroundBake::parts() const {
  const auto told = covers();
  for (std::uint32_t parts = 1; parts <= kMostBakeParts; ++parts) {
    std::uint32_t there = 0;
    std::error_code error;
    for (; there < parts; ++there)
      if (const fs::path file = shareFile(there, parts);
          !fs::exists(file, error) || !told.contains(file.filename().string()))
        break;
    if (there == parts) return parts;
  }
  return 0;
}

Result<Done> GroundBake::join(std::uint32_t parts, const fs::path& file, const Progress& progress) const {
  const auto told = covers();
  std::vector<fs::path> shares;
  GroundCover all{0, 0, std::vector<std::uint64_t>(sources_.images.size())};
  for (std::uint32_t part = 0; part < parts; ++part) {
    shares.push_back(shareFile(part, parts));
    const auto cover = told.find(shares.back().filename().string());
    if (cover == told.end())
      return Finding{Severity::error, shares.back().string(), "ground",
                     "a line of the journal that tells of its end", "none: bake again"};
    all.texels = cover->second.texels;
    all.coveredByAny += cover->second.coveredByAny;
    for (std::size_t i = 0; i < all.covered.size(); ++i) all.covered[i] += cover->second.covered[i];
  }
  Findings notes;
  const auto keep = [&notes](const Findings& more) { notes.insert(notes.end(), more.begin(), more.end()); };
  // What the images showed is in the shares: one that cannot be read by now is not asked for.
  for (const fs::path& image : sources_.images)
    if (const auto opened = GroundImage::open(image)) keep(opened.findings());
  keep(aboutCover(sources_.images, all));
  if (hasError(notes)) return notes;
  if (auto done = joinGround(shares, file, progress); !done) return done;
  return Result<Done>(Done{}, std::move(notes));
}

}  // namespace trimtab::terrain
