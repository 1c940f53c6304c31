#include "census.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

constexpr double kLowest = -11500, kBinMetres = 50;
/// A number that nothing comes nearer to, metres, is no ground: the shore of a lake, or the foot of a wall,
/// has posts between. The sea has cliffs that are higher than a lake's, and a level top may be higher still.
constexpr double kVoidGap = 300, kSeaGap = 500, kTopGap = 2000;
/// So many posts have a number that is no spike by its name.
constexpr std::uint64_t kSpikePosts = 4;
/// Neighbours in a sea differ by less, metres.
constexpr float kCalm = 500;
/// Impossible numbers that are remembered one by one; of these, so many may mean voids.
constexpr std::size_t kStrange = 256, kStrangeVoids = 8;
/// A file with a larger share of impossible numbers that are no voids is refused.
constexpr double kMostImpossible = 0.1;

std::size_t binOf(float metres) {
  const double bin = (static_cast<double>(metres) - kLowest) / kBinMetres;
  return static_cast<std::size_t>(std::clamp(bin, 0.0, 419.0));
}

std::optional<std::size_t> voidNumber(float raw) {
  const auto* const number = std::find(kVoidNumbers.begin(), kVoidNumbers.end(), raw);
  if (number == kVoidNumbers.end()) return {};
  return static_cast<std::size_t>(number - kVoidNumbers.begin());
}

/// A height before anything is judged: neither tagged, nor one of kVoidNumbers, nor impossible.
bool isHeight(float raw, const Values& values, float& metres) {
  metres = metresOf(raw, values);
  return isPossible(metres) && !isTagged(raw, values) && !voidNumber(raw);
}

void count(std::map<float, std::uint64_t>& end, float raw, bool lowest, std::size_t most) {
  if (end.size() == most) {
    const float limit = lowest ? std::prev(end.end())->first : end.begin()->first;
    if (lowest ? raw > limit : raw < limit) return;
  }
  ++end[raw];
  if (end.size() > most) end.erase(lowest ? std::prev(end.end()) : end.begin());
}

}  // namespace

void Census::addHeight(float raw, float metres) {
  ++bins_[binOf(metres)];
  if (heights_++ == 0) origin_ = static_cast<double>(metres);
  const double from = static_cast<double>(metres) - origin_;
  sum_ += from, squares_ += from * from;
  count(low_, raw, true, kEnds);
  count(high_, raw, false, kEnds);
  for (std::size_t k = 0; k < kVoidNumbers.size(); ++k)
    if (kVoidNumbers[k] > 0 ? raw >= 0.9f * kVoidNumbers[k] : raw <= 0.9f * kVoidNumbers[k])
      ++numbers_[k].like;
}

void Census::addImpossible(float raw, const Values& values) {
  ++impossible_;
  if (isAbsurd(metresOf(raw, values))) ++absurd_;
  if (const auto found = strange_.find(raw); found != strange_.end())
    ++found->second;
  else if (strange_.size() < kStrange)
    strange_.emplace(raw, 1);
  if (raw < -32768 || raw > 65535 || raw != std::floor(raw)) return;
  const auto bits = static_cast<std::uint16_t>(static_cast<std::int32_t>(raw));
  const auto swapped = std::bit_cast<std::int16_t>(static_cast<std::uint16_t>(bits << 8 | bits >> 8));
  if (isPossible(metresOf(swapped, values))) ++swappable_;
}

void Census::add(std::span<const float> raw, std::size_t columns, const Values& values) {
  posts_ += raw.size();
  bool deep = false;
  for (const float v : raw) {
    if (isTagged(v, values)) {
      ++tagged_;
      continue;
    }
    if (const auto number = voidNumber(v)) {
      ++numbers_[*number].posts;
      continue;
    }
    const float metres = metresOf(v, values);
    if (!isPossible(metres)) {
      addImpossible(v, values);
      continue;
    }
    addHeight(v, metres);
    deep = deep || isDeep(metres);
  }
  addSteps(raw, columns, values);
  if (deep) addDepths(raw, columns, values);
}

