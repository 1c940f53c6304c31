#pragma once

#include <memory>

#include "tests/support.h"
#include "trimtab/terrain/format/ground_pyramid.h"
#include "trimtab/terrain/ground/build.h"

namespace trimtab::test {

/// Builds a pyramid and opens it. Its file has no name any more when this returns.
inline Result<std::shared_ptr<const terrain::GroundPyramid>> buildAndOpenGround(
    const terrain::GroundSources& sources) {
  const ScratchDir dir;
  const auto built = terrain::buildGround(sources, dir / "ground.bin", {});
  if (!built) return built.findings();
  auto opened = terrain::openGround(dir / "ground.bin", sources.heights->posts());
  if (!opened) return opened.findings();
  return Result<std::shared_ptr<const terrain::GroundPyramid>>(std::move(opened).value(), built.findings());
}

}  // namespace trimtab::test
