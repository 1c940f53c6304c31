// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <cstdint>
#include <optional>
#include <vector>

#include "trimtab/units/geodesy.h"
#include "trimtab/units/result.h"

namespace trimtab::workbench {

/// A place of the free camera to which a person wants to come back.
struct SavedView {
  QString name;
  GeodeticPosition position;
  Attitude attitude;

  friend bool operator==(const SavedView&, const SavedView&) = default;
};

/// A snapshot of the preset that a person kept.
struct SavedSnapshot {
  int slot = 0;    ///< 0 is A
  QString name;    ///< as the person gave it; may be empty
  QString preset;  ///< its values, as presetText() writes them

  friend bool operator==(const SavedSnapshot&, const SavedSnapshot&) = default;
};

/// What was open in the workbench, so that one file opens all of it again. It names files and holds none of
/// them; only snapshots and unsaved edits, which are in no file, are in it with their values. It says on
/// which port to listen but not on which interface: a file from somebody else must not open this machine to a
/// network.
struct SavedSession {
  QString terrain;             ///< a file or folder; empty: the sample terrain
  QString preset;              ///< a file, or the name of a shipped preset; empty: it has none yet
  QString imageGenerator;      ///< the file of its profile; empty: this program's own
  QString flight;              ///< a file; empty: none
  QString flightColumns;       ///< the map of its columns, as `--columns` has it; empty: none
  double flightPositionS = 0;  ///< seconds from the flight's start
  std::optional<std::uint16_t> listenPort;  ///< set if a host was listened for
  QString workspace;                        ///< its name
  std::optional<SavedView> eye;             ///< where the free camera stood; its name is empty
  std::vector<SavedView> views;             ///< the views that were kept
  /// The snapshots that were kept; unset in files of earlier versions.
  std::optional<std::vector<SavedSnapshot>> snapshots;

  /// The preset with its unsaved edits, as presetText() writes it; unset if there are none, and in files of
  /// earlier versions. A preset that has no file yet is here alone, and names the shipped one that it began
  /// as.
  std::optional<QString> draft;

  friend bool operator==(const SavedSession&, const SavedSession&) = default;
};

/// The ending of a session's file.
inline constexpr auto kSessionEnding = ".session.json";

/// Writes a session atomically. Files in the session's own folder and below are named relative to it, so that
/// the folder can be moved.
Result<Done> writeSession(const QString& file, const SavedSession& session);
/// Reads a session; its files become absolute paths, whether they exist or not. An entry that is missing
/// keeps its default, but a view must have all of its numbers. A snapshot and a draft may break rules between
/// parameters. Refused are entries of another type and numbers outside their range.
Result<SavedSession> readSession(const QString& file);

}  // namespace trimtab::workbench
