#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/harness/answer.h"

/// Says what the error of an image is that a run makes small.
namespace trimtab::tune {

/// A run has one: its samples, estimates, front and answer are all of it.
enum class ErrorKind : std::uint8_t { flip, geometric, pop };
inline constexpr std::size_t kErrorKinds = static_cast<std::size_t>(ErrorKind::pop) + 1;

struct ErrorKindRow {
  ErrorKind kind;
  std::string_view key;           ///< as the command line and plans spell it
  std::string_view words;         ///< "mean FLIP"
  std::string_view before, unit;  ///< what stands around a number
  /// The columns of its estimate, and of the ends of the band.
  const char *estimate, *estimateLow, *estimateHigh;
  double FrameError::*ofImage;
  double harness::AnswerRow::*drawn;
  double greatest;  ///< no image has more
  double unseen;    ///< a difference that nobody sees
  double size;      ///< losses are drawn at this part of the width and height
};

/// Geometric errors are drawn at the whole size, because they are told to half a pixel at best.
inline constexpr ErrorKindRow kErrorKindRows[kErrorKinds] = {
    {ErrorKind::flip, "flip", "mean FLIP", "FLIP ", "", "estimated_flip", "estimated_flip_low",
     "estimated_flip_high", &FrameError::flip, &harness::AnswerRow::flip, 1, 1e-5, 0.5},
    {ErrorKind::geometric, "geometric", "largest geometric error", "", " px", "estimated_geometric_px",
     "estimated_geometric_low_px", "estimated_geometric_high_px", &FrameError::geometricMaxPx,
     &harness::AnswerRow::geometricPx, 32, 0.01, 1},
    {ErrorKind::pop, "pop", "95th percentile of pops", "pop ", " of 255", "estimated_pop",
     "estimated_pop_low", "estimated_pop_high", &FrameError::pop, &harness::AnswerRow::pop, 255, 1e-3, 0.5},
};
constexpr const ErrorKindRow& rowOf(ErrorKind kind) {
  return kErrorKindRows[static_cast<std::size_t>(kind)];
}

/// Returns the kind of a key.
ErrorKind errorKindOf(std::string_view key);

/// Returns "FLIP 0.012", "3.1 px" or "pop 4.2 of 255".
std::string errorText(ErrorKind kind, double error);

/// Returns what the errors of a flight's images come to, the statistic that AnswerRow has: the mean FLIP, the
/// largest geometric error, the 95th percentile of the pop (by nearest rank, whatever their number).
double errorOfImages(ErrorKind kind, std::vector<double>& images);
/// Returns what the errors of several flights come to: the mean FLIP; of the others the largest, since none
/// of the flights may have more. NaN without a flight.
double errorOfFlights(ErrorKind kind, std::span<const double> flights);

/// Puts together what several levers lose in an image, each beyond the error of the image with every lever at
/// rest: as the root of the sum of squares. They hide one another, so that their sum is too much, and the
/// largest alone too little where a search makes them alike.
class Losses {
 public:
  explicit Losses(double atRest) : atRest_(atRest) {}
  /// `moved` is the error of the image with one lever moved alone.
  void add(double moved) {
    const double loss = std::max(moved - atRest_, 0.0);
    squares_ += loss * loss;
  }
  double error() const { return atRest_ + std::sqrt(squares_); }

 private:
  double atRest_, squares_ = 0;
};

/// Returns the nearest rank, whatever the number of samples, which it reorders; there is at least one.
double rankOf(std::vector<double>& samples, double fraction);

}  // namespace trimtab::tune
