#pragma once

#include <cstdint>
#include <memory>

#include "trimtab/terrain/format/ground_pyramid.h"

namespace trimtab::scene {

/// Texture unit of the ground (core/scene/shaders/ground_colour.glsl).
constexpr int kGroundUnit = 8;

/// The ground's colours and light about the eye on the GPU: one layer of kSide x kSide texels a level, each
/// centred at the eye and filled as it moves on (a clip map); a level that is not filled yet is shown by the
/// next coarser one. One texture for the whole terrain, whatever its size.
///
/// All calls but the constructor need the context current.
class GroundTexture {
 public:
  static constexpr int kSide = 1024;
  static constexpr int kLevels = 16;  ///< as many as there may be

  GroundTexture();
  ~GroundTexture();
  GroundTexture(const GroundTexture&) = delete;
  GroundTexture& operator=(const GroundTexture&) = delete;

  void setGround(std::shared_ptr<const terrain::GroundPyramid> ground);
  /// Voids that were filled stand out. Changing it reads everything anew.
  void showVoids(bool show);
  /// The eye is over post (column, row); `wait`: all that is missing is read now, for pictures that must not
  /// depend on time. Otherwise tiles are read by a thread and at most `mostBytes` uploaded.
  void update(double column, double row, bool wait, std::size_t mostBytes);
  /// What `groundAt` counts posts from.
  std::int32_t eyeColumn() const;
  std::int32_t eyeRow() const;
  /// Binds the textures and sets the uniforms of the program in use.
  void bind(unsigned program) const;
  void unbind() const;

  std::size_t bytes() const;  ///< of textures and of tiles kept
  std::uint64_t tilesRead() const;
  std::uint64_t bytesUploaded() const;
  bool complete() const;  ///< nothing that can be read is missing about the eye
  /// Tiles that could not be read; the next coarser level is shown there.
  std::size_t failed() const;
  Findings failures() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::scene
