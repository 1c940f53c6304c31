#pragma once

#include <cstdint>
#include <memory>

#include "trimtab/terrain/ground.h"
#include "trimtab/units/linear.h"

namespace trimtab::scene {

/// The ground's colours and light about the eye on the GPU: one layer of kSide x kSide texels a level, each
/// centred at the eye and filled as it moves on (a clip map); a level that is not filled yet is shown by the
/// next coarser one. One texture for the whole terrain, whatever its size.
///
/// All calls but the constructor need the context current.
class GroundTexture {
 public:
  static constexpr int kSide = 1024;

  GroundTexture();
  ~GroundTexture();
  GroundTexture(const GroundTexture&) = delete;
  GroundTexture& operator=(const GroundTexture&) = delete;

  void setGround(std::shared_ptr<const terrain::GroundPyramid> ground);
  /// The eye is over post (column, row); `wait`: all that is missing is read now, for pictures that must not
  /// depend on time. Otherwise tiles are read by a thread and at most `mostBytes` uploaded.
  void update(double column, double row, bool wait, std::size_t mostBytes);
  /// Binds the texture and sets the uniforms of the program in use; kGroundColour in shaders.h reads them.
  void bind(unsigned program) const;
  void unbind() const;

  std::size_t bytes() const;
  std::uint64_t tilesRead() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::scene
