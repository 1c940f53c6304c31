#include "tests/support.h"
#include "trimtab/decision/decide.h"
#include "trimtab/preset/preset.h"

// A production IG's view of the library: nothing but an installed copy and an exported preset.
namespace trimtab::test {
namespace {

class InstalledCore : public testing::Test {
 protected:
  void SetUp() override {
    prefix_ = (dir_ / "prefix").string();
    const Ran installed = run("cmake --install " TRIMTAB_BUILD_DIR " --component core --prefix " + prefix_);
    ASSERT_EQ(installed.exitCode, 0) << installed.err;
    const auto preset = loadPreset("as-published");
    ASSERT_TRUE(preset) << toString(preset.findings());
    const auto parameters = validate(preset->parameters);
    ASSERT_TRUE(parameters);
    writeFile(dir_ / "export.json",
              exportText(*parameters, "as-published", Provenance{}, ExportFormat::json));
    FrameInput input;
    input.state.position.height = Feet{5000}.as<Metres>();
    DecisionMemory memory;
    expected_ = explain(decide(input, *parameters, memory), *parameters) + "\n";
  }

  ScratchDir dir_;
  std::string prefix_, expected_;
  const std::string source_ = (sourceDir() / "tests/core/install/consumer").string();
};

TEST_F(InstalledCore, servesAConsumerThroughItsCmakePackage) {
  const std::string build = (dir_ / "build").string();
  const Ran built = run("cmake -S " + source_ + " -B " + build + " -G Ninja -DCMAKE_PREFIX_PATH=" + prefix_ +
                        " -DCMAKE_CXX_COMPILER=" TRIMTAB_CXX " && cmake --build " + build);
  ASSERT_EQ(built.exitCode, 0) << built.out << built.err;
  const Ran ran = run(build + "/consumer " + (dir_ / "export.json").string());
  EXPECT_EQ(ran.exitCode, 0);
  EXPECT_EQ(ran.out, expected_);
}

TEST_F(InstalledCore, servesAConsumerThroughPkgConfigAlsoAfterAMove) {
  std::filesystem::rename(prefix_, dir_ / "moved");
  const std::string program = (dir_ / "consumer").string();
  const Ran built = run("export PKG_CONFIG_PATH=$(dirname $(find " + (dir_ / "moved").string() +
                        " -name trimtab-core.pc)); " TRIMTAB_CXX " " + source_ +
                        "/main.cpp $(pkg-config --cflags --libs trimtab-core) -o " + program);
  ASSERT_EQ(built.exitCode, 0) << built.err;
  EXPECT_EQ(run(program + " " + (dir_ / "export.json").string()).out, expected_);
}

// The components `interface` and `interface-dev` alone, in a prefix of its own: a program in C needs nothing else.
TEST_F(InstalledCore, servesAConsumerInCThroughCmakeAndPkgConfigAlsoAfterAMove) {
  const std::string prefix = (dir_ / "c-prefix").string(), moved = (dir_ / "c-moved").string(),
                    source = (sourceDir() / "tests/core/install/c_consumer").string(),
                    build = (dir_ / "c-build").string(), preset = (dir_ / "export.json").string();
  for (const char* component : {"interface", "interface-dev"})
    ASSERT_EQ(run(std::string("cmake --install " TRIMTAB_BUILD_DIR " --component ") + component +
                  " --prefix " + prefix)
                  .exitCode,
              0);
  const Ran built = run("cmake -S " + source + " -B " + build + " -G Ninja -DCMAKE_PREFIX_PATH=" + prefix +
                        " && cmake --build " + build);
  ASSERT_EQ(built.exitCode, 0) << built.out << built.err;
  EXPECT_EQ(run(build + "/c_consumer " + preset).out, expected_);

  std::filesystem::rename(prefix, moved);
  const Ran again =
      run("export PKG_CONFIG_PATH=$(dirname $(find " + moved + " -name trimtab.pc)); cc -std=c99 " + source +
          "/main.c $(pkg-config --cflags --libs trimtab) -o " + build + "/again");
  ASSERT_EQ(again.exitCode, 0) << again.err;
  EXPECT_EQ(run("LD_LIBRARY_PATH=$(dirname $(find " + moved + " -name libtrimtab.so.1)) " + build +
                "/again " + preset)
                .out,
            expected_);
}

TEST_F(InstalledCore, bringsLicenceSchemaAndAnExampleThatBuilds) {
  const std::filesystem::path share = std::filesystem::path(prefix_) / "share", doc = share / "doc/trimtab";
  for (const auto& file :
       {doc / "LICENSE", doc / "LICENSE.MIT", doc / "integrating.md",
        share / "trimtab/presets/preset.schema.json", share / "trimtab/presets/default.json"})
    EXPECT_TRUE(std::filesystem::exists(file)) << file;
  const std::string build = (dir_ / "example").string();
  const Ran built = run("cmake -S " + (doc / "examples/follower").string() + " -B " + build +
                        " -G Ninja -DCMAKE_PREFIX_PATH=" + prefix_ +
                        " -DCMAKE_CXX_COMPILER=" TRIMTAB_CXX " && cmake --build " + build);
  EXPECT_EQ(built.exitCode, 0) << built.out << built.err;
}

TEST_F(InstalledCore, bringsNoHeaderOfQtOsgGdalOrJson) {
  const Ran found = run("grep -rnE '#include *[<\"](Q[A-Z]|osg|gdal|ogr|nlohmann)' " + prefix_);
  EXPECT_EQ(found.out, "");
}

// The layer rule's other half: the library builds where there is no Qt, OSG or GDAL to be found.
TEST(CoreOnly, buildsWithWarningsAsErrors) {
  const ScratchDir dir;
  const Ran ran =
      run("cd " + sourceDir().string() + " && cmake --preset core-only -DTRIMTAB_TESTS=OFF -B " +
          dir.path().string() + " && cmake --build " + dir.path().string() +
          " && grep -icE '^(qt|opengl|openscenegraph|gdal|osg)' " + (dir / "CMakeCache.txt").string());
  EXPECT_EQ(ran.exitCode, 1) << ran.out << ran.err;
  EXPECT_TRUE(ran.out.ends_with("\n0\n")) << "found a package that core must not look for: " << ran.out;
}

}  // namespace
}  // namespace trimtab::test
