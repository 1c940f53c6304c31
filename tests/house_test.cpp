#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "cpp_outline.h"
#include "support.h"

// What keeps the tree easy to take over: layers, small folders, small files. CMake's link targets say the
// same of what they can see; private headers are included by their path, which only a reading of the includes
// can judge.
namespace trimtab::test {
namespace {

namespace fs = std::filesystem;

/// A folder includes from itself and from folders that stand before it.
const std::vector<std::string> kLayers{"core/units",
                                       "core/policy",
                                       "core/preset",
                                       "core/frame",
                                       "core/host",
                                       "core/motion",
                                       "core/fuzzy",
                                       "core/weather",
                                       "core/culling",
                                       "core/hold",
                                       "core/decision",
                                       "core/measure",
                                       "core/session",
                                       "core/rig",
                                       "core/interface",
                                       "core/terrain/grid",
                                       "core/terrain/format",
                                       "core/terrain/mesh",
                                       "core/terrain/cdb",
                                       "core/terrain/elevation",
                                       "core/terrain/scenery",
                                       "core/terrain/patches",
                                       "core/terrain/static_lod",
                                       "core/terrain/ground",
                                       "core/terrain/objects",
                                       "core/terrain/bake",
                                       "core/terrain/synthetic",
                                       "core/scene",
                                       "views",
                                       "app/link",
                                       "app/models",
                                       "app/manual",
                                       "app/experiment",
                                       "app/harness",
                                       "app/tune",
                                       "app/cli",
                                       "app/ig",
                                       "app/workbench",
                                       "resources",
                                       "tests"};

std::size_t layerOf(const std::string& path) {
  for (std::size_t i = 0; i < kLayers.size(); ++i)
    if (path.starts_with(kLayers[i] + "/")) return i;
  return kLayers.size();
}

/// The file that an include names, relative to the root; empty where it is none of ours.
std::string included(const std::string& name) {
  if (!name.starts_with("trimtab/")) return name.find('/') == std::string::npos ? "" : name;
  if (name == "trimtab/trimtab.h") return "core/interface/include/" + name;  // as programs in C spell it
  const std::string module = name.substr(8, name.rfind('/') - 8);
  return "core/" + module + "/include/" + name;
}

std::vector<fs::path> sources() {
  std::vector<fs::path> files;
  for (const char* top : {"core", "views", "app", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(sourceDir() / top)) {
      const std::string ending = entry.path().extension();
      if (entry.is_regular_file() &&
          (ending == ".cpp" || ending == ".h" || ending == ".inl" || ending == ".glsl"))
        files.push_back(fs::relative(entry.path(), sourceDir()));
    }
  return files;
}

TEST(House, includesOnlyFromFoldersLowerDown) {
  const std::regex include("^#include \"([^\"]+)\"");
  std::size_t seen = 0;
  for (const fs::path& file : sources()) {
    std::ifstream in(sourceDir() / file);
    const std::size_t layer = layerOf(file.string());
    ASSERT_LT(layer, kLayers.size()) << file << " is in no layer";
    for (std::string line; std::getline(in, line);) {
      std::smatch match;
      if (!std::regex_search(line, match, include)) continue;
      const std::string target = included(match[1]);
      if (target.empty()) continue;
      ++seen;
      EXPECT_TRUE(fs::exists(sourceDir() / target))
          << file << " includes " << match[1] << ", which is not there";
      EXPECT_LE(layerOf(target), layer) << file << " includes " << target << " from a higher layer";
      const bool isPrivate = target.starts_with("core/") && target.find("/include/") == std::string::npos;
      EXPECT_TRUE(!isPrivate || layerOf(target) == layer || layer + 1 == kLayers.size())
          << file << " includes a private header of another module: " << target;
    }
  }
  EXPECT_GT(seen, 2000u) << "the test does not find the includes";
}

TEST(House, noFoldersOfTheProductIncludeEachOther) {
  const std::regex include("^#include \"([^\"]+)\"");
  std::map<std::string, std::set<std::string>> uses;
  for (const fs::path& file : sources()) {
    if (file.string().starts_with("tests/")) continue;
    std::ifstream in(sourceDir() / file);
    for (std::string line; std::getline(in, line);)
      if (std::smatch match; std::regex_search(line, match, include))
        if (const fs::path target = included(match[1]);
            !target.empty() && target.parent_path() != file.parent_path())
          uses[file.parent_path()].insert(target.parent_path());
  }
  EXPECT_GT(uses.size(), 60u) << "the test does not find the includes";
  for (const auto& [folder, first] : uses) {
    std::set<std::string> reached = first;
    for (std::vector<std::string> next(first.begin(), first.end()); !next.empty();) {
      const std::string from = next.back();
      next.pop_back();
      for (const std::string& to : uses[from])
        if (reached.insert(to).second) next.push_back(to);
    }
    std::string through;
    for (const std::string& to : first)
      if (uses[to].contains(folder)) through += " " + to;
    EXPECT_FALSE(reached.contains(folder))
        << folder << " includes itself by way of other folders;" << through;
  }
}

TEST(House, keepsFoldersAndFilesSmall) {
  constexpr std::size_t kMostFiles = 40, kMostLines = 450;
  std::map<std::string, std::size_t> folders;
  for (const fs::path& file : sources()) {
    ++folders[file.parent_path().string()];
    std::ifstream in(sourceDir() / file);
    std::size_t lines = 0;
    for (std::string line; std::getline(in, line);) ++lines;
    EXPECT_LE(lines, kMostLines) << file;
  }
  for (const auto& [folder, files] : folders) EXPECT_LE(files, kMostFiles) << folder;
}

TEST(House, keepsClassesAndArgumentListsShort) {
  constexpr std::size_t kMostMembers = 40, kMostArguments = 9;
  std::size_t classes = 0, functions = 0;
  for (const fs::path& file : sources()) {
    if (file.extension() == ".glsl") continue;
    const CppOutline outline(readFile(sourceDir() / file));
    EXPECT_TRUE(outline.complete()) << file;
    for (const Declared& a : outline.classes())
      EXPECT_LE(a.count, kMostMembers) << file.string() << ':' << a.line << ": members of " << a.name;
    for (const Declared& a : outline.functions())
      EXPECT_LE(a.count, kMostArguments) << file.string() << ':' << a.line << ": arguments of " << a.name;
    classes += outline.classes().size();
    functions += outline.functions().size();
  }
  EXPECT_GT(classes, 1000u) << "the test does not find the classes";
  EXPECT_GT(functions, 5000u) << "the test does not find the functions";
}

std::string namesAndCounts(const std::vector<Declared>& declared) {
  std::string text;
  for (const Declared& a : declared)
    text += std::to_string(a.line) + ": " + a.name + ": " + std::to_string(a.count) + '\n';
  return text;
}

TEST(CppOutline, countsDataMembersAndArguments) {
  const CppOutline outline(R"--(
namespace a { extern "C" { int c(void*); } }
template <class T, class U = int>
class Box : public Base<T, 3>, private Other {
  Q_OBJECT
 public:
  explicit Box(std::map<int, int> m, int n = f(1, 2)) : Base<T, 3>(n), x_{n}, m_(m, 3) { int notAMember; }
  bool operator()(int a, const std::function<void(int, int)>& f) const noexcept { return a < 3; }
  Box& operator=(const Box&) = default;
  static constexpr int kNone = 1'000;  // int commented;
  enum class Kind { one, two };
  using Map = std::map<int, int>;
  friend class Friend;
  struct Inner { int a, b = 2; std::array<float, 2> c{{1, 2}}; };
  struct { int d; } unnamed_;

 private:
  std::function<void(int, int)> call_ = [](int a, int b) { return; };
  Map<int, int> m_{{1, 2}, {3, 4}}, other_;
  int x_ : 3;
  alignas(64) std::atomic<int> y_{f('"', "}")};
};
#define IGNORED(a, b) \\
  struct {
const int kValues[] = {1, 2};
auto last(int a, int b, int c) -> Box<int> { return R"(})"; }
)--");
  EXPECT_TRUE(outline.complete());
  EXPECT_EQ(namesAndCounts(outline.classes()),
            "14: struct Inner: 3\n15: struct: 1\n4: template class Box : public Base private Other: 6\n");
  EXPECT_EQ(namesAndCounts(outline.functions()),
            "2: int c: 1\n7: explicit Box: 2\n8: bool operator const noexcept: 2\n"
            "9: Box & operator =: 1\n26: auto last -> Box: 3\n");
}

}  // namespace
}  // namespace trimtab::test
