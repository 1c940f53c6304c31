#include "textures.h"

#include <algorithm>
#include <cmath>

#include "checked_mesh.h"

namespace trimtab::terrain {

namespace {

using Colour = std::array<std::uint8_t, 4>;

/// A sum of colours, each weighted by its share and its opacity.
struct ColourSum {
  double red = 0, green = 0, blue = 0, opacity = 0, weight = 0;

  void add(const std::uint8_t* rgba, double share) {
    const double seen = share * rgba[3];
    red += seen * rgba[0];
    green += seen * rgba[1];
    blue += seen * rgba[2];
    opacity += seen;
    weight += share;
  }
  Colour mean() const {
    if (!(opacity > 0)) return {255, 255, 255, 0};
    const auto byte = [](double v) {
      return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 255.0)));
    };
    return {byte(red / opacity), byte(green / opacity), byte(blue / opacity), byte(opacity / weight)};
  }
};

/// What one texel covers of a side of the source: pixels, and the share of each.
struct Cover {
  std::uint32_t first = 0;
  std::vector<double> share;
};
std::vector<Cover> coversOf(std::uint32_t pixels) {
  constexpr std::uint32_t kSide = ObjectTexture::kSidePx;
  std::vector<Cover> covers(kSide);
  const double step = double{static_cast<double>(pixels)} / kSide;
  for (std::uint32_t i = 0; i < kSide; ++i) {
    // At least one pixel wide, so that a small image is enlarged smoothly.
    const double half = std::max(step, 1.0) / 2, middle = (i + 0.5) * step;
    const double from = std::clamp(middle - half, 0.0, pixels - 1e-9),
                 to = std::min(middle + half, double(pixels));
    covers[i].first = static_cast<std::uint32_t>(from);
    for (std::uint32_t p = covers[i].first; p < to; ++p)
      covers[i].share.push_back(std::max(std::min(to, p + 1.0) - std::max(from, double(p)), 0.0));
  }
  return covers;
}

}  // namespace

ObjectTexture scaledTexture(const SourceTexture& source) {
  constexpr std::uint32_t kSide = ObjectTexture::kSidePx;
  ObjectTexture texture{std::vector<std::uint8_t>(std::size_t{4} * kSide * kSide, 255)};
  const std::size_t pixels = std::size_t{source.width} * source.height;
  if (pixels == 0 || source.pixels.size() != pixels * 4) return texture;
  const std::vector<Cover> columns = coversOf(source.width), rows = coversOf(source.height);
  std::uint8_t* out = texture.pixels.data();
  for (const Cover& row : rows)
    for (const Cover& column : columns) {
      ColourSum sum;
      for (std::size_t r = 0; r < row.share.size(); ++r)
        for (std::size_t c = 0; c < column.share.size(); ++c)
          sum.add(&source.pixels[4 * (std::size_t{row.first + r} * source.width + column.first + c)],
                  row.share[r] * column.share[c]);
      const Colour mean = sum.mean();
      out = std::copy(mean.begin(), mean.end(), out);
    }
  return texture;
}

Colour meanColour(const ObjectTexture& texture) {
  ColourSum sum;
  for (std::size_t i = 0; i + 3 < texture.pixels.size(); i += 4) sum.add(&texture.pixels[i], 1);
  return sum.mean();
}

Colour product(const Colour& a, const Colour& b) {
  Colour both;
  for (std::size_t i = 0; i < both.size(); ++i)
    both[i] = static_cast<std::uint8_t>((a[i] * b[i] + 127) / 255);
  return both;
}

Colour meanColour(const SourceMesh& mesh, const std::vector<Colour>& textures) {
  ColourSum sum;
  for (std::size_t t = 0; t < mesh.triangles(); ++t) {
    const std::array<float, 3> n = faceNormal(mesh, t);
    const double area = std::hypot(double{n[0]}, double{n[1]}, double{n[2]});
    for (std::size_t k = 3 * t; k < 3 * t + 3; ++k) {
      const SourceVertex& v = mesh.vertices[mesh.indices[k]];
      const bool textured = v.texture != SourceVertex::kNoTexture;
      sum.add((textured ? product(v.colour, textures[v.texture]) : v.colour).data(), area);
    }
  }
  Colour mean = sum.mean();
  mean[3] = 255;
  return mean;
}

}  // namespace trimtab::terrain
