#include "arithmetic.h"

#include <gdal.h>
#include <ogr_srs_api.h>

#include <array>
#include <cmath>
#include <vector>

#include "trimtab/terrain/format/store.h"

namespace trimtab::terrain {

std::string arithmeticOfThisMachine() {
  static const std::string sum = [] {
    std::vector<double> all;
    // The numbers are where the builders ask: angles, shares of one, distances in metres and their squares.
    constexpr int kNumbers = 4096;
    double share = 0.5;
    for (int i = 0; i < kNumbers; ++i) {
      share = std::fmod(share + 0.6180339887498949, 1);
      const double angle = (share - 0.5) * 7, metres = 1e-3 + 7e6 * share * share * share;
      for (const double value :
           {std::sin(angle), std::cos(angle), std::tan(angle), std::asin(2 * share - 1),
            std::atan2(share - 0.3, angle), std::exp(angle), std::exp2(8 * angle), std::log(metres),
            std::log2(metres), std::pow(share, 2.4), std::pow(share, 1 / 2.4), std::pow(metres, share),
            std::hypot(metres, 1e5 * share), std::cbrt(metres)})
        all.push_back(value);
    }
    std::array<int, 3> proj{};
    OSRGetPROJVersion(&proj[0], &proj[1], &proj[2]);
    std::string text(reinterpret_cast<const char*>(all.data()), all.size() * sizeof(double));
    text += GDALVersionInfo("RELEASE_NAME");
    for (const int part : proj) text += ' ' + std::to_string(part);
    return hexadecimal(checksum(text));
  }();
  return sum;
}

}  // namespace trimtab::terrain
