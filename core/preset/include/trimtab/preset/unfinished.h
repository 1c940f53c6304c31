#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>

#include "trimtab/units/result.h"

/// Files and folders in the making. Until they are complete they have no name, or one beside their target
/// with a mark: a file that says which process of this program makes them. What a killed program left is
/// known by its mark; whatever has no mark is not this program's, and is named and left.
namespace trimtab {

/// Tells by its path in a folder whether this program made a file or folder there.
using IsOwn = bool (*)(const std::filesystem::path& inFolder);

/// A file or a folder that takes its place once it is complete, and goes if it never is. A link is kept: what
/// it names is replaced.
class Unfinished {
 public:
  /// Makes an empty file; the file that it replaces gives it its mode. Refuses a target that is a folder, a
  /// pipe, a device, or may not be written. The findings of success name what others left beside the target.
  static Result<Unfinished> file(const std::filesystem::path& target);
  /// Makes an empty folder; only what is its own goes with it.
  static Result<Unfinished> folder(const std::filesystem::path& target, IsOwn isOwn);
  ~Unfinished();
  Unfinished(Unfinished&&) noexcept;
  Unfinished& operator=(Unfinished&&) = delete;

  /// Returns the file, open for reading and writing for as long as this object lives; -1 of a folder.
  int handle() const;
  /// Opens the same file by name; a file that has none is found among this process's handles.
  const std::filesystem::path& path() const;
  /// Writes to the end of a file, also once it is in place.
  Result<Done> append(std::string_view bytes);
  /// Gives it its name. Its bytes reach the disk first, unless the caller sees to that (`flush`). After a
  /// power cut there is the old file or the new one.
  Result<Done> putInPlace(bool flush = true);

 private:
  struct State;
  explicit Unfinished(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Makes a file that never has a name, in a folder, open for reading and writing. Returns -1 if it cannot;
/// errno has the reason.
int openUnnamed(const std::filesystem::path& folder);

/// Removes what killed programs left of a target and returns a warning for all else that has such a name.
/// Without `isOwn` folders stay. Unfinished does it itself.
Findings clearUnfinished(const std::filesystem::path& target, IsOwn isOwn = nullptr);

/// Removes the files in a folder that are its own, except those named in `but`, then the folder if nothing is
/// left. The findings of success name what else is there and stays. Fails if something of its own stays.
Result<Done> removeOwn(const std::filesystem::path& folder, IsOwn isOwn,
                       const std::set<std::string>& but = {});

/// Marks an existing folder as this program's; nothing happens to one that is marked.
Result<Done> markFolder(const std::filesystem::path& folder);
/// Reports whether a folder was marked so. Its mark is the file `trimtab.mark` in it.
bool isMarked(const std::filesystem::path& folder);
inline constexpr const char* kMarkName = "trimtab.mark";

}  // namespace trimtab
