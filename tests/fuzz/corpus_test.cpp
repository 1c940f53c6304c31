#include <errno.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <random>
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
  std::istringstream folders(TRIMTAB_CORPUS);
  for (std::string folder; std::getline(folders, folder, ':');)
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.is_regular_file() &&
          (!wanted || entry.path().filename().string().find(wanted) != std::string::npos))
        files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> inputs;
  for (const auto& file : files) inputs.push_back(trimtab::test::readFile(file));
  return inputs;
}

/// Runs one input from memory of exactly its size, so that a sanitizer sees a read beyond.
void feed(const std::string& input) {
  const std::vector<std::uint8_t> exact(input.begin(), input.end());
  LLVMFuzzerTestOneInput(exact.data(), exact.size());
}

/// The most memory that the program has had at once.
std::size_t mostMemoryKb() {
  struct rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss);
}
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

/// The fixed mutations of an ordinary run; with TRIMTAB_FUZZ_SECONDS=n other ones for so long, as
/// tests/soak.sh asks for. TRIMTAB_FUZZ_SEED repeats those of a run that found something.
TEST(FuzzCorpus, survivesRandomDamage) {
  const std::vector<std::string> inputs = corpus();
  ASSERT_FALSE(inputs.empty());
  const char* const seconds = std::getenv("TRIMTAB_FUZZ_SECONDS");
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const char* const again = std::getenv("TRIMTAB_FUZZ_SEED");
  const auto seed = again     ? static_cast<unsigned>(std::strtoul(again, nullptr, 10))
                    : seconds ? std::random_device()()
                              : 20240501U;
  if (seconds) std::cout << "TRIMTAB_FUZZ_SEED=" << seed << std::endl;
  std::mt19937 random(seed);
  long count = 0;
  double longest = 0;
  std::size_t settledKb = 0;  // once caches are full
  const auto goesOn = [&] {
    const std::chrono::duration<double> run = Clock::now() - begin;
    return seconds ? run.count() < std::atof(seconds) : count < TRIMTAB_MUTATIONS;
  };
  for (; goesOn(); ++count) {
    const std::string input =
        mutated(inputs[random() % inputs.size()], inputs[random() % inputs.size()], random);
    const auto start = Clock::now();
    feed(input);
    longest = std::max(longest, std::chrono::duration<double>(Clock::now() - start).count());
    if (settledKb == 0 && seconds &&
        Clock::now() - begin > std::chrono::duration<double>(std::atof(seconds) / 10))
      settledKb = mostMemoryKb();
  }
  if (!seconds) return;
  const std::size_t kb = mostMemoryKb();
  std::cout << program_invocation_short_name << ": " << count << " damaged inputs, the longest took "
            << longest << " s, most memory " << kb / 1024 << " MiB, " << settledKb / 1024
            << " MiB after a tenth of the time\n";
  EXPECT_LT(longest, 1) << "s";
  EXPECT_LT(kb, settledKb + settledKb / 4 + kRoomKb) << "memory grows";
}

}  // namespace
