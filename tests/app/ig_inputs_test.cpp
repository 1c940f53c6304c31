#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include "ig_support.h"

namespace trimtab {
namespace {

/// Everything right but what a case changes.
struct Arguments {
  std::string preset = "default", terrain, flight, more = "--headless --size 64x64";
  std::string source;  ///< instead of --flight
};

class IgInputs : public ::testing::Test {
 protected:
  IgInputs() {
    test::writeFile(dir_ / "flight.csv", flightCsv(test::weavingFlight(2)));
    good_.terrain = test::smallTerrain().string();
    good_.flight = (dir_ / "flight.csv").string();
  }
  test::Ran run(const Arguments& a, const std::string& environment = "") const {
    const std::string source = a.source.empty() ? "--flight '" + a.flight + "'" : a.source;
    return test::run(environment + " XDG_CACHE_HOME='" + (dir_ / "cache").string() + "' " +
                     test::program("trimtab-ig").string() + " --preset '" + a.preset + "' --terrain '" +
                     a.terrain + "' " + source + " " + a.more);
  }
  std::string file(const std::string& name, const std::string& bytes) const {
    test::writeFile(dir_ / name, bytes);
    return (dir_ / name).string();
  }

  test::ScratchDir dir_;
  Arguments good_;
};

TEST_F(IgInputs, theGoodOnesRun) {
  const test::Ran ran = run(good_);
  EXPECT_EQ(ran.exitCode, 0) << ran.err;
  EXPECT_NE(ran.out.find("2 frames, 2 packets"), std::string::npos) << ran.out;
}

TEST_F(IgInputs, aSummaryThatCannotBeWrittenIsARefusal) {
  for (const char* more : {" >/dev/full", " --json >/dev/full"}) {
    Arguments arguments = good_;
    arguments.more += more;
    const test::Ran ran = run(arguments);
    EXPECT_EQ(ran.exitCode, 1) << more;
    EXPECT_NE(ran.err.find("summary"), std::string::npos) << ran.err;
  }
}

TEST_F(IgInputs, badOnesAreRefusedWithFileAndReason) {
  const std::string preset = test::exported(defaultParameters());
  std::string damaged = preset;
  damaged[damaged.find("8000")] = '9';
  const std::string damagedDatabase = (dir_ / "damaged").string();
  std::filesystem::copy(test::smallTerrain(), damagedDatabase, std::filesystem::copy_options::recursive);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(damagedDatabase))
    if (entry.is_regular_file()) std::filesystem::resize_file(entry.path(), entry.file_size() / 2);
  std::filesystem::create_directory(dir_ / "empty");
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  socklen_t size = sizeof address;
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  const std::string taken = std::to_string(ntohs(address.sin_port));

