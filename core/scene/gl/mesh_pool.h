#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "range_allocator.h"

namespace trimtab::scene {

/// An attribute of a vertex: GL's index, its components and their GL type, and its offset in the vertex.
struct VertexAttribute {
  unsigned index;
  int components;
  unsigned type;
  bool normalised;
  std::size_t offset;
};
/// Defines attributes of the buffer that is bound to GL_ARRAY_BUFFER, in the vertex array that is bound.
void defineAttributes(std::span<const VertexAttribute> attributes, std::size_t vertexBytes);

/// Keeps meshes on the GPU: vertices and indices in two buffers with room to reuse, and for each block of
/// vertices a slot in a buffer texture, which shaders read by gl_VertexID.
///
/// Every call needs the context current that it was made in.
class MeshPool {
 public:
  struct Layout {
    std::size_t vertexBytes, indexBytes;
    std::size_t slotBytes;                        ///< whole texels of 16 bytes (RGBA32I)
    std::uint32_t block, indexBlock;              ///< vertices and indices per block
    std::uint32_t leastBlocks, leastIndexBlocks;  ///< in a buffer
    double growth;                                ///< by which a buffer that is full grows

    std::uint32_t blocksOf(std::size_t vertices) const;
    std::uint32_t indexBlocksOf(std::size_t indices) const;
    /// Returns the bytes of so many blocks.
    std::size_t bytes(std::size_t blocks, std::size_t indexBlocks) const;
  };
  /// The blocks of a mesh; 0 blocks if it is not there.
  struct Place {
    std::uint32_t block = 0, blocks = 0, indexBlock = 0, indexBlocks = 0;
  };

  /// `attach` is called whenever a buffer may have been replaced. It binds the buffers to the vertex arrays
  /// that read them.
  MeshPool(const Layout& layout, std::function<void()> attach);
  ~MeshPool();
  MeshPool(const MeshPool&) = delete;
  MeshPool& operator=(const MeshPool&) = delete;

  /// Gives all memory back; the next mesh has this layout.
  void clear(const Layout& layout);
  void clear() { clear(layout_); }
  /// Makes room for so many bytes of vertices and of indices. Without memory for that, the room stays.
  void reserve(std::size_t vertexBytes, std::size_t indexBytes);
  /// Returns a place for a mesh; unset if there is no memory for it, or if it is empty.
  std::optional<Place> take(std::size_t vertices, std::size_t indices);
  void give(const Place& place);
  /// Stages what belongs into a place; each of its blocks of vertices gets the slot. Call `send` after the
  /// last one.
  void put(const Place& place, std::span<const std::byte> vertices, std::span<const std::byte> indices,
           std::span<const std::byte> slot);
  /// Uploads what is staged. What lies side by side goes together.
  void send();

  unsigned vertexBuffer() const { return vertices_.buffer; }
  unsigned indexBuffer() const { return indices_.buffer; }
  unsigned slotTexture() const { return slotTexture_; }
  std::uint32_t blocks() const { return blocks_.size(); }
  std::size_t bytes() const { return layout_.bytes(blocks_.used(), indexBlocks_.used()); }
  std::size_t reservedBytes() const { return layout_.bytes(blocks_.size(), indexBlocks_.size()); }

 private:
  /// A buffer, and the run of bytes that waits to be sent to it.
  struct Buffer {
    unsigned buffer = 0;
    std::size_t first = 0;
    std::vector<std::byte> staged;

    void stage(std::size_t at, std::span<const std::byte> bytes, std::size_t size);
    void send();
  };
  bool growVertices(std::uint32_t after);
  bool growIndices(std::uint32_t after);

  Layout layout_;
  std::function<void()> attach_;
  Buffer vertices_, indices_, slots_;
  unsigned slotTexture_ = 0;
  RangeAllocator blocks_, indexBlocks_;
};

}  // namespace trimtab::scene
