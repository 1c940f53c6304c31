#include "injection.h"

#include <sched.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>

namespace trimtab::test {
namespace {

namespace fs = std::filesystem;

constexpr int kSilent = 1, kDone = 0, kRefused = 2;

Tree treeOf(const fs::path& folder) {
  Tree tree;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    tree[entry.path().lexically_relative(folder).string()] =
        entry.is_regular_file() ? readFile(entry.path()) : "a folder";
  return tree;
}
std::string namesOf(const Tree& tree) {
  std::string names;
  for (const auto& [name, bytes] : tree) names += name + " ";
  return names;
}
bool isEither(const Tree& tree, const Tree& a, const Tree& b, const WriteCase& of) {
  Tree kept;
  for (const auto& [name, bytes] : tree)
    if (a.contains(name) || b.contains(name) || !of.mayStay(name)) kept.emplace(name, bytes);
  if (!of.inSteps || a == b) return kept == a || kept == b;
  return std::all_of(kept.begin(), kept.end(), [&](const auto& file) {
    const auto is = [&](const Tree& state) {
      const auto there = state.find(file.first);
      return there != state.end() && there->second == file.second;
    };
    return is(a) || is(b);
  });
}

/// What a process of its own did.
struct ChildRun {
  int code = -1;  ///< its exit code, or 128 + signal
  long calls = 0;
  bool disturbed = false;
  std::string found;
};

/// Works in a process of its own, whose call of this number is disturbed. `work` sets what it found.
ChildRun runDisturbed(const fs::path& watched, long call, Way way,
                      const std::function<Findings(std::string&)>& work) {
  int ends[2];
  if (::pipe(ends) != 0) return {};
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(60);
    ::close(ends[0]);
    // On one processor a bake has one thread, so that a call has the same number in each run.
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(::sched_getcpu(), &one);
    ::sched_setaffinity(0, sizeof one, &one);
    std::string found;
    faults::watch(watched);
    faults::disturb(call, way);
    const Findings findings = work(found);
    const long calls = faults::calls();
    const bool disturbed = faults::happened();
    faults::stop();
    std::string text(reinterpret_cast<const char*>(&calls), sizeof calls);
    text += disturbed ? 'y' : 'n';
    text += found;
    for (std::string_view left = text; !left.empty();) {
      const ssize_t wrote = ::write(ends[1], left.data(), left.size());
      if (wrote <= 0) break;
      left.remove_prefix(static_cast<std::size_t>(wrote));
    }
    const bool says = std::all_of(findings.begin(), findings.end(), [](const Finding& f) {
      return !f.where.empty() && !(f.expected.empty() && f.found.empty());
    });
    ::_exit(findings.empty() ? kDone : says ? kRefused : kSilent);
  }
  ::close(ends[1]);
  std::string text;
  std::array<char, 65536> block;
  for (ssize_t got; (got = ::read(ends[0], block.data(), block.size())) > 0;)
    text.append(block.data(), static_cast<std::size_t>(got));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  ChildRun ran;
  ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (text.size() > sizeof ran.calls) {
    std::copy_n(text.data(), sizeof ran.calls, reinterpret_cast<char*>(&ran.calls));
    ran.disturbed = text[sizeof ran.calls] == 'y';
    ran.found = text.substr(sizeof ran.calls + 1);
  }
  return ran;
}

bool exhaustive() {
  const char* all = std::getenv("TRIMTAB_INJECTION");
  return all && std::string(all) == "all";
}

/// Counts and reports what went wrong.
class Violations {
 public:
  explicit Violations(const char* name) : name_(name) {}
  void add(long point, Way way, const std::string& fault) {
    constexpr long kShown = 20;
    if (++count_ <= kShown)
      ADD_FAILURE() << name_ << ", call " << point << ", " << faults::nameOf(way) << ": " << fault;
  }
  void report(long points, long runs) const {
    std::cout << name_ << ": " << points << " calls, " << runs << " runs, " << count_ << " violations\n";
  }

