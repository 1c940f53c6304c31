#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <map>

#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"

/// What tests of bakes that are disturbed share.
namespace trimtab::terrain {

namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;

inline Files filesIn(const fs::path& folder) {
  Files all;
  for (const std::string& name : test::namesIn(folder)) all[name] = test::readFile(folder / name);
  return all;
}

class ResumedBake : public ::testing::Test {
 protected:
  ResumedBake() {
    test::RasterRecipe recipe;
    recipe.columns = 420;
    recipe.rows = 330;
    recipe.noData = -999;
    recipe.value = [](int c, int r, int) {
      const bool hole = (c - 200) * (c - 200) + (r - 120) * (r - 120) < 900 || (c > 390 && r > 300);
      return hole ? -999.0 : test::roughGround(c, r);
    };
    options_.sources = {test::writeRaster(dir_ / "ground.tif", recipe)};
    options_.maxError = Metres{20};
    options_.output = dir_ / "whole";
    const auto made = bake(options_);
    EXPECT_TRUE(made) << toString(made.findings());
    if (made) {
      EXPECT_GT((*made)->info().voidsFilled, 2500u);
    }
    whole_ = filesIn(dir_ / "whole");
    options_.output = dir_ / "db";
  }

  /// In a process of its own.
  template <class Work>
  static pid_t start(const Work& work) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(work());
    return child;
  }
  static int ended(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  void expectWhole(const fs::path& folder) const {
    const Files made = filesIn(folder);
    ASSERT_EQ(made.size(), whole_.size());
    for (const auto& [name, bytes] : whole_)
      EXPECT_TRUE(made.count(name) && made.at(name) == bytes) << name << " is another";
  }

  test::ScratchDir dir_;
  BakeOptions options_;
  Files whole_;
};

}  // namespace trimtab::terrain
