#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab::scene {

/// Owns a windowless GL compatibility context and its RGBA8 framebuffer. Only one thread may use it. `resize`
/// needs it current and changes framebuffer().
class Offscreen {
 public:
  /// Makes a context and makes it current. Refuses with the EGL error if the machine has none to offer.
  static Result<std::unique_ptr<Offscreen>> create(int width, int height);
  virtual ~Offscreen() = default;
  /// Makes the context current on the calling thread; the framebuffer is not bound.
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

/// Encodes packed RGBA rows, bottom row first. It refuses too few bytes.
Result<std::string> encodePng(std::span<const std::uint8_t> rgba, int width, int height);
/// Writes such a PNG atomically.
Result<Done> writePng(const std::filesystem::path& file, std::span<const std::uint8_t> rgba, int width,
                      int height);

}  // namespace trimtab::scene
