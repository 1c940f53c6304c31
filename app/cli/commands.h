#pragma once

#include <CLI/CLI.hpp>
#include <iosfwd>

#include "trimtab/units/result.h"

/// The commands of trimtab-cli, one file each. Each function adds its command to the program; the command
/// sets `exitCode` when it runs.
namespace trimtab::cli {

inline constexpr int kDone = 0, kRefused = 1, kUsage = 2;
/// What other parts of a run have to do is not done yet.
inline constexpr int kIncomplete = 3;

void addPreset(CLI::App& app, int& exitCode);
/// Adds the subcommands `fuzzy` and `policy` to `preset`.
void addFuzzy(CLI::App& preset, int& exitCode);
void addDecide(CLI::App& app, int& exitCode);
void addTerrain(CLI::App& app, int& exitCode);
/// Adds the subcommand `export` to `terrain`.
void addTerrainExport(CLI::App& terrain, int& exitCode);
/// Adds the subcommand `height` to `terrain`.
void addTerrainHeight(CLI::App& terrain, int& exitCode);
void addFeed(CLI::App& app, int& exitCode);
void addBench(CLI::App& app, int& exitCode);
void addResults(CLI::App& app, int& exitCode);
void addExperiment(CLI::App& app, int& exitCode);
void addLeverage(CLI::App& app, int& exitCode);
void addFit(CLI::App& app, int& exitCode);
void addTune(CLI::App& app, int& exitCode);
void addWeather(CLI::App& app, int& exitCode);

/// Prints findings on standard error, one per line, with their severity.
void report(const Findings& findings);
/// Writes a text to a file, or to standard output if `output` is empty or "-". Returns the exit code.
int writeOut(const std::string& output, const std::string& text);

}  // namespace trimtab::cli
