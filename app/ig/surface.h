#pragma once

#include <memory>

#include "trimtab/units/result.h"

namespace trimtab::ig {

/// The target of drawing: a window, or a framebuffer without a window system. Its GL context is current.
class Surface {
 public:
  virtual ~Surface() = default;
  virtual unsigned framebuffer() const = 0;
  virtual int width() const = 0;
  virtual int height() const = 0;
  /// Resizes the framebuffer for an image of this size in pixels.
  virtual void fit(int width, int height) = 0;
  /// Waits until the image is finished and, in a window, shown.
  virtual void present() = 0;
  /// Handles pending events. Returns false if the user closed the window. Sets `stale` if the image must be
  /// drawn again, after exposure or a change of size.
  virtual bool handleEvents(bool& stale) = 0;
  /// Returns a descriptor that becomes readable if there are events; -1 if there never are any.
  virtual int eventFd() const = 0;
  virtual bool hasViewer() const = 0;
};

Result<std::unique_ptr<Surface>> openWindow(int width, int height, const char* title);
Result<std::unique_ptr<Surface>> openHeadless(int width, int height);

}  // namespace trimtab::ig
