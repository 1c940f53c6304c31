#pragma once

#include <cstddef>

/// Buffers of the current context. No call leaves anything bound.
namespace trimtab::scene {

/// Replaces `buffer` (0 if there is none yet) by one of `after` bytes and keeps its first `before` bytes.
/// Returns false and leaves it as it was if there is no memory for that.
bool growBuffer(unsigned& buffer, std::size_t before, std::size_t after);
/// Lets no buffer grow beyond so many bytes while it lives, as if there were no memory for it. It serves
/// tests.
class ScarceMemory {
 public:
  explicit ScarceMemory(std::size_t mostBytes);
  ~ScarceMemory();
  ScarceMemory(const ScarceMemory&) = delete;
  ScarceMemory& operator=(const ScarceMemory&) = delete;

 private:
  std::size_t before_;
};
/// Replaces the content of a buffer.
void uploadBuffer(unsigned buffer, const void* data, std::size_t bytes);
/// Replaces a part of a buffer's content.
void uploadPart(unsigned buffer, std::size_t offset, const void* data, std::size_t bytes);
/// Makes a buffer texture read `buffer`.
void attachBuffer(unsigned texture, unsigned format, unsigned buffer);

}  // namespace trimtab::scene
