#include "work.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

#include "heights.h"
#include "source.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/unfinished.h"
#include "trimtab/terrain/format/store.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

Finding wrong(const fs::path& where, std::string expected, std::string found) {
  return {Severity::error, where.string(), "", std::move(expected), std::move(found)};
}

/// Returns an empty text if the file cannot be read; a pipe of its name is not waited for.
std::string textOf(const fs::path& file) {
  const Result<std::string> text = readWhole(file, kLargestRecording);
  return text ? *text : std::string();
}

std::string thisMachine() {
  char name[256] = "";
  return ::gethostname(name, sizeof name - 1) == 0 && name[0] != 0 ? name : "localhost";
}

/// Reports whether a process of this machine lives and runs this program: its number may be given to others
/// later on.
bool livesAs(pid_t process, const std::string& program) {
  if (::kill(process, 0) != 0 && errno == ESRCH) return false;
  constexpr std::size_t kMostOfName = 15;  // that the system keeps
  std::ifstream name("/proc/" + std::to_string(process) + "/comm");
  std::string is;
  return !std::getline(name, is) || is == program.substr(0, kMostOfName);
}

/// Returns the other processes that have a lock, by what they wrote there; of this machine, those that live.
std::string holdersOf(const fs::path& file) {
  std::set<std::string> holders;
  std::istringstream lines(textOf(file));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    pid_t process = 0;
    std::string machine, program;
    if (!(words >> process >> machine) || !std::getline(words >> std::ws, program)) continue;
    if (machine == thisMachine() && (process == ::getpid() || !livesAs(process, program))) continue;
    holders.insert("process " + std::to_string(process) + " (" + program + ") on " + machine);
  }
  std::string all;
  for (const std::string& holder : holders) all += (all.empty() ? " by " : ", ") + holder;
  return all;
}

Finding otherBake(const fs::path& output, const fs::path& lock, const std::string& also) {
  return wrong(output, "no other bake at work on this folder" + also,
               "one" + holdersOf(lock) + ": let it end and bake again, stop it, or name another folder");
}

/// A rename must be able to put the database there: an empty mount point looks like an empty folder.
bool onFileSystemOfParent(const fs::path& output) {
  const fs::path parent = output.has_parent_path() ? output.parent_path() : fs::path(".");
  struct stat there {
  }, beside{};
  return ::lstat(output.c_str(), &there) != 0 || ::stat(parent.c_str(), &beside) != 0 ||
         there.st_dev == beside.st_dev;
}

Finding otherArithmetic(const fs::path& path) {
  return wrong(path, "parts by machines whose C library, GDAL and PROJ agree to the last bit",
               "those of another machine, left as they are: bake all parts on machines alike");
}

/// Reports whether a bake makes this in its work folder.
bool isOfABake(const fs::path& inFolder) {
  constexpr std::array<std::string_view, 7> kFiles = {
      "lock", "heights.lock", "recipe.json", "recipe.spent", "journal", kVoidsName, kPostSourcesName};
  const std::string folder = inFolder.parent_path().string(), name = inFolder.filename().string();
  if (folder == "database" || folder == "old") return isDatabaseFile(name);
  if (folder == "pieces") return name.ends_with(".pages");
  return folder.empty() && (name == "database" || name == "old" || name == "pieces" ||
                            std::find(kFiles.begin(), kFiles.end(), name) != kFiles.end());
}

Result<Done> empty(const fs::path& folder, const std::set<std::string>& but) {
  std::error_code error;
  // The file that says that the rest is good goes first.
  fs::remove(folder / "recipe.json", error);
  return removeOwn(folder, isOfABake, but);
}

Finding notOurs(const fs::path& path) {
  return wrong(path, "nothing, or the work of a bake that was interrupted",
               "something else, left as it is: give it another name, or name another output");
}

/// Makes the folder, and marks it while there is nothing else in it.
Result<Done> makeMarked(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (fs::exists(path, error) && !fs::is_directory(path, error)) return notOurs(path);
  if (error) return wrong(path, "a folder that can be written", error.message());
  if (fs::is_empty(path, error))
    if (auto marked = markFolder(path); !marked) return marked;
  if (!isMarked(path)) return notOurs(path);
  return Done{};
}

Result<Done> makeFolders(const fs::path& path) {
  std::error_code error;
  for (const char* folder : {"database", "pieces"})
    if (!error) fs::create_directories(path / folder, error);
  if (error) return wrong(path, "a folder that can be written", error.message());
  return Done{};
}

}  // namespace

