#pragma once

#include <cstddef>

/// Buffers of the current context; each call leaves nothing bound but what it says.
namespace trimtab::scene {

/// A buffer of `after` bytes in place of `buffer` (0: none yet), whose first `before` bytes it keeps.
/// False where there is no memory for it: `buffer` is as it was.
bool growBuffer(unsigned& buffer, std::size_t before, std::size_t after);
/// For tests: while it lives, there is no memory for a buffer that grows beyond so many bytes.
class ScarceMemory {
 public:
  explicit ScarceMemory(std::size_t mostBytes);
  ~ScarceMemory();
  ScarceMemory(const ScarceMemory&) = delete;
  ScarceMemory& operator=(const ScarceMemory&) = delete;

 private:
  std::size_t before_;
};
/// All of it, anew.
void uploadBuffer(unsigned buffer, const void* data, std::size_t bytes);
void uploadPart(unsigned buffer, std::size_t offset, const void* data, std::size_t bytes);
/// Makes `buffer` what a buffer texture reads.
void attachBuffer(unsigned texture, unsigned format, unsigned buffer);

}  // namespace trimtab::scene
