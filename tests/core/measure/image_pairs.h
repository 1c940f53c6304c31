#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Pairs of pictures from whole-number arithmetic alone: the same bytes on every machine, so that what other
/// programs found for them can be written down as numbers.
namespace trimtab::test {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;

  Picture(int w, int h)
      : width(w), height(h), rgba(4 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  std::uint8_t* at(int x, int y) {
    return rgba.data() +
           4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

struct PicturePair {
  std::string name;
  Picture reference, test;
};

inline std::uint32_t scrambled(std::uint32_t v) {
  v = (v ^ (v >> 16)) * 0x7feb352du;
  v = (v ^ (v >> 15)) * 0x846ca68bu;
  return v ^ (v >> 16);
}
inline std::uint32_t scrambled(int x, int y, std::uint32_t seed) {
  return scrambled(static_cast<std::uint32_t>(x) * 0x9e3779b9u ^
                   scrambled(static_cast<std::uint32_t>(y) + seed * 0x85ebca6bu));
}

using Colour = std::array<int, 3>;

template <class ColourAt>
Picture picture(int width, int height, const ColourAt& colourAt) {
  Picture made(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Colour colour = colourAt(x, y);
      for (std::size_t c = 0; c < 3; ++c)
        made.at(x, y)[c] = static_cast<std::uint8_t>(std::clamp(colour[c], 0, 255));
      made.at(x, y)[3] = 255;
    }
  return made;
}

/// Noise of lattice values, linear between them: 0..255.
inline int valueNoise(int x, int y, int cell, std::uint32_t seed) {
  const int cx = x / cell, cy = y / cell, fx = x % cell, fy = y % cell;
  const auto value = [&](int i, int j) { return static_cast<int>(scrambled(i, j, seed) & 255); };
  const int top = value(cx, cy) * (cell - fx) + value(cx + 1, cy) * fx;
  const int bottom = value(cx, cy + 1) * (cell - fx) + value(cx + 1, cy + 1) * fx;
  return (top * (cell - fy) + bottom * fy) / (cell * cell);
}

/// Ridges under a sky; `octaves` of detail, so that fewer look like a coarser level.
inline Picture landscape(int width, int height, int octaves) {
  return picture(width, height, [&](int x, int y) -> Colour {
    int skyline = height / 3, shade = 0;
    for (int i = 0, cell = 64; i < octaves; ++i, cell /= 2) {
      skyline += (valueNoise(x, 0, cell, 7) - 128) * height * cell / (64 * 1200);
      shade += (valueNoise(x, y, cell, 11) - 128) * cell / 64;
    }
    if (y < skyline) return {120 + y * 80 / height, 160 + y * 60 / height, 225};
    const int far = (height - y) * 90 / height;
    return {70 + shade + far, 95 + shade * 3 / 4 + far, 50 + shade / 2 + far};
  });
}

inline std::vector<PicturePair> picturePairs() {
  std::vector<PicturePair> pairs;
  const auto add = [&](const char* name, int w, int h, const auto& a, const auto& b) {
    pairs.push_back({name, picture(w, h, a), picture(w, h, b)});
  };
  const auto noise = [](std::uint32_t seed) {
    return [seed](int x, int y) -> Colour {
      const std::uint32_t v = scrambled(x, y, seed);
      return {static_cast<int>(v & 255), static_cast<int>(v >> 8 & 255), static_cast<int>(v >> 16 & 255)};
    };
  };
  const auto flat = [](Colour c) { return [c](int, int) { return c; }; };
  const auto ramp = [](int x, int y) -> Colour { return {x * 255 / 160, y * 255 / 120, (x + y) / 2}; };

  add("noise", 97, 61, noise(1), noise(2));
  add("ramps", 161, 121, ramp, [&](int x, int y) {
    Colour c = ramp(x, y);
    for (int& v : c) v = v / 6 * 6;
    return c;
  });
  const auto lines = [](int shift) {
    return [shift](int x, int y) -> Colour {
      const int v = ((x + shift) / 9 + y / 7) % 2 ? 210 : 30;
      return (x + 2 * shift) % 37 == 0 ? Colour{250, 40, 10} : Colour{v, v, v};
    };
  };
  add("lines", 150, 90, lines(0), lines(1));
  pairs.push_back({"landscape", landscape(320, 200, 6), landscape(320, 200, 3)});
  {
    Picture a = landscape(300, 180, 6), b = a;
    for (int y = 70; y < 100; ++y)
      for (int x = 200; x < 260; ++x) b.at(x, y)[1] = static_cast<std::uint8_t>(b.at(x, y)[1] / 2);
    pairs.push_back({"patch", a, b});
  }
  {
    Picture a = landscape(211, 133, 5), b = a;
    for (int y = 0; y < b.height; ++y)
      for (int x = 0; x < b.width; ++x)
        if (scrambled(x, y, 3) % 20 == 0)
          for (std::size_t c = 0; c < 3; ++c) b.at(x, y)[c] = static_cast<std::uint8_t>(b.at(x, y)[c] ^ 1);
    pairs.push_back({"faint", a, b});
  }
  add("black-white", 40, 30, flat({0, 0, 0}), flat({255, 255, 255}));
  add("green-blue", 41, 23, flat({0, 255, 0}), flat({0, 0, 255}));
  add(
      "hues", 120, 100,
      [](int x, int y) -> Colour {
        return {x / 30 * 60, 120, y / 25 * 60};
      },
      [](int x, int y) -> Colour {
        return {y / 25 * 60, 90, x / 30 * 60};
      });
  add("one-pixel", 64, 48, flat({90, 90, 90}), [](int x, int y) -> Colour {
    return x == 20 && y == 30 ? Colour{255, 0, 0} : Colour{90, 90, 90};
  });
  add("one-by-one", 1, 1, flat({10, 200, 30}), flat({30, 180, 60}));
  add("narrow", 3, 50, noise(5), noise(6));
  add("low", 50, 2, noise(7), noise(8));
  return pairs;
}

/// A few pixels of a picture, scattered.
inline constexpr int kProbes = 6;
inline std::array<int, 2> probeOf(int index, const Picture& p) {
  return {static_cast<int>(scrambled(index, 0, 99) % static_cast<std::uint32_t>(p.width)),
          static_cast<int>(scrambled(index, 1, 99) % static_cast<std::uint32_t>(p.height))};
}

}  // namespace trimtab::test
