#include "horizon_geometry.h"
#include "trimtab/culling/horizon.h"

/// Raises the profile of the horizon to the lines of tiles.
namespace trimtab {

using namespace horizon;

Horizon::Lines Horizon::linesOf(const HorizonTile& tile, const Outline& outline) const {
  Lines l{};
  l.from = fromEye(eye_, tile.surface()->origin);
  l.below = tile.below;
  l.nearest = outline.nearest;
  if (!tile.relief) {
    l.mesh = tile.mesh;
    l.besideM = tile.mesh->besideM;
    return l;
  }
  const TileRelief& relief = *tile.relief;
  const bool rows = runsInRows(outline);
  l.side = relief.side;
  l.besideM = relief.besideM;
  const auto first = static_cast<std::size_t>(rows ? 0 : relief.lines / 2);
  l.xyz = relief.lineXyz.data() + first * 3 * static_cast<std::size_t>(relief.side);
  const TileRelief* next = rows ? tile.east : tile.north;
  if (next && next->lines == relief.lines && next->side == relief.side) {
    l.goOn = next->goOn.data() + first * 3 * TileRelief::kGoOn;
    l.goOnFrom = fromEye(eye_, next->origin);
  }
  return l;
}

/// Copies a line's corners, relative to the eye and lowered, into the working arrays.
void Horizon::take(const Lines& lines, int line) {
  const auto copy = [&](const float* x, const float* y, const float* z) {
    const float left = lines.from[0], back = lines.from[1], down = lines.from[2] - lines.below;
    for (int k = 0; k < corners_; ++k) x_.data()[k] = x[k] + left;
    for (int k = 0; k < corners_; ++k) y_.data()[k] = y[k] + back;
    for (int k = 0; k < corners_; ++k) z_.data()[k] = z[k] + down;
    last_ = corners_ - 1;
  };
  if (lines.mesh) {
    const MeshRelief& mesh = *lines.mesh;
    const std::uint32_t first = mesh.lineFirst[static_cast<std::size_t>(line)],
                        end = mesh.lineFirst[static_cast<std::size_t>(line) + 1];
    corners_ = static_cast<int>(end - first);
    copy(mesh.lineX.data() + first, mesh.lineY.data() + first, mesh.lineZ.data() + first);
    return;
  }
  corners_ = lines.side;
  const float* xyz = lines.xyz + 3 * line * lines.side;
  copy(xyz, xyz + lines.side, xyz + 2 * lines.side);
  if (!lines.goOn) return;
  const float* on = lines.goOn + 3 * TileRelief::kGoOn * line;
  for (int k = 0; k < TileRelief::kGoOn; ++k, on += 3) {
    const auto to = static_cast<std::size_t>(corners_++);
    x_[to] = on[0] + lines.goOnFrom[0];
    y_[to] = on[1] + lines.goOnFrom[1];
    z_[to] = on[2] + lines.goOnFrom[2] - lines.below;
  }
}

/// Returns the ring within which all of the current line lies, with a margin for the depth buffer's rounding.
/// No corner up to `last_` lies further than `besideM` beside the chord from the first to that corner.
std::uint32_t Horizon::ringOfLine(float besideM) const {
  const auto squared = [this](int k) {
    const auto i = static_cast<std::size_t>(k);
    return x_[i] * x_[i] + y_[i] * y_[i];
  };
  float furthest = squared(0);
  for (int k = last_; k < corners_; ++k) furthest = std::max(furthest, squared(k));
  return ringOf((std::sqrt(furthest) + besideM) * (1 + 2e-5f) + 0.02f);
}

/// Raises the profile of a quarter to the current line. Corners nearer than `nearest` do not count.
void Horizon::raiseLine(int side, float besideM, float nearest) {
  const Kernels& kernel = *kernels_;
  kernel.project(projectionOf(side, x_.data(), y_.data(), z_.data(), perT_), corners_, forward_.data(),
                 u_.data(), w_.data());
  const float *u = u_.data(), *forward = forward_.data();
  // Most lines are far away and straight.
  float nearestM = forward[0];
  for (int k = last_; k < corners_; ++k) nearestM = std::min(nearestM, forward[k]);
  nearestM -= besideM;
  if (const int trend = kernel.trend(u, corners_); trend != 0 && nearestM > nearest) {
    raiseRun(side, 0, corners_, trend > 0, nearestM);
    return;
  }
  const auto usable = [&](int k) { return forward[k] > nearest; };
  for (int k = 0; k + 1 < corners_;) {
    if (!usable(k) || !usable(k + 1)) {
      ++k;
      continue;
    }
    const bool rises = u[k + 1] >= u[k];
    int end = k + 1;
    while (end + 1 < corners_ && usable(end + 1) && (u[end + 1] >= u[end]) == rises) ++end;
    raiseRun(side, k, end - k + 1, rises, *std::min_element(forward + k, forward + end + 1));
    k = end;
  }
}

/// Raises the profile to a run of corners along which u only rises, or only falls.
void Horizon::raiseRun(int side, int from, int count, bool rises, float nearestM) {
  const Kernels& kernel = *kernels_;
  const Play& play = play_[static_cast<std::size_t>(side)];
  const float* u = u_.data() + from;
  float* w = w_.data() + from;
  int width = 1;
  if (play.forwards > 0 || play.upwards > 0 || play.side != 0) {
    const float inverse = 1 / (nearestM - play.forwards);
    kernel.lower(w, count, play.upwards, play.forwards, inverse);
    const float t0 = u[0] / perT_ - 1, t1 = u[count - 1] / perT_ - 1;
    const float most = std::max(play.across(t0), play.across(t1)),
                least = (play.side - t0 * play.along) * (play.side - t1 * play.along) > 0
                            ? std::min(play.across(t0), play.across(t1))
                            : 0;
    const float around = play.radius * std::sqrt(1 + std::max(t0 * t0, t1 * t1));
    // Parts are widened by the shift at their own t, which is not quite the line's.
    const float beside =
        (most + around) * inverse * (1 + play.forwards * (1 / kFarM)) - (least + play.radius) * (1 / kFarM);
    // The profile takes the lowest value within so many columns to either side.
    if (beside > 0) width += 2 * static_cast<int>(std::ceil(std::min(beside * 1.0001f, 2.0f) * perT_));
  }
  int first = 0;
  const int step = rises ? 1 : -1, start = rises ? 0 : count - 1;
  int columns = settings_.raised ? reach<true>(u + start, w + start, count, step, width / 2, first)
                                 : reach<false>(u + start, w + start, count, step, width / 2, first);
  if (columns < width) return;
  float* reached = reached_.data();
  if (width > 1) {
    kernel.erode(reached, columns, width);
    columns -= width - 1;
    first += (width - 1) / 2;
  }
  kernel.raise(profile_.data() + side * columns_ + first, reached, columns);
}

/// Fills reached_ with what a run of corners, `step` apart in the arrays and with rising u, reaches in each
/// column that it runs through, from `beside` columns before the quarter to as many after it. Returns their
/// number and sets `first`.
template <bool Raised>
int Horizon::reach(const float* u, const float* w, int count, int step, int beside, int& first) {
  const auto worse = [](float a, float b) { return Raised ? std::max(a, b) : std::min(a, b); };
  const float last = u[(count - 1) * step];
  const int begin = -beside, most = columns_ + beside;
  if (!(last >= static_cast<float>(begin)) || !(u[0] <= static_cast<float>(most))) return 0;
  // The next boundary between columns that the run crosses.
  int column = u[0] <= static_cast<float>(begin) ? begin : static_cast<int>(std::ceil(u[0]));
  first = Raised ? std::max(column - 1, begin) : column;
  float* reached = reached_.data();
  bool started = Raised && column > begin;
  float least = w[0];
  for (int i = 0; i + 1 < count; ++i) {
    const float ua = u[i * step], wa = w[i * step], ub = u[(i + 1) * step], wb = w[(i + 1) * step];
    if (static_cast<float>(column) <= ub && column <= most) {
      const float rise = ub > ua ? (wb - wa) / (ub - ua) : 0;
      const float low = std::min(wa, wb), high = std::max(wa, wb);
      for (; static_cast<float>(column) <= ub && column <= most; ++column) {
        const float at = std::clamp(wa + (static_cast<float>(column) - ua) * rise, low, high);
        if (started) *reached++ = worse(least, at);
        least = at;
        started = true;
      }
    }
    least = worse(least, wb);
  }
  if (Raised && started && column <= most) *reached++ = least;
  return static_cast<int>(reached - reached_.data());
}

}  // namespace trimtab
