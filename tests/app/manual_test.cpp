#include <gmock/gmock.h>

#include <regex>
#include <set>

#include "app/manual/command.h"
#include "tests/support.h"

// Man pages and completion, against what --help of the built programs says.
namespace trimtab::test {
namespace {

using Words = std::set<std::string>;

struct Help {
  Words options, commands;
};

/// What `command --help` lists, by the columns that CLI11 and Qt print.
Help helpOf(const std::string& command) {
  Help help;
  const Ran ran = run(programDir().string() + '/' + command + " --help");
  EXPECT_EQ(ran.exitCode, 0) << command;
  std::istringstream lines(ran.out);
  bool inCommands = false;
  static const std::regex option("^  (-[a-z]), ?(--[a-z-]+).*|^  (--[a-z-]+).*"), name("^  ([a-z-]+) .*");
  for (std::string line; std::getline(lines, line);) {
    if (line == "Subcommands:") inCommands = true;
    std::smatch found;
    if (std::regex_match(line, found, option)) {
      for (std::size_t i = 1; i < found.size(); ++i)
        if (found[i].matched) help.options.insert(found[i]);
    } else if (inCommands && std::regex_match(line, found, name)) {
      help.commands.insert(found[1]);
    }
  }
  return help;
}

class Manual : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const Ran ran = run(program(GetParam()).string() + " --write-manual " + dir_.path().string());
    ASSERT_EQ(ran.exitCode, 0) << ran.err;
  }

  /// The words that bash offers after a line, whose last word is the one that is completed.
  Words offered(const std::vector<std::string>& line) const {
    std::string words;
    for (const std::string& word : line) words += " '" + word + "'";
    std::string function = std::string("_") + GetParam();
    std::replace(function.begin(), function.end(), '-', '_');
    const Ran ran = run("bash -c \"source " + (dir_ / GetParam()).string() + ".bash; COMP_WORDS=(" + words +
                        "); COMP_CWORD=" + std::to_string(line.size() - 1) + "; " + function +
                        "; printf '%s\\n' \\\"\\${COMPREPLY[@]}\\\"\"");
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    Words offers;
    std::istringstream lines(ran.out);
    for (std::string word; std::getline(lines, word);)
      if (!word.empty()) offers.insert(word);
    return offers;
  }

  /// Checks a command and all below it; adds the names of their pages.
  void check(const std::vector<std::string>& command, Words& pages) {
    std::string typed, page;
    for (const std::string& word : command) {
      typed += (typed.empty() ? "" : " ") + word;
      page += (page.empty() ? "" : "-") + word;
    }
    const Help help = helpOf(typed);
    EXPECT_FALSE(help.options.empty()) << typed;
    pages.insert(page + ".1");
    const std::string text = std::regex_replace(readFile(dir_ / (page + ".1")), std::regex("\\\\-"), "-");
    for (const std::string& option : help.options)
      EXPECT_THAT(text, testing::HasSubstr("\\fB" + option + "\\fR")) << page << ".1";

    std::vector<std::string> line = command;
    line.emplace_back("-");
    EXPECT_EQ(offered(line), help.options) << typed;
    line.back().clear();
    if (!help.commands.empty())
      EXPECT_THAT(offered(line), testing::IsSupersetOf(help.commands)) << typed;
    else
      EXPECT_THAT(offered(line), testing::IsEmpty()) << typed << ": files are what bash offers then";
    for (const std::string& sub : help.commands) {
      line.back() = sub;
      check(line, pages);
    }
  }

  ScratchDir dir_;
};

TEST_P(Manual, hasAPageAndACompletionOfEveryCommandWithEachOfItsOptions) {
  Words pages{std::string(GetParam()) + ".bash"};
  check({GetParam()}, pages);
  const std::vector<std::string> written = namesIn(dir_.path());
  EXPECT_EQ(Words(written.begin(), written.end()), pages);
}

TEST_P(Manual, isReadByManWithoutAWarning) {
  if (run("command -v man").exitCode != 0) GTEST_SKIP() << "needs the package man-db";
  for (const std::string& name : namesIn(dir_.path())) {
    if (!name.ends_with(".1")) continue;
    const Ran ran = run("MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z " + (dir_ / name).string());
    EXPECT_EQ(ran.exitCode, 0) << name;
    EXPECT_EQ(ran.err, "") << name;
    EXPECT_FALSE(ran.out.empty()) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Programs, Manual, testing::Values("trimtab", "trimtab-cli", "trimtab-ig"));

using CliManual = Manual;
INSTANTIATE_TEST_SUITE_P(Cli, CliManual, testing::Values("trimtab-cli"));

TEST_P(CliManual, offersTheWordsThatAnOptionTakes) {
  EXPECT_EQ(offered({"trimtab-cli", "preset", "export", "--format", ""}), (Words{"json", "xml", "ini"}));
  EXPECT_EQ(offered({"trimtab-cli", "preset", "export", "default", "--output", ""}), Words{});
  EXPECT_EQ(offered({"trimtab-cli", "preset", "export", "--fo"}), Words{"--format"});
}

TEST(ManPage, showsSignsThatRoffWouldTakeForItsOwn) {
  if (run("command -v man").exitCode != 0) GTEST_SKIP() << "needs the package man-db";
  manual::Command command{"x", "Take \\fB as it is", {}, {}};
  command.arguments.emplace_back().names = {"--at-once"};
  command.arguments.back().text = ".flt or .ive";
  command.arguments.emplace_back().names = {"FILE"};
  command.arguments.back().text = "'quoted' name";
  const ScratchDir dir;
  writeFile(dir / "x.1", manual::manPage(command));
  const Ran ran = run("MANWIDTH=80 man --warnings -l -Tascii -P cat " + (dir / "x.1").string() + " | col -b");
  EXPECT_EQ(ran.err, "");
  for (const char* text : {"x - Take \\fB as it is", "--at-once", ".flt or .ive.", "'quoted' name."})
    EXPECT_THAT(ran.out, testing::HasSubstr(text));
}

TEST(ManualFolder, thatCannotBeMadeIsRefusedByName) {
  for (const char* name : {"trimtab", "trimtab-cli", "trimtab-ig"}) {
    const Ran ran = run(program(name).string() + " --write-manual /dev/null/x");
    EXPECT_NE(ran.exitCode, 0) << name;
    EXPECT_THAT(ran.err, testing::HasSubstr("/dev/null/x")) << name;
  }
}

}  // namespace
}  // namespace trimtab::test
