#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "tests/support.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::bench {

/// The sample with what stands on it, made once into a folder beside the temporary files.
inline std::shared_ptr<const terrain::Database> sampleWorld() {
  const auto folder = std::filesystem::temp_directory_path() / "trimtab-bench" / "world";
  const std::string cli = test::program("trimtab-cli").string();
  if (!terrain::Database::open(folder / "database")) {
    std::filesystem::create_directories(folder);
    const std::string tif = (folder / "sample.tif").string();
    for (const std::string& command :
         {cli + " terrain sample -o " + tif, cli + " terrain bake " + tif + " --objects " +
                                                 (folder / "sample-objects.csv").string() + " -o " +
                                                 (folder / "database").string()})
      if (const test::Ran made = test::run(command); made.exitCode != 0) std::fputs(made.err.c_str(), stderr);
  }
  const auto opened = terrain::Database::open(folder / "database");
  return opened ? *opened : nullptr;
}

}  // namespace trimtab::bench
