#pragma once

#include <memory>

#include "trimtab/units/result.h"

namespace trimtab::ig {

/// What is drawn on: a window, or a framebuffer without a window system. Its GL context is current.
class Surface {
 public:
  virtual ~Surface() = default;
  virtual unsigned framebuffer() const = 0;
  virtual int width() const = 0;
  virtual int height() const = 0;
  /// Makes room for a picture of this size.
  virtual void fit(int width, int height) = 0;
  /// Returns when the picture is finished (and, in a window, shown).
  virtual void present() = 0;
  /// False when the user closed the window. Exposure and a new size set `stale`: the picture has to be drawn
  /// again.
  virtual bool handleEvents(bool& stale) = 0;
  /// Becomes readable when there are events; -1 when there never are.
  virtual int eventFd() const = 0;
  virtual bool hasViewer() const = 0;
};

Result<std::unique_ptr<Surface>> openWindow(int width, int height, const char* title);
Result<std::unique_ptr<Surface>> openHeadless(int width, int height);

}  // namespace trimtab::ig
