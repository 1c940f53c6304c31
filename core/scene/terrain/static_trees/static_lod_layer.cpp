#include "static_lod_layer.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_buffer.h"
#include "core/scene/shaders/shared_constants.h"
#include "trimtab/terrain/format/static_lod_terrain.h"

namespace trimtab::scene {
namespace {

using terrain::StaticLodVertex;

/// A vertex of a terrain that has texture coordinates. Only such a terrain pays for them.
struct TexturedVertex {
  StaticLodVertex plain;
  std::array<float, 2> texture;
};

constexpr MeshPool::Layout kTreeLayout{.vertexBytes = sizeof(StaticLodVertex),
                                       .indexBytes = sizeof(std::uint32_t),
                                       .slotBytes = 4 * sizeof(std::int32_t),
                                       .block = kTreeBlock,
                                       .indexBlock = 64,
                                       .leastBlocks = 4096,
                                       .leastIndexBlocks = 4096,
                                       .growth = 1.5};

MeshPool::Layout layoutFor(bool textured) {
  MeshPool::Layout layout = kTreeLayout;
  if (textured) layout.vertexBytes = sizeof(TexturedVertex);
  return layout;
}

constexpr std::array kTreeAttributes{
    VertexAttribute{0, 3, GL_FLOAT, false, offsetof(StaticLodVertex, x)},
    VertexAttribute{1, 3, GL_BYTE, true, offsetof(StaticLodVertex, normal)},
    VertexAttribute{3, 4, GL_UNSIGNED_BYTE, true, offsetof(StaticLodVertex, colour)}};

constexpr std::array kTexture{VertexAttribute{2, 2, GL_FLOAT, false, offsetof(TexturedVertex, texture)}};

template <class T>
unsigned makeBuffer(unsigned target, const std::vector<T>& data) {
  unsigned buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_STATIC_DRAW);
  return buffer;
}

/// Collects the edges of a node's triangles, each once, as `first << 32 | second` with first < second; the
/// locked apart.
void collectEdges(const terrain::StaticLodTile& tile, const terrain::StaticLodRange& range,
                  std::vector<std::uint64_t>& free, std::vector<std::uint64_t>& locked) {
  for (std::size_t t = range.firstTriangle; t < std::size_t{range.firstTriangle} + range.triangles; ++t)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = tile.indices[3 * t + corner], b = tile.indices[3 * t + (corner + 1) % 3];
      const std::uint64_t edge = std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
      (tile.locked[t] >> corner & 1 ? locked : free).push_back(edge);
    }
  for (std::vector<std::uint64_t>* list : {&free, &locked}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  // An edge that one of its triangles calls locked is.
  std::erase_if(free,
                [&](std::uint64_t edge) { return std::binary_search(locked.begin(), locked.end(), edge); });
}

}  // namespace

StaticLodLayer::StaticLodLayer(std::size_t keptBytes)
    : keptBytes_(keptBytes), pool_(kTreeLayout, [this] { attach(); }) {
  for (GLuint* array : {&array_, &numberedArray_, &edgeArray_}) glGenVertexArrays(1, array);
  glGenBuffers(1, &dataBuffer_);
}

StaticLodLayer::~StaticLodLayer() {
  for (const Edges& edges : edges_) glDeleteBuffers(1, &edges.buffer);
  glDeleteBuffers(1, &dataBuffer_);
  for (const GLuint array : {array_, numberedArray_, edgeArray_}) glDeleteVertexArrays(1, &array);
}

void StaticLodLayer::setTerrain(std::shared_ptr<const terrain::StaticLodTerrain> terrain) {
  for (const Edges& edges : edges_) glDeleteBuffers(1, &edges.buffer);
  terrain_ = std::move(terrain);
  places_.assign(terrain_ ? terrain_->tiles.size() : 0, {});
  edges_.assign(terrain_ ? terrain_->index.size() : 0, {});
  textured_ = terrain_ && terrain::hasTexture(*terrain_);
  pool_.clear(layoutFor(textured_));
  frame_ = 0;
  ++placesNumber_;
}

