#include "heat_colour.h"

#include <algorithm>
#include <cmath>

namespace trimtab::harness {
namespace {

struct Stop {
  double at;
  std::array<double, 3> colour;
};
constexpr std::array<Stop, 6> kStops{{{0.0, {0, 0, 0}},
                                      {0.15, {24, 38, 92}},
                                      {0.4, {60, 92, 148}},
                                      {0.65, {196, 118, 70}},
                                      {0.85, {244, 176, 64}},
                                      {1.0, {255, 246, 186}}}};

}  // namespace

std::array<std::uint8_t, 3> heatColour(double error) {
  const double place = error > 0 ? std::sqrt(std::min(error, 1.0)) : 0;
  std::size_t i = 1;
  while (i + 1 < kStops.size() && place > kStops[i].at) ++i;
  const Stop &a = kStops[i - 1], &b = kStops[i];
  const double t = (place - a.at) / (b.at - a.at);
  std::array<std::uint8_t, 3> colour{};
  for (std::size_t c = 0; c < colour.size(); ++c)
    colour[c] = static_cast<std::uint8_t>(std::lround(std::lerp(a.colour[c], b.colour[c], t)));
  return colour;
}

std::vector<std::uint8_t> heatPixels(std::span<const float> errors) {
  std::vector<std::uint8_t> pixels;
  pixels.reserve(errors.size() * 4);
  for (const float error : errors) {
    const auto colour = heatColour(double{error});
    pixels.insert(pixels.end(), {colour[0], colour[1], colour[2], 255});
  }
  return pixels;
}

}  // namespace trimtab::harness
