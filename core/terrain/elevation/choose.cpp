#include "choose.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

/// Files whose areas have less than this in common, of the smaller, are not compared.
constexpr double kCommonArea = 0.05;
/// Posts a side at which two files are compared, and how many must have heights in both.
constexpr std::uint32_t kSide = 24;
constexpr std::size_t kFewest = 30;
/// Surfaces and grounds of the same place, and seas of different datums, differ by less, metres.
constexpr double kLikely = 50;
constexpr std::size_t kMostCompared = 1000, kMostWarned = 12;
/// A file is left out for another for which so many points more speak.
constexpr int kClear = 2;

using File = std::unique_ptr<ElevationFile>;

/// The grid on which two files are compared; none if they have no place in common.
std::optional<PostGrid> common(const PostGrid& a, const PostGrid& b) {
  const auto east = [](const PostGrid& p) { return p.longitude(p.columns - 1); };
  const auto north = [](const PostGrid& p) { return p.latitude(p.rows - 1); };
  const double west = std::max(a.west, b.west), south = std::max(a.south, b.south),
               width = std::min(east(a), east(b)) - west, height = std::min(north(a), north(b)) - south;
  const auto area = [&](const PostGrid& p) { return (east(p) - p.west) * (north(p) - p.south); };
  if (width <= 0 || height <= 0 || width * height < kCommonArea * std::min(area(a), area(b))) return {};
  PostGrid grid;
  grid.stepLongitude = width / kSide, grid.stepLatitude = height / kSide;
  grid.west = west + grid.stepLongitude / 2, grid.south = south + grid.stepLatitude / 2;
  grid.columns = grid.rows = kSide;
  return grid;
}

/// All heights of a file at the posts of a small grid, NaN where it has none; empty if it cannot be read.
std::vector<float> heightsOn(ElevationFile& file, const PostGrid& grid) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> all(grid.size(), kNone);
  if (!file.placeOn(grid, ElevationFile::Sampling::points)) return {};
  ElevationFile::Room room;
  std::vector<float> row(file.columns());
  std::vector<std::uint8_t> reached(grid.columns);
  std::vector<Continued> continued;
  for (std::uint32_t r = 0; r < grid.rows; ++r) {
    if (!file.reaches(r, 1)) continue;
    if (!file.read(r, 1, row, reached, continued, room)) return {};
    std::copy(row.begin(), row.end(),
              all.begin() + static_cast<std::ptrdiff_t>(std::size_t{r} * grid.columns + file.firstColumn()));
  }
  file.close();
  return all;
}

/// How far two files differ and how far the ground rises where both have heights, metres: means of the
/// differences, and of the distances from the mean height.
struct Contrast {
  double difference = 0, relief = 0;
};

std::optional<Contrast> contrastOf(ElevationFile& a, ElevationFile& b) {
  const auto grid = common(a.posts(), b.posts());
  if (!grid) return {};
  const std::vector<float> one = heightsOn(a, *grid), two = heightsOn(b, *grid);
  if (one.empty() || two.empty()) return {};
  const auto both = [&](const auto& add) {
    for (std::size_t i = 0; i < one.size(); ++i)
      if (!std::isnan(one[i]) && !std::isnan(two[i]))
        add(static_cast<double>(one[i]), static_cast<double>(two[i]));
  };
  std::size_t count = 0;
  double meanOne = 0, meanTwo = 0, reliefOne = 0, reliefTwo = 0;
  Contrast contrast;
  both([&](double x, double y) {
    ++count, meanOne += x, meanTwo += y, contrast.difference += std::abs(x - y);
  });
  if (count < kFewest) return {};
  const auto n = static_cast<double>(count);
  meanOne /= n, meanTwo /= n, contrast.difference /= n;
  both([&](double x, double y) { reliefOne += std::abs(x - meanOne), reliefTwo += std::abs(y - meanTwo); });
  contrast.relief = std::max(reliefOne, reliefTwo) / n;
  return contrast;
}

bool isOneSet(const ElevationFile& a, const ElevationFile& b) {
  return a.evidence().form == b.evidence().form &&
         std::abs(std::log(a.posts().stepLatitude / b.posts().stepLatitude)) < 0.01;
}

