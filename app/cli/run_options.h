#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/link/log_options.h"
#include "trimtab/scene/osg_database.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::cli {

/// What several commands run over and where their results go, asked for in the same words. Whatever reads an
/// option prints what is wrong with it on standard error.
struct RunOptions {
  std::string terrain, origin, columns, size = "1280x720", output;
  std::vector<std::string> settings;
  bool json = false;

  /// Adds the options from --terrain to --size. `flights` and `presets` are a text, or a list where several
  /// may be named.
  template <class Flights, class Presets>
  void add(CLI::App& command, Flights& flights, const char* flightsHelp, Presets& presets,
           const char* presetsHelp) {
    command.add_option("--terrain", terrain, "Database, OpenSceneGraph scene, or elevation to bake")
        ->required();
    command.add_option("--origin", origin, scene::kOriginHelp);
    command.add_option("--flight", flights, flightsHelp);
    command.add_option("--columns", columns, link::kColumnsHelp);
    command.add_option("--preset", presets, presetsHelp)->capture_default_str();
    command.add_option("--set", settings, "KEY=VALUE on top of what --preset names; may be repeated");
    command.add_option("--size", size, "Render size")->capture_default_str();
  }
  /// Adds --json and --output, of which `help` says what it gets.
  CLI::Option* addOutput(CLI::App& command, const char* help);

  /// Returns false unless --size has two sides of 16 to 16384 pixels.
  bool readSize(int& widthPx, int& heightPx) const;
  /// Reads a file that --flight named.
  std::optional<Flight> readFlight(const std::string& file) const;
  /// Opens a database or a scene of OpenSceneGraph, or bakes anything else first. Returns null on an error.
  std::shared_ptr<const terrain::Database> openTerrain(const terrain::Progress& progress) const;
};

/// Returns the file's name without folder and ending, or all of it where that is taken.
template <class Named>
std::string nameOf(const std::string& text, const std::vector<Named>& others) {
  const std::string stem = std::filesystem::path(text).stem().string();
  for (const Named& other : others)
    if (other.name == stem) return text;
  return stem.empty() ? text : stem;
}

}  // namespace trimtab::cli
