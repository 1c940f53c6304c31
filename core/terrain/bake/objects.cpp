#include "objects.h"

#include <cmath>
#include <numbers>

#include "cdb.h"
#include "drawn_ground.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/cdb/features.h"
#include "trimtab/terrain/format/page_file.h"
#include "trimtab/terrain/format/patch_store.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/grid/grid_height.h"
#include "trimtab/terrain/grid/parallel.h"
#include "trimtab/terrain/objects/build_model.h"
#include "trimtab/terrain/objects/build_objects.h"
#include "trimtab/terrain/scenery/objects.h"
#include "trimtab/terrain/scenery/scenery.h"
#include "trimtab/units/linear.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

/// The baked heights, bilinear between posts.
class BakedGround final : public GroundHeights {
 public:
  explicit BakedGround(const HeightSource& heights) : heights_(heights) {}
  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override {
    const double height = heightOf(heights_.posts(), longitude.value(), latitude.value(),
                                   [&](std::uint32_t row, std::uint32_t column) {
                                     float post = 0;
                                     heights_.read({column, row, 1, 1}, 1, std::span(&post, 1));
                                     return post;
                                   });
    if (std::isnan(height)) return {};
    return Metres{height};
  }

 private:
  const HeightSource& heights_;
};

std::size_t bytesOf(const SourceModel& model) {
  std::size_t bytes = 0;
  for (const SourceMesh& mesh : model.levels)
    bytes += mesh.vertices.size() * sizeof(SourceVertex) + mesh.indices.size() * sizeof(std::uint32_t);
  for (const SourceTexture& texture : model.textures) bytes += texture.pixels.size();
  return bytes + model.lights.size() * sizeof(SourceLight);
}

/// Adds findings of one source to those of all; as warnings, if the others can be used without it.
void addAsWarnings(const Findings& some, Findings& all) {
  for (Finding finding : some) {
    if (finding.severity == Severity::error) finding.severity = Severity::warning;
    all.push_back(std::move(finding));
  }
}

/// Reads the list of placements that a person named.
Result<Done> addList(const std::filesystem::path& file, ObjectSources& sources,
                     std::vector<ModelFile>& files) {
  const auto text = readWhole(file, kLargestRecording);
  if (!text) return text.findings();
  auto list = readPlacementList(*text, file.string());
  if (!list) return list.findings();
  sources.file = file;
  sources.required = true;
  sources.sum = checksum(*text);
  Findings findings = list.findings();
  sources.list = std::move(list).value();
  sources.list.tables.push_back({file.string(), 0});
  for (const std::string& name : sources.list.models) files.push_back({(file.parent_path() / name).string()});
  return Result<Done>(Done{}, std::move(findings));
}

/// Appends what a source brings itself.
void addPlaced(const std::filesystem::path& source, PlacedModels placed, ObjectSources& sources,
               std::vector<ModelFile>& files) {
  if (placed.list.placements.empty()) return;
  if (sources.file.empty()) sources.file = source;
  PlacementList& all = sources.list;
  const auto firstModel = static_cast<std::uint32_t>(all.models.size());
  for (PlacementTable& table : placed.list.tables)
    all.tables.push_back({std::move(table.where), table.first + all.placements.size()});
  std::string bytes = std::to_string(sources.sum);
  for (ListedPlacement p : placed.list.placements) {
    bytes += '\n' + placed.list.models[p.model];
    for (const double value : {p.latitude.value(), p.longitude.value(), p.height.value_or(Metres{}).value(),
                               p.aboveGround.value(), p.heading.value(), p.scale, p.height ? 1.0 : 0.0})
      bytes += ' ' + numberText(value);
    p.model += firstModel;
    all.placements.push_back(p);
  }
  sources.sum = checksum(bytes);
  all.models.insert(all.models.end(), placed.list.models.begin(), placed.list.models.end());
  files.insert(files.end(), placed.models.begin(), placed.models.end());
}

/// Makes a model wider, longer and higher, then turns it; normals stay upright to its surfaces.
void change(SourceModel& model, const ModelFile& how) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double cx = std::cos(how.roll.value() * kRadians), sx = std::sin(how.roll.value() * kRadians),
               cy = std::cos(how.pitch.value() * kRadians), sy = std::sin(how.pitch.value() * kRadians);
  const Mat3 turn = Mat3{{Vec3{cy, 0, sy}, Vec3{0, 1, 0}, Vec3{-sy, 0, cy}}} *
                    Mat3{{Vec3{1, 0, 0}, Vec3{0, cx, -sx}, Vec3{0, sx, cx}}};
  const bool turned = how.roll.value() != 0 || how.pitch.value() != 0;
  const auto inTurn = [&](std::array<float, 3>& v) {
    if (!turned) return;
    const Vec3 to = turn * Vec3{double{v[0]}, double{v[1]}, double{v[2]}};
    v = {static_cast<float>(to.x), static_cast<float>(to.y), static_cast<float>(to.z)};
  };
  for (SourceMesh& mesh : model.levels)
    for (SourceVertex& v : mesh.vertices) {
      for (std::size_t k = 0; k < 3; ++k) {
        v.position[k] *= static_cast<float>(how.stretch[k]);
        v.normal[k] /= static_cast<float>(how.stretch[k]);
      }
      inTurn(v.position);
      inTurn(v.normal);
    }
  for (SourceLight& light : model.lights) {
    for (std::size_t k = 0; k < 3; ++k) light.position[k] *= static_cast<float>(how.stretch[k]);
    inTurn(light.position);
  }
}

}  // namespace

