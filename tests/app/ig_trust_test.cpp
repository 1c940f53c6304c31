#include <sys/stat.h>

#include <fstream>

#include "app/link/link.h"
#include "ig_support.h"

/// What an IG does when its terrain is damaged, its inputs never end, or it is asked to stop.
namespace trimtab {
namespace {

namespace fs = std::filesystem;
using test::IgProcess;

class IgTrust : public ::testing::Test {
 protected:
  IgTrust() {
    TuningParameters parameters;
    write(parameters);
    test::writeFile(dir_ / "flight.csv", flightCsv(test::weavingFlight(20)));
  }
  void write(const TuningParameters& parameters) const {
    test::writeFile(dir_ / "preset.json", test::exported(validate(parameters).value()));
  }
  void drawPatches() const {
    TuningParameters parameters;
    parameters.terrain.form = TerrainForm::patches;
    write(parameters);
  }
  fs::path copyOfTerrain() const {
    fs::copy(test::smallTerrain(), dir_ / "db", fs::copy_options::recursive);
    return dir_ / "db";
  }
  std::vector<std::string> arguments(const fs::path& terrain, const std::vector<std::string>& more) const {
    std::vector<std::string> all{"--preset",     (dir_ / "preset.json").string(),
                                 "--terrain",    terrain.string(),
                                 "--headless",   "--size",
                                 "160x100",      "--json",
                                 "--trace",      (dir_ / "trace.csv").string(),
                                 "--screenshot", (dir_ / "picture.png").string()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::vector<std::string> flying() const { return {"--flight", (dir_ / "flight.csv").string()}; }

  test::ScratchDir dir_;
};

void flipABit(const fs::path& file, std::uintmax_t at) {
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  stream.seekg(static_cast<std::streamoff>(at));
  const int byte = stream.get();
  stream.seekp(static_cast<std::streamoff>(at));
  stream.put(static_cast<char>(byte ^ 4));
}

TEST_F(IgTrust, saysWhichTerrainIsDamagedAndEndsWithOne) {
  const struct {
    const char* file;
    bool patches;
  } cases[] = {{"heights.f32", false}, {"ground.pages", true}, {"patches.pages", true}};
  for (const auto& [file, patches] : cases) {
    SCOPED_TRACE(file);
    if (patches) drawPatches();
    const fs::path terrain = copyOfTerrain();
    // Blocks and pages; what a database needs to be opened comes behind them.
    for (std::uintmax_t at = 200; at < fs::file_size(terrain / file) * 4 / 10; at += 20000)
      flipABit(terrain / file, at);
    IgProcess ig(arguments(terrain, flying()));
    EXPECT_EQ(ig.end(), 1);
    EXPECT_NE(ig.err().find(std::string(file) + ": "), std::string::npos) << ig.err();
    EXPECT_NE(ig.err().find("checksum"), std::string::npos) << ig.err();
    EXPECT_GT(ig.summary()["damaged_places"].get<int>(), 0);
    EXPECT_TRUE(fs::exists(dir_ / "trace.csv")) << "what was done is kept";
    fs::remove_all(terrain);
  }
}

TEST_F(IgTrust, fliesOnWhenATerrainIsCutShort) {
  const fs::path terrain = copyOfTerrain();
  test::writeFile(dir_ / "flight.csv", flightCsv(test::weavingFlight(3000)));
  std::vector<std::string> more = flying();
  more.push_back("--realtime");
  IgProcess ig(arguments(terrain, more));
  ASSERT_TRUE(ig.until(
      [&] { return fs::exists(dir_ / "trace.csv.part") && fs::file_size(dir_ / "trace.csv.part") > 5000; }));
  for (const char* name : {"heights.f32", "patches.pages", "ground.pages"})
    fs::resize_file(terrain / name, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  ig.signal(SIGTERM);
  const int code = ig.end();
  EXPECT_LE(code, 1) << "ended by signal " << code - 128 << '\n' << ig.err();
  EXPECT_TRUE(fs::exists(dir_ / "trace.csv"));
}

TEST_F(IgTrust, hearsOnlyTheAddressAndTheSenderThatItWasGiven) {
  for (const bool allowed : {true, false}) {
    IgProcess ig(arguments(test::smallTerrain(), {"--listen", "0", "--bind", "127.0.0.2", "--from",
                                                  allowed ? "127.0.0.1" : "127.0.0.3"}));
    const std::uint16_t port = ig.port();
    ASSERT_NE(port, 0);
    EXPECT_NE(ig.err().find("of 127.0.0.2"), std::string::npos) << ig.err();
    link::PlayOptions here, elsewhere;
    here.to.address = "127.0.0.2";
    here.to.port = elsewhere.to.port = port;
    const auto other = link::FeedPlayer::start(test::weavingFlight(1), elsewhere);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_FALSE(fs::exists(dir_ / "trace.csv.part") && fs::file_size(dir_ / "trace.csv.part") > 5000);
    const auto player = link::FeedPlayer::start(test::weavingFlight(30), here);
    ASSERT_TRUE(player);
    const auto flies = [&] {
      return fs::exists(dir_ / "trace.csv.part") && fs::file_size(dir_ / "trace.csv.part") > 5000;
    };
    if (allowed)
      EXPECT_TRUE(ig.until(flies));
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
    ig.signal(SIGTERM);
    EXPECT_EQ(ig.end(), allowed ? 0 : 1) << "without a packet there is no image for a screenshot" << ig.err();
    EXPECT_EQ(ig.summary()["packets"].get<int>() > 0, allowed);
  }
}

TEST_F(IgTrust, endsAlikeHoweverItIsAskedToStop) {
  for (const std::vector<int>& signals :
       std::vector<std::vector<int>>{{SIGINT}, {SIGTERM}, {SIGHUP}, {SIGTERM, SIGTERM}, {SIGHUP, SIGTERM}}) {
    SCOPED_TRACE(signals.size() * 100 + static_cast<unsigned>(signals[0]));
    IgProcess ig(arguments(test::smallTerrain(), {"--listen", "0"}));
    const std::uint16_t port = ig.port();
    ASSERT_NE(port, 0);
    EXPECT_NE(ig.err().find("of 127.0.0.1, sender: any"), std::string::npos) << ig.err();
    link::PlayOptions how;
    how.to.port = port;
    how.loop = true;
    auto player = link::FeedPlayer::start(test::weavingFlight(60), how);
    ASSERT_TRUE(player);
    ASSERT_TRUE(ig.until([&] {
      return fs::exists(dir_ / "trace.csv.part") && fs::file_size(dir_ / "trace.csv.part") > 5000;
    }));
    for (const int signal : signals) ig.signal(signal);
    EXPECT_EQ(ig.end(), 0) << ig.err();
    EXPECT_TRUE(ig.summary().is_object()) << ig.out();
    for (const char* name : {"trace.csv", "picture.png"}) {
      EXPECT_TRUE(fs::exists(dir_ / name)) << name;
      fs::remove(dir_ / name);
    }
    EXPECT_FALSE(fs::exists(dir_ / "trace.csv.part"));
  }
}

TEST_F(IgTrust, keepsTheTraceOfARunThatWasKilled) {
  const fs::path part = dir_ / "trace.csv.part";
  std::string rows;
  {
    std::vector<std::string> more = flying();
    more.push_back("--realtime");
    test::writeFile(dir_ / "flight.csv", flightCsv(test::weavingFlight(3000)));
    IgProcess ig(arguments(test::smallTerrain(), more));
    ASSERT_TRUE(ig.until([&] { return fs::exists(part) && fs::file_size(part) > 5000; }));
    ig.signal(SIGKILL);
    EXPECT_EQ(ig.end(), 128 + SIGKILL);
    rows = test::readFile(part);
  }
  test::writeFile(dir_ / "flight.csv", flightCsv(test::weavingFlight(20)));
  {
    IgProcess next(arguments(test::smallTerrain(), flying()));
    EXPECT_EQ(next.end(), 1);
    EXPECT_NE(next.err().find("trace.csv.part"), std::string::npos) << next.err();
    EXPECT_EQ(test::readFile(part), rows);
    EXPECT_FALSE(fs::exists(dir_ / "picture.png")) << "it is refused before the first image";
  }
  EXPECT_TRUE(readTrace(part)) << "it reads as it is";
  fs::rename(part, dir_ / "kept.csv");
  IgProcess last(arguments(test::smallTerrain(), flying()));
  EXPECT_EQ(last.end(), 0) << last.err();
  EXPECT_EQ(readTrace(dir_ / "trace.csv")->size(), 20u);
}

TEST_F(IgTrust, refusesAScreenshotThatCannotBeWrittenBeforeItFlies) {
  test::writeFile(dir_ / "flight.csv", flightCsv(test::weavingFlight(1)));
  IgProcess ig({"--preset", "default", "--terrain", test::smallTerrain().string(), "--flight",
                (dir_ / "flight.csv").string(), "--headless", "--screenshot", "/proc/shot.png", "--trace",
                (dir_ / "trace.csv").string()});
  EXPECT_EQ(ig.end(), 1);
  EXPECT_NE(ig.err().find("/proc"), std::string::npos) << ig.err();
  EXPECT_FALSE(fs::exists(dir_ / "trace.csv"));
}

TEST_F(IgTrust, waitsForNoPipeAsAPreset) {
  ASSERT_EQ(::mkfifo((dir_ / "pipe").c_str(), 0600), 0);
  std::vector<std::string> all = arguments(test::smallTerrain(), {"--flight", (dir_ / "pipe").string()});
  all[1] = (dir_ / "pipe").string();
  IgProcess ig(all);
  EXPECT_EQ(ig.end(), 1);
  EXPECT_NE(ig.err().find("a pipe that ends"), std::string::npos) << ig.err();
}

}  // namespace
}  // namespace trimtab
