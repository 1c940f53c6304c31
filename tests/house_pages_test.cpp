#include <algorithm>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "support.h"

// Pages that name files: every name leads to a file that is there.
namespace trimtab::test {
namespace {

namespace fs = std::filesystem;

const std::set<std::string> kTops{"core", "views", "app", "presets", "resources", "tests"};

/// The folders and files of the tree, relative to its root.
std::set<std::string> treePaths() {
  std::set<std::string> paths;
  for (const std::string& top : kTops) {
    paths.insert(top);
    for (const auto& entry : fs::recursive_directory_iterator(sourceDir() / top))
      paths.insert(fs::relative(entry.path(), sourceDir()).string());
  }
  for (const auto& entry : fs::directory_iterator(sourceDir()))
    if (entry.is_regular_file()) paths.insert(entry.path().filename());
  return paths;
}

std::string withoutSlash(std::string path) {
  while (path.ends_with('/')) path.pop_back();
  return path;
}

/// Whether `words` of code name a file of the tree: a path from the root (`core/host/decoder.h`), a header as
/// it is included (`trimtab/host/decoder.h`), or a source by its name alone.
bool isPathFromRoot(const std::string& word) {
  const std::size_t slash = word.find('/');
  return slash != std::string::npos && kTops.count(word.substr(0, slash)) > 0;
}
bool isSourceName(const std::string& word) {
  static const std::regex name("[a-z0-9_*]+(/[a-z0-9_*]+)*\\.(h|cpp|inl|glsl|cmake)");
  return std::regex_match(word, name);
}

/// The pattern of a path with `*` for any part of a name.
std::regex asPattern(const std::string& path) {
  return std::regex("(.*/)?" + std::regex_replace(std::regex_replace(path, std::regex("[.+]"), "\\$&"),
                                                  std::regex("\\*"), "[^/]*"));
}

class Pages {
 public:
  Pages() : paths_(treePaths()) {}

  /// What `page` names that is not in the tree.
  std::vector<std::string> missing(const std::string& page, const std::string& text) {
    std::vector<std::string> lost;
    const fs::path folder = fs::path(page).parent_path();
    static const std::regex link("\\]\\(([^)#\\s]+)[^)]*\\)"), code("`([^`]+)`"), word("[^\\s\"',;]+");
    for (std::sregex_iterator i(text.begin(), text.end(), link), end; i != end; ++i) {
      const std::string target = (*i)[1];
      // A target has a dot or a slash; `[](bool)` of an example in C++ has neither.
      if (target.find("://") != std::string::npos || target.find_first_of("./") == std::string::npos)
        continue;
      ++seen_;
      if (!has(withoutSlash((folder / target).lexically_normal().string()))) lost.push_back(target);
    }
    for (std::sregex_iterator i(text.begin(), text.end(), code), end; i != end; ++i) {
      const std::string words = (*i)[1];
      for (std::sregex_iterator w(words.begin(), words.end(), word); w != end; ++w)
        if (!isNamed(folder.string(), w->str())) lost.push_back(w->str());
    }
    return lost;
  }
  std::size_t seen() const { return seen_; }

 private:
  bool has(const std::string& path) const { return path.empty() || path == "." || paths_.count(path) > 0; }
  bool matches(const std::string& pattern, const std::string& folder) const {
    const std::regex wanted = asPattern(pattern);
    for (const std::string& path : paths_)
      if ((folder.empty() || path.starts_with(folder + "/")) && std::regex_match(path, wanted)) return true;
    return false;
  }

  /// True also for words that name no file, and for patterns with a place for a name (`core/MODULE/x.h`).
  bool isNamed(const std::string& folder, std::string word) {
    static const std::regex placeholder(".*(<|MODULE|NAME|\\{|\\$).*"), line(":[0-9]+$");
    word = withoutSlash(std::regex_replace(word, line, ""));
    const bool included = word.starts_with("trimtab/") && word.ends_with(".h");
    if (std::regex_match(word, placeholder) || !(included || isPathFromRoot(word) || isSourceName(word)))
      return true;
    ++seen_;
    if (isPathFromRoot(word) && word.find('*') == std::string::npos) return has(word);
    // A room's page names the files of the room; a page of the root or of the docs those of the whole tree.
    const bool ofWholeTree = included || isPathFromRoot(word) || folder.starts_with("resources");
    return matches(word, ofWholeTree ? "" : folder);
  }

  std::set<std::string> paths_;
  std::size_t seen_ = 0;
};

TEST(Pages, nameOnlyFilesThatExist) {
  Pages pages;
  for (const std::string& path : treePaths())
    if (path.ends_with(".md"))
      for (const std::string& name : pages.missing(path, readFile(sourceDir() / path)))
        ADD_FAILURE() << path << " names " << name << ", which is not there";
  EXPECT_GT(pages.seen(), 500u) << "the test does not find the names";
}

TEST(Pages, findsNamesThatAreNotThere) {
  Pages pages;
  const std::string text =
      "[a](README.md) [b](gone.md#part) [c](https://x.y/z) [d](../host/) `core/host/gone.h`, "
      "`core/host/decoder.cpp:12`\n"
      "`trimtab/host/decoder.h` `trimtab/host/gone.h` `core/preset/*_rows.h` `core/host/*_gone.h` "
      "`core/NAME/x.h`\n"
      "`bash tests/run.sh --only x` `bash tests/gone.sh` `decoder.h` `session.h` `a/b` `preset.fll`";
  EXPECT_EQ(pages.missing("core/host/README.md", text),
            (std::vector<std::string>{"gone.md", "core/host/gone.h", "trimtab/host/gone.h",
                                      "core/host/*_gone.h", "tests/gone.sh", "session.h"}));
}

TEST(Pages, theReadmeIsShortAndItsTreeIsWhole) {
  const std::string text = readFile(sourceDir() / "README.md");
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 150);
  for (const char* parent : {"core", "app", "views"})
    for (const auto& entry : fs::directory_iterator(sourceDir() / parent)) {
      const std::string name = entry.path().filename();
      if (!entry.is_directory() || name == "include") continue;
      const std::string tree = text.substr(std::min(text.size(), text.find("## The tree")));
      const std::regex line(std::string(parent) == "core"
                                ? "\n    core/" + name + " +[a-zA-Z]"
                                : "\n    " + std::string(parent) + "/ [^\n]*" + name);
      EXPECT_TRUE(std::regex_search(tree, line)) << "the README's tree lacks " << parent << '/' << name;
    }
}

}  // namespace
}  // namespace trimtab::test
