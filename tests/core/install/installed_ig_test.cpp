#include <gtest/gtest.h>

#include "tests/support.h"

// What a production IG can install beside the library.
namespace trimtab::test {
namespace {

/// The whole prefix of a production IG: library, reader, renderer, presets and `trimtab-ig`.
class InstalledIg : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = new ScratchDir;
    const std::string cli = program("trimtab-cli").string(), tif = (*dir_ / "sample.tif").string();
    const Ran made = run(cli + " terrain sample --size-km 6 -o " + tif + " && " + cli + " terrain bake " +
                         tif + " -o " + database());
    ASSERT_EQ(made.exitCode, 0) << made.err;
    for (const char* component : {"core", "ig", "ig-dev"})
      ASSERT_EQ(run(std::string("cmake --install " TRIMTAB_BUILD_DIR " --component ") + component +
                    " --prefix " + prefix())
                    .exitCode,
                0);
  }
  static void TearDownTestSuite() { delete dir_; }
  static std::string prefix() { return (*dir_ / "prefix").string(); }
  static std::string database() { return (*dir_ / "db").string(); }
  static ScratchDir* dir_;
};
ScratchDir* InstalledIg::dir_ = nullptr;

TEST_F(InstalledIg, linksReaderAndRendererAndDrawsAnImage) {
  const std::string build = (*dir_ / "build").string(),
                    preset = prefix() + "/share/trimtab/presets/as-published.json";
  const Ran built = run("cmake -S " + (sourceDir() / "tests/core/install/painter").string() + " -B " + build +
                        " -G Ninja -DCMAKE_PREFIX_PATH=" + prefix() +
                        " -DCMAKE_CXX_COMPILER=" TRIMTAB_CXX " && cmake --build " + build);
  ASSERT_EQ(built.exitCode, 0) << built.out << built.err;
  const std::filesystem::path png = *dir_ / "picture.png";
  const Ran ran = run(build + "/painter " + database() + ' ' + preset + ' ' + png.string());
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  EXPECT_GT(std::stoull(ran.out), 100u);
  EXPECT_GT(std::filesystem::file_size(png), 1000u);
}

TEST_F(InstalledIg, hasTheProgramThatOpensADatabase) {
  const Ran ran = run(prefix() + "/bin/trimtab-ig --headless --terrain " + database() + " --flight " +
                      (sourceDir() / "resources/flights/yecheon-circuit.csv").string() + " --preset " +
                      prefix() + "/share/trimtab/presets/default.json --frames 3 --size 64x48");
  EXPECT_EQ(ran.exitCode, 0) << ran.err;
}

TEST_F(InstalledIg, programLoadsNeitherGdalNorQt) {
  const Ran ran = run("ldd " + prefix() + "/bin/trimtab-ig");
  EXPECT_EQ(ran.exitCode, 0) << ran.err;
  EXPECT_NE(ran.out.find("libosg.so"), std::string::npos) << "ldd lists no libraries: " << ran.out;
  for (const char* library : {"libgdal", "libQt"})
    EXPECT_EQ(ran.out.find(library), std::string::npos) << library << " in " << ran.out;
}

TEST_F(InstalledIg, hasThePresetsTheirSchemaAndItsLicence) {
  for (const char* file : {"share/trimtab/presets/default.json", "share/trimtab/presets/preset.schema.json",
                           "share/doc/trimtab/LICENSE.MIT"})
    EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::path(prefix()) / file)) << file;
  EXPECT_EQ(run("grep -rlE '#include *[<\"](Q[A-Z]|osg|gdal|ogr|nlohmann)' " + prefix()).out, "");
  EXPECT_EQ(run("find " + prefix() + " -name planted_defects.h").out, "");
}

}  // namespace
}  // namespace trimtab::test
