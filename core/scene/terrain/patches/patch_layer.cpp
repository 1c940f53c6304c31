#include "patch_layer.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_buffer.h"
#include "core/scene/gl/multi_draw.h"
#include "core/scene/gl/range_allocator.h"

namespace trimtab::scene {
namespace {

using terrain::PatchVertex;

constexpr std::size_t kVertexBytes = sizeof(PatchVertex), kIndexBytes = sizeof(std::uint16_t);
constexpr auto kBlock = static_cast<std::uint32_t>(PatchLayer::kBlock);
/// Indices are placed in units of so many, too.
constexpr std::uint32_t kIndexBlock = 32;
constexpr std::uint32_t kFirstBlocks = 1024, kFirstIndexBlocks = 2048;

std::uint32_t inBlocks(std::size_t count, std::uint32_t block) {
  return static_cast<std::uint32_t>((count + block - 1) / block);
}

/// Where a patch's vertices and indices are, in blocks.
struct Place {
  std::uint32_t block = 0, blocks = 0, indexBlock = 0, indexBlocks = 0;
  std::array<std::uint32_t, PatchIndex::kMostVariants + 1> firstIndex{};
};

/// As shaders read it of a block: two texels of RGBA32I.
struct SlotData {
  std::int32_t origin[3], patch;
  std::int32_t firstColumn, firstRow, unused[2];
};
static_assert(sizeof(SlotData) == 32);

void defineAttributes() {
  const auto attribute = [](unsigned index, int size, unsigned type, unsigned char normalise,
                            std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, type, normalise, static_cast<int>(kVertexBytes),
                          reinterpret_cast<const void*>(offset));
  };
  attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(PatchVertex, x));
  attribute(1, 3, GL_BYTE, GL_TRUE, offsetof(PatchVertex, normal));
  attribute(2, 2, GL_UNSIGNED_SHORT, GL_FALSE, offsetof(PatchVertex, column));
}

/// One buffer on the GPU, filled by runs: what is to stand together is sent together.
template <class T>
class Staged {
 public:
  void begin(std::uint32_t block, std::uint32_t unit, unsigned buffer) {
    if (!data_.empty() && (first_ * unit_ + data_.size() != std::size_t{block} * unit)) send();
    if (data_.empty()) first_ = block;
    unit_ = unit;
    buffer_ = buffer;
  }
  /// Filled up to whole units.
  void append(std::span<const T> values) {
    data_.insert(data_.end(), values.begin(), values.end());
    data_.resize((data_.size() + unit_ - 1) / unit_ * unit_);
  }
  void send() {
    if (!data_.empty())
      uploadPart(buffer_, first_ * unit_ * sizeof(T), data_.data(), data_.size() * sizeof(T));
    data_.clear();
  }

 private:
  std::vector<T> data_;
  std::size_t first_ = 0, unit_ = 1;
  unsigned buffer_ = 0;
};

}  // namespace

struct PatchLayer::Impl {
  const PatchIndex* index = nullptr;
  std::vector<std::vector<Place>> pages;  ///< of each its patches' places; empty: not there
  RangeAllocator blocks, indexBlocks;
  Staged<PatchVertex> vertexStage;
  Staged<std::uint16_t> indexStage;
  Staged<SlotData> slotStage;
  std::vector<std::uint32_t> tints;
  MultiDraw surface;
  std::uint64_t placesNumber = 1;  ///< changes whenever a page comes or goes
  unsigned vertexArray = 0, vertexBuffer = 0, indexBuffer = 0;
  unsigned slotBuffer = 0, slotTexture = 0, tintBuffer = 0, tintTexture = 0;

  Impl();
  ~Impl();
  void clear();
  /// To so many blocks; false: there is no memory for them, and nothing has changed.
  bool growVertices(std::uint32_t after);
  bool growIndices(std::uint32_t after);
  const Place* placeOf(std::uint32_t patch) const;
  bool put(const terrain::PatchMesh& mesh, std::uint32_t patch, Place& place);
};

PatchLayer::Impl::Impl() {
  glGenVertexArrays(1, &vertexArray);
  glGenBuffers(1, &tintBuffer);
  for (GLuint* texture : {&slotTexture, &tintTexture}) glGenTextures(1, texture);
}

