#include "trimtab/frame/frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace trimtab {
namespace {

/// A perspective's plane is infinitely far out at 90 degrees; a host that asks for more than this is ignored.
constexpr double kLargestHalfAngle = 89;

struct Span {
  double low = 0, high = 0;  ///< degrees
};

double tangent(double degrees) {
  return std::tan(degrees * (std::numbers::pi / 180));
}

/// Returns the host's half-angles if it names both, or one beside the preset's other; the preset's if they
/// make no view.
Span halfAngles(Degrees field, const std::optional<Degrees>& low, const std::optional<Degrees>& high) {
  const Span preset{-field.value() / 2, field.value() / 2};
  const Span asked{low ? low->value() : preset.low, high ? high->value() : preset.high};
  const bool usable =
      asked.low >= -kLargestHalfAngle && asked.high <= kLargestHalfAngle && asked.low < asked.high;
  return usable ? asked : preset;
}

int pixels(Pixels value) {
  constexpr double kLargest = std::numeric_limits<int>::max();
  return static_cast<int>(std::clamp(std::round(value.value()), 1.0, kLargest));
}

}  // namespace

double pixelsPerRadian(const ViewShape& view) {
  return std::max(view.widthPx / (view.right - view.left), view.heightPx / (view.top - view.bottom));
}

ViewShape scaledShape(ViewShape view, double scale) {
  if (!(scale > 0 && scale < 1)) return view;
  // Even numbers have a middle between two pixels, which a guard band needs.
  const auto scaled = [scale](int size) {
    return std::max(2 * static_cast<int>(std::lround(size * scale / 2)), 2);
  };
  view.widthPx = scaled(view.widthPx);
  view.heightPx = scaled(view.heightPx);
  return view;
}

ViewShape filledShape(ViewShape view) {
  const double wider =
      double(view.widthPx) / view.heightPx * (view.top - view.bottom) / (view.right - view.left);
  if (!(wider > 0 && std::isfinite(wider))) return view;
  if (wider > 1) {
    view.left *= wider;
    view.right *= wider;
  } else {
    view.bottom /= wider;
    view.top /= wider;
  }
  return view;
}

ViewShape viewShape(const ViewParameters& parameters, int windowWidthPx, int windowHeightPx,
                    const std::optional<HostView>& host) {
  const HostView asked = parameters.source == ViewSource::host && host ? *host : HostView{};
  const Span horizontal = halfAngles(parameters.horizontalFov, asked.left, asked.right);
  const Span vertical = halfAngles(parameters.verticalFov, asked.bottom, asked.top);

  ViewShape shape;
  shape.left = tangent(horizontal.low);
  shape.right = tangent(horizontal.high);
  shape.bottom = tangent(vertical.low);
  shape.top = tangent(vertical.high);
  shape.nearM = parameters.nearDistance.value();
  if (asked.nearDistance && std::isfinite(asked.nearDistance->value()) && asked.nearDistance->value() > 0)
    shape.nearM = asked.nearDistance->value();
  const bool fixed = parameters.renderSize == RenderSize::fixed;
  shape.widthPx = fixed ? pixels(parameters.width) : std::max(windowWidthPx, 1);
  shape.heightPx = fixed ? pixels(parameters.height) : std::max(windowHeightPx, 1);
  return shape;
}

}  // namespace trimtab