  struct Case {
    const char* name;
    std::function<void(Arguments&)> spoil;
    std::vector<std::string> says;
  };
  const std::vector<Case> cases = {
      {"no preset file", [&](Arguments& a) { a.preset = (dir_ / "none.json").string(); }, {"none.json"}},
      {"preset cut short",
       [&](Arguments& a) { a.preset = file("cut.json", preset.substr(0, 300)); },
       {"cut.json"}},
      {"preset with a changed digit",
       [&](Arguments& a) { a.preset = file("bit.json", damaged); },
       {"bit.json", "checksum"}},
      {"no terrain", [&](Arguments& a) { a.terrain = (dir_ / "nowhere").string(); }, {"nowhere"}},
      {"empty folder", [&](Arguments& a) { a.terrain = (dir_ / "empty").string(); }, {"empty"}},
      {"text as terrain",
       [&](Arguments& a) { a.terrain = file("terrain.tif", "not an image"); },
       {"terrain.tif"}},
      {"database cut short", [&](Arguments& a) { a.terrain = damagedDatabase; }, {"damaged"}},
      {"no flight", [&](Arguments& a) { a.flight = (dir_ / "no.csv").string(); }, {"no.csv"}},
      {"empty flight", [&](Arguments& a) { a.flight = file("void.csv", ""); }, {"void.csv"}},
      {"flight without rows",
       [&](Arguments& a) { a.flight = file("rows.csv", flightCsv({})); },
       {"rows.csv"}},
      {"a word for a number",
       [&](Arguments& a) {
         a.flight = file("word.csv",
                         "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n0,36,"
                         "128,high,0,0,0\n");
       },
       {"word.csv", "high"}},
      {"port in use", [&](Arguments& a) { a.source = "--listen " + taken; }, {taken}},
      {"reply without port",
       [&](Arguments& a) { a.source = "--listen 0 --reply nobody:here"; },
       {"nobody:here"}},
      {"trace nowhere",
       [&](Arguments& a) { a.more += " --trace " + (dir_ / "no" / "t.csv").string(); },
       {"t.csv"}},
      {"trace over a folder",
       [&](Arguments& a) { a.more += " --trace " + (dir_ / "empty").string(); },
       {"empty", "folder"}},
      {"screenshot nowhere",
       [&](Arguments& a) { a.more += " --screenshot " + (dir_ / "no" / "s.png").string(); },
       {"s.png"}},
      {"health nowhere",
       [&](Arguments& a) { a.more += " --health " + (dir_ / "no" / "h.csv").string(); },
       {"h.csv"}},
      {"nothing to watch", [&](Arguments& a) { a.more += " --watch"; }, {"--watch", "default"}},
  };
  for (const Case& c : cases) {
    Arguments arguments = good_;
    c.spoil(arguments);
    const test::Ran ran = run(arguments);
    EXPECT_EQ(ran.exitCode, 1) << c.name << "\n" << ran.err;
    EXPECT_NE(ran.err.find("error: "), std::string::npos) << c.name << "\n" << ran.err;
    for (const std::string& text : c.says)
      EXPECT_NE(ran.err.find(text), std::string::npos) << c.name << "\n" << ran.err;
  }
  ::close(socket);
}

TEST_F(IgInputs, oneRunTellsEverythingThatIsWrong) {
  Arguments arguments = good_;
  arguments.preset = (dir_ / "none.json").string();
  arguments.terrain = (dir_ / "nowhere").string();
  arguments.flight = (dir_ / "no.csv").string();
  const test::Ran ran = run(arguments);
  EXPECT_EQ(ran.exitCode, 1);
  for (const char* name : {"none.json", "nowhere", "no.csv"})
    EXPECT_NE(ran.err.find(name), std::string::npos) << ran.err;
}

TEST_F(IgInputs, wrongUsageIsTwo) {
  const std::string start =
      test::program("trimtab-ig").string() + " --preset default --terrain " + good_.terrain + " ";
  for (const char* usage :
       {"", "--flight a --listen 1", "--listen 70000", "--listen 0 --protocol morse", "--flight a --size 5",
        "--flight a --size 0x5", "--reply 127.0.0.1:5", "--realtime --listen 0", "--nonsense"}) {
    const test::Ran ran = test::run(start + usage);
    EXPECT_EQ(ran.exitCode, 2) << usage << "\n" << ran.err;
    EXPECT_FALSE(ran.err.empty()) << usage;
  }
  EXPECT_EQ(test::run(test::program("trimtab-ig").string() + " --help").exitCode, 0);
  EXPECT_EQ(test::run(test::program("trimtab-ig").string() + " --version").exitCode, 0);
}

TEST_F(IgInputs, noDisplayAndNoOpenGlAreSaidClearly) {
  Arguments window = good_;
  window.more = "--size 64x64";
  const test::Ran noDisplay = run(window, "env -u DISPLAY");
  EXPECT_EQ(noDisplay.exitCode, 1);
  EXPECT_NE(noDisplay.err.find("X display"), std::string::npos) << noDisplay.err;
  EXPECT_NE(noDisplay.err.find("--headless"), std::string::npos) << noDisplay.err;
  const test::Ran noGl = run(good_, "env __EGL_VENDOR_LIBRARY_FILENAMES=/nowhere.json");
  EXPECT_EQ(noGl.exitCode, 1);
  EXPECT_NE(noGl.err.find("error: "), std::string::npos) << noGl.err;
}

/// A limit on the size of files stands in for a full disk.
TEST_F(IgInputs, aFullDiskIsSaid) {
  test::writeFile(dir_ / "flight.csv", flightCsv(test::weavingFlight(100)));
  Arguments arguments = good_;
  arguments.more += " --trace " + (dir_ / "t.csv").string();
  const test::Ran ran = run(arguments, "ulimit -f 60;");
  EXPECT_EQ(ran.exitCode, 1) << ran.err;
  EXPECT_NE(ran.err.find("t.csv.part: expected room for more rows, found File too large"), std::string::npos)
      << ran.err;
  EXPECT_FALSE(std::filesystem::exists(dir_ / "t.csv"));
}

TEST_F(IgInputs, aForeignFileBesideTheTraceStaysAsItIs) {
  const std::string notes = file("t.csv.part", "notes without an end of line");
  Arguments arguments = good_;
  arguments.more += " --trace " + (dir_ / "t.csv").string();
  const test::Ran ran = run(arguments);
  EXPECT_EQ(ran.exitCode, 1) << ran.err;
  EXPECT_NE(ran.err.find(notes + ": "), std::string::npos) << ran.err;
  EXPECT_EQ(test::readFile(notes), "notes without an end of line");
}

TEST_F(IgInputs, anOldHealthFileStaysUntilThereIsARow) {
  const std::string health = file("h.csv", "of the flight before");
  Arguments arguments = good_;
  arguments.more += " --health " + health;
  EXPECT_EQ(run(arguments, "env __EGL_VENDOR_LIBRARY_FILENAMES=/nowhere.json").exitCode, 1);
  EXPECT_EQ(test::readFile(health), "of the flight before");
  const test::Ran ran = run(arguments);
  EXPECT_EQ(ran.exitCode, 0) << ran.err;
  EXPECT_EQ(test::readFile(health).find("second,memory_kb,"), 0u) << test::readFile(health);
  arguments.more += "/h.csv";
  EXPECT_EQ(run(arguments).exitCode, 1) << "no folder";
  std::filesystem::remove(health);
  ASSERT_EQ(::mkfifo(health.c_str(), 0600), 0);
  arguments.more = good_.more + " --health " + health;
  EXPECT_EQ(run(arguments, "timeout 60 env").exitCode, 1) << "a pipe is not waited for";
}

TEST_F(IgInputs, aPipeInPlaceOfTheCostModelDoesNotHoldUpTheEnd) {
  test::writeFile(dir_ / "flight.csv", flightCsv(test::weavingFlight(150)));
  Arguments arguments = good_;
  arguments.preset =
      file("hold.json", test::exported(test::edited([](TuningParameters& p) { p.hold.enabled = true; })));
  ASSERT_EQ(run(arguments).exitCode, 0);
  const auto names = test::namesIn(dir_ / "cache/trimtab");
  ASSERT_EQ(names.size(), 1u);
  const std::filesystem::path model = dir_ / "cache/trimtab" / names.front();
  std::filesystem::remove(model);
  ASSERT_EQ(::mkfifo(model.c_str(), 0600), 0);
  const test::Ran ran = run(arguments, "timeout 120 env");
  EXPECT_EQ(ran.exitCode, 0) << ran.err;
  EXPECT_NE(ran.err.find(names.front() + ": expected a file's name, found a pipe"), std::string::npos)
      << ran.err;
}

}  // namespace
}  // namespace trimtab
