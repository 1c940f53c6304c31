#pragma once

/// What documents A and B print (published/*.csv), as printed.
namespace trimtab::test {

/// A membership with as many decimals as the paper has.
struct Printed {
  double x;
  const char* membership;
};
/// Table 1: feet above the ground, and degrees of pitch.
inline constexpr Printed kPrintedAltitude[] = {
    {4000, "1.0"},   {4010, "0.996"}, {5000, "0.600"}, {5010, "0.597"}, {6000, "0.300"},
    {6010, "0.298"}, {7000, "0.1"},   {7010, "0.099"}, {7990, "0.001"}, {8000, "0.0"}};
inline constexpr Printed kPrintedPitch[] = {{30, "0"},     {29, "0.017"},  {1, "0.493"}, {0, "0.5"},
                                            {-1, "0.507"}, {-29, "0.983"}, {-30, "1.0"}};

/// Table 2: the band of the sum of memberships, and the size of its depth map.
struct PrintedBand {
  double high, low;
  int width, height;
};
inline constexpr PrintedBand kPrintedBands[] = {
    {2.0, 1.5, 800, 600}, {1.5, 1.0, 640, 480}, {1.0, 0.5, 400, 300}, {0.5, 0.1, 320, 240}};

}  // namespace trimtab::test
