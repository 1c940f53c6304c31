#include <memory>

#include "commands.h"
#include "progress.h"
#include "terrain_info.h"
#include "trimtab/terrain/database.h"
#include "trimtab/terrain/scenery.h"

namespace trimtab::cli {

void addTerrain(CLI::App& app, int& exitCode) {
  CLI::App* group = app.add_subcommand("terrain", "Make, bake and look at terrain");
  group->require_subcommand(1);

  struct SampleArguments {
    std::string output;
    terrain::SampleOptions options;
  };
  auto sample = std::make_shared<SampleArguments>();
  CLI::App* makeSample = group->add_subcommand("sample", "Write the seeded sample terrain as a GeoTIFF");
  makeSample->add_option("-o,--output", sample->output, "GeoTIFF to write")->required();
  makeSample->add_option("--seed", sample->options.seed, "The same seed gives the same terrain")
      ->capture_default_str();
  makeSample->add_option("--size-km", sample->options.sizeKm, "Side of the square")
      ->capture_default_str()
      ->check(CLI::Range(5.0, 1000.0));
  makeSample->add_option("--post-m", sample->options.postM, "Distance of posts")
      ->capture_default_str()
      ->check(CLI::Range(5.0, 2000.0));
  makeSample->callback([sample, &exitCode] {
    const Interruptible guard;
    sample->options.progress = progressLines();
    const auto done = terrain::writeSample(sample->output, sample->options);
    report(done.findings());
    exitCode = done ? kDone : kRefused;
  });

  struct BakeArguments {
    std::vector<std::string> sources;
    std::string output, imagery;
    std::uint32_t leafTriangles = terrain::BakeOptions{}.trianglesPerNode;
    bool keepLines = false;
    double postM = 0;
  };
  auto bake = std::make_shared<BakeArguments>();
  CLI::App* makeBake = group->add_subcommand("bake", "Make a database of elevation or scenery");
  makeBake
      ->add_option(
          "source", bake->sources,
          "DTED, .hgt, GeoTIFF and whatever else GDAL reads, or folders of them; or FlightGear scenery: "
          "folders, .stg, .btg and .btg.gz")
      ->required();
  makeBake->add_option("-o,--output", bake->output, "Folder of the database")->required();
  makeBake->add_option("--imagery", bake->imagery, "Georeferenced image to drape");
  makeBake
      ->add_option("--leaf-triangles", bake->leafTriangles,
                   "Most triangles a leaf of the static levels of detail holds (scenery)")
      ->capture_default_str()
      ->check(CLI::Range(16, 1000000));
  makeBake->add_flag("--keep-lines", bake->keepLines,
                     "Keep roads, railways, streams and shorelines in the static levels of detail while a "
                     "pixel shows them (scenery)");
  makeBake
      ->add_option(
          "--post-m", bake->postM,
          "Distance of the posts that scenery is put on; by its size (30 to 60) where it is not given")
      ->check(CLI::Range(1.0, 10000.0));
  makeBake->callback([bake, &exitCode] {
    const Interruptible guard;
    terrain::BakeOptions options;
    options.sources.assign(bake->sources.begin(), bake->sources.end());
    options.output = bake->output;
    if (!bake->imagery.empty()) options.imagery = bake->imagery;
    options.trianglesPerNode = bake->leafTriangles;
    options.keepLines = bake->keepLines;
    if (bake->postM > 0) options.post = Metres{bake->postM};
    options.progress = progressLines();
    const auto done = terrain::bake(options);
    report(done.findings());
    exitCode = done ? kDone : kRefused;
    if (done) printInfo(**done, false);
  });

  struct InfoArguments {
    std::string terrain;
    bool json = false;
  };
  auto info = std::make_shared<InfoArguments>();
  CLI::App* showInfo = group->add_subcommand("info", "What a database or some scenery holds");
  showInfo->add_option("terrain", info->terrain, "Folder of a database; or scenery, not baked")->required();
  showInfo->add_flag("--json", info->json, "One JSON document on standard output");
  showInfo->callback([info, &exitCode] {
    const std::filesystem::path path = info->terrain;
    if (!terrain::isDatabase(path) && terrain::isScenery(path)) {
      exitCode = printSceneryInfo(path, info->json);
      return;
    }
    const auto database = terrain::Database::open(path);
    report(database.findings());
    exitCode = database ? kDone : kRefused;
    if (database) printInfo(**database, info->json);
  });
}

}  // namespace trimtab::cli
