#include "patch_layer.h"

#include <algorithm>
#include <cstddef>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_buffer.h"
#include "core/scene/shaders/shared_constants.h"

namespace trimtab::scene {
namespace {

using terrain::PatchVertex;

/// Holds what shaders read of a block: two texels of RGBA32I.
struct SlotData {
  std::int32_t origin[3], patch;
  std::int32_t firstColumn, firstRow, unused[2];
};
static_assert(sizeof(SlotData) == 32);

constexpr MeshPool::Layout kPatchLayout{.vertexBytes = sizeof(PatchVertex),
                                        .indexBytes = sizeof(std::uint16_t),
                                        .slotBytes = sizeof(SlotData),
                                        .block = kPatchBlock,
                                        .indexBlock = 32,
                                        .leastBlocks = 1024,
                                        .leastIndexBlocks = 2048,
                                        .growth = 2};
constexpr std::array kPatchAttributes{
    VertexAttribute{0, 3, GL_FLOAT, false, offsetof(PatchVertex, x)},
    VertexAttribute{1, 3, GL_BYTE, true, offsetof(PatchVertex, normal)},
    VertexAttribute{2, 2, GL_UNSIGNED_SHORT, false, offsetof(PatchVertex, column)}};

}  // namespace

PatchLayer::PatchLayer() : pool_(kPatchLayout, [this] { attach(); }) {
  glGenVertexArrays(1, &vertexArray_);
  glGenBuffers(1, &tintBuffer_);
  glGenTextures(1, &tintTexture_);
}

PatchLayer::~PatchLayer() {
  glDeleteBuffers(1, &tintBuffer_);
  glDeleteTextures(1, &tintTexture_);
  glDeleteVertexArrays(1, &vertexArray_);
}

void PatchLayer::attach() {
  glBindVertexArray(vertexArray_);
  glBindBuffer(GL_ARRAY_BUFFER, pool_.vertexBuffer());
  if (pool_.vertexBuffer() != 0) defineAttributes(kPatchAttributes, sizeof(PatchVertex));
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, pool_.indexBuffer());
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void PatchLayer::setTerrain(const PatchIndex* index) {
  pool_.clear();
  pages_.clear();
  tints_.clear();
  ++placesNumber_;
  index_ = index;
  if (index) pages_.resize(index->pages.size());
}

const PatchLayer::Mesh* PatchLayer::meshOf(std::uint32_t patch) const {
  const std::uint32_t page = index_->page[patch];
  return pages_[page].empty() ? nullptr : &pages_[page][patch - index_->pages[page].firstPatch];
}

bool PatchLayer::put(const terrain::PatchMesh& mesh, std::uint32_t patch, Mesh& kept) {
  const auto place = pool_.take(mesh.vertices.size(), mesh.indices.size());
  if (!place) return mesh.vertices.empty() || mesh.indices.empty();
  kept = {*place, mesh.firstIndex};
  const SlotData slot{{mesh.origin[0], mesh.origin[1], mesh.origin[2]},
                      static_cast<std::int32_t>(patch),
                      static_cast<std::int32_t>(mesh.firstColumn),
                      static_cast<std::int32_t>(mesh.firstRow),
                      {}};
  pool_.put(*place, std::as_bytes(std::span(mesh.vertices)), std::as_bytes(std::span(mesh.indices)),
            std::as_bytes(std::span(&slot, 1)));
  return true;
}

bool PatchLayer::add(const terrain::PatchPage& page) {
  if (has(page.page)) return true;
  ++placesNumber_;
  std::vector<Mesh>& meshes = pages_[page.page];
  meshes.resize(page.patches.size());
  const std::uint32_t first = index_->pages[page.page].firstPatch;
  bool whole = true;
  for (std::uint32_t i = 0; i < meshes.size() && whole; ++i)
    whole = put(page.patches[i], first + i, meshes[i]);
  pool_.send();
  if (!whole) drop(page.page);
  return whole;
}

void PatchLayer::drop(std::uint32_t page) {
  ++placesNumber_;
  for (const Mesh& mesh : pages_[page]) pool_.give(mesh.place);
  pages_[page] = {};
}

void PatchLayer::draw(std::span<const TileDraw> patches) {
  if (surface_.begin(patches, placesNumber_))
    for (const TileDraw& patch : patches) {
      const Mesh* mesh = meshOf(patch.node);
      if (!mesh || mesh->place.blocks == 0) continue;
      const std::uint32_t first = mesh->firstIndex[patch.variant.number];
      const std::uint32_t count = mesh->firstIndex[patch.variant.number + 1u] - first;
      if (count > 0)
        surface_.add(mesh->place.indexBlock * kPatchLayout.indexBlock + first, count,
                     mesh->place.block * kPatchLayout.block, patch.bothSides);
    }
  surface_.draw(vertexArray_, GL_UNSIGNED_SHORT);
}

void PatchLayer::setTints(std::span<const TileDraw> patches, std::span<const std::uint32_t> colours) {
  tints_.resize(pool_.blocks());
  for (std::size_t i = 0; i < patches.size(); ++i)
    if (const Mesh* mesh = meshOf(patches[i].node))
      std::fill_n(tints_.begin() + mesh->place.block, mesh->place.blocks, colours[i]);
  uploadBuffer(tintBuffer_, tints_.data(), tints_.size() * sizeof(std::uint32_t));
  attachBuffer(tintTexture_, GL_RGBA8, tintBuffer_);
}

std::size_t PatchLayer::bytesOf(std::size_t vertices, std::size_t indices) {
  return kPatchLayout.bytes(kPatchLayout.blocksOf(vertices), kPatchLayout.indexBlocksOf(indices));
}

}  // namespace trimtab::scene
