#include "objects.h"

#include <cmath>

#include "drawn_ground.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/format/page_file.h"
#include "trimtab/terrain/format/patch_store.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/grid/grid_height.h"
#include "trimtab/terrain/grid/parallel.h"
#include "trimtab/terrain/objects/build_model.h"
#include "trimtab/terrain/objects/build_objects.h"

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
  return bytes;
}

/// Adds findings of one source to those of all; as warnings, if the others can be used without it.
void addAsWarnings(const Findings& some, Findings& all) {
  for (Finding finding : some) {
    if (finding.severity == Severity::error) finding.severity = Severity::warning;
    all.push_back(std::move(finding));
  }
}

}  // namespace

Result<ObjectSources> readObjectSources(const BakeOptions& options, std::size_t memory) {
  ObjectSources sources;
  sources.file = *options.objects;
  const std::string where = sources.file.string();
  if (!options.readModel) return Finding{Severity::error, where, "", "a reader of models", "none"};
  const auto text = readWhole(sources.file, kLargestRecording);
  if (!text) return text.findings();
  sources.sum = checksum(*text);
  auto list = readPlacementList(*text, where);
  if (!list) return list.findings();
  Findings findings = list.findings();
  sources.list = std::move(list).value();
  // A row is held as it was read, sorted, and as the file has it: a million of them take 180 MB beyond what
  // the bake takes without. Models are held as read, as triangles apart, and as levels.
  constexpr std::size_t kBytesPerRow = 300, kFormsOfModel = 4;
  std::size_t bytes = sources.list.placements.size() * kBytesPerRow;
  bool any = false;
  for (const std::string& name : sources.list.models) {
    auto model = options.readModel(sources.file.parent_path() / name);
    addAsWarnings(model.findings(), findings);
    sources.models.emplace_back();
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
    findings.push_back({Severity::error, where, "model", "at least one model that can be read", "none"});
    return findings;
  }
  return Result<ObjectSources>(std::move(sources), std::move(findings));
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
  auto objects = buildObjects(built, sources.list, BakedGround(heights), frame, sources.file.string(),
                              stageOf(progress, 0.8, 1));
  findings.insert(findings.end(), objects.findings().begin(), objects.findings().end());
  if (!objects) return findings;
  return Result<ObjectTerrain>(std::move(objects).value(), std::move(findings));
}

}  // namespace trimtab::terrain