PatchLayer::Impl::~Impl() {
  clear();
  glDeleteBuffers(1, &tintBuffer);
  for (const GLuint texture : {slotTexture, tintTexture}) glDeleteTextures(1, &texture);
  glDeleteVertexArrays(1, &vertexArray);
}

/// Gives the memory back: another terrain may need far less.
void PatchLayer::Impl::clear() {
  for (GLuint* buffer : {&vertexBuffer, &indexBuffer, &slotBuffer}) {
    glDeleteBuffers(1, buffer);
    *buffer = 0;
  }
  blocks.clear();
  indexBlocks.clear();
  pages.clear();
  tints.clear();
  ++placesNumber;
}

bool PatchLayer::Impl::growVertices(std::uint32_t after) {
  const std::size_t before = blocks.size();
  GLint mostTexels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &mostTexels);
  if (after * sizeof(SlotData) > static_cast<std::size_t>(mostTexels) * 4 * sizeof(GLint)) return false;
  if (!growBuffer(vertexBuffer, before * kBlock * kVertexBytes, std::size_t{after} * kBlock * kVertexBytes))
    return false;
  glBindVertexArray(vertexArray);
  glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer);
  defineAttributes();
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  if (!growBuffer(slotBuffer, before * sizeof(SlotData), after * sizeof(SlotData))) return false;
  attachBuffer(slotTexture, GL_RGBA32I, slotBuffer);
  blocks.growTo(after);
  return true;
}

bool PatchLayer::Impl::growIndices(std::uint32_t after) {
  const std::size_t before = indexBlocks.size();
  if (!growBuffer(indexBuffer, before * kIndexBlock * kIndexBytes,
                  std::size_t{after} * kIndexBlock * kIndexBytes))
    return false;
  glBindVertexArray(vertexArray);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indexBuffer);
  glBindVertexArray(0);
  indexBlocks.growTo(after);
  return true;
}

const Place* PatchLayer::Impl::placeOf(std::uint32_t patch) const {
  const std::uint32_t page = index->page[patch];
  return pages[page].empty() ? nullptr : &pages[page][patch - index->pages[page].firstPatch];
}

bool PatchLayer::Impl::put(const terrain::PatchMesh& mesh, std::uint32_t patch, Place& place) {
  place.firstIndex = mesh.firstIndex;
  place.blocks = inBlocks(mesh.vertices.size(), kBlock);
  place.indexBlocks = inBlocks(mesh.indices.size(), kIndexBlock);
  if (place.blocks == 0 || place.indexBlocks == 0) {
    place = {};
    return true;
  }
  // What waits to be sent belongs into the buffer that growing would replace.
  auto block = blocks.take(place.blocks);
  if (!block) {
    vertexStage.send();
    slotStage.send();
    const std::uint32_t size = blocks.size(), least = std::max(kFirstBlocks, size + place.blocks);
    if (growVertices(std::max(least, size * 2)) || growVertices(least)) block = blocks.take(place.blocks);
  }
  if (!block) {
    place = {};
    return false;
  }
  auto indexBlock = indexBlocks.take(place.indexBlocks);
  if (!indexBlock) {
    indexStage.send();
    const std::uint32_t size = indexBlocks.size(),
                        least = std::max(kFirstIndexBlocks, size + place.indexBlocks);
    if (growIndices(std::max(least, size * 2)) || growIndices(least))
      indexBlock = indexBlocks.take(place.indexBlocks);
  }
  if (!indexBlock) {
    blocks.give(*block, place.blocks);
    place = {};
    return false;
  }
  place.block = *block;
  place.indexBlock = *indexBlock;
  vertexStage.begin(place.block, kBlock, vertexBuffer);
  vertexStage.append(mesh.vertices);
  indexStage.begin(place.indexBlock, kIndexBlock, indexBuffer);
  indexStage.append(mesh.indices);
  const SlotData slot{{mesh.origin[0], mesh.origin[1], mesh.origin[2]},
                      static_cast<std::int32_t>(patch),
                      static_cast<std::int32_t>(mesh.firstColumn),
                      static_cast<std::int32_t>(mesh.firstRow),
                      {}};
  slotStage.begin(place.block, 1, slotBuffer);
  for (std::uint32_t i = 0; i < place.blocks; ++i) slotStage.append(std::span(&slot, 1));
  return true;
}

