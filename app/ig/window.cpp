#include <GL/gl.h>
#include <GL/glx.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/keysym.h>

#include <cstdlib>
#include <string>

#include "surface.h"

namespace trimtab::ig {
namespace {

Finding refused(const std::string& expected, const std::string& found) {
  return {Severity::error, "window", {}, expected, found + " (--headless draws without a window)"};
}

/// An X11 window with a GLX context. The legacy call gives the compatibility profile that OpenSceneGraph
/// needs.
class Window : public Surface {
 public:
  explicit Window(Display* display) : display_(display) {}
  ~Window() override {
    if (context_) {
      glXMakeCurrent(display_, None, nullptr);
      glXDestroyContext(display_, context_);
    }
    if (window_) XDestroyWindow(display_, window_);
    if (colormap_) XFreeColormap(display_, colormap_);
    XCloseDisplay(display_);
  }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Returns an empty text if all is there; else what is not.
  std::string create(int width, int height, const char* title) {
    int attributes[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_RED_SIZE, 8, GLX_GREEN_SIZE, 8, GLX_BLUE_SIZE, 8,
                        None};
    XVisualInfo* visual = glXChooseVisual(display_, DefaultScreen(display_), attributes);
    if (!visual) return "no double-buffered RGB visual";
    const ::Window root = RootWindow(display_, visual->screen);
    colormap_ = XCreateColormap(display_, root, visual->visual, AllocNone);
    XSetWindowAttributes set{};
    set.colormap = colormap_;
    set.event_mask = ExposureMask | StructureNotifyMask | KeyPressMask;
    width_ = width;
    height_ = height;
    window_ = XCreateWindow(display_, root, 0, 0, static_cast<unsigned>(width), static_cast<unsigned>(height),
                            0, visual->depth, InputOutput, visual->visual, CWColormap | CWEventMask, &set);
    closeMessage_ = XInternAtom(display_, "WM_DELETE_WINDOW", False);
    XSetWMProtocols(display_, window_, &closeMessage_, 1);
    XStoreName(display_, window_, title);
    context_ = glXCreateContext(display_, visual, nullptr, True);
    XFree(visual);
    if (!context_) return "no GLX context";
    XMapWindow(display_, window_);
    if (!glXMakeCurrent(display_, window_, context_)) return "a GLX context that cannot be made current";
    return {};
  }

  unsigned framebuffer() const override { return 0; }
  int width() const override { return width_; }
  int height() const override { return height_; }
  void fit(int width, int height) override {
    // Each size is asked for once: a window manager that refuses must not be asked for ever.
    if ((width == width_ && height == height_) || (width == askedWidth_ && height == askedHeight_)) return;
    askedWidth_ = width;
    askedHeight_ = height;
    XResizeWindow(display_, window_, static_cast<unsigned>(width), static_cast<unsigned>(height));
  }
  void present() override {
    glXSwapBuffers(display_, window_);
    glFinish();
  }
  bool handleEvents(bool& stale) override {
    bool open = true;
    while (XPending(display_) > 0) {
      XEvent event{};
      XNextEvent(display_, &event);
      switch (event.type) {
        case Expose:
          stale = true;
          break;
        case ConfigureNotify:
          stale |= event.xconfigure.width != width_ || event.xconfigure.height != height_;
          width_ = event.xconfigure.width;
          height_ = event.xconfigure.height;
          break;
        case KeyPress: {
          const KeySym key = XLookupKeysym(&event.xkey, 0);
          if (key == XK_Escape || key == XK_q) open = false;
          break;
        }
        case ClientMessage:
          if (static_cast<Atom>(event.xclient.data.l[0]) == closeMessage_) open = false;
          break;
        default:
          break;
      }
    }
    return open;
  }
  int eventFd() const override { return ConnectionNumber(display_); }
  bool hasViewer() const override { return true; }

 private:
  Display* display_;
  ::Window window_ = 0;
  Colormap colormap_ = 0;
  GLXContext context_ = nullptr;
  Atom closeMessage_ = 0;
  int width_ = 0, height_ = 0, askedWidth_ = 0, askedHeight_ = 0;
};

}  // namespace

Result<std::unique_ptr<Surface>> openWindow(int width, int height, const char* title) {
  Display* display = XOpenDisplay(nullptr);
  if (!display) {
    const char* name = std::getenv("DISPLAY");
    return refused("an X display",
                   name && *name ? std::string("none that answers at DISPLAY=") + name : "no DISPLAY");
  }
  auto window = std::make_unique<Window>(display);
  if (const std::string missing = window->create(width, height, title); !missing.empty())
    return refused("OpenGL on the X display", missing);
  return {std::move(window)};
}

}  // namespace trimtab::ig
