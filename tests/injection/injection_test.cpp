#include "injection.h"
#include "tests/core/terrain/elevation/rasters.h"
#include "tests/core/terrain/static_lod/static_lod_support.h"
#include "trimtab/preset/preset.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/scenery/scenery.h"
#include "trimtab/terrain/static_lod/export.h"

namespace trimtab {
namespace {

namespace fs = std::filesystem;
using test::Injection;

TEST_F(Injection, ofASaveOfAPreset) {
  Preset preset;
  preset.name = "new";
  preset.parameters.lod.scale = Ratio{2};
  for (const bool unnamed : {true, false})
    for (const bool isThere : {true, false})
      writes((std::string(isThere ? "preset" : "new preset") + (unnamed ? "" : ", without unnamed files"))
                 .c_str(),
             {.begin =
                  [&](const fs::path& folder) {
                    if (isThere) test::writeFile(folder / "p.json", "{\"the old\": 1}");
                  },
              .work = [&](const fs::path& folder) -> Findings {
                const auto text = presetText(preset);
                if (!text) return text.findings();
                const auto done = writeAtomically(folder / "p.json", *text);
                return done ? Findings{} : done.findings();
              },
              .mayStay = [](const std::string& name) { return name.starts_with(".p.json.trimtab-"); },
              .unnamed = unnamed});
}

class BakeInjection : public Injection {
 protected:
  BakeInjection() {
    test::RasterRecipe recipe;
    recipe.columns = 40;
    recipe.rows = 34;
    recipe.value = [](int c, int r, int) { return test::roughGround(c, r); };
    options_.sources = {test::writeRaster(source_ / "ground.tif", recipe)};
  }
  Findings bakeIn(const fs::path& folder) const {
    terrain::BakeOptions options = options_;
    options.output = folder / "db";
    const auto made = terrain::bake(options);
    if (made) return {};
    // A note of what is kept is no reason.
    return made.findings();
  }
  static bool isWork(const std::string& name) { return name.starts_with(".db.work"); }

  test::ScratchDir source_;
  terrain::BakeOptions options_;
};

TEST_F(BakeInjection, ofABake) {
  writes("bake",
         {[](const fs::path&) {}, [&](const fs::path& folder) { return bakeIn(folder); }, isWork, 97});
}

TEST_F(BakeInjection, ofABakeWithImagery) {
  options_.imagery = test::writeRaster(source_ / "rgb.tif", test::anyColours(40, 34));
  writes("bake with imagery",
         {[](const fs::path&) {}, [&](const fs::path& folder) { return bakeIn(folder); }, isWork, 211});
}

TEST_F(Injection, ofAnExportOfScenery) {
  const auto trees =
      test::built({test::tin(std::to_string(terrain::bucketAt(Degrees{36.001}, Degrees{128.001}).index),
                             test::TinOptions())},
                  200);
  ASSERT_TRUE(trees) << toString(trees.findings());
  writes("export of scenery",
         {.begin = [](const fs::path&) {},
          .work = [&](const fs::path& folder) -> Findings {
            const auto done = terrain::exportScenery(**trees, {0, folder / "out", {}}, "trees");
            return done ? Findings{} : done.findings();
          },
          .mayStay = [](const std::string& name) { return name.starts_with(".out.trimtab-"); },
          // A folder that holds something is refused, so a whole export is put away.
          .between =
              [](const fs::path& folder) {
                fs::remove_all(folder / "out");
                return std::string();
              }});
}

TEST_F(BakeInjection, ofABakeInPlaceOfAnotherDatabase) {
  terrain::BakeOptions old = options_;
  test::RasterRecipe recipe;
  recipe.columns = recipe.rows = 20;
  recipe.value = [](int c, int r, int) { return double(c + r); };
  old.sources = {test::writeRaster(source_ / "old.tif", recipe)};
  old.output = source_ / "old";
  ASSERT_TRUE(terrain::bake(old));
  writes("bake over a database", {[&](const fs::path& folder) {
                                    fs::copy(source_ / "old", folder / "db", fs::copy_options::recursive);
                                  },
                                  [&](const fs::path& folder) { return bakeIn(folder); }, isWork, 211});
}

}  // namespace
}  // namespace trimtab
