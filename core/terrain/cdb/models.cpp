#include "trimtab/terrain/cdb/models.h"

#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <set>

#include "trimtab/preset/file_io.h"
#include "versions.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kZip = "/vsizip/";
constexpr std::size_t kMostInArchive = 100000;

std::string lowerCaseOf(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Returns the names inside an archive; none, with the reason, if it cannot be read.
Result<std::vector<std::string>> namesInArchive(const fs::path& archive) {
  CPLPushErrorHandler(CPLQuietErrorHandler);
  CPLErrorReset();
  char** const list = VSIReadDirRecursive((std::string(kZip) + archive.string()).c_str());
  const std::string why = CPLGetLastErrorMsg();
  CPLErrorReset();
  CPLPopErrorHandler();
  const int count = CSLCount(list);
  std::vector<std::string> names;
  for (int i = 0; i < count && names.size() < kMostInArchive; ++i) names.emplace_back(list[i]);
  CSLDestroy(list);
  if (names.empty())
    return Finding{Severity::warning, archive.string(), "", "a zip archive with files",
                   why.empty() ? "one that cannot be read, or is empty" : why};
  return names;
}

/// The level behind "_W" in a texture's name, and what stands about it.
struct TextureName {
  std::string before, after;
  int level = 0;
};
std::optional<TextureName> textureNameOf(const std::string& name) {
  for (std::size_t at = name.find("_W"); at != std::string::npos; at = name.find("_W", at + 1))
    if (at + 5 <= name.size() && std::isdigit(static_cast<unsigned char>(name[at + 2])) &&
        std::isdigit(static_cast<unsigned char>(name[at + 3])) && name[at + 4] == '_')
      return TextureName{name.substr(0, at), name.substr(at + 5), std::atoi(name.c_str() + at + 2)};
  return {};
}

/// Keeps the name whose level is nearest to what is asked; of two, the finer.
class NearestTexture {
 public:
  explicit NearestTexture(int asked) : asked_(asked) {}
  void offer(const std::string& file, int level) {
    const int apart = std::abs(level - asked_);
    if (file_ && std::pair{apart, -level} >= best_) return;
    file_ = file;
    best_ = {apart, -level};
  }
  const std::optional<std::string>& file() const { return file_; }

 private:
  int asked_;
  std::pair<int, int> best_;
  std::optional<std::string> file_;
};

/// Returns the folder on disk in which a model or its archive lies.
fs::path folderOfModel(const std::string& model) {
  if (!model.starts_with(kZip)) return fs::path(model).parent_path();
  const std::string inside = lowerCaseOf(model);
  const std::size_t end = inside.find(".zip/");
  return fs::path(model.substr(kZip.size(), end == std::string::npos ? end : end + 4 - kZip.size()))
      .parent_path();
}

/// Returns a folder of a CDB and the same one in the versions that its root replaces.
std::vector<fs::path> inVersions(const fs::path& folder) {
  std::vector<fs::path> all{folder};
  for (fs::path part = folder; part.has_relative_path(); part = part.parent_path()) {
    if (part.filename() != "GTModel" && part.filename() != "Tiles") continue;
    const fs::path root = part.parent_path(), below = folder.lexically_relative(root);
    FindingList said;  // by the catalogue
    for (const fs::path& version : cdbVersions(root, said))
      if (version != root) all.push_back(version / below);
    break;
  }
  return all;
}

/// Returns the file of a texture in the folder that the model names.
std::optional<std::string> textureInFolder(const fs::path& asked, const std::string& model,
                                           const TextureName& name) {
  const fs::path named = asked.is_absolute()
                             ? asked.parent_path()
                             : (folderOfModel(model) / asked.parent_path()).lexically_normal();
  for (const fs::path& folder : inVersions(named)) {
    NearestTexture nearest(name.level);
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
      const auto other = textureNameOf(entry->path().filename().string());
      if (other && lowerCaseOf(other->before) == lowerCaseOf(name.before) &&
          lowerCaseOf(other->after) == lowerCaseOf(name.after))
        nearest.offer(entry->path().string(), other->level);
    }
    if (nearest.file()) return nearest.file();
  }
  return {};
}

/// Returns the archives of textures of a cell.
std::set<fs::path> textureArchives(const fs::path& cell) {
  std::set<fs::path> archives;
  std::error_code error;
  for (fs::directory_iterator set(cell, error), end; !error && set != end; set.increment(error))
    if (set->path().filename().string().starts_with("301_"))
      if (const auto visited = visitFiles(set->path(),
                                          [&](const fs::path& file) {
                                            if (lowerCaseOf(file.extension().string()) == ".zip")
                                              archives.insert(file);
                                            return true;
                                          });
          !visited)
        return {};
  return archives;
}

