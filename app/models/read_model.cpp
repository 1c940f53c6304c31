#include "app/models/read_model.h"

#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>
#include <osgDB/Registry>

#include <exception>
#include <utility>

#include "app/models/canonical.h"
#include "app/models/flattened.h"
#include "app/models/watched_reads.h"
#include "trimtab/preset/file_io.h"

namespace trimtab::models {

namespace {

Finding unusable(const std::filesystem::path& file, std::string expected, std::string found) {
  return {Severity::error, file.string(), "", std::move(expected), std::move(found)};
}

/// Turns y up to z up, about x.
void turnUp(Flattened& shown) {
  const auto turn = [](std::array<float, 3>& a) { a = {a[0], -a[2], a[1]}; };
  for (terrain::SourceVertex& v : shown.mesh.vertices) turn(v.position), turn(v.normal);
  for (terrain::SourceLight& light : shown.lights) turn(light.position);
}

bool same(const terrain::SourceMesh& a, const terrain::SourceMesh& b) {
  return terrain::checksumOf({"", {a}, {}}) == terrain::checksumOf({"", {b}, {}});
}

terrain::SourceModel modelOf(osg::Node& node, const std::filesystem::path& file, Findings& findings) {
  terrain::SourceModel model{file.string(), {}, {}};
  TextureList textures;
  constexpr std::size_t kMostLevels = 16;
  for (const double distance : distancesOf(node)) {
    Flattened shown = flattened(node, distance, textures);
    if (osgDB::getLowerCaseFileExtension(file.string()) == "ac") turnUp(shown);
    // Lights have no levels: those of the nearest one that has any are the model's.
    if (model.lights.empty() && !shown.lights.empty()) {
      model.lights = std::move(shown.lights);
      if (shown.moreOfLights)
        findings.push_back({Severity::warning, file.string(), "", "lights that shine always and all around",
                            "some with a sector or a sequence of blinking, which is left out"});
    }
    terrain::SourceMesh& mesh = shown.mesh;
    // Nothing is shown beyond the last range, nor before the first.
    if (mesh.indices.empty() || (!model.levels.empty() && same(mesh, model.levels.back()))) continue;
    model.levels.push_back(std::move(mesh));
    if (model.levels.size() == kMostLevels) break;
  }
  if (model.levels.empty()) model.levels.emplace_back();
  model.textures = textures.take();
  makeCanonical(model);
  return model;
}

}  // namespace

Result<terrain::SourceModel> readModel(const std::filesystem::path& file) {
  std::error_code error;
  if (!file.string().starts_with("/vsizip/")) {
    if (!std::filesystem::is_regular_file(file, error))
      return unusable(file, "a model's file", error ? error.message() : "none");
    if (const auto data = checkIsData(file); !data) return data.findings();
  }
  if (!isModelName(file.string())) return unusable(file, "a model (" + modelFormats() + ")", "another file");
  const bool listed = osgDB::getLowerCaseFileExtension(file.string()) == "xml";
  if (!listed && osgDB::Registry::instance()->getReaderWriterForExtension(
                     osgDB::getLowerCaseFileExtension(file.string())) == nullptr)
    return unusable(file, "OpenSceneGraph's plugin for such files", "none installed");
  WatchedReads watch(file);
  osg::ref_ptr<osg::Node> node;
  try {
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setObjectCacheHint(osgDB::Options::CACHE_NONE);
    node = osgDB::readRefNodeFile(file.string(), options.get());
    if (node) {
      Findings findings = watch.findings();
      terrain::SourceModel model = modelOf(*node, file, findings);
      return Result<terrain::SourceModel>(std::move(model), std::move(findings));
    }
  } catch (const std::exception& thrown) {
    return unusable(file, "a model that can be read", thrown.what());
  }
  Findings findings = watch.findings();
  findings.push_back(unusable(file, "a model that OpenSceneGraph can read", "another or a damaged file"));
  return findings;
}

}  // namespace trimtab::models
