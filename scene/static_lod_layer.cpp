#include "trimtab/scene/static_lod_layer.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "trimtab/scene/gl_api.h"
#include "trimtab/terrain/static_lod.h"

namespace trimtab::scene {
namespace {

using terrain::StaticLodVertex;

void defineAttributes() {
  const auto attribute = [](unsigned index, int size, unsigned type, unsigned char normalise,
                            std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, type, normalise, sizeof(StaticLodVertex),
                          reinterpret_cast<const void*>(offset));
  };
  attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(StaticLodVertex, x));
  attribute(1, 3, GL_BYTE, GL_TRUE, offsetof(StaticLodVertex, normal));
  attribute(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(StaticLodVertex, colour));
}

template <class T>
unsigned makeBuffer(unsigned target, const std::vector<T>& data) {
  unsigned buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_STATIC_DRAW);
  return buffer;
}

/// Edges of a node's triangles, each once, as `first << 32 | second` with first < second; the locked apart.
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

StaticLodLayer::~StaticLodLayer() {
  clear();
}

void StaticLodLayer::clear() {
  for (Tile& tile : tiles_) drop(tile);
  for (const Edges& edges : edges_) glDeleteBuffers(1, &edges.buffer);
  tiles_.clear();
  edges_.clear();
  bytes_ = 0;
}

void StaticLodLayer::drop(Tile& tile) {
  for (const GLuint array : {tile.vertexArray, tile.edgeArray}) glDeleteVertexArrays(1, &array);
  for (const GLuint buffer : {tile.vertexBuffer, tile.indexBuffer}) glDeleteBuffers(1, &buffer);
  tile = {};
}

void StaticLodLayer::setTerrain(std::shared_ptr<const terrain::StaticLodTerrain> terrain) {
  clear();
  terrain_ = std::move(terrain);
  if (!terrain_) return;
  tiles_.resize(terrain_->tiles.size());
  edges_.resize(terrain_->index.size());
}

void StaticLodLayer::upload(std::uint32_t at) {
  const terrain::StaticLodTile& source = terrain_->tiles[at];
  Tile& tile = tiles_[at];
  glGenVertexArrays(1, &tile.vertexArray);
  glBindVertexArray(tile.vertexArray);
  tile.vertexBuffer = makeBuffer(GL_ARRAY_BUFFER, source.vertices);
  defineAttributes();
  tile.indexBuffer = makeBuffer(GL_ELEMENT_ARRAY_BUFFER, source.indices);
  glGenVertexArrays(1, &tile.edgeArray);
  glBindVertexArray(tile.edgeArray);
  defineAttributes();
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  bytes_ += source.vertices.size() * sizeof(StaticLodVertex) + source.indices.size() * sizeof(std::uint32_t);
}

std::size_t StaticLodLayer::prepare(std::span<const TileDraw> nodes, bool anew) {
  std::size_t uploaded = 0;
  if (anew)
    for (const TileDraw& node : nodes) drop(tiles_[terrain_->index.nodes[node.node].tile]);
  for (const TileDraw& node : nodes) {
    const std::uint32_t tile = terrain_->index.nodes[node.node].tile;
    if (tiles_[tile].vertexArray != 0) continue;
    upload(tile);
    ++uploaded;
  }
  return uploaded;
}

template <class Draw>
void StaticLodLayer::eachTile(unsigned program, std::span<const TileDraw> nodes, const Draw& draw) {
  const GLint origin = glGetUniformLocation(program, "treeOrigin");
  for (std::size_t first = 0, end = 0; first < nodes.size(); first = end) {
    const std::uint32_t tile = terrain_->index.nodes[nodes[first].node].tile;
    while (end < nodes.size() && terrain_->index.nodes[nodes[end].node].tile == tile) ++end;
    if (tiles_[tile].vertexArray == 0) continue;
    const std::int32_t* o = terrain_->tiles[tile].origin;
    glUniform3i(origin, o[0], o[1], o[2]);
    draw(tiles_[tile], nodes.subspan(first, end - first));
  }
  glBindVertexArray(0);
}

void StaticLodLayer::draw(unsigned program, std::span<const TileDraw> nodes) {
  eachTile(program, nodes, [this](const Tile& tile, std::span<const TileDraw> ofTile) {
    counts_.clear();
    offsets_.clear();
    for (const TileDraw& node : ofTile) {
      const terrain::StaticLodRange range = terrain_->ranges[node.node];
      counts_.push_back(static_cast<int>(3 * range.triangles));
      offsets_.push_back(
          reinterpret_cast<const void*>(std::size_t{range.firstTriangle} * 3 * sizeof(std::uint32_t)));
    }
    glBindVertexArray(tile.vertexArray);
    glMultiDrawElements(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_INT, offsets_.data(),
                        static_cast<int>(counts_.size()));
  });
}

void StaticLodLayer::drawTinted(unsigned program, std::span<const TileDraw> nodes,
                                std::span<const std::uint32_t> colours) {
  const GLint tint = glGetUniformLocation(program, "treeTint");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::uint32_t c = colours[i];
    const auto part = [c](unsigned shift) { return static_cast<float>(c >> shift & 255u) / 255.0f; };
    glUniform4f(tint, part(0), part(8), part(16), part(24));
    draw(program, nodes.subspan(i, 1));
  }
}

void StaticLodLayer::drawNumbered(unsigned program, std::span<const TileDraw> nodes) {
  const GLint number = glGetUniformLocation(program, "treeNode");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    glUniform1ui(number, nodes[i].node);
    draw(program, nodes.subspan(i, 1));
  }
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
  bytes_ += indices.size() * sizeof(std::uint32_t);
  return edges;
}

void StaticLodLayer::drawPicture(unsigned program, std::span<const TileDraw> nodes) {
  const GLint colour = glGetUniformLocation(program, "flatColour");
  const GLint depthScale = glGetUniformLocation(program, "depthScale");
  glUniform4f(colour, 0.84f, 0.84f, 0.84f, 1);
  glUniform1f(depthScale, 1);
  draw(program, nodes);
  // Lines nearer than the faces they bound, and black before red: where they meet, locked shows.
  const auto lines = [&](float nearer, bool locked) {
    glUniform1f(depthScale, nearer);
    eachTile(program, nodes, [&](const Tile& tile, std::span<const TileDraw> ofTile) {
      glBindVertexArray(tile.edgeArray);
      for (const TileDraw& node : ofTile) {
        const Edges& edges = edgesOf(node.node);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, edges.buffer);
        const std::size_t first = locked ? static_cast<std::size_t>(edges.free) * sizeof(std::uint32_t) : 0;
        glDrawElements(GL_LINES, locked ? edges.locked : edges.free, GL_UNSIGNED_INT,
                       reinterpret_cast<const void*>(first));
      }
    });
  };
  glUniform4f(colour, 0, 0, 0, 1);
  lines(1.003f, true);
  glUniform4f(colour, 0.85f, 0, 0, 1);
  lines(1.002f, false);
}

}  // namespace trimtab::scene