/// Makes room for all tiles that are kept, in the second frame, so that buffers need not grow in flight,
/// which makes an image late. The first image is not held up by it. Free places of tiles that were given up
/// lie apart, so there is a quarter more room than is kept.
void StaticLodLayer::makeRoom() {
  const MeshPool::Layout layout = layoutFor(textured_);
  std::size_t blocks = 0, indexBlocks = 0;
  for (const terrain::StaticLodTile& tile : terrain_->tiles) {
    blocks += layout.blocksOf(tile.vertices.size());
    indexBlocks += layout.indexBlocksOf(tile.indices.size());
  }
  const double all = static_cast<double>(std::max<std::size_t>(layout.bytes(blocks, indexBlocks), 1));
  const double share = std::min(1.0, 1.25 * static_cast<double>(keptBytes_) / all);
  const auto kept = [share](std::size_t bytes) {
    return static_cast<std::size_t>(share * static_cast<double>(bytes));
  };
  pool_.reserve(kept(blocks * layout.block * layout.vertexBytes),
                kept(indexBlocks * layout.indexBlock * layout.indexBytes));
}

void StaticLodLayer::drop(std::uint32_t tile) {
  if (places_[tile].blocks == 0) return;
  pool_.give(places_[tile]);
  places_[tile] = {};
  ++placesNumber_;
}

/// Returns false if this frame needs all that is there.
bool StaticLodLayer::dropOldest() {
  std::optional<std::uint32_t> oldest;
  for (std::uint32_t tile = 0; tile < places_.size(); ++tile)
    if (places_[tile].blocks > 0 && places_[tile].lastUse < frame_ &&
        (!oldest || places_[tile].lastUse < places_[*oldest].lastUse))
      oldest = tile;
  if (oldest) drop(*oldest);
  return oldest.has_value();
}

void StaticLodLayer::attach() {
  for (const GLuint array : {array_, numberedArray_, edgeArray_}) {
    glBindVertexArray(array);
    glBindBuffer(GL_ARRAY_BUFFER, pool_.vertexBuffer());
    glDisableVertexAttribArray(kTexture[0].index);
    if (pool_.vertexBuffer() != 0) {
      const std::size_t bytes = layoutFor(textured_).vertexBytes;
      defineAttributes(kTreeAttributes, bytes);
      if (textured_) defineAttributes(kTexture, bytes);
    }
    if (array != edgeArray_) glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, pool_.indexBuffer());
  }
  glBindVertexArray(numberedArray_);
  glBindBuffer(GL_ARRAY_BUFFER, dataBuffer_);
  glEnableVertexAttribArray(4);
  glVertexAttribIPointer(4, 1, GL_UNSIGNED_INT, sizeof(DrawData), nullptr);
  glVertexAttribDivisor(4, 1);
  glEnableVertexAttribArray(5);
  glVertexAttribPointer(5, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(DrawData),
                        reinterpret_cast<const void*>(offsetof(DrawData, tint)));
  glVertexAttribDivisor(5, 1);
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

std::size_t StaticLodLayer::bytesOf(std::uint32_t tile) const {
  const terrain::StaticLodTile& source = terrain_->tiles[tile];
  const MeshPool::Layout layout = layoutFor(textured_);
  return layout.bytes(layout.blocksOf(source.vertices.size()), layout.indexBlocksOf(source.indices.size()));
}

bool StaticLodLayer::upload(std::uint32_t at) {
  const terrain::StaticLodTile& source = terrain_->tiles[at];
  const std::size_t vertices = source.vertices.size(), indices = source.indices.size();
  if (vertices == 0 || indices == 0) return false;
  while (bytes() + bytesOf(at) > keptBytes_ && dropOldest()) {
  }
  std::optional<MeshPool::Place> place;
  while (!(place = pool_.take(vertices, indices)))
    if (!dropOldest()) return false;
  const std::array<std::int32_t, 4> slot{source.origin[0], source.origin[1], source.origin[2], 0};
  std::vector<TexturedVertex> withTexture;
  if (textured_) {
    withTexture.reserve(vertices);
    for (std::size_t i = 0; i < vertices; ++i)
      withTexture.push_back(
          {source.vertices[i], source.texture.empty() ? std::array{0.0f, 0.0f} : source.texture[i]});
  }
  pool_.put(*place,
            textured_ ? std::as_bytes(std::span(withTexture)) : std::as_bytes(std::span(source.vertices)),
            std::as_bytes(std::span(source.indices)), std::as_bytes(std::span(slot)));
  pool_.send();
  places_[at] = {*place, frame_};
  ++placesNumber_;
  return true;
}

std::size_t StaticLodLayer::prepare(std::span<const TileDraw> nodes, bool anew) {
  if (++frame_ == 2) makeRoom();
  const auto tileOf = [this](const TileDraw& node) { return terrain_->index.nodes[node.node].tile; };
  if (anew)
    for (const TileDraw& node : nodes) drop(tileOf(node));
  // First those that are there, so that none of them is given up for another of the same frame.
  for (const TileDraw& node : nodes) places_[tileOf(node)].lastUse = frame_;
  std::size_t uploaded = 0;
  for (const TileDraw& node : nodes)
    if (const std::uint32_t tile = tileOf(node); places_[tile].blocks == 0) uploaded += upload(tile);
  return uploaded;
}

