#include "trimtab/preset/part_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>

#include "descriptor.h"
#include "trimtab/preset/file_io.h"

namespace trimtab {

namespace {

Finding notOurs(const std::filesystem::path& part, const char* found) {
  return {Severity::error, part.string(), "", "nothing of this name, or no more than a header", found};
}

}  // namespace

struct PartFile::State {
  std::filesystem::path target, part;
  Descriptor file;
  std::uint64_t end = 0;

  bool lock() { return ::flock(file.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; }

  /// The header of a run that ended before it wrote anything else is as good as our own.
  Result<Done> goOn(std::string_view header) {
    file = Descriptor(::open(part.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    struct stat status {};
    if (!file.isOpen() || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode))
      return notOurs(part, "something else: give it another name, or write to another file");
    if (!lock()) return notOurs(part, "one that another program writes: end it, or write to another file");
    std::string there(header.size() + 1, '\0');
    const ssize_t count = ::pread(file.get(), there.data(), there.size(), 0);
    there.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    end = header.size();
    if (there == header) return Done{};
    return notOurs(part,
                   there.starts_with(header)
                       ? "what was left of a run that was cut off, which reads and plays as it is: give it "
                         "another name, or remove it"
                       : "something else: give it another name, or write to another file");
  }

  bool isStillThere() const {
    struct stat held {
    }, there{};
    return ::fstat(file.get(), &held) == 0 && ::lstat(part.c_str(), &there) == 0 &&
           held.st_ino == there.st_ino && held.st_dev == there.st_dev;
  }
};

PartFile::PartFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
PartFile::~PartFile() = default;
PartFile::PartFile(PartFile&&) noexcept = default;

Result<PartFile> PartFile::open(const std::filesystem::path& target, std::string_view header) {
  if (auto may = canReplace(target); !may) return may.findings();
  auto state = std::make_unique<State>();
  state->target = state->part = target;
  state->part += ".part";
  state->file = Descriptor(::open(state->part.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  const bool isNew = state->file.isOpen();
  if (!isNew && errno == ENOENT)
    return Finding{Severity::error, target.string(), "", "a folder that exists",
                   std::filesystem::absolute(target).parent_path().string()};
  if (!isNew && errno != EEXIST) return refused(state->part, kWritable, errno);
  if (isNew) static_cast<void>(state->lock());
  if (auto there = isNew ? Result<Done>(Done{}) : state->goOn(header); !there) return there.findings();
  PartFile file(std::move(state));
  if (isNew)
    if (auto begun = file.append(header); !begun) {
      file.discard();
      return begun.findings();
    }
  return file;
}

const std::filesystem::path& PartFile::path() const {
  return state_->part;
}

Result<Done> PartFile::append(std::string_view bytes) {
  State& s = *state_;
  for (std::uint64_t at = s.end; !bytes.empty();) {
    const ssize_t count = ::pwrite(s.file.get(), bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const int error = count < 0 ? errno : ENOSPC;
      // A part of a row would be read as one that was cut short.
      static_cast<void>(::ftruncate(s.file.get(), static_cast<off_t>(s.end)) == 0);
      return refused(s.part, kWritable, error);
    }
    bytes.remove_prefix(static_cast<std::size_t>(count));
    at += static_cast<std::uint64_t>(count);
    if (bytes.empty()) s.end = at;
  }
  return Done{};
}

Result<Done> PartFile::putInPlace() {
  if (!flushed(state_->file.get())) return refused(state_->target, kWritable, errno);
  if (!state_->isStillThere()) return notOurs(state_->part, "not the file that was written: it was moved");
  return trimtab::putInPlace(state_->part, state_->target);
}

void PartFile::discard() {
  if (state_->isStillThere()) ::unlink(state_->part.c_str());
}

}  // namespace trimtab
