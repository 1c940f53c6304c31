#include "trimtab/scene/tile_cache.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "trimtab/scene/gl_api.h"

namespace trimtab::scene {
namespace {

constexpr std::uint32_t kFirstSlots = 256;
/// Beyond this many slots (178 MB) the longest unused are given up instead; a frame that needs more still
/// gets them.
constexpr std::uint32_t kKeptSlots = 8192;
constexpr std::size_t kVertexBytes = sizeof(terrain::TileVertex);
constexpr std::size_t kSlotBytes = TileCache::kVerticesPerTile * kVertexBytes;

void defineAttributes() {
  const auto attribute = [](unsigned index, int size, unsigned type, unsigned char normalise,
                            std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, type, normalise, static_cast<int>(kVertexBytes),
                          reinterpret_cast<const void*>(offset));
  };
  using terrain::TileVertex;
  attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(TileVertex, x));
  attribute(1, 3, GL_BYTE, GL_TRUE, offsetof(TileVertex, normal));
  attribute(2, 1, GL_UNSIGNED_BYTE, GL_FALSE, offsetof(TileVertex, slope));
  attribute(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(TileVertex, colour));
}

}  // namespace

TileCache::TileCache() : indices_(makeTileIndices()) {
  auto indices = indices_.indices;
  for (unsigned shift = 1; shift < 4; ++shift) {
    const auto coarse = makeCoarseIndices(1 << shift);
    coarse_[shift] = {static_cast<std::uint32_t>(indices.size()), static_cast<std::uint32_t>(coarse.size())};
    indices.insert(indices.end(), coarse.begin(), coarse.end());
  }
  glGenVertexArrays(1, &vertexArray_);
  glBindVertexArray(vertexArray_);
  glGenBuffers(1, &indexBuffer_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indexBuffer_);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint16_t)),
               indices.data(), GL_STATIC_DRAW);
  glBindVertexArray(0);
  glGenBuffers(1, &slotBuffer_);
  glGenBuffers(1, &tintBuffer_);
  glGenTextures(1, &slotTexture_);
  glGenTextures(1, &tintTexture_);
  grow();
}

TileCache::~TileCache() {
  const std::array<GLuint, 4> buffers{vertexBuffer_, indexBuffer_, slotBuffer_, tintBuffer_};
  const std::array<GLuint, 2> textures{slotTexture_, tintTexture_};
  glDeleteTextures(2, textures.data());
  glDeleteBuffers(4, buffers.data());
  glDeleteVertexArrays(1, &vertexArray_);
}

void TileCache::setDatabase(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  slotOfNode_.assign(database_ ? database_->index().size() : 0, kNoSlot);
  for (Slot& slot : slots_) slot = {};
  used_ = 0;
}

std::size_t TileCache::bytes() const {
  return slots_.size() * kSlotBytes;
}

void TileCache::grow() {
  const std::size_t before = slots_.size();
  const std::size_t after = before == 0 ? kFirstSlots : before * 2;
  GLuint larger = 0;
  glGenBuffers(1, &larger);
  glBindBuffer(GL_ARRAY_BUFFER, larger);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(after * kSlotBytes), nullptr, GL_STATIC_DRAW);
  if (before != 0) {
    glBindBuffer(GL_COPY_READ_BUFFER, vertexBuffer_);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_ARRAY_BUFFER, 0, 0,
                        static_cast<GLsizeiptr>(before * kSlotBytes));
    glBindBuffer(GL_COPY_READ_BUFFER, 0);
    glDeleteBuffers(1, &vertexBuffer_);
  }
  vertexBuffer_ = larger;
  glBindVertexArray(vertexArray_);
  defineAttributes();
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);

  slots_.resize(after);
  slotData_.resize(after);
  tints_.resize(after);
  const auto resizeTexture = [after](GLuint texture, GLuint buffer, GLenum format, const void* data,
                                     std::size_t item) {
    glBindBuffer(GL_TEXTURE_BUFFER, buffer);
    glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(after * item), data, GL_DYNAMIC_DRAW);
    glBindTexture(GL_TEXTURE_BUFFER, texture);
    glTexBuffer(GL_TEXTURE_BUFFER, format, buffer);
    glBindTexture(GL_TEXTURE_BUFFER, 0);
    glBindBuffer(GL_TEXTURE_BUFFER, 0);
  };
  resizeTexture(slotTexture_, slotBuffer_, GL_RGBA32I, slotData_.data(), sizeof(SlotData));
  resizeTexture(tintTexture_, tintBuffer_, GL_RGBA8, tints_.data(), sizeof(std::uint32_t));
}

