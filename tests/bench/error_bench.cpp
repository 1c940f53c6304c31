#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "core/measure/image_kernels.h"
#include "row.h"
#include "tests/core/measure/flip_recorded.h"
#include "tests/core/measure/image_pairs.h"
#include "trimtab/measure/image_error.h"

/// Group `error`: what FLIP, SSIM and PSNR of two pictures cost on one core, and how far FLIP lies from the
/// reference implementation.

namespace trimtab::bench {
namespace {

using test::Picture;

constexpr int kWidth = 1280, kHeight = 720;
constexpr double kMegapixels = kWidth * kHeight * 1e-6;

/// Another level of detail, and no pixel left as it was.
Picture allDifferent(const Picture& reference) {
  Picture other = test::landscape(kWidth, kHeight, 4);
  for (std::size_t i = 0; i < other.rgba.size(); i += 4)
    if (std::memcmp(&other.rgba[i], &reference.rgba[i], 4) == 0) other.rgba[i] ^= 1;
  return other;
}

/// What a coarser level does to a frame: the terrain near the horizon changes, and nothing else.
Picture mostlyEqual(const Picture& reference) {
  Picture other = test::landscape(kWidth, kHeight, 5);
  const auto row = [](Picture& p, int y) { return p.rgba.begin() + 4 * kWidth * y; };
  Picture kept = reference;
  const int first = kHeight / 4, last = kHeight / 2;
  std::copy(row(other, first), row(other, last), row(kept, first));
  return kept;
}

double equalShare(const Picture& a, const Picture& b) {
  std::size_t equal = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4)
    if (std::memcmp(&a.rgba[i], &b.rgba[i], 4) == 0) ++equal;
  return static_cast<double>(equal) / static_cast<double>(a.rgba.size() / 4);
}

std::string percent(double share) {
  return std::to_string(std::lround(100 * share)) + " %";
}

/// A plain read of every byte.
__attribute__((target_clones("avx512f", "avx2", "default"))) std::uint64_t sumOfWords(
    const std::uint64_t* words, std::size_t count) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += words[i];
  return sum;
}

double processorSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}
/// The least of so many runs, after one that is not counted. One thread computes and nothing waits: the
/// processor's time is what one core takes, whoever else uses it meanwhile.
template <class Work>
double leastProcessorSeconds(int repeats, const Work& work) {
  work();
  double least = 0;
  for (int i = 0; i < repeats; ++i) {
    const double start = processorSeconds();
    work();
    const double took = processorSeconds() - start;
    if (i == 0 || took < least) least = took;
  }
  return least;
}

struct Speed {
  double seconds = 0, peerSeconds = 0;
};
/// The least of each, measured in turns so that both see the same machine.
template <class Ours, class Theirs>
Speed inTurns(int repeats, const Ours& ours, const Theirs& theirs) {
  Speed least;
  for (int i = 0; i < repeats; ++i) {
    const double a = leastProcessorSeconds(1, ours), b = leastProcessorSeconds(1, theirs);
    least.seconds = i == 0 ? a : std::min(least.seconds, a);
    least.peerSeconds = i == 0 ? b : std::min(least.peerSeconds, b);
  }
  return least;
}

std::vector<std::uint8_t> greenOf(const Picture& p) {
  std::vector<std::uint8_t> green;
  for (std::size_t i = 1; i < p.rgba.size(); i += 4) green.push_back(p.rgba[i]);
  return green;
}

void flipRows(Report& report, const Picture& reference, int repeats) {
  const auto rate = [&](const Picture& other) {
    std::vector<float> map(static_cast<std::size_t>(kWidth) * kHeight);
    return kMegapixels / leastProcessorSeconds(
                             repeats, [&] { keep(flip(reference.rgba, other.rgba, kWidth, kHeight, map)); });
  };
  const Picture different = allDifferent(reference), similar = mostlyEqual(reference);
  const std::string what = "FLIP of 1280x720 with its map, one core, ";
  report.add(ratioAtLeast(20, {.id = "error.flip_speed",
                               .what = what + "no pixel equal",
                               .value = rate(different),
                               .unit = "Mpixel/s",
                               .peer = "reference C++ implementation (NVlabs/flip)",
                               .peerValue = 2.8,
                               .peerFrom = "quoted"}));
  report.add(
      ratioAtLeast(20, {.id = "error.flip_typical",
                        .what = what + percent(equalShare(reference, similar)) + " of the pixels equal",
                        .value = rate(similar),
                        .unit = "Mpixel/s",
                        .peer = "reference C++ implementation (NVlabs/flip)",
                        .peerValue = 2.8,
                        .peerFrom = "quoted"}));
  for (const auto& [level, name] : {std::pair{SimdLevel::avx2, "AVX2"}, {SimdLevel::portable, "portable"}})
    if (level < simdLevel() && useSimdLevel(level))
      report.add({.id = std::string("error.flip_speed_") + (level == SimdLevel::avx2 ? "avx2" : "portable"),
                  .what = what + "no pixel equal, " + name + " instructions only",
                  .value = rate(different),
                  .unit = "Mpixel/s",
                  .peer = "reference C++ implementation (NVlabs/flip)",
                  .peerValue = 2.8,
                  .peerFrom = "quoted"});
  useSimdLevel(simdLevel());
}

