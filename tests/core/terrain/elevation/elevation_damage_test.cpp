#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <new>
#include <random>

#include "rasters.h"
#include "trimtab/terrain/elevation/gdal_errors.h"
#include "trimtab/terrain/elevation/source.h"

namespace trimtab::terrain {
namespace {

namespace fs = std::filesystem;

/// One format and how a small file of it is made.
struct Format {
  const char *name, *file, *driver;
  int side;
  double step;
  GDALDataType type;
  std::vector<const char*> options;
};
const Format kFormats[] = {
    {"GeoTIFF in strips", "a.tif", "GTiff", 61, 0.001, GDT_Int16, {"COMPRESS=NONE"}},
    {"GeoTIFF in tiles, packed",
     "a.tif",
     "GTiff",
     150,
     0.001,
     GDT_Float32,
     {"TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64", "COMPRESS=DEFLATE", "PREDICTOR=2"}},
    {"GeoTIFF, LZW", "a.tif", "GTiff", 90, 0.001, GDT_Int16, {"COMPRESS=LZW"}},
    {"DTED level 0", "n45_e010.dt0", "DTED", 121, 1.0 / 120, GDT_Int16, {}},
    {"SRTM", "N45E010.hgt", "SRTMHGT", 1201, 1.0 / 1200, GDT_Int16, {}},
    {"ASCII grid", "a.asc", "AAIGrid", 40, 0.001, GDT_Float32, {}},
    {"Erdas Imagine", "a.img", "HFA", 80, 0.001, GDT_Float32, {}},
};

std::string bytesOf(const Format& format, const test::ScratchDir& dir) {
  test::RasterRecipe recipe;
  recipe.columns = recipe.rows = format.side;
  recipe.step = format.step;
  recipe.type = format.type;
  // Posts at whole degrees, where a format wants that.
  recipe.west = 10 - recipe.step / 2, recipe.north = 46 + recipe.step / 2;
  recipe.value = [](int c, int r, int) { return std::round(test::roughGround(c, r)); };
  test::writeRaster(dir / "made.tif", recipe);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(format.driver);
  if (driver == nullptr) return {};
  std::vector<const char*> options = format.options;
  options.push_back(nullptr);
  GDALDataset* made = GDALDataset::Open((dir / "made.tif").c_str());
  const fs::path file = dir / format.file;
  GDALDataset* copy =
      driver->CreateCopy(file.c_str(), made, FALSE, const_cast<char**>(options.data()), nullptr, nullptr);
  GDALClose(made);
  if (copy == nullptr) return {};
  GDALClose(copy);
  return test::readFile(file);
}

/// Cut off, flipped, overwritten; near the beginning half of the time, for that is where headers are.
std::string damaged(std::string bytes, std::mt19937& random) {
  const auto below = [&](std::size_t end) {
    return static_cast<std::size_t>(random() % std::max<std::size_t>(end, 1));
  };
  if (below(4) == 0) {
    bytes.resize(below(bytes.size()));
    return bytes;
  }
  for (std::size_t edits = 1 + below(6); edits > 0; --edits) {
    const std::size_t at = below(below(2) == 0 ? std::min<std::size_t>(bytes.size(), 512) : bytes.size());
    switch (below(4)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(random());
        break;
      case 2:
        bytes[at] = '9';
        break;  // more digits in what is written out
      default:
        for (std::size_t k = at; k < std::min(at + 4, bytes.size()); ++k) bytes[k] = static_cast<char>(0xff);
    }
  }
  return bytes;
}

enum Answer { kOpened = 0, kRefused = 1, kSilent = 2, kNoMemory = 3 };

/// In a program of its own: a gigabyte more than it has now, and 20 s.
Answer openAndRead(const fs::path& file) {
  try {
    const auto source = openElevation(std::span(&file, 1));
    if (!source) return source.findings().empty() ? kSilent : kRefused;
    const PostGrid& posts = (*source)->posts();
    std::vector<float> row(posts.columns);
    for (std::uint32_t r = 0; r < posts.rows; r += std::max(1u, posts.rows / 200))
      if (const auto read = (*source)->readRows(r, 1, row); !read)
        return read.findings().empty() ? kSilent : kRefused;
    return kOpened;
  } catch (const std::bad_alloc&) {
    return kNoMemory;
  }
}

std::size_t addressSpace() {
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0;
  file >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// Runs the child; its exit status as waitpid tells it.
int inChild(const std::function<int()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    const rlim_t memory = addressSpace() + (std::size_t{1} << 30);
    const rlimit space{memory, memory}, seconds{20, 20};
    ::setrlimit(RLIMIT_AS, &space);
    ::setrlimit(RLIMIT_CPU, &seconds);
    ::_exit(work());
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

class ElevationDamage : public ::testing::TestWithParam<Format> {};

TEST_P(ElevationDamage, isRefusedOrReadAndNeverWorse) {
  const Format& format = GetParam();
  test::ScratchDir dir;
  useGdal();
  const std::string good = bytesOf(format, dir);
  if (good.empty()) GTEST_SKIP() << "GDAL writes no " << format.name;
  const fs::path file = dir / format.file;
  ASSERT_EQ(openAndRead(file), kOpened) << format.name;
  // Side files of the good one would lend the damaged one what it lacks.
  for (const auto& entry : fs::directory_iterator(dir.path())) fs::remove(entry.path());
  const int rounds = std::getenv("TRIMTAB_SOAK") ? 1000 : format.side > 1000 ? 20 : 80;
  int opened = 0, refused = 0;
  std::mt19937 random(20261121);
  std::vector<std::string> copies;
  for (int k = 0; k < rounds; ++k) copies.push_back(damaged(good, random));
  for (std::size_t k = 0; k < 16; ++k) copies.push_back(good.substr(0, good.size() * k / 16));
  for (const std::string& bytes : copies) {
    test::writeFile(file, bytes);
    const int status = inChild([&] { return static_cast<int>(openAndRead(file)); });
    const bool well = WIFEXITED(status) && WEXITSTATUS(status) <= kRefused;
    if (!well)
      fs::copy_file(file, fs::temp_directory_path() / ("trimtab-damaged-" + file.filename().string()),
                    fs::copy_options::overwrite_existing);
    ASSERT_TRUE(well) << format.name
                      << (WIFSIGNALED(status) ? ": signal " + std::to_string(WTERMSIG(status))
                                              : ": " + std::to_string(WEXITSTATUS(status)));
    ++(WEXITSTATUS(status) == kOpened ? opened : refused);
  }
  EXPECT_GT(refused, rounds / 20);
  std::printf("%-26s %4d read, %4d refused\n", format.name, opened, refused);
}
INSTANTIATE_TEST_SUITE_P(Formats, ElevationDamage, ::testing::ValuesIn(kFormats), [](const auto& instance) {
  std::string name = instance.param.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

struct Lie {
  const char *name, *file;
  std::function<std::string(const test::ScratchDir&)> bytes;
  const char* says;
};

/// A sparse GeoTIFF that claims a size and holds nothing.
std::string claiming(const test::ScratchDir& dir, int columns, int rows, int block) {
  const std::string side = std::to_string(block);
  const std::string x = "BLOCKXSIZE=" + side, y = "BLOCKYSIZE=" + side;
  const char* options[] = {"SPARSE_OK=TRUE", "TILED=YES", "BIGTIFF=YES", x.c_str(), y.c_str(), nullptr};
  GDALDataset* data = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      (dir / "claim.tif").c_str(), columns, rows, 1, GDT_Float32, const_cast<char**>(options));
  std::array<double, 6> corner{10, 1e-5, 0, 50, 0, -1e-5};
  data->SetGeoTransform(corner.data());
  GDALClose(data);
  return test::readFile(dir / "claim.tif");
}

TEST(ElevationClaims, takeNoMemoryAndNoTime) {
  test::ScratchDir dir;
  useGdal();
  const Lie lies[] = {
      {"two thousand million posts a side", "a.tif",
       [](const auto& d) { return claiming(d, 2'000'000, 2'000'000, 4096); }, "size"},
      {"a long thin one", "b.tif", [](const auto& d) { return claiming(d, 4'000'000, 3, 4096); }, "size"},
      {"one block of gigabytes", "c.tif", [](const auto& d) { return claiming(d, 40'000, 40'000, 32768); },
       "blocks"},
      {"an ASCII grid without its numbers", "d.asc",
       [](const auto&) {
         return std::string(
             "ncols 60000\nnrows 60000\nxllcorner 10\nyllcorner 45\ncellsize 0.0001\nNODATA_value -9999\n1 2 "
             "3\n");
       },
       ""},
      {"an ASCII grid beyond all measure", "e.asc",
       [](const auto&) {
         return std::string(
             "ncols 2000000000\nnrows 2000000000\nxllcorner 10\nyllcorner 45\ncellsize 1e-9\n1 2 3\n");
       },
       ""},
      {"an SRTM tile of nothing", "N45E010.hgt",
       [](const auto&) { return std::string(1201 * 1201 * 2 - 2, '\0'); }, ""},
  };
  for (const Lie& lie : lies) {
    const fs::path file = dir / lie.file;
    test::writeFile(file, lie.bytes(dir));
    const int status = inChild([&] {
      const auto source = openElevation(std::span(&file, 1));
      if (source) return 10;
      const std::string text = toString(source.findings());
      return text.find(lie.says) != std::string::npos && text.find(lie.file) != std::string::npos ? 0 : 11;
    });
    EXPECT_TRUE(WIFEXITED(status)) << lie.name << ": signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), 0) << lie.name;
  }
}

}  // namespace
}  // namespace trimtab::terrain