void Census::addSteps(std::span<const float> raw, std::size_t columns, const Values& values) {
  for (std::size_t row = 0; row + columns <= raw.size(); row += columns) {
    float before = 0, here = 0;
    bool was = isHeight(raw[row], values, before);
    for (std::size_t c = 1; c < columns; ++c, before = here) {
      const bool is = isHeight(raw[row + c], values, here);
      if (was && is) {
        const float step = std::abs(here - before);
        ++steps_, stepSum_ += static_cast<double>(step);
        if (step > 180) ++turns_;
      }
      was = is;
    }
  }
}

/// A post under 500 m below the sea continues its neighbours if it is within kCalm of all that are heights.
void Census::addDepths(std::span<const float> raw, std::size_t columns, const Values& values) {
  for (std::size_t i = 0; i < raw.size(); ++i) {
    float metres = 0;
    if (!isHeight(raw[i], values, metres) || !isDeep(metres)) continue;
    bool calm = true;
    const auto compare = [&](std::size_t at) {
      float other = 0;
      if (isHeight(raw[at], values, other) && std::abs(other - metres) > kCalm) calm = false;
    };
    if (i % columns > 0) compare(i - 1);
    if (i % columns + 1 < columns) compare(i + 1);
    if (i >= columns) compare(i - columns);
    if (i + columns < raw.size()) compare(i + columns);
    if (calm) ++calm_[binOf(metres)];
  }
}

double Census::gapToBulk(double metres) const {
  if (heights_ == 0) return std::numeric_limits<double>::infinity();
  const auto hundredth = static_cast<std::uint64_t>(static_cast<double>(heights_) / 100);
  std::uint64_t below = 0, above = 0;
  std::size_t first = 0, last = kBins - 1;
  while (first < kBins && below + bins_[first] <= hundredth) below += bins_[first++];
  while (last > 0 && above + bins_[last] <= hundredth) above += bins_[last--];
  const double lowest = kLowest + static_cast<double>(first) * kBinMetres,
               highest = kLowest + static_cast<double>(last + 1) * kBinMetres;
  return std::max({lowest - metres, metres - highest, 0.0});
}

bool Census::isListedVoid(std::size_t number, const Values& values) const {
  const auto& [posts, like] = numbers_[number];
  if (posts == 0) return false;
  const float metres = metresOf(kVoidNumbers[number], values);
  if (!isPossible(metres)) return true;
  // Where the band names its no-data value, another number has to stand far from the ground as well.
  return like < posts && (!values.noData || gapToBulk(static_cast<double>(metres)) >= kVoidGap);
}

/// Numbers at the ends that are far from all others, one after the other.
void Census::judgeEnds(Values& values, std::vector<std::pair<float, std::uint64_t>>& voids) {
  std::uint64_t left = heights_;
  const auto isSpike = [&](const End::value_type& end, float next, double gap) {
    const double found = std::abs(static_cast<double>(metresOf(end.first, values)) -
                                  static_cast<double>(metresOf(next, values)));
    // Most of a file is no spike: level land beside a few voids.
    return end.second >= kSpikePosts && found >= gap && 2 * end.second < left;
  };
  const auto take = [&](const End::value_type& end) {
    const float number = end.first;
    voids.push_back(end);
    left -= end.second;
    low_.erase(number), high_.erase(number);
  };
  while (low_.size() > 1 && isSpike(*low_.begin(), std::next(low_.begin())->first,
                                    low_.begin()->first == 0 ? kSeaGap : kVoidGap))
    take(*low_.begin());
  while (high_.size() > 1 && isSpike(*high_.rbegin(), std::next(high_.rbegin())->first, kTopGap))
    take(*high_.rbegin());
  for (const auto& [number, posts] : voids) bins_[binOf(metresOf(number, values))] -= posts;
}

