#include <GL/gl.h>

#include "surface.h"
#include "trimtab/scene/offscreen.h"

namespace trimtab::ig {
namespace {

class Headless : public Surface {
 public:
  Headless(std::unique_ptr<scene::Offscreen> offscreen, int width, int height)
      : offscreen_(std::move(offscreen)), width_(width), height_(height) {}
  unsigned framebuffer() const override { return offscreen_->framebuffer(); }
  int width() const override { return width_; }
  int height() const override { return height_; }
  void fit(int width, int height) override {
    if (width == width_ && height == height_) return;
    offscreen_->resize(width, height);
    width_ = width;
    height_ = height;
  }
  void present() override { glFinish(); }
  bool handleEvents(bool&) override { return true; }
  int eventFd() const override { return -1; }
  bool hasViewer() const override { return false; }

 private:
  std::unique_ptr<scene::Offscreen> offscreen_;
  int width_, height_;
};

}  // namespace

Result<std::unique_ptr<Surface>> openHeadless(int width, int height) {
  Result<std::unique_ptr<scene::Offscreen>> offscreen = scene::Offscreen::create(width, height);
  if (!offscreen) return offscreen.findings();
  (*offscreen)->makeCurrent();
  return {std::make_unique<Headless>(std::move(offscreen).value(), width, height)};
}

}  // namespace trimtab::ig
