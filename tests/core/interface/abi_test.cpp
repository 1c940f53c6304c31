#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

#include "tests/support.h"

// What programs that were built with version 1 of libtrimtab rely on. core/interface/libtrimtab-1.abi is the
// dump of version 1. It changes only with the library's SOVERSION; dumpOf() below says how it is made.
namespace trimtab::test {
namespace {

const std::string kFolder = (sourceDir() / "core/interface").string();

std::string header() {
  return readFile(kFolder + "/include/trimtab/trimtab.h");
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from << " is not in the header";
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// Builds a library that has the header's functions with empty bodies, so that a dump of it holds the types
/// that programs see and none of those behind the handles.
std::string dumpOf(const std::string& header, const ScratchDir& dir) {
  const std::string code =
      std::regex_replace(std::regex_replace(header, std::regex(R"(/\*[^]*?\*/)"), ""),
                         std::regex(R"((\btrimtab_\w+\([^()]*\));)"), "$1 { for (;;) {} }");
  writeFile(dir / "stub.c", code);
  const Ran ran =
      run("cd " + dir.path().string() + " && cc -g -std=c99 -shared -fPIC stub.c -o libtrimtab.so.1 " +
          "-Wl,-soname,libtrimtab.so.1 -Wl,--version-script=" + kFolder + "/libtrimtab.map" +
          " && abidw --no-comp-dir-path --no-corpus-path --no-show-locs --type-id-style hash"
          " --out-file now.abi libtrimtab.so.1");
  EXPECT_EQ(ran.exitCode, 0) << ran.err;
  return (dir / "now.abi").string();
}

/// Returns the lines of abidiff's report that a program of version 1 cannot live with. Its exit code is the
/// same for fields that are appended and that are swapped, and a suppression of appended fields
/// (has_data_member_inserted_at = end) hides swapped ones too, so the report is read line by line: what is
/// not known to be harmless counts.
std::string broken(const std::string& header) {
  const ScratchDir dir;
  const Ran ran = run("abidiff " + kFolder + "/libtrimtab-1.abi " + dumpOf(header, dir));
  EXPECT_EQ(ran.exitCode & 3, 0) << "abidiff could not compare: " << ran.err;
  static const std::regex harmless(
      R"(\s*|Functions changes summary: 0 Removed, .*|Variables changes summary: 0 Removed, .*|)"
      R"(\d+ functions? with some indirect sub-type change:|\s*\[C\] 'function .* has some indirect sub-type changes:|)"
      R"(\s*parameter \d+ of type .* has sub-type changes:|\s*in (pointed to|unqualified underlying) type .*|)"
      R"(\s*underlying type 'struct .*' changed:|\s*type size changed from .*|\s*\d+ data member insertions?:|)"
      R"(\s*'.*', at offset \d+ \(in bits\)|\s*\d+ Added functions?:|\s*\[A\] 'function .*)");
  std::string lines;
  std::istringstream report(ran.out);
  for (std::string line; std::getline(report, line);)
    if (!std::regex_match(line, harmless)) lines += line + '\n';
  return lines;
}

TEST(Abi, isThatOfVersionOne) {
  EXPECT_EQ(broken(header()), "");
}

TEST(Abi, mayAppendAField) {
  EXPECT_EQ(broken(replaced(header(), "layer_top_m, near_far_ratio;", "layer_top_m, near_far_ratio, more;")),
            "");
}

TEST(Abi, mayNotSwapTwoFields) {
  const std::string swapped =
      replaced(header(), "double altitude_ft, total_membership;", "double total_membership, altitude_ft;");
  EXPECT_NE(broken(swapped).find("offset changed"), std::string::npos);
  const std::string also =
      replaced(swapped, "layer_top_m, near_far_ratio;", "layer_top_m, near_far_ratio, more;");
  EXPECT_NE(broken(also).find("offset changed"), std::string::npos);
}

TEST(Abi, mayNotLoseAFunctionAnArgumentOrAValue) {
  EXPECT_NE(broken(replaced(header(), "const char* trimtab_version(void);", "")), "");
  EXPECT_NE(broken(replaced(header(), "double* value, trimtab_step* step);", "double* value);")), "");
  EXPECT_NE(broken(replaced(header(), "TRIMTAB_REFUSED = 2", "TRIMTAB_REFUSED = 5")), "");
}

TEST(Abi, exportsWhatTheHeaderDeclaresAndNothingElse) {
  std::set<std::string> declared, exported;
  const std::string text = header();
  const std::regex name(R"(\b(trimtab_\w+)\([^()]*\);)");
  for (std::sregex_iterator at(text.begin(), text.end(), name), end; at != end; ++at)
    declared.insert((*at)[1]);
  std::istringstream symbols(run("nm -D --defined-only --format=just-symbols " TRIMTAB_LIBRARY).out);
  for (std::string symbol; symbols >> symbol;)
    if (symbol.starts_with("trimtab_") || symbol.find("@@") != std::string::npos)
      exported.insert(symbol.substr(0, symbol.find('@')));
    else
      EXPECT_TRUE(symbol == "TRIMTAB_1" || symbol == "TRIMTAB_2") << symbol;
  EXPECT_GT(declared.size(), 30u);
  EXPECT_EQ(exported, declared);
}

}  // namespace
}  // namespace trimtab::test