PatchLayer::PatchLayer() : impl_(std::make_unique<Impl>()) {}
PatchLayer::~PatchLayer() = default;

void PatchLayer::setTerrain(const PatchIndex* index) {
  impl_->clear();
  impl_->index = index;
  if (index) impl_->pages.resize(index->pages.size());
}

bool PatchLayer::has(std::uint32_t page) const {
  return !impl_->pages[page].empty();
}

void PatchLayer::reserve(std::size_t vertexBytes, std::size_t indexBytes) {
  const std::uint32_t blocks = inBlocks(vertexBytes / kVertexBytes, kBlock),
                      indexBlocks = inBlocks(indexBytes / kIndexBytes, kIndexBlock);
  if (blocks > impl_->blocks.size()) impl_->growVertices(std::max(kFirstBlocks, blocks));
  if (indexBlocks > impl_->indexBlocks.size()) impl_->growIndices(std::max(kFirstIndexBlocks, indexBlocks));
}

bool PatchLayer::add(const terrain::PatchPage& page) {
  Impl& m = *impl_;
  if (has(page.page)) return true;
  ++m.placesNumber;
  std::vector<Place>& places = m.pages[page.page];
  places.resize(page.patches.size());
  bool whole = true;
  for (std::size_t i = 0; i < places.size() && whole; ++i)
    whole = m.put(page.patches[i], m.index->pages[page.page].firstPatch + static_cast<std::uint32_t>(i),
                  places[i]);
  m.vertexStage.send();
  m.indexStage.send();
  m.slotStage.send();
  if (!whole) drop(page.page);
  return whole;
}

void PatchLayer::drop(std::uint32_t page) {
  ++impl_->placesNumber;
  for (const Place& place : impl_->pages[page]) {
    if (place.blocks == 0) continue;
    impl_->blocks.give(place.block, place.blocks);
    impl_->indexBlocks.give(place.indexBlock, place.indexBlocks);
  }
  impl_->pages[page] = {};
}

void PatchLayer::draw(std::span<const TileDraw> patches) {
  Impl& m = *impl_;
  if (m.surface.begin(patches, m.placesNumber))
    for (const TileDraw& patch : patches) {
      const Place* place = m.placeOf(patch.node);
      if (!place || place->blocks == 0) continue;
      const std::uint32_t first = place->firstIndex[patch.variant.number];
      const std::uint32_t count = place->firstIndex[patch.variant.number + 1u] - first;
      if (count > 0)
        m.surface.add(place->indexBlock * kIndexBlock + first, count, place->block * kBlock, patch.bothSides);
    }
  m.surface.draw(m.vertexArray, GL_UNSIGNED_SHORT);
}

void PatchLayer::setTints(std::span<const TileDraw> patches, std::span<const std::uint32_t> colours) {
  Impl& m = *impl_;
  m.tints.resize(m.blocks.size());
  for (std::size_t i = 0; i < patches.size(); ++i)
    if (const Place* place = m.placeOf(patches[i].node))
      std::fill_n(m.tints.begin() + place->block, place->blocks, colours[i]);
  uploadBuffer(m.tintBuffer, m.tints.data(), m.tints.size() * sizeof(std::uint32_t));
  attachBuffer(m.tintTexture, GL_RGBA8, m.tintBuffer);
}

unsigned PatchLayer::slotTexture() const {
  return impl_->slotTexture;
}

unsigned PatchLayer::tintTexture() const {
  return impl_->tintTexture;
}

std::size_t PatchLayer::bytesOf(std::size_t vertices, std::size_t indices) {
  return std::size_t{inBlocks(vertices, kBlock)} * (kBlock * kVertexBytes + sizeof(SlotData)) +
         std::size_t{inBlocks(indices, kIndexBlock)} * kIndexBlock * kIndexBytes;
}

std::size_t PatchLayer::bytes() const {
  return std::size_t{impl_->blocks.used()} * (kBlock * kVertexBytes + sizeof(SlotData)) +
         std::size_t{impl_->indexBlocks.used()} * kIndexBlock * kIndexBytes;
}

std::size_t PatchLayer::reservedBytes() const {
  return std::size_t{impl_->blocks.size()} * (kBlock * kVertexBytes + sizeof(SlotData)) +
         std::size_t{impl_->indexBlocks.size()} * kIndexBlock * kIndexBytes;
}

}  // namespace trimtab::scene