PlacedModels placedOn(const std::filesystem::path& source,
                      const std::optional<std::filesystem::path>& sceneryModels, Findings& findings) {
  if (isScenery(source)) return readSceneryObjects(source, baseFolders(sceneryModels), findings);
  if (!isCdb(source)) return {};
  const auto cdb = openCdb(source);
  if (!cdb) return {};  // elevation reports it
  return readCdbFeatures(*cdb, findings);
}

Result<std::optional<ObjectSources>> readObjectSources(const BakeOptions& options, std::size_t memory) {
  ObjectSources sources;
  std::vector<ModelFile> files;
  Findings findings;
  if (options.objects) {
    auto read = addList(*options.objects, sources, files);
    findings = read.findings();
    if (!read) return findings;
  }
  for (const std::filesystem::path& source : options.sources)
    if (options.ownObjects)
      addPlaced(source, placedOn(source, options.sceneryModels, findings), sources, files);
  if (sources.list.placements.empty())
    return Result<std::optional<ObjectSources>>(std::nullopt, std::move(findings));
  const std::string where = sources.file.string();
  if (!options.readModel) {
    findings.push_back({options.objects ? Severity::error : Severity::warning, where, "",
                        "a reader of models", "none: nothing stands on the ground"});
    if (options.objects) return findings;
    return Result<std::optional<ObjectSources>>(std::nullopt, std::move(findings));
  }
  // A row is held as it was read, sorted, and as the file has it: a million of them take 180 MB beyond what
  // the bake takes without. Models are held as read, as triangles apart, and as levels.
  constexpr std::size_t kBytesPerRow = 300, kFormsOfModel = 4;
  std::size_t bytes = sources.list.placements.size() * kBytesPerRow;
  bool any = false;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string& name = sources.list.models[i];
    auto model = options.readModel(files[i].file);
    addAsWarnings(model.findings(), findings);
    sources.models.emplace_back();
    if (model) change(*model, files[i]);
    sources.modelSums.push_back(model ? checksumOf(*model) : 0);
    if (model) {
      bytes += bytesOf(*model) * kFormsOfModel;
      sources.models.back() = std::move(model).value();
      sources.models.back()->name = name;
      any = true;
    }
    if (bytes > memory)
      return Finding{
          Severity::error, where, "",
          "objects that " + std::to_string(memory / 1000000) + " MB of memory hold (--memory-mb gives more)",
          std::to_string(sources.list.placements.size()) + " objects and their models up to " + name +
              ", which take " + std::to_string(bytes / 1000000) + " MB"};
  }
  if (!any) {
    findings.push_back({options.objects ? Severity::error : Severity::warning, where, "model",
                        "at least one model that can be read", "none"});
    if (options.objects) return findings;
    return Result<std::optional<ObjectSources>>(std::nullopt, std::move(findings));
  }
  return Result<std::optional<ObjectSources>>(std::move(sources), std::move(findings));
}

Result<ObjectTerrain> bakeObjects(ObjectSources& sources, const HeightSource& heights,
                                  const std::filesystem::path& patches, const LocalFrame& frame,
                                  const Progress& progress) {
  const auto pages = PageFile::open(patches);
  if (!pages) return pages.findings();
  const auto drawn = openPatches(*pages, patches, heights.posts());
  if (!drawn) return drawn.findings();
  if (auto stood = standOnDrawnGround(sources.list, **drawn, heights.posts()); !stood)
    return stood.findings();
  const auto count = static_cast<std::uint32_t>(sources.models.size());
  std::vector<std::optional<BuiltModel>> built(count);
  std::vector<Findings> about(count);
  const bool done = forEachParallel(
      count,
      [&](std::uint32_t i) {
        if (!sources.models[i]) return;
        auto model = buildModel(*sources.models[i]);
        sources.models[i].reset();
        about[i] = model.findings();
        if (model) built[i] = std::move(model).value();
      },
      [&](double share) { return !progress || progress(0.8 * share, "levels of models"); });
  if (!done) return cancelled("levels of models");
  Findings findings;
  for (const Findings& some : about) addAsWarnings(some, findings);
  bool stopped = false;
  const Progress watched = [&](double share, const std::string& what) {
    stopped = progress && !stageOf(progress, 0.8, 1)(share, what);
    return !stopped;
  };
  auto objects =
      buildObjects(built, sources.list, BakedGround(heights), frame, sources.file.string(), watched);
  if (!objects && !sources.required && !stopped) {
    addAsWarnings(objects.findings(), findings);
    return Result<ObjectTerrain>(ObjectTerrain{}, std::move(findings));
  }
  findings.insert(findings.end(), objects.findings().begin(), objects.findings().end());
  if (!objects) return findings;
  return Result<ObjectTerrain>(std::move(objects).value(), std::move(findings));
}

}  // namespace trimtab::terrain
