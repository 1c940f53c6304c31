#include "scale_up_pass.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "core/scene/gl/frame_buffer.h"
#include "core/scene/gl/gl_api.h"

namespace trimtab::scene {
namespace {

constexpr std::size_t kChannels = 4;
constexpr std::size_t kNoRow = std::numeric_limits<std::size_t>::max();

std::size_t bytesOf(const FrameBuffer& image) {
  return kChannels * static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
}

/// Returns where the middle of pixel i of `to` lies among the middles of `from` pixels over the same length.
double placeOf(int i, int to, int from) {
  return std::clamp((i + 0.5) * from / to - 0.5, 0.0, from - 1.0);
}

void blend(const std::uint16_t* first, const std::uint16_t* second, std::uint16_t weight,
           std::vector<std::uint8_t>::iterator mixed, std::size_t count) {
  const auto rest = static_cast<std::uint16_t>(65535 - weight);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t a = std::uint32_t{first[i]} * rest >> 16, b = std::uint32_t{second[i]} * weight >> 16;
    mixed[static_cast<std::ptrdiff_t>(i)] =
        static_cast<std::uint8_t>(static_cast<std::uint16_t>(a + b + 128) >> 8);
  }
}

}  // namespace

void ScaleUpPass::draw(const FrameBuffer& from, const FrameBuffer& to) {
  if (software_) return interpolate(from, to);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to.id());
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, from.width(), from.height(), 0, 0, to.width(), to.height(), GL_COLOR_BUFFER_BIT,
                    GL_LINEAR);
}

void ScaleUpPass::interpolate(const FrameBuffer& from, const FrameBuffer& to) {
  // The last column reads one pixel past its row, with weight 0, so the buffer has one more.
  small_.resize(bytesOf(from) + kChannels);
  large_.resize(bytesOf(to));
  from.readPixels(small_.data());
  place(from, to);
  stretchedRow_ = {kNoRow, kNoRow};
  const std::size_t fromBytes = kChannels * static_cast<std::size_t>(from.width()),
                    toBytes = kChannels * columns_.size();
  auto mixed = large_.begin();
  for (const Row& row : rows_) {
    blend(stretched(row.first, fromBytes), stretched(row.second, fromBytes), row.weight, mixed, toBytes);
    mixed += static_cast<std::ptrdiff_t>(toBytes);
  }
  to.writePixels(large_.data());
}

void ScaleUpPass::place(const FrameBuffer& from, const FrameBuffer& to) {
  const std::array sizes{from.width(), from.height(), to.width(), to.height()};
  if (std::exchange(placed_, sizes) == sizes) return;
  columns_.clear();
  rows_.clear();
  for (int x = 0; x < to.width(); ++x) {
    const double at = placeOf(x, to.width(), from.width()), first = std::floor(at);
    const auto b = static_cast<std::uint16_t>(std::lround(256 * (at - first)));
    const auto a = static_cast<std::uint16_t>(256 - b);
    columns_.push_back({kChannels * static_cast<std::size_t>(first), Words{a, a, a, a, b, b, b, b}});
  }
  for (int y = 0; y < to.height(); ++y) {
    const double at = placeOf(y, to.height(), from.height()), first = std::floor(at);
    rows_.push_back({static_cast<std::size_t>(first), static_cast<std::size_t>(std::ceil(at)),
                     static_cast<std::uint16_t>(std::lround(65535 * (at - first)))});
  }
}

/// Returns a row of the small image, which has so many bytes, at the width of the large one.
const std::uint16_t* ScaleUpPass::stretched(std::size_t row, std::size_t bytes) {
  std::vector<std::uint16_t>& to = stretched_[row % 2];
  if (std::exchange(stretchedRow_[row % 2], row) == row) return to.data();
  to.resize(kChannels * columns_.size());
  const std::uint8_t* from = small_.data() + row * bytes;
  std::uint16_t* next = to.data();
  for (const Column& column : columns_) {
    std::uint8_t __attribute__((vector_size(2 * kChannels))) two;
    std::memcpy(&two, from + column.offset, sizeof two);
    Words mixed = __builtin_convertvector(two, Words) * column.weights;
    mixed += __builtin_shufflevector(mixed, mixed, 4, 5, 6, 7, 0, 1, 2, 3);
    std::memcpy(next, &mixed, kChannels * sizeof *next);
    next += kChannels;
  }
  return to.data();
}

}  // namespace trimtab::scene
