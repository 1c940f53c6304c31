#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/culling/select.h"

namespace trimtab::scene {

/// How the draws of many meshes that share their buffers reach GL. All draw the same triangles in the same
/// order.
enum class DrawWay : std::uint8_t {
  indirect,     ///< one call; the commands are in a buffer of the GPU
  base_vertex,  ///< one call; the commands are in arrays of this program
  loop          ///< one call a mesh
};

struct DrawFeatures {
  bool indirect = false, baseVertex = false;  ///< glMultiDrawElementsIndirect, glMultiDrawElementsBaseVertex
  bool software = false;                      ///< GL is this processor
};
struct DrawChoice {
  DrawWay way = DrawWay::loop;
  std::string reason;  ///< for people: the way, and why not the one before it
};
DrawChoice chooseDrawWay(const DrawFeatures& features);

/// Of the context that is current.
DrawFeatures drawFeaturesOfContext();
DrawChoice drawChoiceOfContext();

/// For tests and measurements: while it lives, whoever asks for a context's choice gets this way.
class ForcedDrawWay {
 public:
  explicit ForcedDrawWay(DrawWay way);
  ~ForcedDrawWay();
  ForcedDrawWay(const ForcedDrawWay&) = delete;
  ForcedDrawWay& operator=(const ForcedDrawWay&) = delete;

 private:
  std::optional<DrawWay> before_;
};

/// The draws of one list of meshes in one pair of buffers. Commands are made once and kept while the list and
/// the meshes' places stay what they are: a frame like the last one makes none, and uploads none.
///
/// All calls need the context current that it was made in.
class MultiDraw {
 public:
  MultiDraw();
  explicit MultiDraw(DrawWay way);
  ~MultiDraw();
  MultiDraw(const MultiDraw&) = delete;
  MultiDraw& operator=(const MultiDraw&) = delete;

  /// False where the commands are those of these nodes already. True: they are forgotten, and to be added
  /// anew. `places` is a number that changes whenever a mesh's place may have; never 0.
  bool begin(std::span<const TileDraw> nodes, std::uint64_t places);
  /// In the order in which they are to be drawn, which has those of `bothSides` first: they are drawn without
  /// GL's face culling. Offsets and sizes in indices and vertices.
  void add(std::uint32_t firstIndex, std::uint32_t indices, std::uint32_t baseVertex, bool bothSides = false);
  /// Triangles of the array's element buffer, whose indices are `indexType` (GL_UNSIGNED_SHORT or _INT). With
  /// `numbered`, attributes that advance by instance are read at the command's number among those added;
  /// glMultiDrawElementsBaseVertex cannot, so a loop takes its place.
  void draw(unsigned vertexArray, unsigned indexType, bool numbered = false);

  std::size_t size() const { return commands_.size(); }
  std::uint64_t made() const { return made_; }  ///< how often commands were made

 private:
  /// As glMultiDrawElementsIndirect reads it.
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
