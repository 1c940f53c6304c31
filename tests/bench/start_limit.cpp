// The least that any start must do: an OpenGL context without a window system, and the terrain's bytes in
// memory. Prints the time (CLOCK_REALTIME, seconds) when both are there. Argument: the database folder.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <time.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto platformDisplay =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (!platformDisplay) return 1;
  EGLDisplay display = platformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY) display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  const EGLint attributes[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config{};
  EGLint count = 0;
  if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API) ||
      !eglChooseConfig(display, attributes, &config, 1, &count) || count == 0)
    return 1;
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
  if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
    return 1;
  glFinish();

  std::vector<std::vector<char>> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[1])) {
    if (!entry.is_regular_file()) continue;
    files.emplace_back(entry.file_size());
    std::ifstream(entry.path(), std::ios::binary)
        .read(files.back().data(), static_cast<std::streamsize>(files.back().size()));
  }
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  std::printf("%.6f\n", static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec));
  return 0;
}
