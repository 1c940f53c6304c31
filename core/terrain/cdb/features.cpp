#include "trimtab/terrain/cdb/features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <unordered_map>

#include "feature_table.h"
#include "trimtab/terrain/cdb/models.h"
#include "trimtab/units/finding_list.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

/// Selectors of data set 100 that hold lights and no models.
constexpr int kAirportLights = 4, kOtherLights = 5;
/// Scales that differ by less are one.
constexpr double kSameScale = 1e-3;
constexpr double kMostSubcode = 999;
/// So many models are stretched in different ways; each is another model in flight.
constexpr std::size_t kMostStretched = 1000;

/// What a feature's class, or its row itself, says.
struct FeatureClass {
  std::map<std::string, std::string> values;
};
using FeatureClasses = std::unordered_map<std::string, FeatureClass>;

/// Looks attributes up: those of the instance come first.
class Attributes {
 public:
  Attributes(const CdbRow& row, const FeatureClass* ofClass) : row_(row), class_(ofClass) {}
  const std::string& text(const std::string& name) const {
    const std::string& own = row_.text(name);
    if (!own.empty() || !class_) return own;
    const auto found = class_->values.find(name);
    return found == class_->values.end() ? own : found->second;
  }
  /// Returns a number; `otherwise` if there is none, NaN for another text.
  double number(const std::string& name, double otherwise) const {
    const std::string& value = text(name);
    return value.empty() ? otherwise : readNumber(value).value_or(NAN);
  }
  bool isTrue(const std::string& name) const {
    const std::string& value = text(name);
    return !value.empty() && (value[0] == 'T' || value[0] == 't' || value[0] == '1' || value[0] == 'Y');
  }

 private:
  const CdbRow& row_;
  const FeatureClass* class_;
};

/// The tables of one kind of features (a data set and its first selector), over all tiles.
class FeatureTables {
 public:
  FeatureTables(const CdbCatalogue& cdb, int set, int first, FindingList& findings) : findings_(findings) {
    constexpr std::array<std::string_view, 2> kInstances{".shp", ".dbf"};
    constexpr std::array<std::string_view, 1> kClasses{".dbf"};
    instances_ = cdb.tiles(set, first, 1, kInstances);
    for (const CdbFile* const table : cdb.tiles(set, first, 2, kClasses)) classes_[table->tile] = table->file;
    std::erase_if(instances_, [&](const CdbFile* table) {
      const auto rows = cdbRowsIn(table->file);
      if (!rows || table->ending != ".shp") {
        findings_.add({Severity::warning, table->file.string(), "",
                       table->ending == ".shp" ? "a shape file that GDAL can read" : "a .shp with the places",
                       rows ? "none: left out" : "something else: left out"});
        return true;
      }
      if (*rows > 0) withRows_.insert(table->tile);
      return *rows == 0;
    });
  }

  const std::vector<const CdbFile*>& instances() const { return instances_; }

  /// Tells whether a finer table with rows covers a place of this tile.
  bool hasFiner(const CdbTile& tile, double longitude, double latitude) const {
    for (int level = tile.level + 1; level <= CdbTile::kFinest; ++level)
      if (withRows_.contains(tile.at(longitude, latitude, level))) return true;
    return false;
  }

  FeatureClasses classesOf(const CdbTile& instances) const {
    FeatureClasses classes;
    CdbTile tile = instances;
    tile.second = 2;
    const auto file = classes_.find(tile);
    if (file == classes_.end()) return classes;
    const auto read = readCdbTable(file->second, [&](const CdbRow& row) {
      if (const std::string& name = row.text("CNAM"); !name.empty()) classes[name].values = row.values;
    });
    findings_.add(read.findings());
    return classes;
  }

 private:
  FindingList& findings_;
  std::vector<const CdbFile*> instances_;
  std::map<CdbTile, std::filesystem::path> classes_;
  std::set<CdbTile> withRows_;
};

/// Turns rows into placements.
class FeaturePlacer {
 public:
  FeaturePlacer(const CdbCatalogue& cdb, CdbFeatures& features, FindingList& findings)
      : models_(cdb), features_(features), findings_(findings) {}

  void add(const FeatureTables& tables) {
    for (const CdbFile* const table : tables.instances()) {
      const FeatureClasses classes = tables.classesOf(table->tile);
      features_.list.tables.push_back({table->file.string(), features_.list.placements.size()});
      const auto read = readCdbTable(table->file, [&](const CdbRow& row) {
        if (row.point && tables.hasFiner(table->tile, (*row.point)[0], (*row.point)[1])) {
          ++features_.replaced;
          return;
        }
        const auto ofClass = classes.find(row.text("CNAM"));
        place(*table, row, Attributes(row, ofClass == classes.end() ? nullptr : &ofClass->second));
      });
      findings_.add(read.findings());
    }
  }

  Findings aboutModels() const { return models_.findings(); }

 private:
  void leaveOut(const CdbFile& table, const CdbRow& row, const std::string& key, const std::string& expected,
                const std::string& found) {
    findings_.add(Severity::warning, [&] {
      return Finding{Severity::warning, table.file.string() + ':' + std::to_string(row.number), key,
                     expected + "; the feature is left out", found.empty() ? "none" : found};
    });
  }