std::uint32_t TileCache::takeSlot() {
  if (used_ < slots_.size()) return used_++;
  if (slots_.size() >= kKeptSlots) {
    const auto oldest = std::min_element(slots_.begin(), slots_.end(),
                                         [](const Slot& a, const Slot& b) { return a.lastUse < b.lastUse; });
    if (oldest->lastUse < frame_) {
      slotOfNode_[oldest->node] = kNoSlot;
      return static_cast<std::uint32_t>(oldest - slots_.begin());
    }
  }
  grow();
  return used_++;
}

void TileCache::fill(std::uint32_t slot, std::uint32_t node) {
  database_->buildTile(node, mesh_);
  glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer_);
  glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(slot * kSlotBytes),
                  static_cast<GLsizeiptr>(kSlotBytes), mesh_.vertices.data());
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  slotData_[slot] = {{mesh_.origin[0], mesh_.origin[1], mesh_.origin[2]}, 0};
  glBindBuffer(GL_TEXTURE_BUFFER, slotBuffer_);
  glBufferSubData(GL_TEXTURE_BUFFER, static_cast<GLintptr>(slot * sizeof(SlotData)), sizeof(SlotData),
                  &slotData_[slot]);
  glBindBuffer(GL_TEXTURE_BUFFER, 0);
  slots_[slot].node = node;
  slotOfNode_[node] = slot;
}

std::size_t TileCache::prepare(std::span<const TileDraw> tiles) {
  ++frame_;
  std::size_t built = 0;
  // First the tiles that are there, so that none of them is given up for another of the same frame.
  for (const TileDraw& tile : tiles)
    if (const std::uint32_t slot = slotOfNode_[tile.node]; slot != kNoSlot) slots_[slot].lastUse = frame_;
  for (const TileDraw& tile : tiles) {
    if (slotOfNode_[tile.node] != kNoSlot) continue;
    const std::uint32_t slot = takeSlot();
    fill(slot, tile.node);
    slots_[slot].lastUse = frame_;
    ++built;
  }
  return built;
}

void TileCache::setTints(std::span<const TileDraw> tiles, std::span<const std::uint32_t> colours) {
  for (std::size_t i = 0; i < tiles.size(); ++i)
    if (const std::uint32_t slot = slotOfNode_[tiles[i].node]; slot != kNoSlot) tints_[slot] = colours[i];
  glBindBuffer(GL_TEXTURE_BUFFER, tintBuffer_);
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(tints_.size() * sizeof(std::uint32_t)),
               tints_.data(), GL_DYNAMIC_DRAW);
  glBindBuffer(GL_TEXTURE_BUFFER, 0);
}

void TileCache::draw(std::span<const TileDraw> tiles) {
  counts_.resize(tiles.size());
  offsets_.resize(tiles.size());
  baseVertices_.resize(tiles.size());
  std::size_t count = 0;
  for (const TileDraw& tile : tiles) {
    const std::uint32_t slot = slotOfNode_[tile.node];
    if (slot == kNoSlot) continue;
    const TileIndices::Range range = indices_.variant[tile.coarser];
    counts_[count] = static_cast<int>(range.count);
    offsets_[count] = reinterpret_cast<const void*>(range.first * sizeof(std::uint16_t));
    baseVertices_[count++] = static_cast<int>(slot) * kVerticesPerTile;
  }
  multiDraw(count);
}

void TileCache::drawCoarse(std::span<const TileDraw> tiles, unsigned shift) {
  counts_.assign(tiles.size(), static_cast<int>(coarse_[shift].count));
  offsets_.assign(tiles.size(), reinterpret_cast<const void*>(coarse_[shift].first * sizeof(std::uint16_t)));
  baseVertices_.resize(tiles.size());
  std::size_t count = 0;
  for (const TileDraw& tile : tiles)
    if (const std::uint32_t slot = slotOfNode_[tile.node]; slot != kNoSlot)
      baseVertices_[count++] = static_cast<int>(slot) * kVerticesPerTile;
  multiDraw(count);
}

void TileCache::multiDraw(std::size_t count) {
  if (count == 0) return;
  glBindVertexArray(vertexArray_);
  glMultiDrawElementsBaseVertex(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_SHORT, offsets_.data(),
                                static_cast<int>(count), baseVertices_.data());
  glBindVertexArray(0);
}

}  // namespace trimtab::scene
