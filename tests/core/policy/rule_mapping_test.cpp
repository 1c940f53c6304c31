#include "trimtab/policy/rule_mapping.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/policy_file.h"

namespace trimtab {
namespace {

TEST(RuleMapping, readsKeyScaleAndOffset) {
  struct Good {
    const char* text;
    double scale, offset;
  };
  for (const Good& each : {Good{"v=speed", 1, 0},
                           {" v = speed * 0.514 ", 0.514, 0},
                           {"v=speed*-2", -2, 0},
                           {"v=speed-32.5", 1, -32.5},
                           {"v=speed*1e-3+4", 1e-3, 4},
                           {"v=speed*+2e+1-3e-2", 20, -0.03}}) {
    const auto mapping = readRuleMapping(each.text, "--map");
    ASSERT_TRUE(mapping) << each.text << toString(mapping.findings());
    ASSERT_EQ(mapping->size(), 1u);
    EXPECT_EQ((*mapping)[0].variable + "=" + (*mapping)[0].key, "v=speed");
    EXPECT_EQ((*mapping)[0].scale, each.scale) << each.text;
    EXPECT_EQ((*mapping)[0].offset, each.offset) << each.text;
  }
  EXPECT_EQ(readRuleMapping("a b=speed,c=roll", "--map")->size(), 2u);
  EXPECT_TRUE(readRuleMapping("", "--map")->empty());
}

TEST(RuleMapping, refusesWhatIsNoneWithEachPart) {
  for (const char* bad : {"v", "v=", "=speed", "v=speed*", "v=speed*0", "v=speed*x", "v=speed+",
                          "v=speed*inf", "v=speed+nan", "v=*3"}) {
    const auto refused = readRuleMapping(std::string("a=roll,") + bad, "--map");
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(
        toString(refused.findings()),
        std::string("--map: expected VARIABLE=KEY*SCALE+OFFSET with a scale that is not 0, found ") + bad);
  }
}

/// Terms over m/s and degrees below the horizon, and an output from 0 to 100.
const std::string kMetric =
    "[System]\nType='sugeno'\nAndMethod='prod'\nOrMethod='probor'\n"
    "[Input1]\nName='v [m/s]'\nRange=[0 400]\n"
    "MF1='a':'trapmf',[-5 20 60 130]\nMF2='b':'sigmf',[0.06 150]\nMF3='c':'gbellmf',[40 2 220]\n"
    "MF4='d':'linsmf',[50 200]\nMF5='e':'smf',[60 190]\n"
    "[Input2]\nName='Depression'\nRange=[-90 90]\n"
    "MF1='a':'gaussmf',[15 20]\nMF2='b':'trimf',[0 30 90]\nMF3='c':'discretemf',[-20 0.2 10 0.9 40 0.4]\n"
    "MF4='d':'sigmf',[-0.1 15]\nMF5='e':'linzmf',[-10 55]\n"
    "[Output1]\nName='Detail'\nRange=[0 100]\n"
    "MF1='a':'constant',[100]\nMF2='b':'constant',[40]\nMF3='c':'constant',[0]\n"
    "MF4='d':'constant',[75]\nMF5='e':'constant',[20]\n"
    "[Rules]\n1 1, 1 (1) : 1\n2 2, 2 (1) : 1\n3 3, 3 (1) : 1\n4 4, 4 (1) : 1\n5 5, 5 (1) : 2\n";

std::string withNames(const std::string& speed, const std::string& pitch, const std::string& out) {
  std::string text = kMetric;
  for (const auto& [from, to] :
       {std::pair(std::string("v [m/s]"), speed), {"Depression", pitch}, {"Detail", out}})
    text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(RuleMapping, convertsUnitsSignsAndOutputs) {
  const auto mapping =
      readRuleMapping("v [m/s]=speed*0.514444,Depression=pitch*-1,Detail=particle_density*-100+100", "");
  ASSERT_TRUE(mapping);
  const auto mapped = readMatlab(kMetric, "f.fis", {*mapping, false});
  ASSERT_TRUE(mapped) << toString(mapped.findings());
  // The same file with the same numbers over signals and a lever that hold them as they are.
  std::string plain = withNames("speed", "pitch", "visibility");
  plain = withNames("speed", "pitch", "lod_scale");
  for (std::size_t at; (at = plain.find("constant',[")) != std::string::npos;) {
    const std::size_t end = plain.find(']', at);
    const double value = std::stod(plain.substr(at + 11, end - at - 11));
    plain.replace(at, end - at, "CONSTANT',[" + std::to_string(1 + value / 10));
  }
  const auto file = readMatlab(plain, "f.fis");
  ASSERT_TRUE(file) << toString(file.findings());
  const auto a = compile(*mapped, "a"), b = compile(*file, "b");
  PolicyDecision ofA, ofB;
  for (double v = 0.5; v < 400; v += 13.7)
    for (double down = -89.7; down < 90; down += 7.9) {
      SignalValues flight, asFiled;
      flight[Signal::speed] = v / 0.514444, flight[Signal::pitch] = -down;
      asFiled[Signal::speed] = v, asFiled[Signal::pitch] = down;
      a->decide(flight, ofA);
      b->decide(asFiled, ofB);
      EXPECT_NEAR(1 - ofA.target[Lever::particle_density], (ofB.target[Lever::lod_scale] - 1) / 10, 1e-6)
          << v;
    }
}

TEST(RuleMapping, isAskedForOnceWithTheInputsAndTheSignalsThatExist) {
  const auto refused = readMatlab(kMetric, "f.fis");
  ASSERT_FALSE(refused);
  EXPECT_EQ(
      toString(refused.findings()),
      "f.fis:5: input: expected the key of a signal, or --map \"v__m_s_=KEY*SCALE+OFFSET\" with one of "
      "altitude (ft), above_ground (ft), pitch (deg), roll (deg), speed (kt), climb (ft/min), sight_rate "
      "(deg/s), head_rate (deg/s), visibility (m), precipitation, load, triangles, altitude_membership, "
      "pitch_membership, found v__m_s_, Depression\n"
      "f.fis:21: output: expected the key of a lever, or --map \"Detail=KEY*SCALE+OFFSET\" with one of "
      "occlusion, screen_space_error (px), lod_scale, far_distance (x visible distance), particle_density, "
      "blur_strength, render_scale, object_error (px), small_feature (px), object_distance (m), found "
      "Detail");
}

TEST(RuleMapping, ofWhatDoesNotExistIsRefused) {
  const auto refusedFor = [](const char* map) {
    const auto refused = readMatlab(kMetric, "f.fis", {*readRuleMapping(map, ""), false});
    EXPECT_FALSE(refused) << map;
    return toString(refused.findings());
  };
  const std::string rest = ",Detail=particle_density*100";
  EXPECT_EQ(
      refusedFor(("v [m/s]=speed,Depression=pitch,Height=altitude" + rest).c_str()),
      "--map: Height: expected a variable of the file: v__m_s_, Depression, Detail, found none of this name");
  EXPECT_EQ(refusedFor(("v [m/s]=airspeed,Depression=pitch" + rest).c_str()).substr(0, 50),
            "--map: v [m/s]: expected altitude (ft), above_grou");
  EXPECT_EQ(refusedFor(("v [m/s]=pitch,Depression=pitch" + rest).c_str()),
            "f.fis:13: input: expected each key for one variable, found pitch");
  EXPECT_EQ(refusedFor("v [m/s]=speed,Depression=pitch,Detail=particle_density"),
            "f.fis:24: term a: expected particle_density from 0 to 1, or --map "
            "\"OUTPUT=particle_density*SCALE+OFFSET\", found 100");
}

TEST(RuleMapping, isNotNeededForKeysInOtherLetters) {
  const auto mapped = readMatlab(withNames("SPEED", "Pitch", "lod_scale"), "f.fis",
                                 {*readRuleMapping("lod_scale=lod_scale*8-4", ""), false});
  ASSERT_TRUE(mapped) << toString(mapped.findings());
  EXPECT_EQ(mapped.findings()[0].found, "'SPEED', read as speed");
  EXPECT_EQ(mapped->rules[0].condition, "speed is a and pitch is a");
}

}  // namespace
}  // namespace trimtab
