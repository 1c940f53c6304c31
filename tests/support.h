#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

/// What tests share: where things are, and real data that may be absent.
namespace trimtab::test {

/// The root of the source tree.
std::filesystem::path sourceDir();
/// The folder that programs and tests are built into.
std::filesystem::path programDir();
inline std::filesystem::path program(const std::string& name) {
  return programDir() / name;
}

/// Real terrain, flights and captures beside the checkout (or where TRIMTAB_SHARED says).
inline std::filesystem::path sharedDir() {
  if (const char* dir = std::getenv("TRIMTAB_SHARED")) return dir;
  return sourceDir().parent_path() / "shared";
}

/// A folder of one test, emptied at its start and removed at its end.
class ScratchDir {
 public:
  ScratchDir() {
    std::string pattern = (std::filesystem::temp_directory_path() / "trimtab-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~ScratchDir() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchDir(const ScratchDir&) = delete;
  ScratchDir& operator=(const ScratchDir&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::string readFile(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}
inline void writeFile(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

inline std::vector<std::string> namesIn(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Runs a shell command; standard output and standard error apart.
struct Ran {
  int exitCode = -1;
  std::string out, err;
};
inline Ran run(const std::string& command) {
  ScratchDir dir;
  const int status = std::system(
      ("{ " + command + "\n} >" + (dir / "out").string() + " 2>" + (dir / "err").string()).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), readFile(dir / "out"),
          readFile(dir / "err")};
}

}  // namespace trimtab::test

/// Skips the test, saying what is absent, when real data is not beside the checkout.
#define TRIMTAB_NEEDS_SHARED(relative)                                     \
  if (!std::filesystem::exists(::trimtab::test::sharedDir() / (relative))) \
  GTEST_SKIP() << "needs " << (::trimtab::test::sharedDir() / (relative)).string()
