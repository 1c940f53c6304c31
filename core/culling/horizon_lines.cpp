#include "trimtab/culling/horizon.h"
#include "trimtab/culling/horizon_geometry.h"
#include "trimtab/culling/horizon_kernels.h"

/// How lines get into the profile.
namespace trimtab {

using namespace horizon;

/// Takes up a line of the tile in hand; how many corners.
int Horizon::take(const float* x, const float* y, const float* z, int count, float below) {
  const float left = offset_[0], back = offset_[1], down = offset_[2] - below;
  for (int k = 0; k < count; ++k) x_.data()[k] = x[k] + left;
  for (int k = 0; k < count; ++k) y_.data()[k] = y[k] + back;
  for (int k = 0; k < count; ++k) z_.data()[k] = z[k] + down;
  return count;
}

/// Where all of the line in hand is nearer, by more than the depth buffer's rounding. `besideM`: no corner
/// up to the one `last` is further than that from the way between it and the first.
std::uint32_t Horizon::ringOfLine(int last, int count, float besideM) const {
  const auto squared = [this](int k) {
    const auto i = static_cast<std::size_t>(k);
    return x_[i] * x_[i] + y_[i] * y_[i];
  };
  float furthest = squared(0);
  for (int k = last; k < count; ++k) furthest = std::max(furthest, squared(k));
  return ringOf((std::sqrt(furthest) + besideM) * (1 + 2e-5f) + 0.02f);
}

void Horizon::enqueueLines(const MeshRelief& mesh, float below) {
  for (std::size_t line = 0; line < mesh.lines(); ++line) {
    const std::uint32_t first = mesh.lineFirst[line];
    const int count = take(mesh.lineX.data() + first, mesh.lineY.data() + first, mesh.lineZ.data() + first,
                           std::min(static_cast<int>(mesh.lineFirst[line + 1] - first), kMostCorners), below);
    enqueueLine(count - 1, count, mesh.besideM);
  }
}

void Horizon::enqueueLines(const Lines& lines) {
  offset_ = lines.from;
  const float *xyz = lines.xyz, *on = lines.goOn;
  for (int line = 0; line < lines.count; ++line, xyz += 3 * lines.side) {
    int count = take(xyz, xyz + lines.side, xyz + 2 * lines.side, lines.side, lines.below);
    for (int k = 0; on && k < TileRelief::kGoOn; ++k, on += 3) {
      const auto to = static_cast<std::size_t>(count++);
      x_[to] = on[0] + lines.goOnFrom[0];
      y_[to] = on[1] + lines.goOnFrom[1];
      z_[to] = on[2] + lines.goOnFrom[2] - lines.below;
    }
    enqueueLine(lines.side - 1, count, lines.besideM);
  }
}

void Horizon::enqueueLine(int last, int count, float besideM) {
  work_ += 1;
  const std::uint32_t ring = ringOfLine(last, count, besideM);
  const auto [x0, x1] = std::minmax(x_[0], x_[static_cast<std::size_t>(count - 1)]);
  const auto [y0, y1] = std::minmax(y_[0], y_[static_cast<std::size_t>(count - 1)]);
  const Kernels& kernel = kernels(settings_.simd);
  for (int side = 0; side < kSides; ++side) {
    if (!meets(turned(side, x0, x1, y0, y1))) continue;
    const bool turn = side % 2 != 0;
    kernel.project({turn ? y_.data() : x_.data(), turn ? x_.data() : y_.data(), z_.data(),
                    side < 2 ? 1.0f : -1.0f, side == 0 || side == 3 ? 1.0f : -1.0f, perT_},
                   count, forward_.data(), u_.data(), w_.data());
    const float *u = u_.data(), *forward = forward_.data();
    // Mostly the line is far away and straight.
    float nearestM = forward[0];
    for (int k = last; k < count; ++k) nearestM = std::min(nearestM, forward[k]);
    nearestM -= besideM;
    if (const int trend = kernel.trend(u, count); trend != 0 && nearestM > nearest_) {
      enqueueRun(ring, side, 0, count, trend > 0, nearestM);
      continue;
    }
    const auto usable = [&](int k) { return forward[k] > nearest_; };
    for (int k = 0; k + 1 < count;) {
      if (!usable(k) || !usable(k + 1)) {
        ++k;
        continue;
      }
      const bool rises = u[k + 1] >= u[k];
      int end = k + 1;
      while (end + 1 < count && usable(end + 1) && (u[end + 1] >= u[end]) == rises) ++end;
      enqueueRun(ring, side, k, end - k + 1, rises, *std::min_element(forward + k, forward + end + 1));
      k = end;
    }
  }
}

/// Corners along which u rises, or falls all along.
void Horizon::enqueueRun(std::uint32_t ring, int side, int from, int count, bool rises, float nearestM) {
  const Kernels& kernel = kernels(settings_.simd);
  const Play& play = play_[static_cast<std::size_t>(side)];
  const float* u = u_.data() + from;
  float* w = w_.data() + from;
  int width = 1;
  if (play.forwards > 0) {
    const float inverse = 1 / (nearestM - play.forwards);
    kernel.lower(w, count, play.upwards, play.forwards, inverse);
    const float t0 = u[0] / perT_ - 1, t1 = u[count - 1] / perT_ - 1;
    const float most = std::max(play.across(t0), play.across(t1)),
                least = (play.side - t0 * play.along) * (play.side - t1 * play.along) > 0
                            ? std::min(play.across(t0), play.across(t1))
                            : 0;
    const float around = play.radius * std::sqrt(1 + std::max(t0 * t0, t1 * t1));
    // Parts are tested wider by what the play is at their own t, which is not quite that of the line.
    const float beside =
        (most + around) * inverse * (1 + play.forwards * (1 / kFarM)) - (least + play.radius) * (1 / kFarM);
    // Of columns to either side.
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
  // What is not above the horizon already needs not wait.
  const float* horizon = profile_.data() + side * columns_ + first;
  while (columns > 0 && !(reached[columns - 1] > horizon[columns - 1])) --columns;
  int skip = 0;
  while (skip < columns && !(reached[skip] > horizon[skip])) ++skip;
  if (skip == columns) return;
  pieces_.push_back({.column = static_cast<std::uint32_t>(side * columns_ + first + skip),
                     .first = static_cast<std::uint32_t>(pool_.size()),
                     .next = firstPiece_[ring],
                     .count = columns - skip});
  firstPiece_[ring] = static_cast<std::uint32_t>(pieces_.size() - 1);
  pool_.insert(pool_.end(), reached + skip, reached + columns);
}

/// What a run of corners, `step` apart in the arrays, along which u rises, reaches in the columns that it
/// runs through, from `beside` of them before the quarter to as many after it: fills reached_; their number,
/// and which is the first.
template <bool Raised>
int Horizon::reach(const float* u, const float* w, int count, int step, int beside, int& first) {
  const auto worse = [](float a, float b) { return Raised ? std::max(a, b) : std::min(a, b); };
  const float last = u[(count - 1) * step];
  const int begin = -beside, most = columns_ + beside;
  if (!(last >= static_cast<float>(begin)) || !(u[0] <= static_cast<float>(most))) return 0;
  // The next column's side to be crossed.
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

void Horizon::flush(std::uint32_t ring) {
  const Kernels& kernel = kernels(settings_.simd);
  for (std::uint32_t n = firstPiece_[ring]; n != 0xffffffffu; n = pieces_[n].next)
    kernel.raise(profile_.data() + pieces_[n].column, pool_.data() + pieces_[n].first, pieces_[n].count);
}

}  // namespace trimtab
