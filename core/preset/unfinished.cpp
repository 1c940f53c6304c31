#include "trimtab/preset/unfinished.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "descriptor.h"
#include "trimtab/preset/file_io.h"

namespace trimtab {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "trimtab-mark 1";
constexpr std::string_view kMarkEnding = ".mark";
/// These texts follow a target's name in the names of its unfinished files; the second did so before there
/// were marks.
constexpr std::string_view kUnfinished = ".trimtab-", kFormerly = ".part-";

/// Holds what a mark says: whose work it is, and which process does it.
struct Mark {
  std::string entry;
  pid_t process = 0;
  std::uint64_t started = 0;
  std::string boot;

  std::string text() const {
    return std::string(kMagic) + "\nof " + entry + "\nprocess " + std::to_string(process) + " started " +
           std::to_string(started) + " boot " + boot + '\n';
  }
};

/// Returns when a process of this machine began, in the system's ticks; unset if there is none, or it only
/// waits to be asked how it ended. The system may give the number of a process to others later on, but never
/// its number and start.
std::optional<std::uint64_t> startOf(pid_t process) {
  std::ifstream in("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  // A program's name may hold anything, and stands in brackets.
  if (!std::getline(in, text) || text.rfind(')') == std::string::npos) return {};
  std::istringstream words(text.substr(text.rfind(')') + 1));
  std::string word;
  constexpr int kState = 3, kStart = 22;  // proc(5)
  for (int field = kState; field <= kStart && words >> word; ++field)
    if (field == kState && (word == "Z" || word == "X")) return {};
  return words ? std::optional<std::uint64_t>(std::strtoull(word.c_str(), nullptr, 10)) : std::nullopt;
}

std::string thisBoot() {
  std::ifstream in("/proc/sys/kernel/random/boot_id");
  std::string boot;
  return in >> boot ? boot : "unknown";
}

Mark markOf(const std::string& entry) {
  return {entry, ::getpid(), startOf(::getpid()).value_or(0), thisBoot()};
}

/// Returns nothing if the file is not a mark, to the last byte.
std::optional<Mark> readMark(int handle) {
  std::string text(4096, '\0');
  const ssize_t count = ::pread(handle, text.data(), text.size(), 0);
  if (count <= 0) return {};
  text.resize(static_cast<std::size_t>(count));
  std::istringstream in(text);
  std::string magic, of, process, started, boot;
  Mark mark;
  if (!std::getline(in, magic) || !(in >> of >> std::ws) || !std::getline(in, mark.entry) ||
      !(in >> process >> mark.process >> started >> mark.started >> boot >> mark.boot) || mark.text() != text)
    return {};
  return mark;
}

/// A pipe of that name is not waited for.
Descriptor openedToLook(const fs::path& file) {
  return Descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
}

/// Locks a mark whose process has ended; elsewhere, and where a file system has no locks, its work stays.
bool isDead(const Descriptor& handle, const Mark& mark) {
  return ::flock(handle.get(), LOCK_EX | LOCK_NB) == 0 &&
         (mark.boot != thisBoot() || startOf(mark.process) != mark.started);
}

fs::path withName(const fs::path& target) {
  return target.has_filename() ? target : target.parent_path();
}
/// Returns the target of links, where they lead somewhere.
fs::path throughLinks(const fs::path& target) {
  std::error_code failed;
  const fs::path real = fs::weakly_canonical(withName(target), failed);
  return failed || real.empty() ? withName(target) : real;
}
fs::path folderOf(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

int openTemporary(const fs::path& folder) {
  return ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
}
fs::path amongHandles(const Descriptor& file) {
  return "/proc/self/fd/" + std::to_string(file.get());
}
bool link(const Descriptor& file, const fs::path& name) {
  return ::linkat(AT_FDCWD, amongHandles(file).c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

/// Makes a mark, locked for as long as it is open: at once with all that it says, so that no mark is ever
/// without it. Only a file system without unnamed files has it empty for a moment.
Descriptor makeMark(const fs::path& mark, const std::string& entry) {
  const std::string text = markOf(entry).text();
  const auto filled = [&](const Descriptor& file) {
    if (!file.isOpen()) return false;
    // Where a file system has no locks, nothing is cleared away.
    static_cast<void>(::flock(file.get(), LOCK_EX));
    return writeAll(file.get(), text);
  };
  if (Descriptor unnamed(openTemporary(folderOf(mark))); filled(unnamed)) {
    if (link(unnamed, mark)) return unnamed;
    if (errno == EEXIST) return Descriptor();
  }
  Descriptor named(::open(mark.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (filled(named)) return named;
  if (const int error = errno; named.isOpen()) {
    ::unlink(mark.c_str());
    errno = error;
  }
  return Descriptor();
}

fs::path markBeside(fs::path entry) {
  return entry += kMarkEnding;
}

bool isThere(const fs::path& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0;
}

std::vector<std::string> namesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
    names.push_back(entry->path().filename().string());
  return names;
}

Finding left(const fs::path& path) {
  return {Severity::warning, path.string(), "", "nothing, or what this program is proven to have made",
          "something else, left as it is"};
}

void remove(const fs::path& path, Findings& findings) {
  std::error_code error;
  fs::remove(path, error);
  if (error) findings.push_back(refused(path, "a file that can be removed", error.value()));
}

enum class Found { noMark, atWork, ended };

/// Removes what a mark names, if its process has ended, then the mark.
Found clearMarked(const fs::path& folder, const std::string& entry, IsOwn isOwn) {
  const fs::path path = folder / entry, file = markBeside(path);
  const Descriptor handle = openedToLook(file);
  const std::optional<Mark> mark = handle.isOpen() ? readMark(handle.get()) : std::nullopt;
  if (!mark || mark->entry != entry) return Found::noMark;
  if (!isDead(handle, *mark)) return Found::atWork;
  std::error_code error;
  const fs::file_status there = fs::symlink_status(path, error);
  if (fs::is_regular_file(there)) fs::remove(path, error);
  if (isOwn && fs::is_directory(there)) static_cast<void>(removeOwn(path, isOwn));
  if (!isThere(path)) fs::remove(file, error);
  return Found::ended;
}

/// Returns the name of a mark without its ending; empty if it is no name of a mark.
std::string entryOf(const std::string& name) {
  return name.ends_with(kMarkEnding) ? name.substr(0, name.size() - kMarkEnding.size()) : std::string();
}

/// Removes dead work in a folder, whatever its target is.
void clearAllMarked(const fs::path& folder) {
  for (const std::string& name : namesIn(folder))
    if (const std::string entry = entryOf(name); entry.starts_with('.')) clearMarked(folder, entry, nullptr);
}

void removeOwnIn(const fs::path& folder, const fs::path& inFolder, IsOwn isOwn,
                 const std::set<std::string>& but, Findings& findings) {
  clearAllMarked(folder);
  for (const std::string& name : namesIn(folder)) {
    const fs::path path = folder / name, known = inFolder / name;
    if (but.contains(known.string()) || known == kMarkName) continue;
    std::error_code error;
    const fs::file_status there = fs::symlink_status(path, error);
    const bool own = isOwn(known);
    if (own && fs::is_regular_file(there)) {
      remove(path, findings);
    } else if (own && fs::is_directory(there)) {
      removeOwnIn(path, known, isOwn, but, findings);
      fs::remove(path, error);
    } else {
      findings.push_back(left(path));
    }
  }
}

}  // namespace

struct Unfinished::State {
  fs::path asked, target, path, mark;
  Descriptor file, marked;
  IsOwn isOwn = nullptr;
  bool made = false, placed = false;

  explicit State(const fs::path& of) : asked(of), target(throughLinks(of)) {}
  ~State() {
    if (made && !placed && isOwn)
      static_cast<void>(removeOwn(path, isOwn));
    else if (made && !placed)
      ::unlink(path.c_str());
    if (!mark.empty() && (!made || !isThere(path))) ::unlink(mark.c_str());
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// Finds a free name beside the target and marks it.
  bool reserve() {
    static std::atomic<unsigned> count{0};
    for (;;) {
      const std::string name = "." + target.filename().string() + std::string(kUnfinished) +
                               std::to_string(::getpid()) + '-' + std::to_string(count++);
      path = folderOf(target) / name;
      if (isThere(path)) continue;
      mark = markBeside(path);
      marked = makeMark(mark, name);
      if (marked.isOpen()) return true;
      const int error = errno;
      mark.clear();
      errno = error;
      if (error != EEXIST) return false;
    }
  }

  bool makeNamedFile() {
    file.close();
    if (!reserve()) return false;
    file = Descriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    return made = file.isOpen();
  }

  bool nameFile() {
    if (mark.empty()) {
      if (link(file, target)) return true;
      if (errno != EEXIST || !reserve() || !(made = link(file, path))) return false;
    }
    return ::rename(path.c_str(), target.c_str()) == 0;
  }

  Finding cannotBeMade() const {
    return refused(asked, "a folder that can be written, " + folderOf(target).string(), errno);
  }
};

Unfinished::Unfinished(std::unique_ptr<State> state) : state_(std::move(state)) {}
Unfinished::~Unfinished() = default;
Unfinished::Unfinished(Unfinished&&) noexcept = default;

Result<Unfinished> Unfinished::file(const fs::path& target) {
  auto state = std::make_unique<State>(target);
  if (auto may = canReplace(target); !may) return may.findings();
  Findings others = clearUnfinished(state->target);
  state->file = Descriptor(openTemporary(folderOf(state->target)));
  state->path = amongHandles(state->file);
  if ((!state->file.isOpen() || ::access(state->path.c_str(), F_OK) != 0) && !state->makeNamedFile())
    return state->cannotBeMade();
  return {Unfinished(std::move(state)), std::move(others)};
}

Result<Unfinished> Unfinished::folder(const fs::path& target, IsOwn isOwn) {
  auto state = std::make_unique<State>(target);
  Findings others = clearUnfinished(state->target, isOwn);
  state->isOwn = isOwn;
  if (!state->reserve() || !(state->made = ::mkdir(state->path.c_str(), 0777) == 0))
    return state->cannotBeMade();
  return {Unfinished(std::move(state)), std::move(others)};
}

int Unfinished::handle() const {
  return state_->file.get();
}
const fs::path& Unfinished::path() const {
  return state_->path;
}

Result<Done> Unfinished::append(std::string_view bytes) {
  if (writeAll(state_->file.get(), bytes)) return Done{};
  return refused(state_->asked, kWritable, errno);
}

Result<Done> Unfinished::putInPlace(bool flush) {
  State& s = *state_;
  if (s.isOwn) {
    if (auto done = reachDisk(s.path); !done) return done;
    s.placed = ::rename(s.path.c_str(), s.target.c_str()) == 0;
  } else {
    struct stat replaced {};
    s.placed =
        (::stat(s.target.c_str(), &replaced) != 0 || ::fchmod(s.file.get(), replaced.st_mode & 07777) == 0) &&
        (!flush || flushed(s.file.get())) && s.nameFile();
  }
  if (!s.placed) return refused(s.asked, kWritable, errno);
  s.path = s.target;
  if (!s.mark.empty()) ::unlink(std::exchange(s.mark, {}).c_str());
  // The new name must survive as well. It is there already: who cannot look into its folder may still write.
  if (flush) static_cast<void>(reachDisk(folderOf(s.target)));
  return Done{};
}

int openUnnamed(const fs::path& folder) {
  if (const int unnamed = openTemporary(folder); unnamed >= 0) return unnamed;
  std::string name = (folder / ".trimtab-XXXXXX").string();
  const int made = ::mkostemp(name.data(), O_CLOEXEC);
  if (made >= 0) ::unlink(name.c_str());
  return made;
}

Findings clearUnfinished(const fs::path& target, IsOwn isOwn) {
  const fs::path real = throughLinks(target), folder = folderOf(real);
  const std::string beginning = "." + real.filename().string();
  std::vector<std::string> names;
  for (const std::string& name : namesIn(folder))
    if (const std::string_view all(name);
        all.starts_with(beginning) && (all.substr(beginning.size()).starts_with(kUnfinished) ||
                                       all.substr(beginning.size()).starts_with(kFormerly)))
      names.push_back(name);
  Findings findings;
  for (const std::string& name : names) {
    const std::string entry = entryOf(name).empty() ? name : entryOf(name);
    // It may have come, or have gone to its place, while names were read.
    const Found found = clearMarked(folder, entry, isOwn);
    if (isThere(folder / name) && (found == Found::noMark || (found == Found::ended && name == entry)))
      findings.push_back(left(folder / name));
  }
  return findings;
}

Result<Done> removeOwn(const fs::path& folder, IsOwn isOwn, const std::set<std::string>& but) {
  Findings findings;
  removeOwnIn(folder, {}, isOwn, but, findings);
  std::error_code ignored;
  // The mark goes last: what is left of a killed removal must be known.
  if (namesIn(folder) == std::vector<std::string>{kMarkName}) fs::remove(folder / kMarkName, ignored);
  fs::remove(folder, ignored);
  if (hasError(findings)) return findings;
  return {Done{}, std::move(findings)};
}

Result<Done> markFolder(const fs::path& folder) {
  if (isMarked(folder) || makeMark(folder / kMarkName, "this folder").isOpen() || isMarked(folder))
    return Done{};
  return refused(folder, "a folder that can be written", errno);
}

bool isMarked(const fs::path& folder) {
  const Descriptor handle = openedToLook(folder / kMarkName);
  const auto mark = handle.isOpen() ? readMark(handle.get()) : std::nullopt;
  return mark && mark->entry == "this folder";
}

}  // namespace trimtab
