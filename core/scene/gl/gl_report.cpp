#include <algorithm>

#include "gl_api.h"
#include "multi_draw.h"
#include "trimtab/scene/gl_report.h"

namespace trimtab::scene {

bool contextIsSoftware() {
  const auto* bytes = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string renderer(bytes ? bytes : "");
  for (const char* software : {"llvmpipe", "softpipe", "swrast", "SWR", "Software"})
    if (renderer.find(software) != std::string::npos) return true;
  return false;
}

GlReport reportContext() {
  GlReport report;
  const auto text = [](GLenum name) {
    const auto* bytes = reinterpret_cast<const char*>(glGetString(name));
    return std::string(bytes ? bytes : "");
  };
  report.version = text(GL_VERSION);
  if (report.version.empty()) {
    report.missing = "a current OpenGL context";
    return report;
  }
  report.vendor = text(GL_VENDOR);
  report.renderer = text(GL_RENDERER);
  report.software = contextIsSoftware();

  const auto misses = [&report](const char* what) {
    report.missing += (report.missing.empty() ? "" : "; ") + std::string(what);
  };
  GLint major = 0, minor = 0, profile = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  if (major < 4 || (major == 4 && minor < 5)) misses("OpenGL 4.5 (clip control, texture buffers, GLSL 4.30)");
  if (major > 3 || (major == 3 && minor > 1)) {
    glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    if (!(profile & GL_CONTEXT_COMPATIBILITY_PROFILE_BIT)) misses("the compatibility profile");
  }
  while (glGetError() != GL_NO_ERROR) {
  }
  report.usable = report.missing.empty();
  if (report.usable) report.drawing = drawChoiceOfContext().reason;
  return report;
}

int subpixelBitsOfContext() {
  constexpr GLint kLeast = 4;
  GLint bits = 0;
  glGetIntegerv(GL_SUBPIXEL_BITS, &bits);
  return std::max(kLeast, bits);
}

}  // namespace trimtab::scene