BuiltAhead StaticLodLayer::buildAhead(std::span<const std::uint32_t> nodes,
                                      std::chrono::steady_clock::time_point deadline) {
  BuiltAhead ahead;
  for (const std::uint32_t node : nodes) {
    const std::uint32_t tile = terrain_->index.nodes[node].tile;
    if (places_[tile].blocks > 0 || bytes() + bytesOf(tile) > keptBytes_) continue;
    if (ahead.left > 0 || std::chrono::steady_clock::now() >= deadline)
      ++ahead.left;
    else
      ahead.built += upload(tile);
  }
  return ahead;
}

const StaticLodLayer::Place& StaticLodLayer::placeOf(std::uint32_t node) const {
  return places_[terrain_->index.nodes[node].tile];
}

void StaticLodLayer::addCommands(MultiDraw& draw, std::span<const TileDraw> nodes) {
  if (!draw.begin(nodes, placesNumber_)) return;
  for (const TileDraw& node : nodes) {
    const Place& place = placeOf(node.node);
    const terrain::StaticLodRange range = terrain_->ranges[node.node];
    if (place.blocks > 0)
      draw.add(place.indexBlock * kTreeLayout.indexBlock + 3 * range.firstTriangle, 3 * range.triangles,
               place.block * kTreeLayout.block);
  }
}

void StaticLodLayer::draw(std::span<const TileDraw> nodes) {
  addCommands(surface_, nodes);
  surface_.draw(array_, GL_UNSIGNED_INT);
}

void StaticLodLayer::drawNumbered(std::span<const TileDraw> nodes, std::span<const std::uint32_t> colours) {
  addCommands(numbered_, nodes);
  data_.clear();
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (placeOf(nodes[i].node).blocks > 0) data_.push_back({nodes[i].node, colours.empty() ? 0 : colours[i]});
  uploadBuffer(dataBuffer_, data_.data(), data_.size() * sizeof(DrawData));
  numbered_.draw(numberedArray_, GL_UNSIGNED_INT, true);
}

const StaticLodLayer::Edges& StaticLodLayer::edgesOf(std::uint32_t node) {
  Edges& edges = edges_[node];
  if (edges.buffer != 0) return edges;
  std::vector<std::uint64_t> free, locked;
  collectEdges(terrain_->tiles[terrain_->index.nodes[node].tile], terrain_->ranges[node], free, locked);
  std::vector<std::uint32_t> indices;
  for (const auto* list : {&free, &locked})
    for (const std::uint64_t edge : *list) {
      indices.push_back(static_cast<std::uint32_t>(edge >> 32));
      indices.push_back(static_cast<std::uint32_t>(edge));
    }
  edges = {makeBuffer(GL_ELEMENT_ARRAY_BUFFER, indices), static_cast<int>(2 * free.size()),
           static_cast<int>(2 * locked.size())};
  return edges;
}

void StaticLodLayer::drawEdges(std::span<const TileDraw> nodes, bool locked) {
  glBindVertexArray(edgeArray_);
  for (const TileDraw& node : nodes) {
    const Place& place = placeOf(node.node);
    if (place.blocks == 0) continue;
    const Edges& edges = edgesOf(node.node);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, edges.buffer);
    const std::size_t first = locked ? static_cast<std::size_t>(edges.free) * sizeof(std::uint32_t) : 0;
    glDrawElementsBaseVertex(GL_LINES, locked ? edges.locked : edges.free, GL_UNSIGNED_INT,
                             reinterpret_cast<const void*>(first),
                             static_cast<GLint>(place.block * kTreeLayout.block));
  }
  glBindVertexArray(0);
}

void StaticLodLayer::drawPicture(unsigned program, std::span<const TileDraw> nodes) {
  const GLint colour = glGetUniformLocation(program, "flatColour");
  const GLint depthScale = glGetUniformLocation(program, "depthScale");
  glUniform4f(colour, 0.84f, 0.84f, 0.84f, 1);
  glUniform1f(depthScale, 1);
  draw(nodes);
  // Lines nearer than the faces they bound, and black before red: where they meet, locked shows.
  glUniform4f(colour, 0, 0, 0, 1);
  glUniform1f(depthScale, 1.003f);
  drawEdges(nodes, true);
  glUniform4f(colour, 0.85f, 0, 0, 1);
  glUniform1f(depthScale, 1.002f);
  drawEdges(nodes, false);
}

}  // namespace trimtab::scene
