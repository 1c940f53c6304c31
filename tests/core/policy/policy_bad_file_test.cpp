#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "trimtab/policy/policy_file.h"
#include "trimtab/units/finding_list.h"

namespace trimtab {
namespace {

struct BadLanguage {
  RuleFormat format;
  const char* ending;
  std::string good;
};

const BadLanguage kBadLanguages[] = {{RuleFormat::fuzzylite, "f.fll",
                                      "Engine: e\n"
                                      "InputVariable: speed\n"
                                      "  enabled: true\n"
                                      "  range: 0 1500\n"
                                      "  lock-range: true\n"
                                      "  term: fast Ramp 100 200\n"
                                      "  term: step Discrete 10 0 10 1 20 0.5\n"
                                      "OutputVariable: lod_scale\n"
                                      "  lock-range: false\n"
                                      "  defuzzifier: WeightedAverage TakagiSugeno\n"
                                      "  default: nan\n"
                                      "  term: coarse Constant 4\n"
                                      "RuleBlock: r\n"
                                      "  conjunction: Minimum\n"
                                      "  disjunction: Maximum\n"
                                      "  activation: General\n"
                                      "  rule: if speed is fast then lod_scale is coarse with 0.5\n"
                                      "  # rule: if speed is step then lod_scale is coarse  # off\n"},
                                     {RuleFormat::matlab, "f.fis",
                                      "[System]\n"
                                      "Name='e'\n"
                                      "Type='sugeno'\n"
                                      "AndMethod='min'\n"
                                      "OrMethod='max'\n"
                                      "DefuzzMethod='wtaver'\n"
                                      "[Input1]\n"
                                      "Name='speed'\n"
                                      "Range=[0 1500]\n"
                                      "NumMFs=2\n"
                                      "MF1='fast':'rampmf',[100 200]\n"
                                      "MF2='step':'discretemf',[10 0 10 1 20 0.5]\n"
                                      "[Output1]\n"
                                      "Name='lod_scale'\n"
                                      "MF1='coarse':'constant',[4]\n"
                                      "[Rules]\n"
                                      "1, 1 (0.5) : 1\n"
                                      "% rule: 2, 1 (1) : 1\n"}};

/// What of the good file is replaced, with what, and what is said of it: nothing if it is good too.
struct Row {
  const char *from, *to, *finding;
};

void check(const BadLanguage& language, const std::vector<Row>& rows) {
  ASSERT_TRUE(readPolicyFile(language.good, language.ending, language.format));
  for (const Row& row : rows) {
    std::string text = language.good;
    const std::size_t at = text.find(row.from);
    ASSERT_NE(at, std::string::npos) << row.from;
    text.replace(at, std::string(row.from).size(), row.to);
    const auto read = readPolicyFile(text, language.ending, language.format);
    EXPECT_EQ(read.ok(), row.finding[0] == '\0') << row.to;
    EXPECT_EQ(toString(read.findings()).substr(0, std::string(row.finding).size()), row.finding) << row.to;
    if (row.finding[0] == '\0') {
      EXPECT_EQ(toString(read.findings()), "");
    }
  }
}

TEST(BadPolicyFile, inFuzzyLiteLanguageIsRefusedWithLineExpectedAndFound) {
  check(
      kBadLanguages[0],
      {{"100 200", "200 100", ""},
       {"Engine: e", "# by hand", ""},
       {"Minimum", "none", ""},
       {"nan", "nan\n  aggregation: UnboundedSum", ""},
       {"  # rule: if", "  # rule: something else", ""},
       {"with 0.5", "with 0  # never", ""},
       {"Engine: e", "Engine e",
        "f.fll:1: expected key: value, as in a file that is whole; write it again, found Engine e"},
       {"speed\n", "pressure\n",
        "f.fll:2: input: expected the key of a signal, or --map \"pressure=KEY*SCALE+OFFSET\" with one of "
        "altitude (ft), "},
       {"enabled: true", "enabled: false",
        "f.fll:3: enabled: expected true; remove what is switched off, or switch it on, found false"},
       {"0 1500", "0 1000",
        "f.fll:2: input speed: expected the range 0 1500, or lock-range: false, found 0 1000"},
       {"0 1500", "0 x", "f.fll:4: range: expected two numbers, found 0 x"},
       {"Ramp", "Cosine", "f.fll:6: term fast: expected a shape that a policy has, found Cosine"},
       {"100 200", "100 x", "f.fll:6: term fast: expected numbers, found x"},
       {"100 200", "", "f.fll:6: term: expected a name, a shape and numbers, found fast Ramp"},
       {"100 200", "100 100", "f.fll:6: terms.speed.fast: expected two different numbers, found 100 100"},
       {"100 200", "100 inf", "f.fll:6: terms.speed.fast: expected numbers from -1e12 to 1e12, found inf"},
       {"100 200", "nan 200", "f.fll:6: terms.speed.fast: expected numbers from -1e12 to 1e12, found nan"},
       {"100 200", "100 200 0.5",
        "f.fll:6: terms.speed.fast: expected two numbers: where it is 0, where it is 1, found 3 numbers"},
       {"fast Ramp", "very Ramp", "f.fll:6: terms.speed.very: expected a name of at most 40 letters"},
       {"fast Ramp", "f\xff Ramp", "f.fll:6: terms.speed.f\xff: expected a name of at most 40 letters"},
       {"step Discrete", "fast Discrete", "f.fll:7: term: expected a name that stands once, found fast"},
       {"10 0 10 1", "10 0 5 1",
        "f.fll:7: terms.speed.step: expected points from left to right, found 10 before 5"},
       {"10 0 10 1 20", "10 0 10 1 10",
        "f.fll:7: terms.speed.step: expected at most two points at one x, found three at 10"},
       {"10 0 10 1 20 0.5", "10 0",
        "f.fll:7: terms.speed.step: expected 2 to 64 points, each x and membership, found 2 numbers"},
       {"10 0 10 1", "10 0 10 2", "f.fll:7: terms.speed.step: expected memberships from 0 to 1, found 2"},
       {"OutputVariable", "OutputVariable: colour\nOutputVariable",
        "f.fll:8: output: expected the key of a lever, or --map \"colour=KEY*SCALE+OFFSET\" with one of "
        "occlusion, "},
       {"RuleBlock", "OutputVariable: lod_scale\nRuleBlock",
        "f.fll:13: variable: expected a name that stands once, found lod_scale"},
       {"lock-range: false", "lock-range: true",
        "f.fll:9: lock-range: expected false; change it in the tool that wrote the file, found true"},
       {"WeightedAverage ", "Centroid ",
        "f.fll:10: defuzzifier: expected WeightedAverage TakagiSugeno; change it in the tool that wrote the "
        "file, found Centroid TakagiSugeno"},
       {"default: nan", "default: 0",
        "f.fll:11: default: expected nan: a lever that no rule sets is neutral; write nan, or add a rule for "
        "what the default was for, found 0"},
       {"Constant 4", "Linear 4 5",
        "f.fll:8: difference of lod_scale: expected at most 5 % of its range between the file"},
       {"Constant 4", "Linear 4 5 6",
        "f.fll:12: term coarse: expected Constant with one number, or Linear with one for each"},
       {"Constant 4", "Triangle 1 4 5",
        "f.fll:12: term coarse: expected Constant with one number, found Triangle of 3 numbers"},
       {"Constant 4", "Constant 400", "f.fll:12: term coarse: expected lod_scale from 0.1 to 16, or --map"},
       {"RuleBlock: r", "RuleBlock: a\nRuleBlock: b",
        "f.fll:14: RuleBlock: expected one rule block, found a second one"},
       {"Minimum", "DrasticProduct", "f.fll:14: conjunction: expected Minimum with Maximum, or"},
       {"Maximum", "AlgebraicSum", ""},
       {"Constant 4", "Linear 0 4", ""},
       {"General", "Highest 1",
        "f.fll:16: activation: expected General; change it in the tool that wrote the file, found Highest 1"},
       {"if speed", "when speed", "f.fll:17: rule: expected \"if\", found when"},
       {"then", "so", "f.fll:17: rule: expected \"and\", \"or\" or \"then\", found the end of the line"},
       {"is fast", "is slow", "f.fll:17: rules.1: expected a term of speed: fast, step, found slow"},
       {"is fast", "is hardly fast", "f.fll:17: rules.1: expected and, or, or the end of the condition"},
       {"speed is fast", "pressure is fast", "f.fll:17: rules.1: expected a signal: altitude"},
       {"speed is fast", "((speed is fast)", "f.fll:17: rules.1: expected ), found nothing"},
       {"then lod_scale", "then colour", "f.fll:17: rule: expected an output (lod_scale), found colour"},
       {"is coarse", "is fine", "f.fll:17: rule: expected a term (coarse), found fine"},
       {"is coarse", "is coarse and lod_scale is coarse",
        "f.fll:17: rules.1: expected each lever once, found lod_scale"},
       {"with 0.5", "with", "f.fll:17: rule: expected a weight, found the end of the line"},
       {"with 0.5", "with -1", "f.fll:17: rules.1: expected a weight from 0 to 1, found -1"},
       {"with 0.5", "with nan", "f.fll:17: rules.1: expected a weight from 0 to 1, found nan"},
       {"with 0.5", "with 1.5",
        "f.fll:17: weight: expected a weight from 0 to 1; divide all weights of the file"},
       {"with 0.5", "with 0.5 0.5", "f.fll:17: rule: expected the end of the line, found 0.5"},
       {"is step", "is gone", "f.fll:18: rules.2: expected a term of speed: fast, step, found gone"}});
  std::string joint = kBadLanguages[0].good;
  joint.replace(joint.find("Minimum"), 7, "none");
  joint.replace(joint.find("is fast then"), 7, "is fast and speed is step");
  EXPECT_EQ(toString(readFuzzyLite(joint, "f").findings()),
            "f:17: rule: expected conjunction: Minimum, found \"and\" without conjunction");
}

TEST(BadPolicyFile, inMatlabsLanguageIsRefusedWithLineExpectedAndFound) {
  check(
      kBadLanguages[1],
      {{"rampmf',[100 200", "linzmf',[200,100", ""},
       {"'step'", "'my step'", ""},
       {"1, 1 (0.5) : 1", "0, 1 (0.5) : 1", ""},
       {"1, 1 (0.5) : 1", "-1.200000 , 1.0000 (0.5000) : 2", ""},
       {"1, 1 (0.5) : 1", "0.99, 1 (0.5) : 1", ""},
       {"1, 1 (0.5) : 1", "1.4, 1 (0.5) : 1", ""},
       {"% rule: 2", "% rule: of thumb 2", ""},
       {"Name='e'", "Name e", "f.fis:2: expected key=value, found Name e"},
       {"sugeno", "anfis", "f.fis:3: Type: expected 'sugeno' or 'mamdani', found anfis"},
       {"sugeno", "mamdani",
        "f.fis:6: DefuzzMethod: expected 'centroid', 'bisector', 'mom', 'lom' or 'som', found wtaver"},
       {"Type='sugeno'\n", "", "f.fis:17: Type: expected 'sugeno' or 'mamdani', found none"},
       {"'min'", "'lukasiewicz'", "f.fis:4: AndMethod: expected 'min' or 'prod', found lukasiewicz"},
       {"'max'", "'probor'", ""},
       {"wtaver", "wtsum", "f.fis:6: DefuzzMethod: expected 'wtaver', the weighted average, found wtsum"},
       {"[Input1]", "[Input2]", "f.fis:7: Input2: expected [Input1], found Input2"},
       {"[Input1]", "[Inputs]", "f.fis:7: Inputs: expected [Input1], found Inputs"},
       {"[Input1]", "[INPUT1]", ""},
       {"'speed'", "'pressure'",
        "f.fis:7: input: expected the key of a signal, or --map \"pressure=KEY*SCALE+OFFSET\" with one of "
        "altitude (ft), "},
       {"[0 1500]", "[0]", "f.fis:9: Range: expected [low high], found [0]"},
       {"NumMFs", "Colour", "f.fis:10: Colour: expected Name, Range, NumMFs or MF1, found another"},
       {"MF1='fast'", "MF2='fast'", "f.fis:11: MF2: expected MF1, found MF2"},
       {"rampmf", "cosmf",
        "f.fis:11: MF1: expected discretemf, rampmf, linsmf, linzmf, trimf, trapmf, gaussmf,"},
       {"[100 200]", "100 200", "f.fis:11: MF1: expected 'name':'shape',[numbers]"},
       {"[100 200]", "[100 x]", "f.fis:11: MF1: expected numbers, found [100 x]"},
       {"[100 200]", "[]", "f.fis:11: terms.speed.fast: expected two numbers"},
       {"'step'", "'fast'", "f.fis:12: term: expected a name that stands once, found fast"},
       {"'lod_scale'", "'colour'",
        "f.fis:13: output: expected the key of a lever, or --map \"colour=KEY*SCALE+OFFSET\" with one of "
        "occlusion, "},
       {"'constant',[4]", "'linear',[0 4]", ""},
       {"'constant',[4]", "'trimf',[1 4 5]", "f.fis:15: term coarse: expected Constant with one number"},
       {"[Rules]", "[Rule]", "f.fis:16: Rule: expected [System], [Input1], [Output1] or [Rules], found Rule"},
       {"1, 1 (0.5)", "3, 1 (0.5)", "f.fis:17: Rules: expected the number of a term of speed, found 3"},
       {"1, 1 (0.5)", "1.07, 1 (0.5)", "f.fis:17: Rules: expected the number of a term of speed, found 1.07"},
       {"1, 1 (0.5)", "0.2, 1 (0.5)", "f.fis:17: Rules: expected the number of a term of speed, found 0.2"},
       {"1, 1 (0.5)", "1e300, 1 (0.5)", "f.fis:17: Rules: expected the number of a term of speed"},
       {"1, 1 (0.5)", "nan, 1 (0.5)", "f.fis:17: Rules: expected the number of a term of speed, found nan"},
       {"1, 1 (0.5)", "1, 2 (0.5)", "f.fis:17: Rules: expected the number of a term of lod_scale, found 2"},
       {"1, 1 (0.5)", "1, -1 (0.5)", "f.fis:17: Rules: expected the number of a term of lod_scale, found -1"},
       {"1, 1 (0.5)", "1, nan (0.5)",
        "f.fis:17: Rules: expected the number of a term of lod_scale, found nan"},
       {"1, 1 (0.5)", "1, 0 (0.5)",
        "f.fis:17: Rules: expected a term of an output, or no such rule, found none"},
       {"1, 1 (0.5)", "1 1, 1 (0.5)",
        "f.fis:17: Rules: expected terms of inputs, terms of outputs (weight) : 1"},
       {"1, 1 (0.5)", "1 1 (0.5)",
        "f.fis:17: Rules: expected terms of inputs, terms of outputs (weight) : 1"},
       {"(0.5) : 1", "(0.5) : 3", "f.fis:17: Rules: expected 1 for and, or 2 for or, found 3"},
       {"(0.5)", "(nan)", "f.fis:17: rules.1: expected a weight from 0 to 1, found nan"},
       {"(0.5)", "(2)", "f.fis:17: weight: expected a weight from 0 to 1; divide all weights of the file"},
       {"% rule: 2,", "% rule: 7,", "f.fis:18: Rules: expected the number of a term of speed, found 7"}});
}

/// Each is refused, or read, within a second, and by a hundred findings at most.
TEST(BadPolicyFile, isNeverSlowHoweverLargeItIs) {
  const std::string million(1000000, 'x'), deep(1000000, '('), blanks(1000000, ' ');
  for (const BadLanguage& language : kBadLanguages) {
    const bool fll = language.format == RuleFormat::fuzzylite;
    const std::string term = fll ? "100 200" : "[100 200]", rule = fll ? "speed is fast" : "1, 1 (0.5) : 1";
    const auto with = [&](const std::string& from, const std::string& to) {
      std::string text = language.good;
      return text.replace(text.find(from), from.size(), to);
    };
    std::string rules = language.good, badRules = language.good, terms, ands = "speed is fast", numbers;
    for (int i = 0; i < 10000; ++i) {
      rules += fll ? "  rule: if speed is fast then lod_scale is coarse\n" : "1, 1 (1) : 1\n";
      badRules += fll ? "  rule: if speed is slow then lod_scale is fine\n" : "7, 9 (1) : 1\n";
      const std::string n = std::to_string(i + 3);
      terms += fll ? "\n  term: t" + n + " Ramp 1 2" : "\nMF" + n + "='t" + n + "':'rampmf',[1 2]";
    }
    for (int i = 0; i < 100000; ++i) ands += " and speed is fast";
    for (int i = 0; i < 200000; ++i) numbers += "1 ";
    const std::string last = fll ? "20 0.5" : "20 0.5]";
    for (const std::string& text :
         {rules, badRules, with(last, last + terms), with(term, million), with(rule, million),
          with(rule, deep), with("lod_scale", million), with("speed", million), with(rule, blanks),
          with(rule, ands), with("100 200", numbers), with("coarse", million), million, blanks, deep,
          std::string(1000000, '\n'), std::string(500000, '\0'), std::string(300000, '\xff'),
          with("lod_scale", million + "\n" + million)}) {
      const auto begin = std::chrono::steady_clock::now();
      const auto read = readPolicyFile(text, language.ending, language.format);
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
      EXPECT_LT(took.count(), 1) << text.substr(0, 60);
      EXPECT_TRUE(read.ok() || !read.findings().empty());
      EXPECT_LE(read.findings().size(), 100u);
      for (const Finding& f : read.findings()) EXPECT_LT(toString(f).size(), 1000u);
    }
    const auto many = readPolicyFile(rules, language.ending, language.format);
    EXPECT_FALSE(many);
    EXPECT_NE(toString(many.findings()).find("expected at most 2048 rules, found more"), std::string::npos);
  }
}

TEST(BadPolicyFile, hasAsManyVariablesAsEachRuleCanBeComparedWith) {
  for (const BadLanguage& language : kBadLanguages) {
    std::string text = language.good;
    for (int i = 2; i < 3000; ++i)
      text += language.format == RuleFormat::fuzzylite ? "OutputVariable: v" + std::to_string(i) + "\n"
                                                       : "\n[Output" + std::to_string(i) + "]\n";
    const auto read = readPolicyFile(text, language.ending, language.format);
    ASSERT_FALSE(read);
    EXPECT_NE(toString(read.findings()[0]).find("expected at most 256 of a kind, found more"),
              std::string::npos)
        << toString(read.findings());
    EXPECT_EQ(read.findings().size(), FindingList::kMost + 1);
    EXPECT_NE(read.findings().back().found.find("2,7"), std::string::npos)
        << toString(read.findings().back());
  }
}

TEST(BadPolicyFile, mayBeginWithAByteOrderMark) {
  for (const BadLanguage& language : kBadLanguages)
    EXPECT_TRUE(readPolicyFile("\xef\xbb\xbf" + language.good, language.ending, language.format));
}

TEST(BadPolicyFile, isRefusedOrReadWhateverByteIsWrong) {
  std::mt19937_64 random(24);
  for (const BadLanguage& language : kBadLanguages)
    for (std::size_t at = 0; at < language.good.size(); ++at) {
      const auto cut = readPolicyFile(language.good.substr(0, at), "f", language.format);
      EXPECT_TRUE(cut.ok() || !cut.findings().empty());
      for (int i = 0; i < 20; ++i) {
        std::string bad = language.good;
        bad[at] = static_cast<char>(random());
        const auto read = readPolicyFile(bad, "f", language.format);
        ASSERT_TRUE(read.ok() || !read.findings().empty());
        if (read) {
          EXPECT_TRUE(policyFileText(*read, "again", language.format)) << bad;
        }
      }
    }
}

}  // namespace
}  // namespace trimtab
