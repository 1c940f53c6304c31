#include "trimtab/scene/offscreen.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>

#include "frame_buffer.h"
#include "gl_api.h"

namespace trimtab::scene {
namespace {

/// Mesa's surfaceless platform, else the first device that initialises (NVIDIA).
EGLDisplay openDisplay() {
  const auto getDisplay =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (getDisplay == nullptr) return EGL_NO_DISPLAY;
  const auto works = [](EGLDisplay display) {
    return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE;
  };
  const auto queryDevices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  const auto device = [&](bool nvidiaOnly) -> EGLDisplay {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (queryDevices == nullptr || !queryDevices(static_cast<EGLint>(devices.size()), devices.data(), &count))
      return EGL_NO_DISPLAY;
    for (EGLint i = 0; i < count; ++i) {
      const EGLDisplay display =
          getDisplay(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr);
      if (!works(display)) continue;
      const std::string vendor = eglQueryString(display, EGL_VENDOR);
      if (!nvidiaOnly || vendor.find("NVIDIA") != std::string::npos) return display;
    }
    return EGL_NO_DISPLAY;
  };
  // A hardware vendor's own implementation before Mesa's: with both installed, Mesa's surfaceless display is
  // software.
  if (const EGLDisplay display = device(true); display != EGL_NO_DISPLAY) return display;
  if (const EGLDisplay display = getDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
      works(display))
    return display;
  return device(false);
}

class EglOffscreen final : public Offscreen {
 public:
  EglOffscreen(EGLDisplay display, EGLContext context) : display_(display), context_(context) {}
  ~EglOffscreen() override {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
    target_.reset();
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    // The display is the process's own: another Offscreen may live on it, so it is not terminated.
  }
  void makeCurrent() override { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_); }
  void resize(int width, int height) override {
    if (!target_) target_ = std::make_unique<FrameBuffer>();
    target_->resize(width, height);
  }
  unsigned framebuffer() const override { return target_->id(); }

 private:
  EGLDisplay display_;
  EGLContext context_;
  std::unique_ptr<FrameBuffer> target_;
};

}  // namespace

Result<std::unique_ptr<Offscreen>> Offscreen::create(int width, int height) {
  const auto refuse = [](const std::string& expected, const std::string& found) {
    return Finding{Severity::error, "EGL", "", expected, found};
  };
  const auto error = [] {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "EGL error 0x%x", static_cast<unsigned>(eglGetError()));
    return std::string(text.data());
  };
  if (width <= 0 || height <= 0)
    return refuse("a size of at least 1 x 1", std::to_string(width) + " x " + std::to_string(height));
  const EGLDisplay display = openDisplay();
  if (display == EGL_NO_DISPLAY) return refuse("a surfaceless or device display", "none");
  if (!eglBindAPI(EGL_OPENGL_API)) return refuse("desktop OpenGL", error());
  const std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                     EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  if (!eglChooseConfig(display, wanted.data(), &config, 1, &configs) || configs == 0)
    config = EGL_NO_CONFIG_KHR;
  // Compatibility: the distribution's OpenSceneGraph uses the fixed-function matrices.
  const std::array<EGLint, 7> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                         4,
                                         EGL_CONTEXT_MINOR_VERSION,
                                         5,
                                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                         EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT,
                                         EGL_NONE};
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
  if (context == EGL_NO_CONTEXT) return refuse("an OpenGL 4.5 compatibility context", error());
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    const std::string why = error();
    eglDestroyContext(display, context);
    return refuse("a context without a surface", why);
  }
  auto offscreen = std::make_unique<EglOffscreen>(display, context);
  offscreen->resize(width, height);
  return std::unique_ptr<Offscreen>(std::move(offscreen));
}

}  // namespace trimtab::scene