 private:
  const char* name_;
  long count_ = 0;
};

}  // namespace

void Injection::writes(const char* name, WriteCase of) {
  ScratchDir place;
  const fs::path folder = place / "work";
  const auto begin = [&] {
    fs::remove_all(folder);
    fs::create_directory(folder);
    of.begin(folder);
  };
  const auto run = [&](long call, Way way) {
    return runDisturbed(folder, call, way, [&](std::string&) {
      faults::haveUnnamedFiles(of.unnamed);
      return of.work(folder);
    });
  };
  begin();
  const Tree old = treeOf(folder);
  const ChildRun undisturbed = run(-1, Way::killed);
  ASSERT_EQ(undisturbed.code, kDone);
  const Tree good = treeOf(folder);
  ASSERT_NE(old, good);
  ASSERT_GT(undisturbed.calls, 0);
  const long stride = exhaustive() ? 1 : of.stride;
  long runs = 0, turn = 0;
  Violations violations(name);
  for (long point = 0; point < undisturbed.calls; ++point)
    for (const Way way : faults::kWays) {
      if (turn++ % stride != 0) continue;
      ++runs;
      begin();
      const int code = run(point, way).code;
      const Tree disturbed = treeOf(folder);
      const std::string kept = of.between ? of.between(folder) : std::string();
      const int again = run(-1, Way::killed).code;
      Tree end = treeOf(folder);
      if (!of.unnamed)
        std::erase_if(end, [](const auto& f) { return f.first.ends_with(".mark") && f.second.empty(); });
      std::string fault;
      if (code != kDone && code != kRefused && !(way == Way::killed && code == 128 + SIGKILL))
        fault = "it ended with " + std::to_string(code);
      else if (!isEither(disturbed, old, good, of))
        fault = "neither the old state nor the new one";
      else if (code == kDone && !isEither(disturbed, good, good, of))
        fault = "it said that all was well, and it was not";
      else if (!kept.empty())
        fault = kept;
      else if (again != kDone || end != good)
        fault = "the next run ended with " + std::to_string(again) + " and left " + namesOf(end);
      if (!fault.empty()) violations.add(point, way, fault + "; after it " + namesOf(disturbed));
    }
  violations.report(undisturbed.calls, runs);
}

void Injection::reads(const char* name, ReadCase of) {
  ScratchDir place;
  of.begin(place.path());
  const auto run = [&](long call, Way way) {
    return runDisturbed(place.path(), call, way, [&](std::string& found) {
      const Result<std::string> read = of.read(place.path());
      if (!read) return read.findings();
      found = *read;
      return Findings{};
    });
  };
  const ChildRun undisturbed = run(-1, Way::killed);
  ASSERT_EQ(undisturbed.code, kDone);
  ASSERT_GT(undisturbed.calls, 0);
  ASSERT_FALSE(undisturbed.found.empty());
  const long stride = exhaustive() ? 1 : of.stride;
  long runs = 0, turn = 0, refused = 0;
  Violations violations(name);
  for (long point = 0; point < undisturbed.calls; ++point)
    for (const Way way : {Way::io_error, Way::no_permission, Way::interrupted, Way::short_count}) {
      if (turn++ % stride != 0) continue;
      ++runs;
      const ChildRun ran = run(point, way);
      refused += ran.code == kRefused;
      if (ran.code != kDone && ran.code != kRefused)
        violations.add(point, way, "it ended with " + std::to_string(ran.code));
      else if (ran.code == kDone && ran.found != undisturbed.found)
        violations.add(point, way, "it read something else and said nothing");
      else if (ran.code == kRefused && way == Way::short_count)
        violations.add(point, way, "a short read is no reason to refuse");
    }
  violations.report(undisturbed.calls, runs);
  EXPECT_GT(refused, 0) << "no call was disturbed";
}

}  // namespace trimtab::test
