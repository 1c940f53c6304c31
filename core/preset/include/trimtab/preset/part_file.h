#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "trimtab/units/result.h"

namespace trimtab {

/// A file that grows in flight, as `FILE.part` beside its target: whatever ends the program, what was
/// appended before is there and can be read. One at a time writes it.
class PartFile {
 public:
  /// Begins `FILE.part` with a header. Refuses a target that cannot be replaced, and a `FILE.part` that holds
  /// anything but this header: it may be all that is left of a flight, or somebody else's.
  static Result<PartFile> open(const std::filesystem::path& target, std::string_view header);
  ~PartFile();
  PartFile(PartFile&&) noexcept;
  PartFile& operator=(PartFile&&) = delete;

  const std::filesystem::path& path() const;
  /// Hands the bytes to the system, all or none: if that fails, as on a full disk, the file ends with what
  /// was appended before.
  Result<Done> append(std::string_view bytes);
  /// Gives the file its target's name once its bytes are on the disk. If it fails, `FILE.part` stays.
  Result<Done> putInPlace();
  /// Removes `FILE.part`, unless it is another file by now.
  void discard();

 private:
  struct State;
  explicit PartFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace trimtab
