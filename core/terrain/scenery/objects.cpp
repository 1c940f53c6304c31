#include "trimtab/terrain/scenery/objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <unordered_map>

#include "stg_lines.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/scenery/scenery.h"
#include "trimtab/units/finding_list.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

/// Elevation of what scenery's makers had none for.
constexpr double kNoElevation = -9999;
/// Pitch and roll that differ by less are one, degrees.
constexpr double kSameTurn = 0.01;
/// So many models are tilted in different ways; each is another model in flight.
constexpr std::size_t kMostTilted = 1000;

bool staysBelow(const fs::path& path) {
  return !path.empty() && path.is_relative() && std::find(path.begin(), path.end(), "..") == path.end();
}

class ListReader {
 public:
  ListReader(std::span<const fs::path> baseFolders, SceneryObjects& objects, FindingList& findings)
      : baseFolders_(baseFolders), objects_(objects), findings_(findings) {}

  void read(const fs::path& list) {
    const auto text = readWhole(list);
    if (!text) return;  // the scenery's own reader reports it
    objects_.list.tables.push_back({list.string(), objects_.list.placements.size()});
    list_ = list;
    forEachStgLine(*text, [this](StgLine& line) {
      line_ = line.number;
      if (line.tooLong())
        return leaveOut("line", "at most " + std::to_string(StgLine::kMostBytes) + " bytes",
                        std::to_string(line.bytes));
      const std::string& verb = line.verb;
      if (verb == "OBJECT_BASE" || verb == "OBJECT") return;
      const bool aboveGround = verb.ends_with("_AGL");
      const std::string kind = verb.substr(0, verb.size() - (aboveGround ? 4 : 0));
      if (kind == "OBJECT_SIGN")
        ++objects_.signs;
      else if (kind == "OBJECT_SHARED" || kind == "OBJECT_STATIC")
        place(line.words, verb, kind == "OBJECT_SHARED", aboveGround);
      else
        ++objects_.others[verb];
    });
  }

 private:
  void leaveOut(const std::string& key, const std::string& expected, const std::string& found) {
    findings_.add(Severity::warning, [&] {
      return Finding{Severity::warning, list_.string() + ':' + std::to_string(line_), key,
                     expected + "; the object is left out", found.empty() ? "nothing" : found};
    });
  }

  void place(std::istringstream& words, const std::string& verb, bool shared, bool aboveGround) {
    struct Column {
      const char* name;
      double limit;
    };
    constexpr double kTurn = PlacementLimits::kHeadingDeg;
    constexpr std::array<Column, 6> kColumns{{{"longitude", 360},
                                              {"latitude", 90},
                                              {"elevation", PlacementLimits::kHeightM},
                                              {"heading", kTurn},
                                              {"pitch", kTurn},
                                              {"roll", kTurn}}};
    constexpr std::size_t kNeeded = 4;
    std::string path;
    words >> path;
    std::array<double, kColumns.size()> values{};
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      const auto& [name, limit] = kColumns[i];
      std::string word;
      if (!(words >> word) && i >= kNeeded) break;
      const std::optional<double> value = readNumber(word);
      if (!value || !(std::abs(*value) <= limit)) {
        leaveOut(verb, std::string(name) + " from " + numberText(-limit) + " to " + numberText(limit), word);
        return;
      }
      values[i] = *value;
    }
    if (!staysBelow(path)) {
      leaveOut(verb, shared ? "a model below the base package's folder" : "a model below the list's folder",
               path);
      return;
    }
    const fs::path file = shared ? sharedFile(path) : list_.parent_path() / path;
    std::error_code error;
    if (file.empty() || !fs::is_regular_file(file, error)) {
      ++objects_.withoutModel[path];
      return;
    }
    const auto [longitude, latitude, elevation, heading, pitch, roll] = values;
    const auto model =
        numberOf({file.string(), {1, 1, 1}, turnOf(roll), turnOf(pitch)}, shared ? path : file.string());
    if (!model) {
      leaveOut(verb, "at most " + std::to_string(kMostTilted) + " models that are tilted differently",
               "one more");
      return;
    }
    ListedPlacement placement;
    placement.longitude = Degrees{longitude};
    placement.latitude = Degrees{latitude};
    placement.heading = Degrees{std::remainder(90 - heading, 360.0)};
    placement.model = *model;
    placement.line = line_;
    if (elevation == kNoElevation)
      placement.aboveGround = Metres{0};
    else if (aboveGround)
      placement.aboveGround = Metres{elevation};
    else
      placement.height = Metres{elevation};
    objects_.list.placements.push_back(placement);
    ++(shared ? objects_.shared : objects_.own);
  }

  static Degrees turnOf(double degrees) { return Degrees{std::round(degrees / kSameTurn) * kSameTurn}; }

  /// Returns the file of a shared model; an empty path if there is none.
  fs::path sharedFile(const std::string& path) const {
    // A list is in Terrain/e000n50/e007n50 of its scenery, or in Objects beside it.
    std::vector<fs::path> folders{list_.parent_path() / ".." / ".." / ".."};
    folders.insert(folders.end(), baseFolders_.begin(), baseFolders_.end());
    std::error_code error;
    for (const fs::path& folder : folders)
      for (const fs::path& file : {folder / path, folder / "Scenery" / path})
        if (fs::is_regular_file(file, error)) return file.lexically_normal();
    return {};
  }

  /// Returns the model's number; none if it would be one tilted model too many.
  std::optional<std::uint32_t> numberOf(ModelFile model, std::string name) {
    const bool tilted = model.roll.value() != 0 || model.pitch.value() != 0;
    std::string key = model.file;
    if (tilted) {
      const std::string turns =
          ", pitch " + numberText(model.pitch.value(), 5) + ", roll " + numberText(model.roll.value(), 5);
      key += turns;
      name += turns;
    }
    const auto known = numbers_.find(key);
    if (known != numbers_.end()) return known->second;
    if (tilted && ++tilted_ > kMostTilted) return {};
    const auto number = static_cast<std::uint32_t>(objects_.models.size());
    numbers_.emplace(std::move(key), number);
    objects_.list.models.push_back(std::move(name));
    objects_.models.push_back(std::move(model));
    return number;
  }

  std::span<const fs::path> baseFolders_;
  SceneryObjects& objects_;
  FindingList& findings_;
  fs::path list_;
  std::uint32_t line_ = 0;
  std::unordered_map<std::string, std::uint32_t> numbers_;
  std::size_t tilted_ = 0;
};