void leaveOut(const ElevationFile& file, const std::string& why, Findings& findings) {
  findings.push_back({Severity::note, file.name(), "", "elevation",
                      "something else: " + why + "; left out (name the file itself to use it)"});
}

/// Files that are something else by themselves. A level tile of a set looks like nothing; it stays with its
/// neighbours.
void leaveOthers(std::vector<File>& files, const std::set<std::string>& found, Findings& findings) {
  const auto isOther = [&](const File& file) {
    return found.contains(file->name()) && file->evidence().isOther();
  };
  const auto others =
      std::stable_partition(files.begin(), files.end(), [&](const File& f) { return !isOther(f); });
  const std::size_t kept = static_cast<std::size_t>(others - files.begin());
  std::vector<File> chosen;
  for (std::size_t k = 0; k < files.size(); ++k) {
    ElevationFile& file = *files[k];
    const Evidence& evidence = file.evidence();
    const auto end = files.begin() + static_cast<std::ptrdiff_t>(kept);
    const bool belongs =
        k < kept ||
        (evidence.declared >= 0 &&
         std::any_of(files.begin(), end, [&](const File& one) { return one && isOneSet(*one, file); }) &&
         std::none_of(files.begin(), end,
                      [&](const File& one) { return one && common(one->posts(), file.posts()); }));
    if (!belongs)
      leaveOut(file, evidence.against, findings);
    else if (evidence.isOther())
      findings.push_back({Severity::warning, file.name(), "", "elevation",
                          "something else by its looks: " + evidence.against +
                              (found.contains(file.name()) ? "; taken with its neighbours"
                                                           : "; taken because it was named")});
    if (!belongs) files[k].reset();
  }
  std::erase(files, nullptr);
}

}  // namespace

bool chooseElevation(std::vector<File>& files, const std::set<std::string>& found, const Progress& progress,
                     Findings& findings) {
  leaveOthers(files, found, findings);
  std::size_t compared = 0, warned = 0;
  for (std::size_t i = 0; i < files.size(); ++i)
    for (std::size_t j = i + 1; j < files.size() && files[i]; ++j) {
      if (!files[j] || !common(files[i]->posts(), files[j]->posts())) continue;
      if (progress && !progress(1, "comparing files")) return false;
      if (++compared > kMostCompared) continue;
      const auto contrast = contrastOf(*files[i], *files[j]);
      if (!contrast || contrast->difference <= std::max(contrast->relief, kLikely)) continue;
      const std::string by = numberText(contrast->difference, 3) + " m on average, where the relief is " +
                             numberText(contrast->relief, 3) + " m";
      const bool less = files[i]->evidence().score() < files[j]->evidence().score();
      File &weak = less ? files[i] : files[j], &strong = less ? files[j] : files[i];
      const Evidence& against = weak->evidence();
      // Heights that are smooth, or say of themselves that they are heights, are not left out by points
      // alone.
      const int lead = strong->evidence().score() - against.score();
      const bool unsaid = against.declared <= 1 && against.numbers <= 0;
      if (found.contains(weak->name()) &&
          ((against.score() <= 0 && lead >= kClear) || (unsaid && lead >= 2 * kClear))) {
        leaveOut(*weak,
                 "it contradicts " + strong->name() + " by " + by + ", and less speaks for it" +
                     (against.against.empty() ? "" : " (" + against.against + ")"),
                 findings);
        weak.reset();
      } else if (++warned <= kMostWarned) {
        findings.push_back({Severity::warning, files[i]->name(), "",
                            "heights like those of " + files[j]->name() + " at the same place",
                            "a difference of " + by + "; one of the two may be something else"});
      }
    }
  std::erase(files, nullptr);
  if (compared > kMostCompared || warned > kMostWarned)
    findings.push_back({Severity::warning, "elevation", "", "files that agree",
                        std::to_string(std::max(warned, kMostWarned) - kMostWarned) +
                            " contradictions more, and " +
                            std::to_string(std::max(compared, kMostCompared) - kMostCompared) +
                            " pairs of files that were not compared"});
  return true;
}

}  // namespace trimtab::terrain
