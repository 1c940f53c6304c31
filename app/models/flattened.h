#pragma once

#include <osg/Node>

#include <map>
#include <vector>

#include "trimtab/terrain/objects/source_model.h"

namespace trimtab::models {

/// Numbers the textures of a model in the order in which they are met.
class TextureList {
 public:
  /// Returns the number of an image; SourceVertex::kNoTexture for one without readable pixels.
  std::uint32_t numberOf(const osg::Image& image);
  std::vector<terrain::SourceTexture> take() { return std::move(textures_); }

 private:
  std::map<const osg::Image*, std::uint32_t> numbers_;
  std::vector<terrain::SourceTexture> textures_;
};

/// Returns distances, one between each two at which what osg::LOD nodes show changes, nearest first; one
/// alone if there are none. Of ranges in pixels, the reverse is used as a distance.
std::vector<double> distancesOf(osg::Node& node);

/// What a graph shows at a distance.
struct Flattened {
  terrain::SourceMesh mesh;
  std::vector<terrain::SourceLight> lights;  ///< points of geometries, and osgSim's light points
  bool moreOfLights = false;                 ///< some have sectors or blink, which is left out
};
Flattened flattened(osg::Node& node, double distance, TextureList& textures);

}  // namespace trimtab::models
