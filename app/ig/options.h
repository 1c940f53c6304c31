#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/link/link.h"
#include "trimtab/preset/parameters.h"

namespace trimtab::ig {

inline constexpr int kDone = 0, kRefused = 1, kUsage = 2;

struct Options {
  std::string preset;  ///< a file, or a shipped preset's name
  std::filesystem::path terrain;
  std::string origin;  ///< of a flat OpenSceneGraph scene, LAT,LON
  std::optional<std::uint16_t> listen;
  std::string bindAddress = link::kOwnMachine, group;  ///< of the port that is listened on
  std::string sender = link::kAnyone;                  ///< see link::ReceiverOptions::sender
  std::string reply;                                   ///< HOST:PORT, empty for none
  std::optional<HostProtocol> protocol;                ///< these three are the preset's, if unset
  std::string entity;                                  ///< see HostChoice::chooseEntity
  std::optional<std::uint16_t> view;
  std::filesystem::path flight;
  std::string columns, headColumns;  ///< maps of the columns of flight and head log
  std::string head;                  ///< a head log or a sweep; empty: the head in the states
  bool skipBadRows = false;          ///< ignore unusable rows of the head log
  bool realtime = false;
  bool headless = false;
  int width = 1280, height = 720;
  std::uint64_t frames = 0;  ///< 0: until the flight ends or a signal comes
  std::filesystem::path trace, screenshot, health;
  bool watch = false;
  bool json = false;
};

/// Reads the command line. Returns nothing if the program must end with `exitCode`: after help, version or
/// wrong usage, whose text is already printed.
std::optional<Options> parseOptions(int argc, char** argv, int& exitCode);

}  // namespace trimtab::ig
