#include <gmock/gmock.h>

#include <GeographicLib/Geocentric.hpp>
#include <cmath>

#include "host_support.h"
#include "tests/support.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/motion.h"
#include "wire_writer.h"

/// Entity State of DIS after the table of IEEE 1278.1. GeographicLib says where north, east and down are, and
/// turns are made one after another, as nobody here computes them.
namespace trimtab::test {
namespace {

using testing::HasSubstr;

struct Sent {
  unsigned entity = 5;
  std::string marking = "VIPER1";
  unsigned algorithm = 1, kind = 1;
  std::uint32_t appearance = 0;
  double seconds = 100;  ///< past the hour
  GeodeticPosition position{Degrees{47.25}, Degrees{-122.5}, Metres{1850}};
  Attitude attitude{Degrees{312.5}, Degrees{6.25}, Degrees{-28}};
  Vec3 velocity, acceleration, angular;
};

struct Frame {
  Vec3 north, east, down, place;
};
Frame frameAt(const GeodeticPosition& p) {
  std::vector<double> m(9);
  Vec3 at;
  GeographicLib::Geocentric::WGS84().Forward(p.latitude.value(), p.longitude.value(), p.height.value(), at.x,
                                             at.y, at.z, m);
  return {{m[1], m[4], m[7]}, {m[0], m[3], m[6]}, {-m[2], -m[5], -m[8]}, at};
}
/// Turns `v` about a unit axis, right-handed.
Vec3 turned(Vec3 v, Vec3 axis, double radians) {
  return v * std::cos(radians) + cross(axis, v) * std::sin(radians) +
         axis * (dot(axis, v) * (1 - std::cos(radians)));
}
struct Body {
  Vec3 forward, right, down;
  Vec3 toEcef(Vec3 v) const { return forward * v.x + right * v.y + down * v.z; }
};
Body bodyOf(const Frame& f, const Attitude& a) {
  constexpr double kRadian = 0.017453292519943295;
  const double heading = a.heading.value() * kRadian;
  Body b{turned(f.north, f.down, heading), turned(f.east, f.down, heading), f.down};
  const auto turn = [&b](Vec3 axis, double by) {
    b = {turned(b.forward, axis, by), turned(b.right, axis, by), turned(b.down, axis, by)};
  };
  turn(b.right, a.pitch.value() * kRadian);
  turn(b.forward, a.roll.value() * kRadian);
  return b;
}

std::vector<std::byte> pdu(const Sent& s) {
  const Frame frame = frameAt(s.position);
  const Body body = bodyOf(frame, s.attitude);
  WireWriter w(ByteOrder::big);
  w.begin(144).u8(0, 7).u8(1, 3).u8(2, 1).u8(3, 1).u16(8, 144).u16(12, 17).u16(14, 2).u16(16, s.entity);
  w.u32(4, static_cast<std::uint32_t>(s.seconds / 3600 * 2147483648.0) << 1U | 1U);
  w.u8(18, 1).u8(20, s.kind).u8(21, 2).u16(22, 225);
  const auto vector = [&w](std::size_t at, Vec3 v) { w.f32(at, v.x).f32(at + 4, v.y).f32(at + 8, v.z); };
  vector(36, s.velocity);
  w.f64(48, frame.place.x).f64(56, frame.place.y).f64(64, frame.place.z);
  w.f32(72, std::atan2(body.forward.y, body.forward.x)).f32(76, -std::asin(body.forward.z));
  w.f32(80, std::atan2(body.right.z, body.down.z)).u32(84, s.appearance).u8(88, s.algorithm);
  vector(104, s.acceleration);
  vector(116, s.angular);
  w.u8(128, 1).text(129, s.marking);
  return w.bytes;
}

double off(Degrees a, Degrees b) {
  return std::abs(wrapped180(a - b).value());
}

TEST(Dis, placeAndAttitudeAreThoseOfTheLocalHorizon) {
  for (int i = 0; i < 60; ++i) {
    Sent s;
    s.position = {Degrees{-88.0 + 2.98 * i}, Degrees{-179.0 + 6.07 * i}, Metres{-300.0 + 611 * i}};
    s.attitude = {Degrees{5.9 * i}, Degrees{-84.0 + 2.85 * i}, Degrees{-175.0 + 5.91 * i}};
    HostDecoder decoder;
    const auto state = feed(decoder, pdu(s), 1);
    ASSERT_TRUE(state) << i << ' ' << decoder.statistics().firstBadReason;
    EXPECT_LT(distanceM(state->position, s.position), 1e-6);
    EXPECT_LT(off(state->attitude.heading, s.attitude.heading), 1e-4) << i;
    EXPECT_LT(off(state->attitude.pitch, s.attitude.pitch), 1e-5) << i;
    EXPECT_LT(off(state->attitude.roll, s.attitude.roll), 1e-4) << i;
  }
}

TEST(Dis, aVerticalAircraftHasAHeadingAndNoRoll) {
  Sent s;
  s.attitude = {Degrees{75}, Degrees{90}, Degrees{0}};
  HostDecoder decoder;
  const auto state = feed(decoder, pdu(s), 1);
  ASSERT_TRUE(state);
  EXPECT_NEAR(state->attitude.pitch.value(), 90, 0.02) << "as near as floats turn it";
  EXPECT_LT(off(state->attitude.heading - state->attitude.roll, Degrees{75}), 0.01);
}

TEST(Dis, isReadByTheDissectorFieldByField) {
  if (run("tshark --version").exitCode != 0) GTEST_SKIP() << "needs tshark";
  Sent s;
  s.algorithm = 8;
  s.velocity = {210, -4, 7};
  s.acceleration = {1.5, -0.25, 0.75};
  s.angular = {0.125, -0.0625, 0.25};
  ScratchDir dir;
  ASSERT_TRUE(writePcap(dir / "x.pcap",
                        std::vector<CapturedDatagram>{{1e9, "127.0.0.1:3000", "127.0.0.1:3000", pdu(s)}}));
  const char* const fields[] = {"entity_id_site",
                                "entity_id_application",
                                "entity_id_entity",
                                "entity_location.x",
                                "entity_location.y",
                                "entity_location.z",
                                "entity_orientation.psi",
                                "entity_orientation.theta",
                                "entity_orientation.phi",
                                "entity_linear_velocity.x",
                                "entity_linear_acceleration.y",
                                "entity_angular_velocity.z",
                                "entity_marking"};
  std::string command =
      "tshark -r '" + (dir / "x.pcap").string() + "' -d udp.port==3000,dis -T fields -E separator=,";
  for (const char* field : fields) command += std::string(" -e dis.") + field;
  const Ran ran = run(command);
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  std::vector<std::string> cells;
  std::istringstream line(ran.out);
  for (std::string cell; std::getline(line, cell, ',');) cells.push_back(cell);
  ASSERT_EQ(cells.size(), std::size(fields)) << ran.out;
  const auto number = [&cells](std::size_t i) { return std::strtod(cells[i].c_str(), nullptr); };
  EXPECT_EQ(number(0), 17);
  EXPECT_EQ(number(1), 2);
  EXPECT_EQ(number(2), 5);
  EXPECT_EQ(number(9), 210);
  EXPECT_EQ(number(10), -0.25);
  EXPECT_EQ(number(11), 0.25);
  EXPECT_THAT(cells[12], testing::StartsWith("VIPER1"));
  // What it shows, turned to the horizon by GeographicLib and single turns, is what we read.
  double latitude = 0, longitude = 0, height = 0;
  GeographicLib::Geocentric::WGS84().Reverse(number(3), number(4), number(5), latitude, longitude, height);
  HostDecoder decoder;
  const auto state = feed(decoder, pdu(s), 1);
  ASSERT_TRUE(state);
  EXPECT_NEAR(state->position.latitude.value(), latitude, 1e-9);
  EXPECT_NEAR(state->position.longitude.value(), longitude, 1e-9);
  EXPECT_NEAR(state->position.height.value(), height, 1e-4) << "as many digits as it shows";
  Body b{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto turn = [&b](Vec3 axis, double by) {
    b = {turned(b.forward, axis, by), turned(b.right, axis, by), turned(b.down, axis, by)};
  };
  turn(b.down, number(6));
  turn(b.right, number(7));
  turn(b.forward, number(8));
  const Body ours = bodyOf(frameAt(state->position), state->attitude);
  EXPECT_LT(length(b.forward - ours.forward) + length(b.right - ours.right), 2e-5)
      << "as many digits as it shows";
}

/// What the motion comes to in many small steps.
struct Reckoned {
  Vec3 place;
  Body body;
};
Reckoned stepped(const Sent& s, double seconds) {
  const bool inBody = s.algorithm >= 6,
             rotates = s.algorithm == 3 || s.algorithm == 4 || s.algorithm == 7 || s.algorithm == 8,
             accelerates = s.algorithm == 4 || s.algorithm == 5 || s.algorithm >= 8, moves = s.algorithm > 1;
  const Frame frame = frameAt(s.position);
  Reckoned now{frame.place, bodyOf(frame, s.attitude)};
  constexpr int kSteps = 40000;
  const double dt = seconds / kSteps, rate = rotates ? length(s.angular) : 0;
  const auto turnBy = [&](double by) {
    if (rate == 0) return;
    const Vec3 axis = now.body.toEcef(s.angular * (1 / rate));
    now.body = {turned(now.body.forward, axis, by), turned(now.body.right, axis, by),
                turned(now.body.down, axis, by)};
  };
  for (int i = 0; i < kSteps; ++i) {
    turnBy(rate * dt / 2);
    const Vec3 v = s.velocity + (accelerates ? s.acceleration * ((i + 0.5) * dt) : Vec3{});
    if (moves) now.place = now.place + (inBody ? now.body.toEcef(v) : v) * dt;
    turnBy(rate * dt / 2);
  }
  return now;
}

TEST(Dis, theEyeMovesOnByEachAlgorithmAsSmallStepsDo) {
  for (unsigned algorithm = 1; algorithm <= 9; ++algorithm)
    for (const double seconds : {0.05, 1.5, 9.0})
      for (const Vec3 angular : {Vec3{0.3, -0.2, 0.4}, Vec3{2e-5, 1e-5, -3e-5}, Vec3{}}) {
        SCOPED_TRACE(testing::Message() << algorithm << ' ' << seconds << " s " << angular.x);
        Sent s;
        s.algorithm = algorithm;
        s.velocity = {180, -25, 12};
        s.acceleration = {4, 3, -6};
        s.angular = angular;
        HostDecoder decoder;
        const auto state = feed(decoder, pdu(s), 1);
        ASSERT_TRUE(state);
        Extrapolator extrapolator;
        extrapolator.push(*state);
        const AircraftState eye = extrapolator.at(state->time + seconds, 0.5);
        const Reckoned expected = stepped(s, seconds);
        const Frame there = frameAt(eye.position);
        const Body body = bodyOf(there, eye.attitude);
        EXPECT_LT(length(there.place - expected.place), 2e-3) << "metres; the velocity was a float";
        EXPECT_LT(length(body.forward - expected.body.forward), 2e-6);
        EXPECT_LT(length(body.right - expected.body.right), 2e-6);
        EXPECT_EQ(eye.time, state->time + seconds);
      }
}

TEST(Dis, theEyeStandsOnceTheHostIsGivenUpAndIfNobodyExtrapolates) {
  Sent s;
  s.algorithm = 2;
  s.velocity = {100, 0, 0};
  HostDecoder decoder;
  const auto state = feed(decoder, pdu(s), 1);
  ASSERT_TRUE(state);
  Extrapolator extrapolator;
  extrapolator.push(*state);
  EXPECT_NEAR(distanceM(extrapolator.at(state->time + 60, 0.5).position, s.position), 1200, 0.01) << "12 s";
  EXPECT_EQ(extrapolator.at(state->time + 1, 0).position, state->position);
}

TEST(Dis, velocityIsThatOfTheHorizon) {
  Sent s;
  const Frame f = frameAt(s.position);
  s.algorithm = 2;
  s.velocity = f.north * 30.0 + f.east * -40.0 + f.down * 5.0;
  HostDecoder world, inBody;
  const auto expectVelocity = [](const std::optional<AircraftState>& state, double north, double east,
                                 double down) {
    ASSERT_TRUE(state && state->velocity);
    EXPECT_NEAR(state->velocity->north.value(), north, 1e-4);
    EXPECT_NEAR(state->velocity->east.value(), east, 1e-4);
    EXPECT_NEAR(state->velocity->down.value(), down, 1e-4);
  };
  expectVelocity(feed(world, pdu(s), 1), 30, -40, 5);
  s.algorithm = 6;
  s.attitude = {Degrees{90}, Degrees{0}, Degrees{0}};
  s.velocity = {150, 10, -2};
  expectVelocity(feed(inBody, pdu(s), 1), -10, 150, -2);
}

TEST(Dis, whatStandsOrHasNoAlgorithmPromisesNoMotion) {
  Sent s;
  s.algorithm = 4;
  s.velocity = {90, 0, 0};
  s.appearance = 1U << 21U;
  HostDecoder frozen, unknown, wild;
  EXPECT_EQ(feed(frozen, pdu(s), 1)->deadReckoning, DeadReckoning{});
  s.appearance = 0;
  s.algorithm = 0;
  EXPECT_FALSE(feed(unknown, pdu(s), 1)->deadReckoning);
  s.algorithm = 4;
  s.velocity = {std::nan(""), 0, 0};
  const auto state = feed(wild, pdu(s), 1);
  ASSERT_TRUE(state) << "its place holds";
  EXPECT_FALSE(state->deadReckoning);
  EXPECT_FALSE(state->velocity);
}

TEST(Dis, theOwnAircraftIsChosenByIdNumberOrMarking) {
  Sent first, second;
  second.entity = 6;
  second.marking = "Cobra 7";
  second.position.latitude = Degrees{10};
  for (const char* wanted : {"17:2:6", "6", "COBRA 7"}) {
    HostChoice choice;
    choice.chooseEntity(wanted);
    HostDecoder decoder(choice);
    EXPECT_FALSE(feed(decoder, pdu(first), 1)) << wanted;
    ASSERT_TRUE(decoder.statistics().newestNotForUs);
    EXPECT_THAT(
        toString(*decoder.statistics().newestNotForUs),
        HasSubstr("entity: expected " + std::string(wanted) + ", found 17:2:5 VIPER1 only; choose one"));
    const auto state = feed(decoder, pdu(second), 1.1);
    ASSERT_TRUE(state) << wanted;
    EXPECT_NEAR(state->position.latitude.value(), 10, 1e-9);
    EXPECT_EQ(decoder.statistics().ownEntity, "17:2:6 Cobra 7");
    EXPECT_EQ(decoder.statistics().notForUs, 1U);
  }
  HostDecoder any;
  Sent missile;
  missile.kind = 2;
  missile.entity = 9;
  missile.marking = "";
  EXPECT_FALSE(feed(any, pdu(missile), 1)) << "no platform";
  EXPECT_TRUE(feed(any, pdu(second), 1.1));
  EXPECT_FALSE(feed(any, pdu(first), 1.2)) << "the first platform stays the own one";
  EXPECT_EQ(any.statistics().ownEntity, "17:2:6 Cobra 7");
  EXPECT_EQ(any.statistics().otherEntityNames, "17:2:9, 17:2:5 VIPER1");
}

TEST(Dis, severalPdusInADatagramAreReadAndABadOneCostsItself) {
  Sent own, other;
  other.entity = 77;
  auto bytes = pdu(other);
  wire::put(std::span(bytes), 48, ByteOrder::big, std::nan(""));
  const auto mine = pdu(own);
  bytes.insert(bytes.end(), mine.begin(), mine.end());
  HostChoice fifth(HostProtocol::dis);
  fifth.chooseEntity("5");
  HostDecoder decoder(fifth);
  EXPECT_TRUE(feed(decoder, bytes, 1));
  wire::put(std::span(bytes), 144 + 64, ByteOrder::big, 1e6);
  HostDecoder bad(fifth);
  EXPECT_FALSE(feed(bad, bytes, 1));
  EXPECT_THAT(bad.statistics().firstBadReason, HasSubstr("byte 48: location x"));
}

TEST(Dis, timeIsTheHostsAndGoesOnOverTheHour) {
  HostDecoder decoder;
  Sent s;
  s.seconds = 3599.5;
  const auto before = feed(decoder, pdu(s), 10);
  s.seconds = 1.5;
  const auto after = feed(decoder, pdu(s), 12.1);
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(after->time - before->time, 2, 1e-5);
  s.seconds = 1.0;
  EXPECT_FALSE(feed(decoder, pdu(s), 12.2)) << "late";
  EXPECT_EQ(decoder.statistics().reordered, 1U);
}

TEST(Dis, aHeartbeatOfFiveSecondsIsNeitherASilenceNorAJump) {
  HostDecoder decoder;
  Sent s;
  s.algorithm = 2;
  s.velocity = frameAt(s.position).north * 250.0;
  ASSERT_TRUE(feed(decoder, pdu(s), 10));
  s.seconds += 5;
  s.position.latitude = s.position.latitude + Degrees{1250.0 / 111e3};
  ASSERT_TRUE(feed(decoder, pdu(s), 15));
  EXPECT_EQ(decoder.statistics().jumps, 0U);
  EXPECT_EQ(decoder.statistics().silences, 0U);
}

TEST(Dis, whatIsDamagedIsRefusedWithItsByte) {
  struct Case {
    std::size_t at;
    double value;
    const char* says;
  };
  for (const Case& c :
       {Case{48, 1e9, "byte 48: location x"}, Case{56, 1, "byte 48: location: expected a place"}}) {
    auto bytes = pdu({});
    wire::put(std::span(bytes), c.at, ByteOrder::big, c.value);
    HostDecoder decoder;
    EXPECT_FALSE(feed(decoder, bytes, 1));
    EXPECT_THAT(decoder.statistics().firstBadReason, HasSubstr(c.says));
  }
  auto parameters = pdu({});
  wire::put(std::span(parameters), 19, ByteOrder::big, std::uint8_t{2});
  HostDecoder decoder;
  EXPECT_FALSE(feed(decoder, parameters, 1));
  EXPECT_THAT(decoder.statistics().firstBadReason,
              HasSubstr("byte 19: variable parameters: expected at most 0"));
}

}  // namespace
}  // namespace trimtab::test
