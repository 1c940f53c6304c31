#include <cmath>
#include <regex>

#include "rasters.h"
#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::terrain {
namespace {

namespace fs = std::filesystem;

/// What becomes of every file of the data folders when it is given to a bake.
struct Kind {
  const char* pattern;  ///< of the path; the first that fits counts
  const char* says;     ///< why it is refused; null: it opens
};
const Kind kKinds[] = {
    {R"(\.hgt$|\.dt[01]$)", nullptr},
    {R"(craterlake-elev.*\.tif$)", nullptr},
    {R"(elev\d\d_.*\.tif$|mt_.*_90m\.tif$|bigtujunga\.tif$)", nullptr},
    {R"(/3056443\.stg$)", "a tile that is there"},
    {R"(\.btg$|\.btg\.gz$|\.stg$)", nullptr},
    {R"(imagery.*\.tif$|_rgb_.*\.tif$)", "an image"},
    {R"(NaturalEarthII/.*\.(jpg|xml)$|blue-marble\.jpg$|natural-earth.*\.png$)", "an image"},
    {R"(earth-topology\.png$)", "where the raster is on earth"},
    {R"(\.pcap$)", "a capture of packets"},
    {R"(\.(txt|md|csv|xml|dirindex|repo|three-globe)$|/LICENSE[^/]*$)", "text, not recognized as a raster"},
};

/// Opens it as a bake would, and reads it through.
Findings open(const fs::path& file, bool& opened) {
  opened = false;
  if (isScenery(file)) {
    if (file.extension() == ".stg") {
      const auto files = sceneryFiles(file);
      opened = files.ok();
      return files.findings();
    }
    const auto mesh = readBtg(file);
    opened = mesh.ok() && mesh->trianglesInFile > 0;
    return mesh.findings();
  }
  const auto source = openElevation(std::span(&file, 1));
  if (!source) return source.findings();
  const PostGrid& posts = (*source)->posts();
  std::vector<float> row(posts.columns);
  std::size_t heights = 0;
  for (std::uint32_t r = 0; r < posts.rows; ++r) {
    if (auto read = (*source)->readRows(r, 1, row); !read) return read.findings();
    for (const float h : row)
      if (!std::isnan(h)) {
        EXPECT_GT(h, -500) << file;
        EXPECT_LT(h, 8900) << file;
        ++heights;
      }
  }
  opened = heights > posts.size() / 2;
  return source.findings();
}

TEST(AllFiles, openOrAreRefusedForAReasonThatAPersonUnderstands) {
  TRIMTAB_NEEDS_SHARED("data");
  std::vector<fs::path> files;
  for (const char* folder : {"data", "captures"})
    if (fs::exists(test::sharedDir() / folder))
      for (const auto& entry : fs::recursive_directory_iterator(test::sharedDir() / folder))
        // The files of a CDB say what they are by where they lie in it; alone they are no source.
        if (entry.is_regular_file() && entry.path().string().find("/data/cdb-") == std::string::npos)
          files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_FALSE(files.empty());
  std::vector<std::size_t> met(std::size(kKinds), 0);
  for (const fs::path& file : files) {
    const auto kind = std::find_if(std::begin(kKinds), std::end(kKinds), [&](const Kind& k) {
      return std::regex_search(file.string(), std::regex(k.pattern));
    });
    ASSERT_NE(kind, std::end(kKinds)) << file << ": what should become of it?";
    ++met[static_cast<std::size_t>(kind - std::begin(kKinds))];
    bool opened = false;
    const Findings findings = open(file, opened);
    const std::string text = toString(findings);
    EXPECT_EQ(opened, kind->says == nullptr) << file << '\n' << text;
    if (kind->says == nullptr) {
      for (const Finding& finding : findings) EXPECT_NE(finding.severity, Severity::error) << text;
      continue;
    }
    ASSERT_FALSE(findings.empty()) << file;
    EXPECT_NE(text.find(kind->says), std::string::npos) << text;
    EXPECT_NE(findings.back().where.find(file.filename().string()), std::string::npos) << text;
    EXPECT_FALSE(findings.back().expected.empty() || findings.back().found.empty()) << text;
    EXPECT_LT(text.size(), file.string().size() + 250) << text;
  }
  for (std::size_t k = 0; k < met.size(); ++k) {
    std::printf("%4zu files  %-70s %s\n", met[k], kKinds[k].pattern,
                kKinds[k].says ? kKinds[k].says : "opens");
    EXPECT_GT(met[k], 0u) << kKinds[k].pattern;
  }
}

TEST(AllFiles, undeclaredVoidsOfCraterLakeAreFoundAndTold) {
  TRIMTAB_NEEDS_SHARED("data/dem-image-craterlake");
  const fs::path file = test::sharedDir() / "data/dem-image-craterlake/craterlake-elev-16bit-30m.tif";
  const auto source = openElevation(std::span(&file, 1));
  ASSERT_TRUE(source);
  EXPECT_NE(toString(source.findings()).find("39489 posts with impossible heights"), std::string::npos);
  const PostGrid& posts = (*source)->posts();
  std::vector<float> heights(posts.size());
  std::vector<std::uint8_t> beyond(posts.size());
  ASSERT_TRUE((*source)->readRows(0, posts.rows, heights, beyond));
  EXPECT_EQ(std::count_if(heights.begin(), heights.end(), [](float h) { return std::isnan(h); }), 39489);
  EXPECT_EQ(std::count(beyond.begin(), beyond.end(), 1), 0);
}

}  // namespace
}  // namespace trimtab::terrain
