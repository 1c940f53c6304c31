#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab::scene {

/// A GL compatibility context without a window system (EGL surfaceless on Mesa, device platform elsewhere)
/// with one RGBA8 framebuffer. Belongs to one thread.
class Offscreen {
 public:
  /// Makes a context and makes it current. Refuses with the EGL error if the machine has none to offer.
  static Result<std::unique_ptr<Offscreen>> create(int width, int height);
  virtual ~Offscreen() = default;
  virtual void makeCurrent() = 0;
  virtual void resize(int width, int height) = 0;
  virtual unsigned framebuffer() const = 0;
};

struct RgbaPicture {
  int widthPx = 0, heightPx = 0;
  std::vector<std::uint8_t> rgba;  ///< rows from the bottom
};
/// Reads a PNG file as RGBA.
Result<RgbaPicture> readPng(const std::filesystem::path& file);

/// Returns the bytes of a PNG of RGBA rows from the bottom, as GL reads them.
Result<std::string> encodePng(std::span<const std::uint8_t> rgba, int width, int height);
/// Writes such a PNG atomically.
Result<Done> writePng(const std::filesystem::path& file, std::span<const std::uint8_t> rgba, int width,
                      int height);

}  // namespace trimtab::scene
