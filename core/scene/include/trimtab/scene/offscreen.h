#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab::scene {

/// A GL compatibility context without a window system (EGL surfaceless on Mesa, device platform elsewhere)
/// with one RGBA8 framebuffer.
class Offscreen {
 public:
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
Result<RgbaPicture> readPng(const std::filesystem::path& file);

/// RGBA rows from the bottom (as GL reads them) as the bytes of a PNG.
Result<std::string> encodePng(std::span<const std::uint8_t> rgba, int width, int height);
/// The same to a file, written atomically.
Result<Done> writePng(const std::filesystem::path& file, std::span<const std::uint8_t> rgba, int width,
                      int height);

}  // namespace trimtab::scene
