#include "trimtab/terrain/scenery/scenery.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <set>

#include "stg_lines.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/grid/parallel.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

bool isTile(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.ends_with(".btg") || name.ends_with(".btg.gz");
}
bool isList(const fs::path& file) {
  return file.extension() == ".stg";
}

Finding about(Severity severity, const std::string& where, std::string key, std::string expected,
              std::string found) {
  return {severity, where, std::move(key), std::move(expected), std::move(found)};
}

/// Holds what there is to read, and what the lists name besides.
struct Inventory {
  std::map<fs::path, bool> tiles;  ///< path, and whether it is an airport
  std::set<fs::path> lists;
  std::vector<std::string> missing;
  Findings findings;
};

/// Returns a tile of a list: as it is named, or zipped.
fs::path onDisk(const fs::path& named) {
  std::error_code error;
  for (const fs::path& candidate : {fs::path(named.string() + ".gz"), named})
    if (fs::is_regular_file(candidate, error)) return candidate;
  return {};
}

void readList(const fs::path& list, Inventory& found) {
  found.lists.insert(list);
  const Result<std::string> text = readWhole(list);
  if (!text) {
    found.findings.insert(found.findings.end(), text.findings().begin(), text.findings().end());
    return;
  }
  forEachStgLine(*text, [&](StgLine& line) {
    const std::string where = list.string() + ":" + std::to_string(line.number);
    const std::string& verb = line.verb;
    if (verb != "OBJECT_BASE" && verb != "OBJECT") return;  // objects' own reader reports lines too long
    std::string name;
    line.words >> name;
    // A list speaks for its own folder: nothing outside it is opened.
    if (name.empty() || name.find('/') != std::string::npos || !isTile(name)) {
      found.findings.push_back(about(Severity::warning, where, verb,
                                     "the name of a .btg in the list's own folder",
                                     name.empty() ? "nothing" : name));
      return;
    }
    const fs::path file = onDisk(list.parent_path() / name);
    if (file.empty()) {
      found.missing.push_back(name);
      found.findings.push_back(about(Severity::warning, where, verb,
                                     name + " or " + name + ".gz beside the list", "neither, left out"));
      return;
    }
    found.tiles.emplace(file, verb == "OBJECT");
  });
}

bool isAirportName(const fs::path& file) {
  const std::string name = file.filename().string();
  const std::string stem = name.substr(0, name.find('.'));
  return !std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
}

Result<Inventory> inventory(const fs::path& path) {
  Inventory found;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    return about(Severity::error, path.string(), "", "scenery: a folder, .stg, .btg or .btg.gz",
                 "nothing there");
  if (!fs::is_directory(status)) {
    if (isList(path))
      readList(path, found);
    else
      found.tiles.emplace(path, isAirportName(path));
  } else {
    std::map<fs::path, std::vector<fs::path>> folders;
    const auto visited = visitFiles(path, [&](const fs::path& file) {
      if (isTile(file) || isList(file)) folders[file.parent_path()].push_back(file);
      return true;
    });
    if (!visited) return visited.findings();
    for (auto& [folder, files] : folders) {
      std::sort(files.begin(), files.end());
      const bool lists = std::any_of(files.begin(), files.end(), isList);
      for (const fs::path& file : files) {
        if (isList(file))
          readList(file, found);
        else if (!lists)
          found.tiles.emplace(file, isAirportName(file));
      }
    }
  }
  if (found.tiles.empty()) {
    found.findings.push_back(about(Severity::error, path.string(), "", "scenery tiles (.btg, .btg.gz)",
                                   found.lists.empty() ? "none" : "lists without a tile that is there"));
    return found.findings;
  }
  return found;
}

}  // namespace

bool isScenery(const fs::path& path) {
  std::error_code error;
  if (isTile(path) || isList(path)) return fs::is_regular_file(path, error);
  if (!fs::is_directory(path, error)) return false;
  bool found = false;
  const auto visited =
      visitFiles(path, [&](const fs::path& file) { return !(found = isTile(file) || isList(file)); });
  return visited && found;
}

Result<std::vector<fs::path>> sceneryFiles(const fs::path& path) {
  const auto found = inventory(path);
  if (!found) return found.findings();
  std::vector<fs::path> files(found->lists.begin(), found->lists.end());
  for (const auto& [file, airport] : found->tiles) files.push_back(file);
  std::sort(files.begin(), files.end());
  return files;
}

Result<SceneryList> listScenery(const fs::path& path) {
  auto found = inventory(path);
  if (!found) return found.findings();
  SceneryList list;
  list.missing = std::move(found->missing);
  for (const auto& [file, airport] : found->tiles) list.files.push_back({file, airport});
  std::stable_partition(list.files.begin(), list.files.end(),
                        [](const SceneryList::File& file) { return !file.airport; });
  return Result<SceneryList>(std::move(list), std::move(found->findings));
}

Result<Scenery> readScenery(const fs::path& path, const SceneryProgress& progress) {
  auto list = listScenery(path);
  if (!list) return list.findings();
  const auto& files = list->files;
  std::vector<Result<SceneryMesh>> read(files.size(), Result<SceneryMesh>(Findings{}));
  const bool whole = forEachParallel(
      static_cast<std::uint32_t>(files.size()), [&](std::uint32_t i) { read[i] = readBtg(files[i].path); },
      [&](double fraction) { return !progress || progress(fraction, "reading scenery"); });
  if (!whole) return about(Severity::note, path.string(), "", "to be completed", "cancelled");

  Scenery scenery;
  scenery.missing = std::move(list->missing);
  Findings findings = list.findings();
  for (std::size_t i = 0; i < files.size(); ++i) {
    findings.insert(findings.end(), read[i].findings().begin(), read[i].findings().end());
    if (!read[i]) continue;
    SceneryMesh& mesh = *read[i];
    mesh.airport = files[i].airport;
    scenery.tiles.push_back(std::move(mesh));
  }
  if (scenery.tiles.empty()) return findings;
  return Result<Scenery>(std::move(scenery), std::move(findings));
}

}  // namespace trimtab::terrain
