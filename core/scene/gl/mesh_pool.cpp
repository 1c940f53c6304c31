#include "mesh_pool.h"

#include <algorithm>

#include "gl_api.h"
#include "gl_buffer.h"

namespace trimtab::scene {
namespace {

std::uint32_t inBlocks(std::size_t count, std::uint32_t block) {
  return static_cast<std::uint32_t>((count + block - 1) / block);
}

/// Takes units, and if none are free, makes room for more where there is memory.
template <class Grow>
std::optional<std::uint32_t> takeGrowing(RangeAllocator& places, std::uint32_t units, std::uint32_t least,
                                         double growth, const Grow& grow) {
  if (const auto first = places.take(units)) return first;
  const std::uint32_t enough = std::max(least, places.size() + units),
                      more = static_cast<std::uint32_t>(growth * places.size());
  if (grow(std::max(enough, more)) || grow(enough)) return places.take(units);
  return {};
}

}  // namespace

void defineAttributes(std::span<const VertexAttribute> attributes, std::size_t vertexBytes) {
  for (const VertexAttribute& a : attributes) {
    glEnableVertexAttribArray(a.index);
    glVertexAttribPointer(a.index, a.components, a.type, a.normalised ? GL_TRUE : GL_FALSE,
                          static_cast<int>(vertexBytes), reinterpret_cast<const void*>(a.offset));
  }
}

std::uint32_t MeshPool::Layout::blocksOf(std::size_t vertices) const {
  return inBlocks(vertices, block);
}

std::uint32_t MeshPool::Layout::indexBlocksOf(std::size_t indices) const {
  return inBlocks(indices, indexBlock);
}

std::size_t MeshPool::Layout::bytes(std::size_t blocks, std::size_t indexBlocks) const {
  return blocks * (block * vertexBytes + slotBytes) + indexBlocks * indexBlock * indexBytes;
}

MeshPool::MeshPool(const Layout& layout, std::function<void()> attach)
    : layout_(layout), attach_(std::move(attach)) {
  glGenTextures(1, &slotTexture_);
}

MeshPool::~MeshPool() {
  clear();
  glDeleteTextures(1, &slotTexture_);
}

void MeshPool::clear(const Layout& layout) {
  layout_ = layout;
  for (Buffer* b : {&vertices_, &indices_, &slots_}) {
    glDeleteBuffers(1, &b->buffer);
    *b = {};
  }
  blocks_.clear();
  indexBlocks_.clear();
}

bool MeshPool::growVertices(std::uint32_t after) {
  const std::size_t before = blocks_.size(), blockBytes = layout_.block * layout_.vertexBytes;
  GLint mostTexels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &mostTexels);
  if (after * layout_.slotBytes > static_cast<std::size_t>(mostTexels) * 4 * sizeof(GLint)) return false;
  // The staged bytes belong into the buffers that growing replaces.
  send();
  const bool grown = growBuffer(vertices_.buffer, before * blockBytes, after * blockBytes) &&
                     growBuffer(slots_.buffer, before * layout_.slotBytes, after * layout_.slotBytes);
  if (slots_.buffer != 0) attachBuffer(slotTexture_, GL_RGBA32I, slots_.buffer);
  attach_();
  if (grown) blocks_.growTo(after);
  return grown;
}

bool MeshPool::growIndices(std::uint32_t after) {
  const std::size_t blockBytes = layout_.indexBlock * layout_.indexBytes;
  send();
  const bool grown = growBuffer(indices_.buffer, indexBlocks_.size() * blockBytes, after * blockBytes);
  attach_();
  if (grown) indexBlocks_.growTo(after);
  return grown;
}

void MeshPool::reserve(std::size_t vertexBytes, std::size_t indexBytes) {
  const std::uint32_t blocks = layout_.blocksOf(vertexBytes / layout_.vertexBytes),
                      indexBlocks = layout_.indexBlocksOf(indexBytes / layout_.indexBytes);
  if (blocks > blocks_.size()) growVertices(std::max(layout_.leastBlocks, blocks));
  if (indexBlocks > indexBlocks_.size()) growIndices(std::max(layout_.leastIndexBlocks, indexBlocks));
}

std::optional<MeshPool::Place> MeshPool::take(std::size_t vertices, std::size_t indices) {
  Place place{.blocks = layout_.blocksOf(vertices), .indexBlocks = layout_.indexBlocksOf(indices)};
  if (place.blocks == 0 || place.indexBlocks == 0) return {};
  const auto block = takeGrowing(blocks_, place.blocks, layout_.leastBlocks, layout_.growth,
                                 [this](std::uint32_t after) { return growVertices(after); });
  if (!block) return {};
  const auto indexBlock =
      takeGrowing(indexBlocks_, place.indexBlocks, layout_.leastIndexBlocks, layout_.growth,
                  [this](std::uint32_t after) { return growIndices(after); });
  if (!indexBlock) {
    blocks_.give(*block, place.blocks);
    return {};
  }
  place.block = *block;
  place.indexBlock = *indexBlock;
  return place;
}

void MeshPool::give(const Place& place) {
  if (place.blocks == 0) return;
  blocks_.give(place.block, place.blocks);
  indexBlocks_.give(place.indexBlock, place.indexBlocks);
}

void MeshPool::put(const Place& place, std::span<const std::byte> vertices,
                   std::span<const std::byte> indices, std::span<const std::byte> slot) {
  const std::size_t block = layout_.block * layout_.vertexBytes,
                    indexBlock = layout_.indexBlock * layout_.indexBytes;
  vertices_.stage(place.block * block, vertices, place.blocks * block);
  indices_.stage(place.indexBlock * indexBlock, indices, place.indexBlocks * indexBlock);
  for (std::size_t i = 0; i < place.blocks; ++i)
    slots_.stage((place.block + i) * layout_.slotBytes, slot, layout_.slotBytes);
}

void MeshPool::send() {
  for (Buffer* b : {&vertices_, &indices_, &slots_}) b->send();
}

void MeshPool::Buffer::stage(std::size_t at, std::span<const std::byte> bytes, std::size_t size) {
  if (first + staged.size() != at) send();
  if (staged.empty()) first = at;
  staged.insert(staged.end(), bytes.begin(), bytes.end());
  staged.resize(at - first + size);
}

void MeshPool::Buffer::send() {
  if (!staged.empty()) uploadPart(buffer, first, staged.data(), staged.size());
  staged.clear();
}

}  // namespace trimtab::scene
