#include <iostream>
#include <memory>
#include <optional>

#include "app/models/read_model.h"
#include "commands.h"
#include "progress.h"
#include "settings.h"
#include "terrain_info.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/elevation/height_unit.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/scenery/scenery.h"
#include "trimtab/terrain/synthetic/country.h"
#include "trimtab/terrain/synthetic/land_picture.h"
#include "trimtab/terrain/synthetic/sample.h"

namespace trimtab::cli {

void addTerrain(CLI::App& app, int& exitCode) {
  CLI::App* group = app.add_subcommand("terrain", "Make, bake and look at terrain");
  group->require_subcommand(1);

  struct SampleArguments {
    std::string output;
    terrain::SampleOptions options;
    bool bare = false;
  };
  auto sample = std::make_shared<SampleArguments>();
  CLI::App* makeSample = group->add_subcommand(
      "sample",
      "Write the seeded sample terrain as a GeoTIFF, and what stands on it, for terrain bake --objects");
  makeSample
      ->add_option("-o,--output", sample->output,
                   "GeoTIFF to write; objects go beside NAME.tif, into NAME-objects.csv and its models into "
                   "NAME-objects")
      ->required();
  makeSample->add_flag("--bare", sample->bare, "Write no objects");
  makeSample->add_option("--seed", sample->options.seed, "The same seed gives the same terrain")
      ->capture_default_str();
  makeSample->add_option("--size-km", sample->options.sizeKm, "Side of the square")
      ->capture_default_str()
      ->check(CLI::Range(5.0, 1000.0));
  makeSample->add_option("--post-m", sample->options.postM, "Distance of posts")
      ->capture_default_str()
      ->check(CLI::Range(5.0, 2000.0));
  stopWhenAsked(*makeSample);
  makeSample->callback([sample, &exitCode] {
    sample->options.progress = progressLines();
    sample->options.objects = !sample->bare;
    const auto done = terrain::writeSample(sample->output, sample->options);
    report(done.findings());
    exitCode = done ? kDone : kRefused;
  });

  struct CountryArguments {
    std::string output;
    terrain::CountryOptions options;
  };
  auto country = std::make_shared<CountryArguments>();
  CLI::App* makeCountry = group->add_subcommand(
      "country", "Write rough land of a country's size as a GeoTIFF, to try large terrain with");
  makeCountry->add_option("-o,--output", country->output, "GeoTIFF to write")->required();
  makeCountry->add_option("--seed", country->options.seed, "The same seed gives the same land")
      ->capture_default_str();
  makeCountry->add_option("--columns", country->options.columns, "Posts from west to east")
      ->capture_default_str()
      ->check(CLI::Range(33, 65536));
  makeCountry->add_option("--rows", country->options.rows, "Posts from south to north")
      ->capture_default_str()
      ->check(CLI::Range(33, 65536));
  makeCountry->add_option("--post-m", country->options.postM, "Distance of posts")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 2000.0));
  stopWhenAsked(*makeCountry);
  makeCountry->callback([country, &exitCode] {
    country->options.progress = progressLines();
    const auto done = terrain::writeCountry(country->output, country->options);
    report(done.findings());
    exitCode = done ? kDone : kRefused;
  });

  struct PictureArguments {
    std::string elevation, output;
    terrain::LandPictureOptions options;
  };
  auto picture = std::make_shared<PictureArguments>();
  CLI::App* makePicture = group->add_subcommand(
      "picture", "Paint a picture of the ground from elevation as a GeoTIFF: fields, roads, woods, water");
  makePicture
      ->add_option("elevation", picture->elevation,
                   "One raster in WGS84 degrees, as sample and country write")
      ->required();
  makePicture->add_option("-o,--output", picture->output, "GeoTIFF to write, for terrain bake --imagery")
      ->required();
  makePicture->add_option("--seed", picture->options.seed, "The same seed gives the same picture")
      ->capture_default_str();
  makePicture
      ->add_option("--pixel-m", picture->options.pixelM,
                   "Size of pixels, metres; the nearest whole part of the distance of posts is taken")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 2000.0));
  stopWhenAsked(*makePicture);
  makePicture->callback([picture, &exitCode] {
    picture->options.progress = progressLines();
    const auto done = terrain::writeLandPicture(picture->elevation, picture->output, picture->options);
    report(done.findings());
    exitCode = done ? kDone : kRefused;
  });

  struct BakeArguments {
    std::vector<std::string> sources;
    std::string output, imagery, objects, sceneryModels;
    std::uint32_t leafTriangles = terrain::BakeOptions{}.trianglesPerNode;
    bool keepLines = false, keepTexture = false, noObjects = false;
    double postM = 0, memoryMb = terrain::BakeOptions{}.memory.value();
    std::optional<double> maxErrorM;
    std::string heightUnit;
    PartOptions part;
    bool ignoreChecksums = false;
  };
  auto bake = std::make_shared<BakeArguments>();
  CLI::App* makeBake = group->add_subcommand("bake", "Make a database of elevation or scenery");
  makeBake
      ->add_option(
          "source", bake->sources,
          "DTED, .hgt, GeoTIFF and whatever else GDAL reads, or folders of them; or FlightGear scenery: "
          "folders, .stg, .btg and .btg.gz; or OGC CDB 1.x: folders with Tiles, with their imagery and "
          "features")
      ->required();
  makeBake->add_option("-o,--output", bake->output, "Folder of the database")->required();
  makeBake
      ->add_option(
          "--height-unit", bake->heightUnit,
          "Unit of heights in files that name none, or none that is known: " + terrain::unitsOfHeight())
      ->check([](const std::string& name) {
        return terrain::metresPerUnit(name) ? std::string()
                                            : name + " is none of " + terrain::unitsOfHeight();
      });
  makeBake->add_flag("--ignore-checksums", bake->ignoreChecksums,
                     "Read DTED whose profiles do not agree with their checksums, or have none");
  makeBake->add_option("--imagery", bake->imagery, "Georeferenced image to drape, or a folder of them");
  makeBake->add_option("--objects", bake->objects,
                       "What stands on the ground: a table with columns model, latitude_deg, longitude_deg, "
                       "and if wanted height_m (empty: on the ground), heading_deg and scale; models are "
                       "files beside it: " +
                           models::modelFormats() +
                           ", in metres, z up (.ac, as FlightGear writes it, and .obj: y up)");
  makeBake->add_option("--scenery-models", bake->sceneryModels,
                       "FlightGear's base package, whose Models scenery shares; without it FG_ROOT and "
                       "/usr/share/games/flightgear are searched");
  makeBake->add_flag(
      "--no-objects", bake->noObjects,
      "Leave out what sources bring to stand on the ground: features of a CDB, objects of scenery");
  makeBake
      ->add_option("--leaf-triangles", bake->leafTriangles,
                   "Most triangles a leaf of the static levels of detail holds (scenery)")
      ->capture_default_str()
      ->check(CLI::Range(16, 1000000));
  makeBake->add_flag("--keep-lines", bake->keepLines,
                     "Keep roads, railways, streams and shorelines in the static levels of detail while a "
                     "pixel shows them (scenery)");
  makeBake->add_flag("--keep-texture", bake->keepTexture,
                     "Keep the texture coordinates of the files in the static levels of detail, for export "
                     "(scenery)");
  makeBake
      ->add_option("--post-m", bake->postM,
                   "Distance of posts. Without it scenery takes 30 to 60 by its size, elevation that of the "
                   "finest file")
      ->check(CLI::Range(1.0, 10000.0));
  makeBake
      ->add_option("--max-error-m", bake->maxErrorM,
                   "Vertical error of the finest patches at the posts, metres; 0: every post counts")
      ->check(CLI::Range(0.0, 1000.0));
  makeBake
      ->add_option("--memory-mb", bake->memoryMb,
                   "Most memory that baking may use; tiles and trees that would take more are left out")
      ->capture_default_str()
      ->check(CLI::Range(64.0, 1048576.0));
  bake->part.add(*makeBake);
  stopWhenAsked(*makeBake);
  makeBake->callback([bake, &exitCode] {
    terrain::BakeOptions options;
    options.sources.assign(bake->sources.begin(), bake->sources.end());
    options.output = bake->output;
    if (!bake->imagery.empty()) options.imagery = bake->imagery;
    if (!bake->objects.empty()) options.objects = bake->objects;
    options.ownObjects = !bake->noObjects;
    if (!bake->sceneryModels.empty()) options.sceneryModels = bake->sceneryModels;
    options.readModel = models::readModel;
    if (!bake->heightUnit.empty()) options.reading.heightUnit = terrain::metresPerUnit(bake->heightUnit);
    options.reading.ignoreChecksums = bake->ignoreChecksums;
    options.trianglesPerNode = bake->leafTriangles;
    options.keepLines = bake->keepLines;
    options.keepTexture = bake->keepTexture;
    if (bake->postM > 0) options.post = Metres{bake->postM};
    if (bake->maxErrorM) options.maxError = Metres{*bake->maxErrorM};
    options.memory = Megabytes{bake->memoryMb};
    options.progress = progressLines();
    report(terrain::aboutSources(options));
    const bool join = bake->part.join;
    if (const auto part = bake->part.read(); part && !join) {
      const auto done = terrain::bakePart(options, static_cast<std::uint32_t>(part->index + 1),
                                          static_cast<std::uint32_t>(part->count));
      report(done.findings());
      exitCode = done ? kDone : kRefused;
      return;
    }
    const auto done = join ? terrain::bakeJoin(options) : terrain::bake(options);
    report(done.findings());
    exitCode = !done ? kRefused : *done ? kDone : kIncomplete;
    if (done && *done) printInfo(**done, false);
  });

  struct InfoArguments {
    std::string terrain;
    bool json = false, check = false;
  };
  auto info = std::make_shared<InfoArguments>();
  CLI::App* showInfo = group->add_subcommand("info",
                                             "What a database or some scenery holds; of patches each depth's "
                                             "largest error and its RMS over all posts");
  showInfo->add_option("terrain", info->terrain, "Folder of a database; or scenery, not baked")->required();
  showInfo->add_flag("--json", info->json, "One JSON document on standard output");
  showInfo->add_flag("--check", info->check, "Read all of a database and compare every checksum");
  showInfo->callback([info, &exitCode] {
    const std::filesystem::path path = info->terrain;
    if (!terrain::isDatabase(path) && terrain::isScenery(path)) {
      exitCode = printSceneryInfo(path, info->json);
      return;
    }
    const auto database = terrain::Database::open(path);
    report(database.findings());
    exitCode = database ? kDone : kRefused;
    if (!database) return;
    printInfo(**database, info->json);
    if (!info->check) return;
    const Findings damage = (*database)->checkAll();
    report(damage);
    if (!damage.empty()) exitCode = kRefused;
    if (damage.empty() && !info->json) std::cout << "every checksum holds\n";
  });

  addTerrainHeight(*group, exitCode);
  addTerrainExport(*group, exitCode);
}

}  // namespace trimtab::cli