  /// Returns the model that a row's attributes name; none, counted, if it is not there.
  std::optional<std::string> modelOf(const CdbFile& table, const CdbRow& row, const Attributes& attributes) {
    const double subcode = attributes.number("FSC", 0);
    const std::string &facc = attributes.text("FACC"), &model = attributes.text("MODL"),
                      &unnamed = row.text("CNAM");
    if (model.empty() || facc.empty() || !(subcode >= 0 && subcode <= kMostSubcode)) {
      ++features_
            .withoutModel["no FACC, FSC and MODL for " + (unnamed.empty() ? "a row without CNAM" : unnamed)];
      return {};
    }
    const CdbModelName name{facc, static_cast<int>(subcode), model};
    const auto file = table.tile.set == CdbSet::kTypicalFeatures
                          ? models_.typical(name)
                          : models_.specific(table.tile, (*row.point)[0], (*row.point)[1],
                                             levelOf(attributes.number("MLOD", table.tile.level)), name);
    if (!file) ++features_.withoutModel[name.text()];
    return file;
  }

  static int levelOf(double mlod) {
    return std::abs(mlod) <= CdbTile::kFinest ? static_cast<int>(mlod) : CdbTile::kFinest + 1;
  }

  void place(const CdbFile& table, const CdbRow& row, const Attributes& attributes) {
    if (!row.point || !(std::abs((*row.point)[0]) <= 360) || !(std::abs((*row.point)[1]) <= 90)) {
      leaveOut(table, row, "place", "a point in degrees",
               row.point ? numberText((*row.point)[0], 9) + ", " + numberText((*row.point)[1], 9) : "none");
      return;
    }
    const double heading = attributes.number("AO1", 0), height = (*row.point)[2];
    if (!(std::abs(heading) <= PlacementLimits::kHeadingDeg)) {
      leaveOut(table, row, "AO1", "-360 to 360 degrees", attributes.text("AO1"));
      return;
    }
    if (!(std::abs(height) <= PlacementLimits::kHeightM)) {
      leaveOut(table, row, "height", "at most 20000 m either way", numberText(height, 9));
      return;
    }
    std::array<double, 3> scale{};
    const std::array<const char*, 3> names{"SCALX", "SCALY", "SCALZ"};
    for (std::size_t k = 0; k < 3; ++k) {
      scale[k] = attributes.number(names[k], 1);
      if (!(scale[k] >= PlacementLimits::kLeastScale && scale[k] <= PlacementLimits::kMostScale)) {
        leaveOut(table, row, names[k], "0.001 to 1000", attributes.text(names[k]));
        return;
      }
    }
    const auto file = modelOf(table, row, attributes);
    if (!file) return;
    const double largest = *std::max_element(scale.begin(), scale.end());
    const auto model = numberOf({*file, stretchOf(scale, largest)});
    if (!model) {
      leaveOut(table, row, "SCALX, SCALY, SCALZ",
               "at most " + std::to_string(kMostStretched) + " models that are stretched differently",
               "one more");
      return;
    }
    ListedPlacement placement;
    placement.longitude = Degrees{(*row.point)[0]};
    placement.latitude = Degrees{(*row.point)[1]};
    placement.heading = Degrees{heading};
    placement.scale = largest;
    placement.model = *model;
    placement.line = row.number;
    if (attributes.isTrue("AHGT"))
      placement.height = Metres{height};
    else
      placement.aboveGround = Metres{height};
    features_.list.placements.push_back(placement);
    ++(table.tile.set == CdbSet::kTypicalFeatures ? features_.typical : features_.specific);
  }

  static std::array<double, 3> stretchOf(const std::array<double, 3>& scale, double largest) {
    std::array<double, 3> stretch{1, 1, 1};
    for (std::size_t k = 0; k < 3; ++k)
      stretch[k] = std::max(kSameScale, std::round(scale[k] / largest / kSameScale) * kSameScale);
    return stretch;
  }

  /// Returns the model's number; none if it would be one stretched model too many.
  std::optional<std::uint32_t> numberOf(ModelFile model) {
    std::string name = model.file;
    const auto& [x, y, z] = model.stretch;
    const bool stretched = x != 1 || y != 1 || z != 1;
    if (stretched)
      name += ", stretched " + numberText(x, 4) + " x " + numberText(y, 4) + " x " + numberText(z, 4);
    const auto known = numbers_.find(name);
    if (known != numbers_.end()) return known->second;
    if (stretched && ++stretched_ > kMostStretched) return {};
    const auto number = static_cast<std::uint32_t>(features_.models.size());
    numbers_.emplace(name, number);
    features_.list.models.push_back(std::move(name));
    features_.models.push_back(std::move(model));
    return number;
  }

  CdbModels models_;
  CdbFeatures& features_;
  FindingList& findings_;
  std::unordered_map<std::string, std::uint32_t> numbers_;
  std::size_t stretched_ = 0;
};

}  // namespace

CdbFeatures readCdbFeatures(const CdbCatalogue& cdb, Findings& findings) {
  CdbFeatures features;
  FindingList list;
  FeaturePlacer placer(cdb, features, list);
  std::set<std::pair<int, int>> kinds;
  for (const CdbFile& file : cdb.files)
    if (file.tile.second == 1 &&
        (file.tile.set == CdbSet::kSpecificFeatures || file.tile.set == CdbSet::kTypicalFeatures))
      kinds.insert({file.tile.set, file.tile.first});
  for (const auto& [set, first] : kinds) {
    const FeatureTables tables(cdb, set, first, list);
    if (set == CdbSet::kSpecificFeatures && (first == kAirportLights || first == kOtherLights)) {
      for (const CdbFile* const table : tables.instances()) {
        const auto read = readCdbTable(table->file, [&](const CdbRow& row) {
          if (!row.point || !tables.hasFiner(table->tile, (*row.point)[0], (*row.point)[1]))
            ++features.lights;
        });
        list.add(read.findings());
      }
      continue;
    }
    placer.add(tables);
  }
  list.add(placer.aboutModels());
  for (Finding& finding : list.all(cdb.root.string())) findings.push_back(std::move(finding));
  return features;
}

}  // namespace trimtab::terrain
