#pragma once

#include <cstdint>
#include <memory>

#include "trimtab/terrain/format/ground_pyramid.h"

namespace trimtab::scene {

/// Texture unit of the ground (core/scene/shaders/ground_colour.glsl).
constexpr int kGroundUnit = 8;

/// Keeps the ground's colours and light around the eye on the GPU: one layer of kGroundSide x kGroundSide
/// texels per level, each centred at the eye and filled as it moves on (a clip map). The next coarser level
/// shows where one is not filled yet. One texture serves a terrain of any size.
///
/// All calls except the constructor need the context current.
class GroundTexture {
 public:
  static constexpr int kLevels = 16;  ///< as many as there may be

  GroundTexture();
  ~GroundTexture();
  GroundTexture(const GroundTexture&) = delete;
  GroundTexture& operator=(const GroundTexture&) = delete;

  void setGround(std::shared_ptr<const terrain::GroundPyramid> ground);
  /// Makes voids that were filled stand out. A change reads everything again.
  void showVoids(bool show);
  /// Fills the texture for an eye over post (column, row). With `wait`, reads all that is missing now, for
  /// images that must not depend on time; otherwise a thread reads tiles, and at most `mostBytes` are
  /// uploaded.
  void update(double column, double row, bool wait, std::size_t mostBytes);
  /// Return the post from which `groundAt` (ground_colour.glsl) counts.
  std::int32_t eyeColumn() const;
  std::int32_t eyeRow() const;
  /// Binds the textures and sets the uniforms of the program in use. The texture has 1 / `coarser` of the
  /// width and height that the image asks for or the data have; `coarser` is 1 or more.
  void bind(unsigned program, double coarser = 1) const;
  void unbind() const;

  std::size_t bytes() const;  ///< of textures and of tiles kept
  std::uint64_t bytesUploaded() const;
  bool complete() const;  ///< nothing that can be read is missing around the eye
  /// Returns how many tiles could not be read; the next coarser level shows there.
  std::size_t failed() const;
  Findings failures() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::scene
