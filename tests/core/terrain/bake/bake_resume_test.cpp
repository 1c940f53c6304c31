#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "core/terrain/bake/work.h"
#include "resumed_bake.h"
#include "tests/disk_order.h"
#include "tests/shared_scene.h"
#include "trimtab/preset/unfinished.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/ground_pyramid.h"
#include "trimtab/terrain/format/patch_terrain.h"

/// As many cores as a test says there are, in place of the C library's answer.
static int coresThere = 0;
extern "C" int get_nprocs() noexcept {
  return coresThere > 0 ? coresThere : static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN));
}

/// Bakes that are killed, meet each other or share the work: the database is the same to the byte.
namespace trimtab::terrain {
namespace {

TEST_F(ResumedBake, isOnTheDiskBeforeItHasItsName) {
  test::DiskOrder& order = test::DiskOrder::instance();
  order.clear();
  ASSERT_TRUE(bake(options_));
  const std::size_t named = order.placeOf("rename db");
  EXPECT_LT(named, order.events().size());
  for (const auto& [name, bytes] : whole_) EXPECT_LT(order.placeOf("flush " + name), named) << name;
  EXPECT_LT(order.placeOf("flush database"), named);
  EXPECT_EQ(order.events()[named + 1], "flush " + dir_.path().filename().string());
}

TEST_F(ResumedBake, isTheSameWhereverItIsKilled) {
  int killed = 0;
  // At every step that tells of itself, one after the other, each going on from the last.
  for (int step = 0; step < 400; ++step) {
    const int status = ended(start([&] {
      int told = 0;
      options_.progress = [&](double, const std::string&) {
        if (told++ >= step) ::kill(::getpid(), SIGKILL);
        return true;
      };
      return bake(options_) ? 0 : 1;
    }));
    if (status == 0) break;
    ASSERT_EQ(status, -SIGKILL);
    ++killed;
  }
  EXPECT_GT(killed, 5);
  if (!fs::exists(dir_ / "db")) {
    ASSERT_TRUE(bake(options_));
  }
  expectWhole(dir_ / "db");
  EXPECT_FALSE(fs::exists(dir_ / ".db.work"));
}

TEST_F(ResumedBake, isTheSameKilledAtRandomMoments) {
  std::mt19937 random(11);
  const auto began = std::chrono::steady_clock::now();
  ASSERT_TRUE(bake(options_));
  const auto took =
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - began);
  int killed = 0;
  for (int round = 0; round < 3; ++round) {
    // The last bake's database is replaced: it stays whole until then.
    for (int k = 0; k < 5; ++k) {
      const pid_t child = start([&] { return bake(options_) ? 0 : 1; });
      std::this_thread::sleep_for(std::chrono::microseconds(random() % static_cast<unsigned>(took.count())));
      ::kill(child, SIGKILL);
      killed += ended(child) == -SIGKILL;
      ASSERT_NO_FATAL_FAILURE(expectWhole(dir_ / "db"));
    }
    ASSERT_TRUE(bake(options_));
    expectWhole(dir_ / "db");
    EXPECT_FALSE(fs::exists(dir_ / ".db.work"));
  }
  EXPECT_GT(killed, 3);
}

TEST_F(ResumedBake, namesTheWorkThatItLeavesAndWhatItTakes) {
  options_.progress = [](double fraction, const std::string&) { return fraction < 0.9; };
  const auto cancelled = bake(options_);
  ASSERT_FALSE(cancelled);
  const auto named = [&](const Findings& findings) {
    return std::count_if(findings.begin(), findings.end(), [&](const Finding& f) {
      return f.severity == Severity::note && f.where == (dir_ / ".db.work").string() &&
             f.found.find(" MB of finished work; remove the folder") != std::string::npos;
    });
  };
  EXPECT_EQ(named(cancelled.findings()), 1) << toString(cancelled.findings());
  fs::remove_all(dir_ / ".db.work");
  options_.progress = [](double, const std::string&) { return false; };
  EXPECT_EQ(named(bake(options_).findings()), 0) << "nothing is finished yet";
  EXPECT_FALSE(fs::exists(dir_ / ".db.work"));
}

TEST_F(ResumedBake, makesDamagedPiecesAgain) {
  options_.progress = [](double fraction, const std::string&) { return fraction < 0.9; };
  ASSERT_FALSE(bake(options_));
  options_.progress = nullptr;
  const fs::path work = dir_ / ".db.work";
  int damaged = 0;
  for (const auto& entry : fs::recursive_directory_iterator(work)) {
    // Without its recipe or its mark it is no work to go on with.
    if (!entry.is_regular_file() || entry.file_size() < 100 || entry.path().filename() == "recipe.json" ||
        entry.path().filename() == kMarkName)
      continue;
    std::string bytes = test::readFile(entry.path());
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
    test::writeFile(entry.path(), bytes);
    ++damaged;
  }
  EXPECT_GT(damaged, 2);
  // A piece whose damage shows only when it is joined is removed, and made the next time.
  Result<std::shared_ptr<const Database>> made = bake(options_);
  for (int k = 0; k < 20 && !made; ++k) {
    EXPECT_NE(toString(made.findings()).find("bake again"), std::string::npos) << toString(made.findings());
    made = bake(options_);
  }
  ASSERT_TRUE(made) << toString(made.findings());
  expectWhole(dir_ / "db");
}

/// What a power cut leaves: no sum of the heights in the journal, and bytes that never came to the disk.
TEST_F(ResumedBake, readsHeightsAgainThatNoSumBearsOut) {
  // The last quarter of the rows, or one filled void.
  constexpr std::size_t kQuarter = 420 * 330, kVoid = sizeof(float) * (209 * 420 + 200);
  for (const auto& [from, size] : {std::pair{3 * kQuarter, kQuarter}, {kVoid, sizeof(float)}}) {
    options_.progress = [](double fraction, const std::string&) { return fraction < 0.5; };
    ASSERT_FALSE(bake(options_));
    options_.progress = nullptr;
    const fs::path work = dir_ / ".db.work";
    std::istringstream journal(test::readFile(work / "journal"));
    std::string kept;
    int dropped = 0;
    for (std::string line; std::getline(journal, line);)
      if (line.starts_with("heights "))
        ++dropped;
      else
        kept += line + "\n";
    ASSERT_EQ(dropped, 1);
    test::writeFile(work / "journal", kept);
    std::string rows = test::readFile(work / "database/heights.f32");
    ASSERT_EQ(rows.size(), 4 * kQuarter);
    rows.replace(from, size, size, '\0');
    test::writeFile(work / "database/heights.f32", rows);
    fs::remove(work / "database/heights.sums");
    fs::remove_all(work / "pieces");
    const auto made = bake(options_);
    ASSERT_TRUE(made) << toString(made.findings());
    expectWhole(dir_ / "db");
  }
}

TEST_F(ResumedBake, tellsWhatEachFileGaveWhoeverReadIt) {
  // Two files side by side, in two bands.
  options_.sources.clear();
  for (int file = 0; file < 2; ++file) {
    test::RasterRecipe recipe;
    recipe.columns = 1000;
    recipe.rows = 700;
    recipe.north += file * recipe.rows * recipe.step;
    recipe.value = [](int c, int r, int) { return test::roughGround(c, r); };
    options_.sources.push_back(test::writeRaster(dir_ / ("half" + std::to_string(file) + ".tif"), recipe));
  }
  options_.maxError = Metres{500};
  options_.memory = Megabytes{64};
  const auto shares = [](const Findings& findings) {
    std::string all;
    for (const Finding& f : findings)
      if (f.key == "share") all += f.found + "\n";
    return all;
  };
  int bands = 0;
  options_.progress = [&](double, const std::string& what) {
    return what != "reading heights" || ++bands < 2;
  };
  ASSERT_FALSE(bake(options_));
  options_.progress = nullptr;
  const auto resumed = bake(options_);
  ASSERT_TRUE(resumed) << toString(resumed.findings());
  options_.output = dir_ / "at-once";
  const auto atOnce = bake(options_);
  ASSERT_TRUE(atOnce) << toString(atOnce.findings());
  EXPECT_NE(shares(atOnce.findings()).find("50.0 %"), std::string::npos) << toString(atOnce.findings());
  EXPECT_EQ(shares(resumed.findings()), shares(atOnce.findings()));
}

TEST_F(ResumedBake, beginsAnewWithOtherOptionsOrSources) {
  options_.progress = [](double fraction, const std::string&) { return fraction < 0.9; };
  options_.maxError = Metres{5};
  ASSERT_FALSE(bake(options_));
  options_.progress = nullptr;
  options_.maxError = Metres{20};
  ASSERT_TRUE(bake(options_));
  expectWhole(dir_ / "db");
}

TEST_F(ResumedBake, inPartsIsTheSame) {
  const auto early = bakeJoin(options_);
  ASSERT_TRUE(early);
  EXPECT_EQ(*early, nullptr);
  EXPECT_NE(toString(early.findings()).find("missing"), std::string::npos) << toString(early.findings());
  EXPECT_FALSE(fs::exists(dir_ / ".db.work")) << "nothing is read for what is not there";
  std::vector<pid_t> children;
  for (std::uint32_t part = 1; part <= 3; ++part)
    children.push_back(start([&, part] {
      options_.memory = Megabytes{64.0 * part};
      const auto made = bakePart(options_, part, 3);
      if (!made) std::fprintf(stderr, "%s\n", toString(made.findings()).c_str());
      return made ? 0 : 1;
    }));
  for (const pid_t child : children) EXPECT_EQ(ended(child), 0);
  EXPECT_FALSE(fs::exists(dir_ / "db"));
  const auto joined = bakeJoin(options_);
  ASSERT_TRUE(joined) << toString(joined.findings());
  expectWhole(dir_ / "db");
  EXPECT_FALSE(bakePart(options_, 0, 3));
  EXPECT_FALSE(bakePart(options_, 4, 3));
}

TEST_F(ResumedBake, onAnyNumberOfCoresIsTheSame) {
  for (const int cores : {1, 5}) {
    const pid_t child = start([&] {
      coresThere = cores;
      if (std::thread::hardware_concurrency() != static_cast<unsigned>(cores)) return 2;
      return bake(options_) ? 0 : 1;
    });
    ASSERT_EQ(ended(child), 0) << cores;
    expectWhole(dir_ / "db");
  }
}

/// A part by a machine whose sines end in other bits.
TEST_F(ResumedBake, doesNotMixPartsOfMachinesThatCalculateOtherwise) {
  ASSERT_TRUE(bakePart(options_, 1, 2));
  const fs::path recipe = dir_ / ".db.work/recipe.json";
  const std::string ours = test::readFile(recipe);
  std::string theirs = ours;
  const std::size_t at = theirs.find("\"arithmetic\": \"");
  ASSERT_NE(at, std::string::npos);
  theirs[at + 15] = theirs[at + 15] == '0' ? '1' : '0';
  test::writeFile(recipe, theirs);
  const auto pieces = test::namesIn(dir_ / ".db.work/pieces");
  const auto second = bakePart(options_, 2, 2);
  ASSERT_FALSE(second);
  EXPECT_NE(toString(second.findings()).find("last bit"), std::string::npos) << toString(second.findings());
  const auto joined = bakeJoin(options_);
  ASSERT_FALSE(joined);
  EXPECT_NE(toString(joined.findings()).find("last bit"), std::string::npos) << toString(joined.findings());
  EXPECT_EQ(test::namesIn(dir_ / ".db.work/pieces"), pieces) << "nothing is lost";
  test::writeFile(recipe, ours);
  ASSERT_TRUE(bakePart(options_, 2, 2));
  ASSERT_TRUE(bakeJoin(options_));
  expectWhole(dir_ / "db");
}

TEST_F(ResumedBake, doesNotJoinWhenAPartIsAbsent) {
  ASSERT_TRUE(bakePart(options_, 1, 2));
  const auto joined = bakeJoin(options_);
  ASSERT_TRUE(joined);
  EXPECT_EQ(*joined, nullptr);
  EXPECT_NE(toString(joined.findings()).find("missing"), std::string::npos) << toString(joined.findings());
  // What is there serves a whole bake.
  ASSERT_TRUE(bake(options_));
  expectWhole(dir_ / "db");
}

TEST_F(ResumedBake, doesNotMeetAnotherOfTheSameOutput) {
  int ready[2], go[2];
  ASSERT_EQ(::pipe(ready), 0);
  ASSERT_EQ(::pipe(go), 0);
  const pid_t child = start([&] {
    bool waited = false;
    options_.progress = [&](double fraction, const std::string&) {
      char c = 0;
      if (!waited && fraction > 0.25) {
        waited = true;
        if (::write(ready[1], "r", 1) != 1 || ::read(go[0], &c, 1) != 1) return false;
      }
      return true;
    };
    return bake(options_) ? 0 : 1;
  });
  char c = 0;
  ASSERT_EQ(::read(ready[0], &c, 1), 1);
  const auto second = bake(options_);
  ASSERT_FALSE(second);
  const std::string said = toString(second.findings());
  for (const std::string& word : {std::string("other bake"), "process " + std::to_string(child) + " (",
                                  options_.output.string(), std::string("another folder")})
    EXPECT_NE(said.find(word), std::string::npos) << word << ": " << said;
  ASSERT_EQ(::write(go[1], "g", 1), 1);
  EXPECT_EQ(ended(child), 0);
  expectWhole(dir_ / "db");
}

/// Those that were killed, or have ended, are not named; nor is who has the number of one by now.
TEST_F(ResumedBake, namesEveryPartAtWorkAndNoOther) {
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  std::vector<pid_t> parts;
  for (int i = 0; i < 3; ++i) {
    parts.push_back(start([&] {
      const auto work = WorkFolder::open(options_.output, "{}", WorkFolder::Use::part);
      if (::write(ready[1], work ? "r" : "x", 1) != 1 || !work) return 1;
      ::pause();
      return 0;
    }));
    char c = 0;
    ASSERT_EQ(::read(ready[0], &c, 1), 1);
    ASSERT_EQ(c, 'r');
  }
  ::kill(parts[1], SIGKILL);
  EXPECT_EQ(ended(parts[1]), -SIGKILL);
  const fs::path lock = dir_ / ".db.work/lock";
  const std::string held = test::readFile(lock);
  const std::size_t machine = held.find(' '), program = held.find(' ', machine + 1);
  ASSERT_NE(program, std::string::npos) << held;
  std::ofstream(lock, std::ios::app) << ::getppid() << held.substr(machine, program - machine)
                                     << " another\n";
  const auto refused = WorkFolder::open(options_.output, "{}", WorkFolder::Use::alone);
  ASSERT_FALSE(refused);
  const std::string said = toString(refused.findings());
  EXPECT_EQ(said.find("another)"), std::string::npos) << said;
  const auto names = [&](pid_t part) {
    return said.find("process " + std::to_string(part) + " (") != std::string::npos;
  };
  EXPECT_TRUE(names(parts[0]) && names(parts[2])) << said;
  EXPECT_FALSE(names(parts[1])) << said;
  for (const pid_t part : {parts[0], parts[2]}) {
    ::kill(part, SIGKILL);
    ended(part);
  }
  EXPECT_TRUE(WorkFolder::open(options_.output, "{}", WorkFolder::Use::alone));
}

/// Nobody has it: there is nothing to wait for.
TEST_F(ResumedBake, saysWhyALockCannotBeHad) {
  ASSERT_TRUE(bakePart(options_, 1, 2));
  options_.progress = [](double, const std::string& what) {
    return what.find("waiting") == std::string::npos;
  };
  for (const char* name : {"heights.lock", "lock"}) {
    const fs::path lock = dir_ / ".db.work" / name;
    fs::remove(lock);
    fs::create_directory(lock);
    for (const Findings& said : {bakePart(options_, 2, 2).findings(), bake(options_).findings()}) {
      EXPECT_NE(toString(said).find(lock.string()), std::string::npos) << toString(said);
      EXPECT_NE(toString(said).find("Is a directory"), std::string::npos) << toString(said);
    }
    fs::remove(lock);
  }
  ASSERT_TRUE(bake(options_));
  expectWhole(dir_ / "db");
}

TEST_F(ResumedBake, isRefusedALockWithTheReason) {
  const fs::path file = dir_ / "lock";
  const auto first = FileLock::tryLock(file, false);
  ASSERT_TRUE(first);
  EXPECT_FALSE(FileLock::tryLock(file, true));
  EXPECT_EQ(errno, EWOULDBLOCK);
  EXPECT_FALSE(FileLock::tryLock(dir_ / "absent/lock", false));
  EXPECT_EQ(errno, ENOENT);
}

TEST_F(ResumedBake, sharedByTestsWaitsForItsTurn) {
  test::RasterRecipe recipe;
  recipe.columns = recipe.rows = 900;  // more work than a bake waits for another
  recipe.value = [](int c, int r, int) { return test::roughGround(c, r); };
  const fs::path source = test::writeRaster(dir_ / "shared.tif", recipe);
  std::vector<pid_t> children;
  for (int i = 0; i < 4; ++i)
    children.push_back(start([&] {
      const auto opened = test::openOrBakeInTurn(source, dir_ / "cache");
      if (!opened) std::fprintf(stderr, "%s\n", toString(opened.findings()).c_str());
      return opened ? 0 : 1;
    }));
  for (const pid_t child : children) EXPECT_EQ(ended(child), 0);
}

/// Killed when the old database was aside and the new one not yet there.
TEST_F(ResumedBake, putsTheOldDatabaseBack) {
  const Files before = filesIn(dir_ / "whole");
  ASSERT_TRUE(bakePart(options_, 1, 2));
  fs::remove(dir_ / ".db.work/recipe.json");
  fs::copy(dir_ / "whole", dir_ / ".db.work/old");
  options_.progress = [](double fraction, const std::string&) { return fraction < 0.5; };
  EXPECT_FALSE(bake(options_));
  EXPECT_EQ(filesIn(dir_ / "db"), before);
}

TEST_F(ResumedBake, doesNotMixWhatOtherVersionsMade) {
  ASSERT_TRUE(bakePart(options_, 1, 1));
  const fs::path recipe = dir_ / ".db.work/recipe.json", piece = dir_ / ".db.work/pieces/0.pages";
  std::string text = test::readFile(recipe);
  const std::string key = "\"builder\": ";
  ASSERT_NE(text.find(key), std::string::npos);
  text.insert(text.find(key) + key.size(), "9");
  test::writeFile(recipe, text);
  const auto joined = bakeJoin(options_);
  ASSERT_FALSE(joined);
  EXPECT_NE(toString(joined.findings()).find("version of this program"), std::string::npos)
      << toString(joined.findings());
  EXPECT_TRUE(fs::exists(piece));
  test::writeFile(piece, "of another");
  const auto made = bake(options_);
  ASSERT_TRUE(made) << toString(made.findings());
  EXPECT_EQ(toString(made.findings()).find("goes on"), std::string::npos);
  expectWhole(dir_ / "db");
}

TEST_F(ResumedBake, isReadByTwoProcessesAtOnce) {
  const fs::path folder = dir_ / "whole";
  const auto readAll = [&] {
    const auto database = Database::open(folder);
    if (!database || !(*database)->checkAll().empty()) return 1;
    const auto patches = (*database)->patches();
    for (int turn = 0; turn < 5; ++turn)
      for (std::uint32_t page = 0; page < patches->index().pages.size(); ++page)
        if (!patches->readPage(page)) return 2;
    return 0;
  };
  const pid_t child = start(readAll);
  EXPECT_EQ(readAll(), 0);
  EXPECT_EQ(ended(child), 0);
}

/// Whoever has it open keeps it when it is baked again.
TEST_F(ResumedBake, leavesWhatIsOpenAsItWas) {
  options_.output = dir_ / "whole";
  const auto open = Database::open(dir_ / "whole");
  ASSERT_TRUE(open);
  options_.maxError = Metres{60};
  ASSERT_TRUE(bake(options_));
  EXPECT_TRUE((*open)->checkAll().empty());
  EXPECT_NE(filesIn(dir_ / "whole").at("patches.pages"), whole_.at("patches.pages"));
}

}  // namespace
}  // namespace trimtab::terrain