/// Returns the file of a texture in the archives of the cell, by the part of its name behind the tile's.
std::optional<std::string> textureInArchives(const std::string& name, const std::string& model) {
  const auto asked = cdbNameOf(name);
  if (!asked || asked->tile.set != CdbSet::kSpecificTextures) return {};
  // ".../N32/W118/300_GSModelGeometry/L00/U0": the cell is three folders up.
  const fs::path cell = folderOfModel(model).parent_path().parent_path().parent_path();
  const auto level = textureNameOf(asked->rest);
  const auto plain = [](const std::string& rest, const std::optional<TextureName>& withLevel) {
    return lowerCaseOf(withLevel ? withLevel->before + "_" + withLevel->after : rest);
  };
  const std::string wanted = plain(asked->rest, level);
  constexpr int kUnknownLevel = 99;
  for (const fs::path& folder : inVersions(cell)) {
    NearestTexture nearest(level ? level->level : kUnknownLevel);
    for (const fs::path& archive : textureArchives(folder)) {
      const auto names = namesInArchive(archive);
      if (!names) continue;
      for (const std::string& inside : *names) {
        const auto other = cdbNameOf(fs::path(inside).filename().string());
        if (!other) continue;
        const auto otherLevel = textureNameOf(other->rest);
        if (plain(other->rest, otherLevel) == wanted)
          nearest.offer(std::string(kZip) + archive.string() + '/' + inside,
                        otherLevel ? otherLevel->level : kUnknownLevel);
      }
    }
    if (nearest.file()) return nearest.file();
  }
  return {};
}

}  // namespace

std::string CdbModelName::text() const {
  std::array<char, 16> code;
  std::snprintf(code.data(), code.size(), "_%03d_", subcode);
  return facc + code.data() + model;
}

CdbModels::CdbModels(const CdbCatalogue& cdb) : cdb_(cdb) {
  for (const fs::path& version : cdb.versions) {
    std::error_code error;
    const fs::path folder = version / "GTModel" / "500_GTModelGeometry";
    if (!fs::is_directory(folder, error)) continue;
    std::set<fs::path> models;
    if (const auto visited =
            visitFiles(folder, [&](const fs::path& file) { return models.insert(file).second; });
        !visited)
      findings_.add(visited.findings());
    for (const fs::path& model : models)
      typical_.try_emplace(lowerCaseOf(model.filename().string()), model.string());
  }
  for (const CdbFile& file : cdb.files)
    if (file.tile.set == CdbSet::kSpecificModels && file.ending == ".zip" && file.rest.empty())
      archives_.try_emplace(file.tile, file.file);
}

std::optional<std::string> CdbModels::typical(const CdbModelName& name) const {
  const auto found = typical_.find(lowerCaseOf("D500_S001_T001_" + name.text() + ".flt"));
  return found == typical_.end() ? std::nullopt : std::optional(found->second);
}

const CdbModels::Files& CdbModels::inArchive(const fs::path& archive) {
  const auto [known, isNew] = inside_.try_emplace(archive);
  if (!isNew) return known->second;
  const auto names = namesInArchive(archive);
  findings_.add(names.findings());
  if (names)
    for (const std::string& name : *names)
      known->second.try_emplace(lowerCaseOf(fs::path(name).filename().string()),
                                std::string(kZip) + archive.string() + '/' + name);
  return known->second;
}

std::optional<std::string> CdbModels::specific(const CdbTile& feature, double longitude, double latitude,
                                               int mlod, const CdbModelName& name) {
  if (mlod < CdbTile::kCoarsest || mlod > CdbTile::kFinest) return {};
  CdbTile tile = feature.at(longitude, latitude, mlod);
  tile.set = CdbSet::kSpecificModels;
  tile.first = tile.second = 1;
  const auto archive = archives_.find(tile);
  if (archive == archives_.end()) return {};
  const Files& files = inArchive(archive->second);
  const auto found = files.find(lowerCaseOf(tile.name() + '_' + name.text() + ".flt"));
  return found == files.end() ? std::nullopt : std::optional(found->second);
}

Result<std::string> bytesOfFile(const std::string& file, std::size_t mostInArchive) {
  const std::size_t mostBytes =
      file.starts_with(kZip) ? mostInArchive : std::numeric_limits<std::size_t>::max();
  CPLPushErrorHandler(CPLQuietErrorHandler);
  CPLErrorReset();
  std::string bytes, why;
  if (VSILFILE* const in = VSIFOpenL(file.c_str(), "rb")) {
    constexpr std::size_t kPortion = std::size_t{1} << 20;
    for (std::size_t read = 1; read > 0 && bytes.size() <= mostBytes;) {
      const std::size_t before = bytes.size();
      bytes.resize(before + kPortion);
      read = VSIFReadL(bytes.data() + before, 1, kPortion, in);
      bytes.resize(before + read);
    }
    // A damaged archive gives fewer bytes than its list says, and an error.
    VSIStatBufL there;
    if (bytes.size() > mostBytes)
      why = "more than " + std::to_string(mostBytes >> 20) + " MiB";
    else if (VSIStatL(file.c_str(), &there) == 0 && static_cast<std::size_t>(there.st_size) != bytes.size())
      why = std::to_string(bytes.size()) + " of " + std::to_string(there.st_size) + " bytes";
    VSIFCloseL(in);
  } else {
    why = CPLGetLastErrorMsg();
    if (why.empty()) why = "none";
  }
  CPLPopErrorHandler();
  if (!why.empty()) return Finding{Severity::error, file, "", "a file that can be read", why};
  return bytes;
}

std::optional<std::string> cdbTexture(const std::string& asked, const std::string& model) {
  std::string path = asked;
  std::replace(path.begin(), path.end(), '\\', '/');
  const std::string name = fs::path(path).filename().string();
  if (const auto level = textureNameOf(name))
    if (auto found = textureInFolder(path, model, *level)) return found;
  return textureInArchives(name, model);
}

}  // namespace trimtab::terrain
