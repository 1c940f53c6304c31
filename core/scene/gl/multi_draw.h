#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/culling/select.h"

namespace trimtab::scene {

/// Says how the draws of many meshes that share their buffers reach GL. All ways draw the same triangles in
/// the same order.
enum class DrawWay : std::uint8_t {
  indirect,     ///< one call; the commands are in a buffer of the GPU
  base_vertex,  ///< one call; the commands are in arrays of this program
  loop          ///< one call per mesh
};

struct DrawChoice {
  DrawWay way = DrawWay::loop;
  std::string reason;  ///< for people: the way, and why
};
/// Returns the best way for the current context, which has GL 4.5 and so has all of them.
DrawChoice drawChoiceOfContext();

/// Makes drawChoiceOfContext() return this way while it lives. It serves tests and measurements.
class ForcedDrawWay {
 public:
  explicit ForcedDrawWay(DrawWay way);
  ~ForcedDrawWay();
  ForcedDrawWay(const ForcedDrawWay&) = delete;
  ForcedDrawWay& operator=(const ForcedDrawWay&) = delete;

 private:
  std::optional<DrawWay> before_;
};

/// Draws one list of meshes that share a pair of buffers. Keeps the commands while the list and the meshes'
/// places stay what they are, so a frame like the last one makes and uploads none. Every call needs the
/// context current that it was made in.
class MultiDraw {
 public:
  MultiDraw();
  explicit MultiDraw(DrawWay way);
  ~MultiDraw();
  MultiDraw(const MultiDraw&) = delete;
  MultiDraw& operator=(const MultiDraw&) = delete;

  /// Returns false if the commands are those of these nodes already. Otherwise forgets them, and the caller
  /// must add them. `places` is a number, never 0, that changes whenever a mesh's place may have changed.
  bool begin(std::span<const TileDraw> nodes, std::uint64_t places);
  /// Adds a mesh, in the order of drawing. Those of `bothSides`, which are drawn without GL's face culling,
  /// must come first. Offsets and sizes count indices and vertices.
  void add(std::uint32_t firstIndex, std::uint32_t indices, std::uint32_t baseVertex, bool bothSides = false);
  /// Draws triangles of the array's element buffer, whose indices are `indexType` (GL_UNSIGNED_SHORT or
  /// _INT). With `numbered`, attributes that advance by instance are read at the command's number among those
  /// added; glMultiDrawElementsBaseVertex cannot do that, so a loop replaces it.
  void draw(unsigned vertexArray, unsigned indexType, bool numbered = false);

  std::size_t size() const { return commands_.size(); }
  std::uint64_t made() const { return made_; }  ///< how often commands were made

 private:
  /// The layout that glMultiDrawElementsIndirect reads.
  struct Command {
    std::uint32_t indices, instances, firstIndex;
    std::int32_t baseVertex;
    std::uint32_t baseInstance;
  };
  void drawPart(unsigned indexType, bool numbered, std::size_t first, std::size_t count);
  void drawIndirect(unsigned indexType, std::size_t first, std::size_t count);
  void drawBaseVertex(unsigned indexType, std::size_t first, std::size_t count);
  void drawLoop(unsigned indexType, bool numbered, std::size_t first, std::size_t commands);

  DrawWay way_;
  std::vector<TileDraw> nodes_;
  std::uint64_t places_ = 0, made_ = 0;
  std::vector<Command> commands_;
  std::size_t bothSides_ = 0;  ///< the first so many commands
  bool passed_ = false;        ///< the commands are where the way wants them
  unsigned buffer_ = 0;
  std::vector<std::int32_t> counts_, baseVertices_;
  std::vector<const void*> offsets_;
};

}  // namespace trimtab::scene
