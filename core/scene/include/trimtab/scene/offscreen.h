#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab::scene {

/// Owns a GL 4.5 compatibility context without a window, and a framebuffer with RGBA8 colour and 32-bit float
/// depth. Use and destroy it on the thread that made it. The destructor leaves that thread without a context.
class Offscreen {
 public:
  /// Makes a context, makes it current on the calling thread in place of any other, and leaves its
  /// framebuffer bound. Refuses a size below 1 x 1. If the machine has no such context to offer, the finding
  /// says what is missing, with EGL's error if there is one.
  static Result<std::unique_ptr<Offscreen>> create(int width, int height);
  virtual ~Offscreen() = default;
  /// Makes the context current on the calling thread. It does not bind the framebuffer: what was bound in
  /// this context stays bound. EGL's failure is not reported.
  virtual void makeCurrent() = 0;
  /// Replaces the framebuffer by one of another size and leaves it bound. Its pixels are undefined, and
  /// framebuffer() may change. With the size that it has, nothing happens. The context must be current, and
  /// the size at least 1 x 1.
  virtual void resize(int width, int height) = 0;
  /// Returns the framebuffer's GL name.
  virtual unsigned framebuffer() const = 0;
};

/// An image of 8 bits per channel.
struct RgbaPicture {
  int widthPx = 0, heightPx = 0;
  std::vector<std::uint8_t> rgba;  ///< four bytes per pixel without gaps, the bottom row first
};
/// Reads a PNG file and converts it to RGBA; alpha is 255 if the file has none. Refuses what is not a PNG
/// file.
Result<RgbaPicture> readPng(const std::filesystem::path& file);

/// Returns the bytes of a PNG file. `rgba` is laid out as in RgbaPicture; bytes beyond the image are ignored.
/// Refuses too few bytes and a size below 1 x 1.
Result<std::string> encodePng(std::span<const std::uint8_t> rgba, int width, int height);
/// Writes the same to a file, so that there is the old file or the whole new one. Refuses as encodePng()
/// does, and if the file cannot be written.
Result<Done> writePng(const std::filesystem::path& file, std::span<const std::uint8_t> rgba, int width,
                      int height);

}  // namespace trimtab::scene
