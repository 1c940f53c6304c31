#include "node_pass.h"

#include <array>

#include "core/scene/gl/gl_api.h"

namespace trimtab::scene {

void NodeTarget::begin(int width, int height) {
  frame_.resize(width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  forget();
}

void NodeTarget::forget() {
  const GLuint none[4] = {kNone, 0, 0, 0};
  glClearBufferuiv(GL_COLOR, 0, none);
}

void nearView(std::span<const TileDraw> tiles, std::span<const Box> bounds, const EyePose& eye,
              const ViewShape& view, std::vector<TileDraw>& near) {
  near.clear();
  // These are the outward normals of the view's sides, in eye axes (right, up, backward).
  const auto side = [](Vec3 normal) { return normalized(normal); };
  const std::array<Vec3, 4> sides{side({-1, 0, -view.left}), side({1, 0, view.right}),
                                  side({0, -1, -view.bottom}), side({0, 1, view.top})};
  for (const TileDraw& tile : tiles) {
    const Box& b = bounds[tile.node];
    const Vec3 middle{0.5 * (double{b.minX} + b.maxX), 0.5 * (double{b.minY} + b.maxY),
                      0.5 * (double{b.minZ} + b.maxZ)};
    const double reach =
        0.75 * length(Vec3{double{b.maxX} - b.minX, double{b.maxY} - b.minY, double{b.maxZ} - b.minZ});
    const Vec3 seen = eye.axes * (middle - eye.position);
    bool outside = seen.z > reach;
    for (const Vec3& normal : sides) outside = outside || dot(normal, seen) > reach;
    if (!outside) near.push_back(tile);
  }
}

std::vector<std::uint32_t> NodeTarget::read() const {
  std::vector<std::uint32_t> nodes(static_cast<std::size_t>(frame_.width()) *
                                   static_cast<std::size_t>(frame_.height()));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_.id());
  glReadPixels(0, 0, frame_.width(), frame_.height(), GL_RED_INTEGER, GL_UNSIGNED_INT, nodes.data());
  return nodes;
}

}  // namespace trimtab::scene