void speedRows(Report& report) {
  const int repeats = report.quick() ? 5 : 40;
  const Picture reference = test::landscape(kWidth, kHeight, 7), different = allDifferent(reference);
  flipRows(report, reference, repeats);

  const auto a = greenOf(reference), b = greenOf(different);
  report.add(ratioAtLeast(
      1, {.id = "error.ssim_speed",
          .what = "SSIM of one channel of 1280x720, one core",
          .value = kMegapixels / leastProcessorSeconds(repeats, [&] { keep(ssim(a, b, kWidth, kHeight)); }),
          .unit = "Mpixel/s",
          .peer = "rmgr's SSIM library",
          .peerValue = 134,
          .peerFrom = "quoted"}));

  const auto read = [](const Picture& p) {
    return sumOfWords(reinterpret_cast<const std::uint64_t*>(p.rgba.data()), p.rgba.size() / 8);
  };
  const Speed psnr = inTurns(
      repeats, [&] { keep(psnrDb(reference.rgba, different.rgba, kWidth, kHeight)); },
      [&] { keep(read(reference) + read(different)); });
  report.add(ratioAtLeast(0.8, {.id = "error.psnr_speed",
                                .what = "PSNR of 1280x720, one core",
                                .value = kMegapixels / psnr.seconds,
                                .unit = "Mpixel/s",
                                .peer = "plain read of both pictures",
                                .peerValue = kMegapixels / psnr.peerSeconds,
                                .peerFrom = "run"}));

  const double all = leastProcessorSeconds(repeats, [&] {
    keep(flip(reference.rgba, different.rgba, kWidth, kHeight));
    keep(ssimOfLuma(reference.rgba, different.rgba, kWidth, kHeight));
    keep(psnrDb(reference.rgba, different.rgba, kWidth, kHeight));
  });
  report.add({.id = "error.frame",
              .what = "FLIP, SSIM of luma and PSNR of one frame of 1280x720, no pixel equal",
              .value = all * 1e3,
              .unit = "ms"});
}

void differenceRows(Report& report) {
  double worst = 0, worstMean = 0;
  int pixels = 0, pictures = 0;
  const auto pairs = test::picturePairs();
  for (const test::RecordedFlip& recorded : test::kRecordedFlip)
    for (const test::PicturePair& p : pairs) {
      if (p.name != recorded.pair || recorded.pixelsPerDegree != kFlipPixelsPerDegree) continue;
      std::vector<float> map(p.test.rgba.size() / 4);
      const double mean = flip(p.reference.rgba, p.test.rgba, p.test.width, p.test.height, map);
      worstMean = std::max(worstMean, std::abs(mean - recorded.mean));
      ++pictures;
      for (int i = 0; i < test::kProbes; ++i, ++pixels) {
        const auto [x, y] = test::probeOf(i, p.test);
        worst = std::max(worst, std::abs(map[static_cast<std::size_t>(y * p.test.width + x)] -
                                         recorded.atProbes[static_cast<std::size_t>(i)]));
      }
    }
  const std::string from = " from the reference implementation's";
  report.add(valueAtMost(1e-4, {.id = "error.flip_difference",
                                .what = "Largest distance of a pixel's FLIP" + from + ", " +
                                        std::to_string(pixels) + " recorded pixels",
                                .value = worst,
                                .unit = "FLIP"}));
  report.add(valueAtMost(1e-4, {.id = "error.flip_difference_mean",
                                .what = "Largest distance of a pair's mean FLIP" + from + ", " +
                                        std::to_string(pictures) + " pairs",
                                .value = worstMean,
                                .unit = "FLIP"}));
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  trimtab::bench::Report report(argc, argv);
  if (report.wants("speed")) trimtab::bench::speedRows(report);
  if (report.wants("difference")) trimtab::bench::differenceRows(report);
  return report.finish();
}
