#include "trimtab/terrain/cdb/catalogue.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <tuple>

#include "trimtab/preset/file_io.h"
#include "versions.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

namespace {

std::string lowerEnding(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

/// Tells whether a folder is the Tiles of a CDB.
bool isTilesOfCdb(const fs::path& folder) {
  std::error_code error;
  fs::directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.size() == 3 && std::string_view("NSns").find(name[0]) != std::string_view::npos &&
        std::isdigit(static_cast<unsigned char>(name[1])) &&
        std::isdigit(static_cast<unsigned char>(name[2])) && entry->is_directory(error))
      return true;
  }
  return false;
}

bool isText(const fs::path& file) {
  const std::string ending = lowerEnding(file);
  return ending == ".txt" || ending == ".md" || ending == ".xml" || ending == ".html" || ending == ".pdf";
}

/// Returns the roots that a folder is, lies in as Tiles, or has right inside it.
std::vector<fs::path> rootsAt(const fs::path& folder) {
  const fs::path here = folder.has_filename() ? folder : folder.parent_path();
  if (isTilesOfCdb(here / "Tiles")) return {here};
  if (here.filename() == "Tiles" && isTilesOfCdb(here)) return {here.parent_path()};
  std::set<fs::path> roots;
  std::error_code error;
  fs::directory_iterator entry(here, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code unknown;
    // A folder that has data of its own is not only where a CDB lies.
    if (entry->is_regular_file(unknown) && !isText(entry->path())) return {};
    if (entry->is_directory(unknown) && isTilesOfCdb(entry->path() / "Tiles")) roots.insert(entry->path());
  }
  return {roots.begin(), roots.end()};
}

/// Returns the folder in which a tile belongs, below Tiles, without the set's name behind its number.
std::vector<std::string> foldersOf(const CdbTile& tile) {
  const std::string name = tile.name();
  std::string set = std::to_string(tile.set);
  set.insert(0, 3 - std::min<std::size_t>(3, set.size()), '0');
  return {name.substr(0, 3), name.substr(3, 4), set + '_', tile.level < 0 ? "LC" : tile.levelName(),
          "U" + std::to_string(tile.up)};
}

bool sameButForCase(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::toupper(x) == std::toupper(y); });
}

/// Tells whether the folders of a file, below Tiles, are those that its name says.
bool standsInItsFolder(const CdbTile& tile, const fs::path& below) {
  const std::vector<std::string> should = foldersOf(tile);
  std::vector<std::string> is;
  for (const fs::path& part : below.parent_path()) is.push_back(part.string());
  if (is.size() != should.size()) return false;
  for (std::size_t i = 0; i < is.size(); ++i)
    if (!sameButForCase(i == 2 ? is[i].substr(0, should[i].size()) : is[i], should[i])) return false;
  return true;
}

/// Collects the files of one version after the other.
class CdbLister {
 public:
  CdbLister(CdbCatalogue& cdb, FindingList& findings) : cdb_(cdb), findings_(findings) {}

  Result<Done> add(const fs::path& root) {
    std::set<fs::path> inside;
    const fs::path tiles = root / "Tiles";
    std::error_code error;
    if (!fs::is_directory(tiles, error)) return Done{};
    const auto visited = visitFiles(tiles, [&](const fs::path& file) { return inside.insert(file).second; });
    findings_.add(visited.findings());
    if (!visited) return visited.findings();
    for (const fs::path& file : inside) take(file, file.lexically_relative(tiles));
    return Done{};
  }

 private:
  void leaveOut(const fs::path& file, const std::string& expected, const std::string& found) {
    findings_.add(Severity::warning, [&] {
      return Finding{Severity::warning, file.string(), "name", expected, found + "; left out"};
    });
  }

  void take(const fs::path& file, const fs::path& below) {
    const std::string ending = lowerEnding(file);
    // What GDAL and editors put beside a file is not the database's.
    if (ending == ".xml" || ending == ".txt" || ending == ".ovr" || ending == ".msk") return;
    const auto name = cdbNameOf(file.stem().string());
    if (!name) {
      leaveOut(file, "the name of a tile, as N32W118_D001_S001_T001_L00_U0_R0", "none");
      return;
    }
    const CdbTile& tile = name->tile;
    if (!standsInItsFolder(tile, below)) {
      std::string should;
      for (const std::string& folder : foldersOf(tile)) should += folder + '/';
      leaveOut(file, "the folder Tiles/" + should + " that the name says", "another folder");
      return;
    }
    if (const int width = cdbCellWidth(tile.south); (tile.west + 180) % width != 0) {
      leaveOut(file,
               "a cell that begins at a multiple of " + std::to_string(width) +
                   " degrees of longitude, as all do at its latitude",
               "one that stands across two of them and claims their place");
      return;
    }
    if (seen_.insert({tile, name->rest, ending}).second)
      cdb_.files.push_back({tile, name->rest, ending, file});
  }

  CdbCatalogue& cdb_;
  FindingList& findings_;
  std::set<std::tuple<CdbTile, std::string, std::string>> seen_;
};

}  // namespace

bool isCdb(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder, error) && !rootsAt(folder).empty();
}

std::vector<const CdbFile*> CdbCatalogue::tiles(int set, int first, int second,
                                                std::span<const std::string_view> endings) const {
  std::map<CdbTile, std::pair<std::size_t, const CdbFile*>> chosen;
  for (const CdbFile& file : files) {
    const auto ending = std::find(endings.begin(), endings.end(), file.ending);
    if (file.tile.set != set || file.tile.first != first || file.tile.second != second ||
        ending == endings.end() || !file.rest.empty())
      continue;
    const auto rank = static_cast<std::size_t>(ending - endings.begin());
    const auto [known, isNew] = chosen.try_emplace(file.tile, rank, &file);
    if (!isNew && rank < known->second.first) known->second = {rank, &file};
  }
  std::vector<const CdbFile*> list;
  for (const auto& [tile, file] : chosen) list.push_back(file.second);
  return list;
}

Result<CdbCatalogue> openCdb(const fs::path& folder) {
  const std::vector<fs::path> roots = rootsAt(folder);
  if (roots.empty())
    return Finding{Severity::error, folder.string(), "", "a CDB: a folder Tiles with cells such as N32",
                   "none"};
  if (roots.size() > 1) {
    std::string names;
    for (const fs::path& root : roots) names += (names.empty() ? "" : ", ") + root.filename().string();
    return Finding{Severity::error, folder.string(), "", "one CDB: name the folder of one, or of each",
                   std::to_string(roots.size()) + ": " + names};
  }
  CdbCatalogue cdb{roots.front(), {}, {}};
  FindingList findings;
  cdb.versions = cdbVersions(cdb.root, findings);
  CdbLister lister(cdb, findings);
  for (const fs::path& version : cdb.versions)
    if (auto added = lister.add(version); !added) return added.findings();
  std::sort(cdb.files.begin(), cdb.files.end(), [](const CdbFile& a, const CdbFile& b) {
    return std::tie(a.tile, a.rest, a.ending) < std::tie(b.tile, b.rest, b.ending);
  });
  if (cdb.files.empty())
    findings.add({Severity::error, folder.string(), "", "at least one file with the name of a tile", "none"});
  Findings all = findings.all(folder.string());
  if (hasError(all)) return all;
  return Result<CdbCatalogue>(std::move(cdb), std::move(all));
}

}  // namespace trimtab::terrain
