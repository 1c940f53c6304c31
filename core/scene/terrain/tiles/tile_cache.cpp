#include "tile_cache.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_buffer.h"
#include "core/scene/gl/mesh_pool.h"
#include "core/scene/shaders/shared_constants.h"

namespace trimtab::scene {
namespace {

constexpr std::uint32_t kFirstSlots = 256;
/// Beyond this many slots (89 MB) the least recently used are given up instead; a frame that needs more still
/// gets them.
constexpr std::uint32_t kKeptSlots = 4096;
constexpr std::size_t kVertexBytes = sizeof(terrain::TileVertex);
constexpr std::size_t kSlotBytes = kTileVertices * kVertexBytes;
constexpr std::size_t kOccluderBytes = kOccluderVertices * sizeof(OccluderVertex);
constexpr std::size_t kPartBytes = kParts * sizeof(PartBox);

using terrain::TileVertex;
constexpr std::array kTileAttributes{
    VertexAttribute{0, 3, GL_FLOAT, false, offsetof(TileVertex, x)},
    VertexAttribute{1, 3, GL_BYTE, true, offsetof(TileVertex, normal)},
    VertexAttribute{2, 1, GL_UNSIGNED_BYTE, false, offsetof(TileVertex, slope)},
    VertexAttribute{3, 4, GL_UNSIGNED_BYTE, true, offsetof(TileVertex, colour)}};

/// Makes a vertex array with its own index buffer.
GLuint makeArray(const std::vector<std::uint16_t>& indices, GLuint& indexBuffer) {
  GLuint array = 0;
  glGenVertexArrays(1, &array);
  glBindVertexArray(array);
  glGenBuffers(1, &indexBuffer);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indexBuffer);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint16_t)),
               indices.data(), GL_STATIC_DRAW);
  glBindVertexArray(0);
  return array;
}

}  // namespace

TileCache::TileCache() : indices_(makeTileIndices()) {
  const auto occluder = makeOccluderIndices();
  occluderIndices_ = static_cast<std::uint32_t>(occluder.size());
  vertexArray_ = makeArray(indices_.indices, indexBuffer_);
  occluderArray_ = makeArray(occluder, occluderIndexBuffer_);
  for (GLuint* buffer : {&slotBuffer_, &tintBuffer_}) glGenBuffers(1, buffer);
  for (GLuint* texture : {&slotTexture_, &tintTexture_, &partTexture_}) glGenTextures(1, texture);
  growTo(kFirstSlots);
}

TileCache::~TileCache() {
  for (const GLuint texture : {slotTexture_, tintTexture_, partTexture_}) glDeleteTextures(1, &texture);
  for (const GLuint buffer : {vertexBuffer_, indexBuffer_, occluderBuffer_, occluderIndexBuffer_, slotBuffer_,
                              tintBuffer_, partBuffer_})
    glDeleteBuffers(1, &buffer);
  for (const GLuint array : {vertexArray_, occluderArray_}) glDeleteVertexArrays(1, &array);
}

void TileCache::setDatabase(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  slotOfNode_.assign(database_ ? database_->index().size() : 0, kNoSlot);
  for (Slot& slot : slots_) slot = {};
  used_ = 0;
  frame_ = 0;
  ++places_;
}

/// To grow in flight makes an image late, on an NVIDIA H200 by 8 ms, because the buffer is made anew. So the
/// second image makes room for all tiles that are kept; the first one is not held up by that. Where there is
/// no memory for it, the buffer grows as far as it can.
void TileCache::makeRoom() {
  const std::size_t wanted = std::min<std::size_t>(slotOfNode_.size(), kKeptSlots);
  if (wanted > slots_.size()) growTo(wanted);
}

std::size_t TileCache::bytes() const {
  return slots_.size() * kSlotBytes;
}

/// Returns false if there is no memory for more: the slots are those that there were.
bool TileCache::growTo(std::size_t after) {
  const std::size_t before = slots_.size();
  const bool grown = growBuffer(vertexBuffer_, before * kSlotBytes, after * kSlotBytes) &&
                     growBuffer(occluderBuffer_, before * kOccluderBytes, after * kOccluderBytes) &&
                     growBuffer(partBuffer_, before * kPartBytes, after * kPartBytes);
  // The buffers may have been replaced even so.
  glBindVertexArray(vertexArray_);
  glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer_);
  defineAttributes(kTileAttributes, kVertexBytes);
  glBindVertexArray(occluderArray_);
  glBindBuffer(GL_ARRAY_BUFFER, occluderBuffer_);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(OccluderVertex), nullptr);
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  attachBuffer(partTexture_, GL_RGBA32F, partBuffer_);
  if (!grown) return false;

  slots_.resize(after);
  slotData_.resize(after);
  tints_.resize(after);
  uploadBuffer(slotBuffer_, slotData_.data(), after * sizeof(SlotData));
  uploadBuffer(tintBuffer_, tints_.data(), after * sizeof(std::uint32_t));
  attachBuffer(slotTexture_, GL_RGBA32I, slotBuffer_);
  attachBuffer(tintTexture_, GL_RGBA8, tintBuffer_);
  return true;
}

