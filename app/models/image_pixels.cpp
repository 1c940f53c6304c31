#include "app/models/image_pixels.h"

#include <algorithm>
#include <cmath>

namespace trimtab::models {

std::optional<terrain::SourceTexture> pixelsOf(const osg::Image& image) {
  constexpr unsigned kMostSide = 1024;
  if (image.s() <= 0 || image.t() <= 0 || image.data() == nullptr || image.isCompressed()) return {};
  const auto columns = static_cast<unsigned>(image.s()), rows = static_cast<unsigned>(image.t());
  const unsigned block = (std::max(columns, rows) + kMostSide - 1) / kMostSide;
  terrain::SourceTexture texture{(columns + block - 1) / block, (rows + block - 1) / block, {}};
  texture.pixels.reserve(std::size_t{4} * texture.width * texture.height);
  const bool fromTop = image.getOrigin() == osg::Image::TOP_LEFT;
  for (unsigned y = 0; y < texture.height; ++y)
    for (unsigned x = 0; x < texture.width; ++x) {
      osg::Vec4 sum;
      float seen = 0, count = 0;
      for (unsigned r = y * block; r < std::min((y + 1) * block, rows); ++r)
        for (unsigned c = x * block; c < std::min((x + 1) * block, columns); ++c) {
          const osg::Vec4 colour = image.getColor(c, fromTop ? rows - 1 - r : r);
          sum += osg::Vec4(colour.r(), colour.g(), colour.b(), 0) * colour.a();
          seen += colour.a();
          count += 1;
        }
      if (seen > 0) sum /= seen;
      sum.a() = seen / count;
      for (unsigned k = 0; k < 4; ++k)
        texture.pixels.push_back(
            static_cast<std::uint8_t>(std::lround(std::clamp(sum[k], 0.0f, 1.0f) * 255)));
    }
  return texture;
}

}  // namespace trimtab::models
