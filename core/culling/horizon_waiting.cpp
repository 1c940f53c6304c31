#include "horizon_geometry.h"
#include "trimtab/culling/horizon.h"

/// Lines that wait until a test needs them. The bounds kept here are estimates that only decide whether a
/// line is read; the proof does not depend on them.
namespace trimtab {

using namespace horizon;

namespace {

/// Lines that reach above the needed w by less than this share of it, and by less than kLeastRise, are not
/// read. One in five of them would prove it, and they were half of all lines that were read 1,500 m above
/// rough ground.
constexpr float kLeastShare = 0.03f, kLeastRise = 0.003f;

}  // namespace

void Horizon::awaitLines(const Outline& outline) {
  Prism prism = outline;
  if (outline.lines > 0) {
    const bool rows = runsInRows(outline),
               forwards = rows ? prism.y0 + prism.y1 > 0 : prism.x0 + prism.x1 > 0;
    float &near = rows ? prism.y0 : prism.x0, &far = rows ? prism.y1 : prism.x1;
    const float inset = outline.inset * (far - near);
    near += inset;
    far -= inset;
    (rows ? prism.x1 : prism.y1) += outline.goOn * (rows ? prism.x1 - prism.x0 : prism.y1 - prism.y0);
    prism.top = outline.lineTop;
    await({.tile = outline.tile,
           .ring = 0,
           .line = forwards ? 0 : outline.lines - 1,
           .count = outline.lines,
           .step = forwards ? 1 : -1},
          prism, outline.nearest);
    return;
  }
  const HorizonTile& tile = tiles_[outline.tile];
  const auto from = fromEye(eye_, tile.mesh->origin);
  Waiting line{.tile = outline.tile, .ring = 0, .line = 0, .count = 1, .step = 1};
  for (const Box& b : tile.mesh->lineBox) {
    prism = prismOf(b, from);
    prism.top -= tile.below;
    await(line, prism, outline.nearest);
    ++line.line;
  }
}

/// Enters lines that lie within a prism.
void Horizon::await(const Waiting& lines, const Prism& prism, float nearest) {
  for (int side = 0; side < kSides; ++side) {
    const TurnedBox b = turned(side, prism.x0, prism.x1, prism.y0, prism.y1);
    if (!meets(b)) continue;
    Waiting here = lines;
    // Lines that are too near to be projected may raise every column.
    int first = 0, last = columns_ - 1;
    float top = std::numeric_limits<float>::max();
    if (b.f0 > nearest) {
      const BoxImage image(b, prism.top);
      if (image.t0 > 1 || image.t1 < -1) continue;
      first = columnOf(image.t0);
      last = columnOf(image.t1);
      top = image.w;
      const float beside = std::max(-b.l0, b.l1);
      here.ring = ringOf(std::sqrt(b.f0 * b.f0 + beside * beside));
    }
    float* awaited = awaited_.data() + at(side, 0);
    for (int column = first; column <= last; ++column) awaited[column] = std::max(awaited[column], top);
    for (int n = first >> binShift_; n <= last >> binShift_; ++n) {
      auto& bin = bins_[static_cast<std::size_t>(side * binsEach_ + n)];
      bin.push_back({.top = top,
                     .topSoFar = bin.empty() ? top : std::max(bin.back().topSoFar, top),
                     .first = static_cast<std::int16_t>(first),
                     .last = static_cast<std::int16_t>(last),
                     .waiting = static_cast<std::uint32_t>(waiting_.size())});
    }
    waiting_.push_back(here);
  }
}

/// Returns whether the profile is above w in a column, after reading lines that may raise it so far. Reads
/// the lines that came last first, because ground mostly rises towards its crest, and the lines before the
/// crest are then not needed.
bool Horizon::lift(int side, int column, float w) {
  const float& reached = profile_[at(side, column)];
  if (reached > w) return true;
  float& awaited = awaited_[at(side, column)];
  const float worth = w + std::min(kLeastShare * std::abs(w), kLeastRise);
  if (!(awaited > worth)) return false;
  const auto number = static_cast<std::size_t>(side * binsEach_ + (column >> binShift_));
  const auto& bin = bins_[number];
  bool any = false;
  float stays = worth;
  for (std::size_t k = bin.size(); k-- > 0 && bin[k].topSoFar > worth && !(reached > w);) {
    const Raiser& raiser = bin[k];
    if (!(raiser.top > worth && raiser.first <= column && column <= raiser.last)) continue;
    Waiting& lines = waiting_[raiser.waiting];
    if (lines.count > 0 && lines.ring < progress_.ring) any = look(lines, side) || any;
    if (lines.count > 0) stays = std::max(stays, raiser.top);
  }
  if (any) tidy(number);
  if (reached > w) return true;
  awaited = stays;
  return false;
}

/// Removes entries of a bin that are done, or that are no higher than all of the bin's columns.
void Horizon::tidy(std::size_t number) {
  auto& bin = bins_[number];
  const int side = static_cast<int>(number) / binsEach_,
            first = static_cast<int>(number) % binsEach_ << binShift_;
  const float* profile = profile_.data() + at(side, 0);
  const float floor =
      *std::min_element(profile + first, profile + std::min(first + (1 << binShift_), columns_));
  std::size_t kept = 0;
  float topSoFar = kNowhere;
  for (Raiser raiser : bin) {
    if (!(raiser.top > floor) || waiting_[raiser.waiting].count == 0) continue;
    raiser.topSoFar = topSoFar = std::max(topSoFar, raiser.top);
    bin[kept++] = raiser;
  }
  bin.resize(kept);
}

/// Reads all lines that may raise a bin's columns and are nearer than the tile being tested.
void Horizon::lookAtAll(std::size_t number) {
  const auto& bin = bins_[number];
  const int side = static_cast<int>(number) / binsEach_,
            first = static_cast<int>(number) % binsEach_ << binShift_,
            last = std::min(first + (1 << binShift_), columns_) - 1;
  const Kernels& kernel = *kernels_;
  for (std::size_t k = bin.size(); k-- > 0;) {
    const Raiser& raiser = bin[k];
    Waiting& lines = waiting_[raiser.waiting];
    if (lines.count == 0 || lines.ring >= progress_.ring) continue;
    const int from = std::max(first, int{raiser.first}), count = std::min(last, int{raiser.last}) - from + 1;
    if (kernel.firstNotAbove(profile_.data() + at(side, from), count, raiser.top) < count) look(lines, side);
  }
}

/// Raises the profile to those lines that are wholly nearer than the tile being tested. Returns whether there
/// was one.
bool Horizon::look(Waiting& waiting, int side) {
  const Lines lines = linesOf(tiles_[waiting.tile], outlines_[waiting.tile]);
  bool any = false;
  for (; waiting.count > 0; --waiting.count, waiting.line += waiting.step) {
    take(lines, waiting.line);
    waiting.ring = ringOfLine(lines.besideM);
    if (waiting.ring >= progress_.ring) break;
    ++progress_.work;
    raiseLine(side, lines.besideM, lines.nearest);
    any = true;
  }
  return any;
}

}  // namespace trimtab
