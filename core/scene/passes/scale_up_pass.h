#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace trimtab::scene {

class FrameBuffer;

/// Scales an image up, with colours interpolated between the middles of its pixels (bilinear). On a GPU this
/// is one blit. With a software rasteriser the processor interpolates, to within a grey level: to 1280 x 720,
/// the blit takes 2.3 to 3.3 times as long on two cores, and 50 ms more at the first image and at the first
/// whose width is a power of two, because its shaders are compiled then.
class ScaleUpPass {
 public:
  explicit ScaleUpPass(bool softwareRasteriser) : software_(softwareRasteriser) {}

  /// Fills `to` with `from`. Both need at least one pixel. What framebuffers are bound then is undefined.
  void draw(const FrameBuffer& from, const FrameBuffer& to);

 private:
  using Words = std::uint16_t __attribute__((vector_size(16)));
  /// A column of the large image: the two pixels of a row of the small one that it lies between, as the
  /// offset of the first in bytes, and their weights channel by channel, of 256.
  struct Column {
    std::size_t offset;
    Words weights;
  };
  /// A row of the large image: the two rows that it lies between, and the weight of the second, of 65,535.
  struct Row {
    std::size_t first, second;
    std::uint16_t weight;
  };
  void interpolate(const FrameBuffer& from, const FrameBuffer& to);
  void place(const FrameBuffer& from, const FrameBuffer& to);
  const std::uint16_t* stretched(std::size_t row, std::size_t bytes);

  bool software_;
  std::array<int, 4> placed_{};  ///< the sizes that columns_ and rows_ are for
  std::vector<std::uint8_t> small_, large_;
  std::vector<Column> columns_;
  std::vector<Row> rows_;
  /// The last even and the last odd row of the small image at the width of the large one, times 256.
  std::array<std::vector<std::uint16_t>, 2> stretched_;
  std::array<std::size_t, 2> stretchedRow_{};
};

}  // namespace trimtab::scene
