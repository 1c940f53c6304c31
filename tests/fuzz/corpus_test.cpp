#include <errno.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

/// Returns the files of the corpus; with TRIMTAB_FUZZ_FILES=TEXT those whose name contains TEXT, such as one
/// protocol's.
std::vector<std::string> corpus() {
  const char* const wanted = std::getenv("TRIMTAB_FUZZ_FILES");
  std::vector<std::filesystem::path> files;
  const auto take = [&](const std::filesystem::path& file) {
    if (std::filesystem::is_regular_file(file) &&
        (!wanted || file.filename().string().find(wanted) != std::string::npos))
      files.push_back(file);
  };
  std::istringstream places(TRIMTAB_CORPUS);
  for (std::string place; std::getline(places, place, ':');) {
    if (!std::filesystem::exists(place)) throw std::runtime_error("the corpus has no " + place);
    if (std::filesystem::is_directory(place))
      for (const auto& entry : std::filesystem::directory_iterator(place)) take(entry.path());
    else
      take(place);
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> inputs;
  for (const auto& file : files) inputs.push_back(trimtab::test::readFile(file));
  return inputs;
}

/// Runs one input from memory of exactly its size, so that a sanitizer sees a read beyond.
void feed(const std::string& input) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(input.data());
  const std::vector<std::uint8_t> exact(bytes, bytes + input.size());
  LLVMFuzzerTestOneInput(exact.data(), exact.size());
}

/// The most memory that the program has had at once.
std::size_t mostMemoryKb() {
  struct rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss);
}
/// What takes so many seconds counts as a hang.
constexpr double kHangS = 1;
/// What one large input may add.
constexpr std::size_t kRoomKb = 64 << 10;

/// What damage looks like: changed, lost, repeated and moved bytes, and pieces of another input.
std::string mutated(std::string input, const std::string& other, std::mt19937& random) {
  const auto below = [&](std::size_t end) {
    return end == 0 ? 0 : std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
  };
  for (std::size_t edits = 1 + below(4); edits > 0; --edits) {
    const std::size_t at = below(input.size()), length = 1 + below(16);
    switch (below(6)) {
      case 0:
        if (!input.empty()) input[at] = static_cast<char>(random());
        break;
      case 1:
        if (!input.empty()) input[at] = static_cast<char>(input[at] ^ 1 << below(8));
        break;
      case 2:
        input.erase(at, length);
        break;
      case 3:
        input.insert(at, input.substr(below(input.size()), length));
        break;
      case 4:
        input.insert(at, other.substr(below(other.size()), length * 4));
        break;
      case 5:
        if (below(4) == 0) input.resize(at);
        break;
    }
  }
  return input;
}

TEST(FuzzCorpus, runsWithoutHarm) {
  const std::vector<std::string> inputs = corpus();
  ASSERT_FALSE(inputs.empty());
  for (const std::string& input : inputs) feed(input);
}

/// Returns what the environment says under this name; 0 if unset.
double numberOf(const char* name) {
  const char* const text = std::getenv(name);
  return text ? std::atof(text) : 0;
}

/// An ordinary run tries the fixed mutations of one seed. With TRIMTAB_FUZZ_COUNT=n it tries n other ones,
/// and with TRIMTAB_FUZZ_SECONDS=n other ones for so long, as tests/soak.sh asks for. TRIMTAB_FUZZ_SEED
/// repeats those of a run that found something.
TEST(FuzzCorpus, survivesRandomDamage) {
  const std::vector<std::string> inputs = corpus();
  ASSERT_FALSE(inputs.empty());
  const double seconds = numberOf("TRIMTAB_FUZZ_SECONDS"), wanted = numberOf("TRIMTAB_FUZZ_COUNT");
  const bool ordinary = seconds <= 0 && wanted <= 0;
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const char* const again = std::getenv("TRIMTAB_FUZZ_SEED");
  const auto seed = again      ? static_cast<unsigned>(std::strtoul(again, nullptr, 10))
                    : ordinary ? 20240501U
                               : std::random_device()();
  if (!ordinary) std::cout << "TRIMTAB_FUZZ_SEED=" << seed << std::endl;
  std::mt19937 random(seed);
  double count = 0, longest = 0;
  std::size_t settledKb = 0;  // once caches are full
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const auto share = [&] {
    if (seconds > 0) return since(begin) / seconds;
    return count / (ordinary ? TRIMTAB_MUTATIONS : wanted);
  };
  for (; share() < 1; ++count) {
    const std::string input =
        mutated(inputs[random() % inputs.size()], inputs[random() % inputs.size()], random);
    const auto start = Clock::now();
    feed(input);
    double took = since(start);
    if (took > kHangS) {
      // It may be that other programs had the processor.
      const auto restart = Clock::now();
      feed(input);
      took = since(restart);
    }
    longest = std::max(longest, took);
    if (settledKb == 0 && share() > 0.1) settledKb = mostMemoryKb();
  }
  if (ordinary) return;
  const std::size_t kb = mostMemoryKb();
  std::cout << program_invocation_short_name << ": " << std::fixed << std::setprecision(0) << count
            << " damaged inputs, the longest took " << std::defaultfloat << std::setprecision(2) << longest
            << " s, most memory " << kb / 1024 << " MiB, " << settledKb / 1024
            << " MiB after a tenth of the run\n";
  EXPECT_LT(longest, kHangS) << "s";
  EXPECT_LT(kb, settledKb + settledKb / 4 + kRoomKb) << "memory grows";
}

}  // namespace
