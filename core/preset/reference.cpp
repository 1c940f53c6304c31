#include <utility>

#include "trimtab/preset/preset.h"
#include "trimtab/preset/rules.h"
#include "trimtab/units/number.h"

namespace trimtab {

namespace {

std::string rangeText(Range range, std::string_view unit) {
  return numberText(range.low) + " to " + numberText(range.high) + (unit.empty() ? "" : " ") +
         std::string(unit);
}

std::string_view groupOf(std::string_view key) {
  return key.substr(0, key.find('.'));
}

std::string_view groupTitle(std::string_view group) {
  if (group == "fuzzy") return "Fuzzy choice of the culling scheme";
  if (group == "culling") return "Culling";
  if (group == "lod") return "Level of detail";
  if (group == "terrain") return "Terrain";
  if (group == "static_lod") return "Static levels of detail";
  if (group == "view") return "View";
  if (group == "host") return "Host";
  if (group == "measure") return "Measurement";
  return group;
}

std::string_view effectText(Effect effect) {
  switch (effect) {
    case Effect::next_frame:
      return "the next frame";
    case Effect::resize:
      return "the next frame, after the picture has been set up again";
    case Effect::host:
      return "the next packet";
  }
  return "";
}

std::string describe(const ParameterRow& row) {
  std::string text = "### `" + std::string(row.key) + "`\n\n" + std::string(row.label) + ". " +
                     std::string(row.help) + "\n\n";
  const auto item = [&text](std::string_view name, const std::string& value) {
    text += "* " + std::string(name) + ": " + value + "\n";
  };
  item("default", "`" + toText(row, row.get(TuningParameters{})) + "`" +
                      (row.kind == Kind::scalar && !row.unit.empty() ? " " + std::string(row.unit) : ""));
  switch (row.kind) {
    case Kind::scalar:
      item("accepted", rangeText(row.hard, row.unit) + (row.whole ? ", whole numbers" : ""));
      item("usual", rangeText(row.usual, row.unit));
      break;
    case Kind::flag:
      item("values", "`true`, `false`");
      break;
    case Kind::choice: {
      std::string names;
      for (const ChoiceOption& option : row.choices)
        names += (names.empty() ? "`" : ", `") + std::string(option.name) + "` (" +
                 std::string(option.label) + ")";
      item("values", names);
      break;
    }
    case Kind::curve:
      item("accepted", "2 to " + std::to_string(CurvePoints::kCapacity) +
                           " points `x:y` in rising order, x " + rangeText(row.hard, row.unit) +
                           ", y 0 to 1; two points may share an x");
      item("usual", "x " + rangeText(row.usual, row.unit));
      break;
    case Kind::bands:
      item("accepted", "1 to " + std::to_string(BandList::kCapacity) +
                           " bands `low:WIDTHxHEIGHT` in rising order, low above 0 and below " +
                           numberText(BandList::kTop) + ", sizes " + rangeText(row.hard, row.unit));
      item("usual", "sizes " + rangeText(row.usual, row.unit));
      break;
    case Kind::rules:
      item("accepted",
           "1 to " + std::to_string(RuleList::kCapacity) +
               " rules `conditions*weight=output`, conditions `low` or `high`, `down` or `up`, joined "
               "by `&`, or `any`; weights " +
               rangeText(row.hard, row.unit) + ", outputs " + rangeText({0, BandList::kTop}, ""));
      item("usual", "weights " + rangeText(row.usual, row.unit));
      break;
    case Kind::lines:
      item("accepted", "lines of text; on one line ` | ` stands between them");
      break;
  }
  item("takes effect with", std::string(effectText(row.effect)));
  if (!row.source.empty()) item("source", std::string(row.source));
  return text + "\n";
}

/// Returns the rules of Eq. (2) that ship.
std::string ruleBase() {
  std::string text =
      "## The rule base\n\nUsed when `fuzzy.combination` is `rules`. *Low* is the altitude membership, "
      "*high* its complement to 1; *nose "
      "down* is the\npitch membership, *nose up* its complement. A rule fires with the smaller of its "
      "conditions, and the total is the average of "
      "the\noutputs, weighted by firing times weight. When nothing fires the total is 0. What ships in "
      "`fuzzy.rules`:\n\n"
      "| Altitude | Pitch | Weight | Output |\n|---|---|---|---|\n";
  for (const FuzzyRule& rule : TuningParameters{}.scheme.rules.span()) {
    const std::string pitch(nameOf(rule.pitch));
    text += "| " + std::string(nameOf(rule.altitude)) + " | " +
            (rule.pitch == PitchCondition::any ? pitch : "nose " + pitch) + " | " + numberText(rule.weight) +
            " | " + numberText(rule.output) + " |\n";
  }
  return text + "\n";
}

std::string rulesBetweenParameters() {
  std::string text =
      "## Rules between parameters\n\nA preset that breaks one can be edited and saved, but does not run and "
      "is not exported.\n\n";
  for (const RuleText& rule : ruleTexts())
    text += "* `" + std::string(rule.key) + "`: " + std::string(rule.text) + "\n";
  return text + "\n";
}

constexpr std::pair<char, std::string_view> kDocuments[] = {
    {'A',
     "C. J. Lee, K. C. Park, K. Kim: Dynamic Culling Scheme for Graphic Rendering System of Flight "
     "Simulator"},
    {'B',
     "C. Lee, S. Kang, K. Kim: Dynamic Culling Scheme Based on Altitude for Real-Time Rendering System (in "
     "Korean, 2015)"},
    {'C',
     "J. H. Lim, C. J. Lee, K. H. Kim, K. Kim: Preventing Rendering Speed Degradation for Helmet Mounted "
     "Display Simulation"},
    {'D',
     "Y. Cha, J. Kim, K. Kim: Adaptive Culling Mechanism for Weather Phenomena Effect in Flight Simulator "
     "(in "
     "Korean, 2014)"},
    {'E',
     "World Custom Scenery Project: Creating better scenery, Static Level-of-Detail for FlightGear (the page "
     "names no author)"}};

std::string sources() {
  std::string text = "## Sources\n\n";
  for (const auto& [letter, document] : kDocuments)
    text += "* " + std::string(1, letter) + ": " + std::string(document) + "\n";
  return text;
}

}  // namespace

std::string_view documentOf(char letter) {
  for (const auto& [known, document] : kDocuments)
    if (known == letter) return document;
  return {};
}

std::string parameterReference() {
  std::string text =
      "# Parameters\n\nWritten by `trimtab-cli preset reference`. Keys are those of preset files, exports "
      "and `--set key=value`; "
      "the unit is the\nkey's suffix. What is outside the accepted range is refused; what is outside the "
      "usual one is "
      "accepted with a warning.\n\n";
  std::string_view group;
  for (const ParameterRow& row : parameterRows()) {
    if (groupOf(row.key) != group) {
      group = groupOf(row.key);
      text += "## " + std::string(groupTitle(group)) + "\n\n";
    }
    text += describe(row);
  }
  return text + ruleBase() + rulesBetweenParameters() + sources();
}

}  // namespace trimtab
