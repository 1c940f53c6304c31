#include <iostream>

#include "commands.h"

namespace trimtab::cli {

void report(const Findings& findings) {
  for (const Finding& f : findings) {
    const char* label = f.severity == Severity::error     ? "error"
                        : f.severity == Severity::warning ? "warning"
                                                          : "note";
    std::cerr << label << ": " << toString(f) << '\n';
  }
}

}  // namespace trimtab::cli

int main(int argc, char** argv) {
  CLI::App app{"Trimtab: tune culling and level of detail of image generators"};
  app.set_version_flag("--version", TRIMTAB_VERSION);
  app.require_subcommand(1);
  int exitCode = trimtab::cli::kDone;
#ifdef TRIMTAB_HAS_PRESET
  trimtab::cli::addPreset(app, exitCode);
#endif
#ifdef TRIMTAB_HAS_DECIDE
  trimtab::cli::addDecide(app, exitCode);
#endif
#ifdef TRIMTAB_HAS_TERRAIN
  trimtab::cli::addTerrain(app, exitCode);
#endif
#ifdef TRIMTAB_HAS_FEED
  trimtab::cli::addFeed(app, exitCode);
#endif
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? trimtab::cli::kDone : trimtab::cli::kUsage;
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return trimtab::cli::kRefused;
  }
  return exitCode;
}