/// Keeps depths down to the deepest at which most posts continue their neighbours. What lies below is a
/// mixture of voids and ground, which resampling makes.
void Census::judgeDepths(Values& values, std::vector<std::pair<float, std::uint64_t>>& voids) {
  std::size_t deepest = binOf(-500);
  for (std::size_t bin = 0; bin < deepest; ++bin)
    if (bins_[bin] > 0 && 2 * calm_[bin] >= bins_[bin]) deepest = bin;
  const double limit = kLowest + static_cast<double>(deepest) * kBinMetres;
  std::uint64_t under = 0;
  for (std::size_t bin = 0; bin < deepest; ++bin) under += bins_[bin];
  if (under == 0) return;
  values.deepest = static_cast<float>(limit);
  voids.emplace_back(std::numeric_limits<float>::quiet_NaN(), under);
}

void Census::judge(Values& values) {
  values.voids.clear();
  values.deepest = -std::numeric_limits<float>::infinity();
  std::vector<std::pair<float, std::uint64_t>> voids;
  judgeEnds(values, voids);
  for (std::size_t k = 0; k < kVoidNumbers.size(); ++k)
    if (isListedVoid(k, values)) voids.emplace_back(kVoidNumbers[k], numbers_[k].posts);
  for (const auto& [number, posts] : voids) values.voids.push_back(number);
  if (!voids.empty() || absurd_ > 0) judgeDepths(values, voids);
  // A number of the list that is a depth, and lies below all depths that are kept.
  for (std::size_t k = 0; k < kVoidNumbers.size(); ++k)
    if (numbers_[k].posts > 0 && metresOf(kVoidNumbers[k], values) < values.deepest &&
        std::find(values.voids.begin(), values.voids.end(), kVoidNumbers[k]) == values.voids.end())
      voids.emplace_back(kVoidNumbers[k], numbers_[k].posts);
  untagged_ = impossible_;
  for (const auto& [number, posts] : voids) {
    untagged_ += posts;
    told_ += (told_.empty() ? "" : ", ") + std::to_string(posts) +
             (std::isnan(number) ? " deeper than " + numberText(static_cast<double>(values.deepest), 6) + " m"
                                 : " of " + numberText(static_cast<double>(number), 9));
  }
}

std::optional<std::string> Census::impossible() const {
  std::vector<std::uint64_t> counts;
  for (const auto& [number, posts] : strange_)
    if (posts >= kSpikePosts) counts.push_back(posts);
  std::sort(counts.rbegin(), counts.rend());
  std::uint64_t scattered = impossible_;
  for (std::size_t k = 0; k < std::min(counts.size(), kStrangeVoids); ++k) scattered -= counts[k];
  const std::uint64_t all = posts_ - tagged_;
  if (all == 0 || static_cast<double>(scattered) <= kMostImpossible * static_cast<double>(all)) return {};
  const bool swapped = static_cast<double>(swappable_) > 0.95 * static_cast<double>(impossible_);
  return numberText(100.0 * static_cast<double>(impossible_) / static_cast<double>(all), 3) +
         " % of the numbers outside that" +
         (swapped ? "; with their two bytes exchanged they are inside: the file has the wrong byte order"
                  : "; perhaps the wrong byte order, or heights in another unit than the file says");
}

HeightShape Census::shape(const Values& values) const {
  HeightShape shape;
  if (heights_ == 0) return shape;
  const auto n = static_cast<double>(heights_);
  shape.heights = heights_, shape.steps = steps_;
  shape.deviation = std::sqrt(std::max(0.0, squares_ / n - sum_ / n * (sum_ / n)));
  if (steps_ > 0) shape.step = stepSum_ / static_cast<double>(steps_);
  if (steps_ > 0) shape.turns = static_cast<double>(turns_) / static_cast<double>(steps_);
  if (low_.empty() || high_.empty()) return shape;
  const float one = metresOf(low_.begin()->first, values),
              other = metresOf(std::prev(high_.end())->first, values);
  shape.lowest = static_cast<double>(std::min(one, other));
  shape.highest = static_cast<double>(std::max(one, other));
  return shape;
}

}  // namespace trimtab::terrain