std::uint32_t TileCache::takeSlot() {
  if (used_ < slots_.size()) return used_++;
  const std::size_t more = std::max<std::size_t>(kFirstSlots, 2 * slots_.size());
  if (slots_.size() < kKeptSlots && growTo(std::min<std::size_t>(kKeptSlots, more))) return used_++;
  const auto oldest = std::min_element(slots_.begin(), slots_.end(),
                                       [](const Slot& a, const Slot& b) { return a.lastUse < b.lastUse; });
  if (oldest != slots_.end() && oldest->lastUse < frame_) {
    slotOfNode_[oldest->node] = kNoSlot;
    ++places_;
    return static_cast<std::uint32_t>(oldest - slots_.begin());
  }
  return slots_.size() >= kKeptSlots && growTo(more) ? used_++ : kNoSlot;
}

void TileCache::fill(std::uint32_t slot, std::uint32_t node) {
  database_->buildTile(node, mesh_);
  makeOccluder(mesh_, database_->index().slopeMax[node], occluder_);
  uploadPart(vertexBuffer_, slot * kSlotBytes, mesh_.vertices.data(), kSlotBytes);
  uploadPart(occluderBuffer_, slot * kOccluderBytes, occluder_.vertices.data(), kOccluderBytes);
  uploadPart(partBuffer_, slot * kPartBytes, occluder_.parts.data(), kPartBytes);
  slotData_[slot] = {{mesh_.origin[0], mesh_.origin[1], mesh_.origin[2], static_cast<std::int32_t>(node)},
                     occluder_.limits};
  uploadPart(slotBuffer_, slot * sizeof(SlotData), &slotData_[slot], sizeof(SlotData));
  slots_[slot].node = node;
  slotOfNode_[node] = slot;
  ++places_;
}

std::size_t TileCache::prepare(std::span<const TileDraw> tiles, bool anew) {
  if (++frame_ == 2) makeRoom();
  std::size_t built = 0;
  // First the tiles that are there, so that none of them is given up for another of the same frame.
  for (const TileDraw& tile : tiles)
    if (const std::uint32_t slot = slotOfNode_[tile.node]; slot != kNoSlot) slots_[slot].lastUse = frame_;
  for (const TileDraw& tile : tiles) {
    const std::uint32_t had = slotOfNode_[tile.node];
    if (had != kNoSlot && !anew) continue;
    const std::uint32_t slot = had != kNoSlot ? had : takeSlot();
    if (slot == kNoSlot) break;
    fill(slot, tile.node);
    slots_[slot].lastUse = frame_;
    ++built;
  }
  return built;
}

BuiltAhead TileCache::buildAhead(std::span<const std::uint32_t> nodes,
                                 std::chrono::steady_clock::time_point deadline) {
  BuiltAhead ahead;
  for (const std::uint32_t node : nodes) {
    if (slotOfNode_[node] == kNoSlot) {
      if (ahead.left > 0 || std::chrono::steady_clock::now() >= deadline) {
        ++ahead.left;
        continue;
      }
      const std::uint32_t slot = takeSlot();
      if (slot == kNoSlot) break;
      fill(slot, node);
      ++ahead.built;
    }
    slots_[slotOfNode_[node]].lastUse = frame_;
  }
  return ahead;
}

void TileCache::setTints(std::span<const TileDraw> tiles, std::span<const std::uint32_t> colours) {
  for (std::size_t i = 0; i < tiles.size(); ++i)
    if (const std::uint32_t slot = slotOfNode_[tiles[i].node]; slot != kNoSlot) tints_[slot] = colours[i];
  uploadBuffer(tintBuffer_, tints_.data(), tints_.size() * sizeof(std::uint32_t));
}

void TileCache::draw(std::span<const TileDraw> tiles) {
  if (surface_.begin(tiles, places_))
    for (const TileDraw& tile : tiles)
      if (const std::uint32_t slot = slotOfNode_[tile.node]; slot != kNoSlot) {
        const TileIndices::Range range = indices_.variant[tile.border.bits];
        surface_.add(range.first, range.count, slot * kTileVertices, tile.bothSides);
      }
  surface_.draw(vertexArray_, GL_UNSIGNED_SHORT);
}

void TileCache::drawOccluders(std::span<const TileDraw> tiles) {
  if (occluders_.begin(tiles, places_))
    for (const TileDraw& tile : tiles)
      if (const std::uint32_t slot = slotOfNode_[tile.node]; slot != kNoSlot)
        occluders_.add(0, occluderIndices_, slot * kOccluderVertices);
  occluders_.draw(occluderArray_, GL_UNSIGNED_SHORT);
}

}  // namespace trimtab::scene