/// Returns "3 of a, 2 of b", and their sum.
std::pair<std::string, std::size_t> inWords(const std::map<std::string, std::size_t>& counts) {
  constexpr std::size_t kMostNamed = 20;
  std::string text;
  std::size_t sum = 0, named = 0;
  for (const auto& [name, count] : counts) {
    sum += count;
    if (named++ < kMostNamed) text += (text.empty() ? "" : ", ") + std::to_string(count) + " of " + name;
  }
  if (named > kMostNamed) text += " and " + std::to_string(named - kMostNamed) + " more kinds";
  return {text, sum};
}

}  // namespace

std::vector<fs::path> baseFolders(const std::optional<fs::path>& named) {
  std::vector<fs::path> folders;
  if (named) folders.push_back(*named);
  if (const char* const root = std::getenv("FG_ROOT"); root != nullptr && *root != 0)
    folders.emplace_back(root);
  folders.emplace_back("/usr/share/games/flightgear");
  return folders;
}

SceneryObjects readSceneryObjects(const fs::path& source, std::span<const fs::path> baseFolders,
                                  Findings& findings) {
  SceneryObjects objects;
  FindingList list;
  ListReader reader(baseFolders, objects, list);
  if (const auto files = sceneryFiles(source))
    for (const fs::path& file : *files)
      if (file.extension() == ".stg") reader.read(file);
  for (Finding& finding : list.all(source.string())) findings.push_back(std::move(finding));
  return objects;
}

Findings aboutSceneryObjects(const fs::path& source, const SceneryObjects& objects) {
  Findings notes;
  const auto say = [&](const char* key, const std::string& what, const std::string& found) {
    notes.push_back({Severity::note, source.string(), key, what, found});
  };
  if (const std::size_t placed = objects.list.placements.size(); placed > 0)
    say("objects", "objects of the scenery's lists with a model, placed",
        std::to_string(placed) + " by " + std::to_string(objects.models.size()) + " models (" +
            std::to_string(objects.shared) + " of shared models, " + std::to_string(objects.own) +
            " of its own)");
  if (!objects.withoutModel.empty()) {
    const auto [names, count] = inWords(objects.withoutModel);
    say("models",
        "a model for each object: shared ones are in FlightGear's base package, which --scenery-models or "
        "FG_ROOT names",
        "none for " + std::to_string(count) + " objects, which are not drawn: " + names);
  }
  if (objects.signs > 0)
    say("signs", "objects that are drawn", std::to_string(objects.signs) + " signs, not drawn");
  if (!objects.others.empty())
    say("lines", "lines that are read", inWords(objects.others).first + ", not drawn");
  return notes;
}

}  // namespace trimtab::terrain
