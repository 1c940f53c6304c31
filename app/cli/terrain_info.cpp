#include "terrain_info.h"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "trimtab/terrain/format/level_report.h"
#include "trimtab/terrain/format/object_file.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/scenery/import.h"
#include "trimtab/terrain/scenery/scenery.h"
#include "trimtab/terrain/static_lod/static_lod.h"
#include "trimtab/units/number.h"

namespace trimtab::cli {

namespace {

using Json = nlohmann::ordered_json;

Json toJson(const terrain::SceneryCounts& counts) {
  return {{"tiles", counts.tiles},
          {"airports", counts.airports},
          {"triangles_in_file", counts.trianglesInFile},
          {"degenerate", counts.degenerate},
          {"triangles", counts.triangles},
          {"missing", counts.missing}};
}

Json toJson(const terrain::StaticLodTerrain& trees) {
  const terrain::StaticLodCounts& counts = trees.counts;
  return {{"triangles_per_node", trees.trianglesPerNode},
          {"trees", trees.index.roots.size()},
          {"nodes", trees.index.size()},
          {"levels", counts.levels},
          {"source_triangles", counts.sourceTriangles},
          {"faces_of_level", counts.facesOfLevel},
          {"faces", counts.faces},
          {"distinct_faces", counts.distinctFaces},
          {"locked_minima", counts.lockedMinima},
          {"joined_vertices", counts.joinedVertices},
          {"degenerate", counts.degenerate},
          {"repeated", counts.repeated},
          {"folded", counts.folded},
          {"bytes", counts.bytes}};
}

Json toJson(const terrain::ObjectTerrain& objects) {
  const terrain::ObjectCounts counts = terrain::countObjects(objects);
  const ObjectIndex& index = objects.index;
  std::vector<std::size_t> placed(index.models.size());
  for (const ObjectInstance& instance : index.instances) ++placed[instance.model];
  Json models = Json::array();
  for (std::size_t m = 0; m < index.models.size(); ++m) {
    Json triangles = Json::array(), errors = Json::array();
    for (std::uint32_t i = 0; i < index.models[m].levels; ++i) {
      const ObjectIndex::Level& level = index.levels[index.models[m].firstLevel + i];
      triangles.push_back(level.triangles);
      errors.push_back(level.errorM);
    }
    models.push_back({{"name", objects.names[m]},
                      {"instances", placed[m]},
                      {"radius_m", index.models[m].radiusM},
                      {"triangles", triangles},
                      {"error_m", errors}});
  }
  return {{"instances", counts.instances},
          {"cells", counts.cells},
          {"levels", counts.levels},
          {"triangles", counts.triangles},
          {"finest_triangles", counts.finestTriangles},
          {"coarsest_triangles", counts.coarsestTriangles},
          {"textures", counts.textures},
          {"lights", counts.lights},
          {"models", models}};
}

Json patchLevels(const terrain::PatchTerrain& patches) {
  Json depths = Json::array();
  for (const terrain::LevelReport& level : terrain::levelsOf(patches))
    depths.push_back({{"depth", depths.size()},
                      {"patches", level.nodes},
                      {"triangles", level.triangles},
                      {"bytes", level.bytes},
                      {"error_m", level.maxErrorM},
                      {"rms_error_m", level.rmsErrorM},
                      {"bilinear_error_m", level.bilinearErrorM}});
  return depths;
}

Json toJson(const terrain::Database& database) {
  const terrain::TerrainInfo& i = database.info();
  const TerrainIndex& index = database.index();
  Json levels = Json::array();
  for (std::size_t l = 0; l < index.levels.size(); ++l) {
    const TerrainIndex::Level& level = index.levels[l];
    float error = 0;
    for (std::uint32_t n = 0; n < level.columns * level.rows; ++n)
      error = std::max(error, index.errorM[level.firstNode + n]);
    levels.push_back({{"level", l}, {"columns", level.columns}, {"rows", level.rows}, {"error_m", error}});
  }
  Json json = {{"name", i.name},
               {"source", i.source},
               {"south_deg", i.southWest.latitude.value()},
               {"west_deg", i.southWest.longitude.value()},
               {"north_deg", i.northEast.latitude.value()},
               {"east_deg", i.northEast.longitude.value()},
               {"columns", i.columns},
               {"rows", i.rows},
               {"post_longitude_deg", i.postLongitude.value()},
               {"post_latitude_deg", i.postLatitude.value()},
               {"lowest_m", i.lowest.value()},
               {"highest_m", i.highest.value()},
               {"voids_filled", i.voidsFilled},
               {"image", i.hasImage},
               {"bytes", i.bytes},
               {"bytes_a_post", static_cast<double>(i.bytes) / (static_cast<double>(i.columns) * i.rows)},
               {"levels", levels}};
  if (const auto patches = database.patches()) json["patches"] = patchLevels(*patches);
  if (i.scenery) json["scenery"] = toJson(*i.scenery);
  if (const auto trees = database.staticLod()) json["static_lod"] = toJson(*trees);
  if (const auto objects = database.objects()) json["objects"] = toJson(*objects);
  return json;
}

Json toJson(const terrain::SceneryMesh& mesh) {
  double west = 0, east = 0, south = 0, north = 0, low = 0, high = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const GeodeticPosition p = toGeodetic(mesh.vertices[v]);
    const double latitude = p.latitude.value(), height = p.height.value();
    // Longitudes beside the first vertex's, so that the date line does not widen the tile.
    const double longitude =
        v == 0 ? p.longitude.value() : west + wrapped180(p.longitude - Degrees{west}).value();
    if (v == 0) west = east = longitude, south = north = latitude, low = high = height;
    west = std::min(west, longitude), east = std::max(east, longitude);
    south = std::min(south, latitude), north = std::max(north, latitude);
    low = std::min(low, height), high = std::max(high, height);
  }
  return {{"name", mesh.name},
          {"kind", mesh.airport ? "airport" : "tile"},
          {"version", mesh.version},
          {"triangles_in_file", mesh.trianglesInFile},
          {"degenerate", mesh.degenerate},
          {"triangles", mesh.triangles.size()},
          {"vertices", mesh.vertices.size()},
          {"west_deg", west},
          {"south_deg", south},
          {"east_deg", east},
          {"north_deg", north},
          {"lowest_m", low},
          {"highest_m", high}};
}

std::string plain(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string all;
  for (const Json& item : value) all += (all.empty() ? "" : ", ") + plain(item);
  return all.empty() ? "none" : all;
}

/// "key  value" a line; of an object inside, "key.inner".
void printLines(const Json& json, const std::string& prefix = "") {
  for (const auto& [key, value] : json.items()) {
    if (value.is_object())
      printLines(value, prefix + key + ".");
    else if (!value.is_array() || value.empty() || !value[0].is_object())
      std::cout << std::left << std::setw(36) << prefix + key + " " << plain(value) << '\n';
  }
}

void printDocument(const Json& json) {
  std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace

void printInfo(const terrain::Database& database, bool json) {
  const Json all = toJson(database);
  if (json) return printDocument(all);
  printLines(all);
  for (const auto& level : all["levels"])
    std::cout << "level " << level["level"] << ": " << level["columns"] << " x " << level["rows"]
              << " tiles, error " << level["error_m"].get<double>() << " m\n";
  if (all.contains("objects"))
    for (const auto& model : all["objects"]["models"]) {
      std::cout << "model " << model["name"].get<std::string>() << ": " << model["instances"] << " placed;";
      for (std::size_t i = 0; i < model["triangles"].size(); ++i)
        std::cout << (i > 0 ? "," : "") << ' ' << model["triangles"][i] << " triangles to "
                  << numberText(model["error_m"][i].get<double>(), 3) << " m";
      std::cout << '\n';
    }
  if (!all.contains("patches")) return;
  // A space stands before every column, however wide its numbers are: errors of the whole earth's coarsest
  // patches are thousands of kilometres.
  std::cout << "depth   patches   triangles        bytes     error m       rms m  between posts m\n";
  for (const auto& depth : all["patches"])
    std::cout << std::right << std::fixed << std::setw(5) << depth["depth"].get<int>() << ' ' << std::setw(9)
              << depth["patches"].get<std::uint64_t>() << ' ' << std::setw(11)
              << depth["triangles"].get<std::uint64_t>() << ' ' << std::setw(12)
              << depth["bytes"].get<std::uint64_t>() << std::setprecision(2) << ' ' << std::setw(11)
              << depth["error_m"].get<double>() << ' ' << std::setw(11) << depth["rms_error_m"].get<double>()
              << ' ' << std::setw(16) << depth["bilinear_error_m"].get<double>() << '\n';
  std::cout
      << "error: the largest at any post; rms: over all posts of the depth, not the worst patch's; between\n"
         "posts: the largest measured over the bilinear surface\n"
      << std::defaultfloat << std::left;
}

int printSceneryInfo(const std::filesystem::path& path, bool json) {
  const auto scenery = terrain::readScenery(path);
  report(scenery.findings());
  if (!scenery) return kRefused;
  // Findings are no reason to stop: whatever could be read is reported.
  const bool whole = !hasError(scenery.findings());
  std::map<std::string, std::uint64_t> materials;
  Json meshes = Json::array();
  for (const terrain::SceneryMesh& mesh : scenery->tiles) {
    meshes.push_back(toJson(mesh));
    for (const terrain::SceneryMesh::Triangle& t : mesh.triangles) ++materials[mesh.materials[t.material]];
  }
  const Json all = {{"source", path.string()},
                    {"scenery", toJson(terrain::countsOf(*scenery))},
                    {"materials", materials},
                    {"files", meshes}};
  if (json) {
    printDocument(all);
    return whole ? kDone : kRefused;
  }
  printLines(all);
  for (const auto& mesh : all["files"])
    std::cout << mesh["kind"].get<std::string>() << ' ' << mesh["name"].get<std::string>() << ": version "
              << mesh["version"] << ", " << mesh["triangles"] << " triangles (" << mesh["degenerate"]
              << " degenerate dropped), " << mesh["lowest_m"].get<double>() << " to "
              << mesh["highest_m"].get<double>() << " m\n";
  return whole ? kDone : kRefused;
}

}  // namespace trimtab::cli
