#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <set>

#include "faults.h"
#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/host/flight.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"

/// Every call on a file fails once in every way, and the process is killed after each. The promise: there is
/// the old state or the new one, a failure says why, and the next run leaves the new state and nothing else.
namespace trimtab {
namespace {

namespace fs = std::filesystem;
using test::faults::Way;
using Tree = std::map<std::string, std::string>;

/// All files below a folder, with what they hold.
Tree treeOf(const fs::path& folder) {
  Tree tree;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    tree[entry.path().lexically_relative(folder).string()] =
        entry.is_regular_file() ? test::readFile(entry.path()) : "a folder";
  return tree;
}

struct Case {
  /// Makes the old state in a folder; then the work, which is to lead to the new state and returns why it did
  /// not.
  std::function<void(const fs::path&)> begin;
  std::function<Findings(const fs::path&)> work;
  /// What may be there after a disturbed run beside the old state or the new one: work in hand.
  std::function<bool(const std::string&)> mayStay;
  /// Every so many points is tried; 1 with TRIMTAB_INJECTION=all.
  long stride = 1;
};

constexpr int kSilent = 1, kDone = 0, kRefused = 2;

class Injection : public ::testing::Test {
 protected:
  /// Works in a process of its own. Returns its exit code, or 128 + signal.
  static int run(const fs::path& folder, const Case& of, long call, Way way, long* calls = nullptr) {
    int ends[2];
    if (::pipe(ends) != 0) return -1;
    const pid_t child = ::fork();
    if (child == 0) {
      ::alarm(60);
      test::faults::watch(folder);
      test::faults::disturb(call, way);
      const Findings findings = of.work(folder);
      const long number = test::faults::calls();
      static_cast<void>(::write(ends[1], &number, sizeof number));
      const bool says = std::all_of(findings.begin(), findings.end(), [](const Finding& f) {
        return !f.where.empty() && !(f.expected.empty() && f.found.empty());
      });
      ::_exit(findings.empty() ? kDone : says ? kRefused : kSilent);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ::close(ends[1]);
    if (calls && ::read(ends[0], calls, sizeof *calls) != sizeof *calls) *calls = 0;
    ::close(ends[0]);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  void tryAll(const char* name, Case of) {
    test::ScratchDir place;
    const fs::path folder = place / "work";
    const auto begin = [&] {
      fs::remove_all(folder);
      fs::create_directory(folder);
      of.begin(folder);
    };
    begin();
    const Tree old = treeOf(folder);
    long points = 0;
    ASSERT_EQ(run(folder, of, -1, Way::killed, &points), kDone);
    const Tree good = treeOf(folder);
    ASSERT_NE(old, good);
    ASSERT_GT(points, 0);
    if (const char* all = std::getenv("TRIMTAB_INJECTION"); all && std::string(all) == "all") of.stride = 1;
    long runs = 0, violations = 0, turn = 0;
    for (long point = 0; point < points; ++point)
      for (const Way way : test::faults::kWays) {
        if (turn++ % of.stride != 0) continue;
        ++runs;
        begin();
        const int code = run(folder, of, point, way);
        const Tree disturbed = treeOf(folder);
        const int again = run(folder, of, -1, Way::killed);
        const Tree end = treeOf(folder);
        std::string fault;
        if (code != kDone && code != kRefused && !(way == Way::killed && code == 128 + SIGKILL))
          fault = "it ended with " + std::to_string(code);
        else if (!isEither(disturbed, old, good, of))
          fault = "neither the old state nor the new one";
        else if (code == kDone && !isEither(disturbed, good, good, of))
          fault = "it said that all was well, and it was not";
        else if (again != kDone || end != good)
          fault = "the next run ended with " + std::to_string(again) + " and left " + namesOf(end);
        if (fault.empty()) continue;
        if (++violations <= 20)
          ADD_FAILURE() << name << ", call " << point << ", " << nameOf(way) << ": " << fault << "; after it "
                        << namesOf(disturbed);
      }
    std::cout << name << ": " << points << " calls, " << runs << " runs, " << violations << " violations\n";
  }

 private:
  static bool isEither(const Tree& tree, const Tree& a, const Tree& b, const Case& of) {
    Tree kept;
    for (const auto& [name, bytes] : tree)
      if (a.contains(name) || b.contains(name) || !of.mayStay(name)) kept.emplace(name, bytes);
    return kept == a || kept == b;
  }
  static std::string namesOf(const Tree& tree) {
    std::string names;
    for (const auto& [name, bytes] : tree) names += name + " ";
    return names;
  }
};

TEST_F(Injection, ofASaveOfAPreset) {
  Preset preset;
  preset.name = "new";
  preset.parameters.lod.scale = Ratio{2};
  tryAll("preset", {[](const fs::path& folder) { test::writeFile(folder / "p.json", "{\"the old\": 1}"); },
                    [&](const fs::path& folder) {
                      const auto text = presetText(preset);
                      if (!text) return text.findings();
                      return writeAtomically(folder / "p.json", *text).findings();
                    },
                    [](const std::string& name) { return name.starts_with(".p.json.trimtab-"); }});
}

TEST_F(Injection, ofARecording) {
  const auto write = [](const fs::path& folder) -> Findings {
    auto writer = PcapWriter::open(folder / "r.pcap.part");
    if (!writer) return writer.findings();
    PcapWriter& pcap = *writer;
    for (int i = 0; i < 3; ++i) {
      const CapturedDatagram datagram{1.0 + i, "127.0.0.1:1", "127.0.0.1:2", std::vector<std::byte>(100)};
      if (auto done = pcap.add({&datagram, 1}); !done) {
        // All or none: what is there reads back.
        const auto there = readPcap(folder / "r.pcap.part");
        return there && there->size() == pcap.size() ? done.findings() : Findings{Finding{}};
      }
    }
    if (auto done = pcap.close(); !done) return done.findings();
    return putInPlace(folder / "r.pcap.part", folder / "r.pcap").findings();
  };
  tryAll("recording", {[](const fs::path& folder) { test::writeFile(folder / "r.pcap", "the old one"); },
                       write, [](const std::string& name) { return name == "r.pcap.part"; }});
}

class BakeInjection : public Injection {
 protected:
  BakeInjection() {
    test::RasterRecipe recipe;
    recipe.columns = 40;
    recipe.rows = 34;
    recipe.value = [](int c, int r, int) { return test::roughGround(c, r); };
    options_.sources = {test::writeRaster(source_ / "ground.tif", recipe)};
  }
  Findings bakeIn(const fs::path& folder) const {
    terrain::BakeOptions options = options_;
    options.output = folder / "db";
    const auto made = terrain::bake(options);
    if (made) return {};
    // A note of what is kept is no reason.
    return made.findings();
  }
  static bool isWork(const std::string& name) { return name.starts_with(".db.work"); }

  test::ScratchDir source_;
  terrain::BakeOptions options_;
};

TEST_F(BakeInjection, ofABake) {
  tryAll("bake",
         {[](const fs::path&) {}, [&](const fs::path& folder) { return bakeIn(folder); }, isWork, 97});
}

TEST_F(BakeInjection, ofABakeInPlaceOfAnotherDatabase) {
  terrain::BakeOptions old = options_;
  test::RasterRecipe recipe;
  recipe.columns = recipe.rows = 20;
  recipe.value = [](int c, int r, int) { return double(c + r); };
  old.sources = {test::writeRaster(source_ / "old.tif", recipe)};
  old.output = source_ / "old";
  ASSERT_TRUE(terrain::bake(old));
  tryAll("bake over a database", {[&](const fs::path& folder) {
                                    fs::copy(source_ / "old", folder / "db", fs::copy_options::recursive);
                                  },
                                  [&](const fs::path& folder) { return bakeIn(folder); }, isWork, 211});
}

}  // namespace
}  // namespace trimtab
