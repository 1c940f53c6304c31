#include "static_lod_occlusion.h"

#include "core/scene/gl/gl_api.h"

namespace trimtab::scene {

void StaticLodOcclusion::read(int pictureWidth, int pictureHeight, int width, int height) {
  picture_.resize(static_cast<std::size_t>(pictureWidth) * static_cast<std::size_t>(pictureHeight));
  // Reduced here: on a software rasteriser, making the map by a shader costs several times as much.
  glReadPixels(0, 0, pictureWidth, pictureHeight, GL_DEPTH_COMPONENT, GL_FLOAT, picture_.data());
  pyramid_.buildFromPicture(picture_, pictureWidth, pictureHeight, width, height);
}

}  // namespace trimtab::scene