std::unique_ptr<FileLock> FileLock::tryLock(const fs::path& file, bool shared) {
  const int handle = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_APPEND, 0666);
  if (handle < 0) return {};
  struct stat held {
  }, there{};
  int refused =
      ::flock(handle, (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0 || ::fstat(handle, &held) != 0 ? errno : 0;
  // The process that had the lock before may have removed the folder with it.
  if (refused == 0 &&
      (::stat(file.c_str(), &there) != 0 || held.st_ino != there.st_ino || held.st_dev != there.st_dev))
    refused = EWOULDBLOCK;
  if (refused != 0) {
    ::close(handle);
    errno = refused;
    return {};
  }
  // The line is for whoever is refused; without room for it the lock holds all the same.
  const std::string line =
      std::to_string(::getpid()) + ' ' + thisMachine() + ' ' + ::program_invocation_short_name + '\n';
  const bool told = (shared || ::ftruncate(handle, 0) == 0) && ::write(handle, line.data(), line.size()) > 0;
  static_cast<void>(told);
  return std::unique_ptr<FileLock>(new FileLock(handle));
}

FileLock::~FileLock() {
  ::close(handle_);
}

Result<std::unique_ptr<WorkFolder>> WorkFolder::open(const fs::path& output, const std::string& recipe,
                                                     Use use) {
  if (!onFileSystemOfParent(output))
    return wrong(output, "a folder on the file system of the one that holds it",
                 "a mount point: name a folder in it");
  const bool shared = use == Use::part;
  const fs::path path = output.parent_path() / ("." + output.filename().string() + ".work");
  const fs::path lockFile = path / "lock";
  if (std::error_code error;
      use == Use::join && !fs::exists(path / "recipe.json", error) && !fs::exists(path / "old", error))
    return {nullptr, {{Severity::note, path.string(), "", "all parts of a bake", "none: all are missing"}}};
  std::unique_ptr<FileLock> lock;
  int refused = 0;
  const auto takeLock = [&](bool beside) {
    lock = FileLock::tryLock(lockFile, beside);
    refused = lock ? 0 : errno;
    // The folder may be gone again for a moment.
    return lock || refused == EWOULDBLOCK || refused == ENOENT;
  };
  const auto noLock = [&] { return wrong(lockFile, "a file that can be locked", std::strerror(refused)); };
  Findings others;
  constexpr auto kTurn = std::chrono::milliseconds(20);
  // Parts that begin at once take turns to look at the folder.
  for (int turn = 0; turn < 100; ++turn) {
    std::error_code error;
    // Another process may be about to mark it, or have removed it again for a moment.
    if (auto made = makeMarked(path); !made) {
      if (turn >= 5) return made.findings();
      std::this_thread::sleep_for(kTurn);
      continue;
    }
    if (!takeLock(false)) return noLock();
    if (lock) {
      const std::string there = textOf(path / "recipe.json");
      const bool same = there == recipe;
      if (!same && use != Use::alone && sameButForArithmetic(there, recipe)) return otherArithmetic(path);
      if (!same && use == Use::join && fs::exists(path / "recipe.json", error))
        return wrong(path, "parts of the same sources, options and version of this program",
                     "those of others, left as they are");
      if (!same) {
        // A bake killed between its last two steps left the old database here.
        if (fs::exists(path / "old", error) && !fs::exists(output, error))
          fs::rename(path / "old", output, error);
        if (error) return wrong(path / "old", "a database that can go back to its place", error.message());
        const auto emptied = empty(path, {"lock"});
        if (!emptied) return emptied.findings();
        others = emptied.findings();
        if (auto written = writeAtomically(path / "recipe.json", recipe); !written) return written.findings();
      }
      if (auto made = makeFolders(path); !made) return made.findings();
      if (!shared) return {std::unique_ptr<WorkFolder>(new WorkFolder(path, std::move(lock), same)), others};
      lock.reset();
    }
    if (shared) {
      if (!takeLock(true)) return noLock();
      if (lock && textOf(path / "recipe.json") == recipe)
        return {std::unique_ptr<WorkFolder>(new WorkFolder(path, std::move(lock), true)), others};
      if (lock && sameButForArithmetic(textOf(path / "recipe.json"), recipe)) return otherArithmetic(path);
      if (lock) return otherBake(output, lockFile, " with other sources or options");
    } else if (turn >= 5) {
      break;
    }
    std::this_thread::sleep_for(kTurn);
  }
  if (refused == ENOENT) return noLock();
  Finding busy = otherBake(output, lockFile, "");
  if (use != Use::join) return busy;
  busy.severity = Severity::note;
  return {nullptr, {busy}};
}

WorkFolder::~WorkFolder() {
  if (!lock_ || !journal().empty()) return;
  // Others may be at work on their parts.
  lock_.reset();
  const auto alone = FileLock::tryLock(path_ / "lock", false);
  if (alone && journal().empty()) static_cast<void>(removeOwn(path_, isOfABake));
}

Result<Done> WorkFolder::beginAnew() {
  const std::string recipe = textOf(path_ / "recipe.json");
  // The database that was the output before, and could not go back there, is not part of this work.
  const auto emptied = empty(path_, {"lock", "heights.lock", "old"});
  if (!emptied) return emptied;
  if (auto made = makeFolders(path_); !made) return made;
  if (auto written = writeAtomically(path_ / "recipe.json", recipe); !written) return written.findings();
  resumed_ = false;
  return emptied;
}

Finding WorkFolder::kept() const {
  constexpr std::uintmax_t kMB = 1000000;
  std::uintmax_t bytes = 0;
  std::error_code error, gone;
  for (fs::recursive_directory_iterator entry(path_, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->is_regular_file(gone)) bytes += entry->file_size(gone);
  return {Severity::note, path_.string(), "", "another bake of the same, which goes on from here",
          std::to_string(bytes / kMB + 1) + " MB of finished work; remove the folder to free the disk"};
}

Result<Done> WorkFolder::clearDatabase() const {
  const IsOwn isFile = [](const fs::path& file) { return isDatabaseFile(file.string()); };
  return removeOwn(database(), isFile, {kHeightsName, kHeightSumsName});
}

std::vector<std::string> WorkFolder::journal() const {
  std::vector<std::string> lines;
  std::istringstream in(textOf(path_ / "journal"));
  for (std::string line; std::getline(in, line);) {
    // A line that a full disk cut off may have another one behind it.
    if (line.size() > 17 &&
        line.substr(line.size() - 16) == hexadecimal(checksum(line.substr(0, line.size() - 17))))
      lines.push_back(line.substr(0, line.size() - 17));
  }
  return lines;
}

Result<Done> WorkFolder::note(const std::string& line) const {
  const fs::path file = path_ / "journal";
  const std::string text = "\n" + line + " " + hexadecimal(checksum(line)) + "\n";
  const int handle = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, 0666);
  const bool done =
      handle >= 0 && ::write(handle, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int error = errno;
  if (handle >= 0) ::close(handle);
  if (!done) return wrong(file, "room to write a line", std::strerror(error));
  return Done{};
}

Result<Done> WorkFolder::finish(const fs::path& output) {
  // Pieces that a power cut spoils are found by their sums and made again; the database must be whole under
  // its name.
  std::error_code error, ignored;
  for (const auto& entry : fs::directory_iterator(database(), error))
    if (auto done = reachDisk(entry.path()); !done) return done;
  if (error) return wrong(database(), "a folder that can be read", error.message());
  if (auto done = reachDisk(database()); !done) return done;
  const fs::path recipe = path_ / "recipe.json", spent = path_ / "recipe.spent";
  // If killed after this, the next bake begins anew; it must not mistake the old database for its own.
  fs::rename(recipe, spent, error);
  if (error) return wrong(recipe, "a file that can be renamed", error.message());
  const fs::path made = database(), old = path_ / "old";
  std::string also;
  if (fs::symlink_status(output, ignored).type() == fs::file_type::not_found) {
    fs::rename(made, output, error);
  } else if (::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, output.c_str(), RENAME_EXCHANGE) != 0) {
    fs::rename(output, old, error);
    if (!error) {
      fs::rename(made, output, error);
      std::error_code back;
      if (error) fs::rename(old, output, back);
      if (back) also = "; what was there is in " + old.string();
    }
  }
  if (error) {
    fs::rename(spent, recipe, ignored);
    return wrong(output, "a place to put the database", error.message() + also);
  }
  const fs::path beside = output.has_parent_path() ? output.parent_path() : fs::path(".");
  static_cast<void>(reachDisk(beside));
  Findings others = removeOwn(path_, isOfABake).findings();
  for (Finding& finding : others) finding.severity = Severity::warning;
  lock_.reset();
  return {Done{}, std::move(others)};
}

}  // namespace trimtab::terrain
