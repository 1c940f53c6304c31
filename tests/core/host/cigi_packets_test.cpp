#include <gmock/gmock.h>

#include <functional>

#include "host_support.h"
#include "tests/support.h"
#include "trimtab/units/not_finite.h"

/// What one packet of a message may cost, and what of a CIGI host is followed.
namespace trimtab::test {
namespace {

using Bytes = std::vector<std::byte>;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// Where the packets of encodeCigiHost(aFullState()) begin.
constexpr std::size_t kEntity = 24, kHead = 72, kView = 104, kAir = 136, kRain = 168, kSnow = 224;

struct DamagedPacket {
  const char* name;
  std::size_t offset;
  std::function<void(Bytes&, std::size_t, ByteOrder)> put;
  const char* reason;
};

template <class T>
std::function<void(Bytes&, std::size_t, ByteOrder)> value(T v) {
  return [v](Bytes& bytes, std::size_t at, ByteOrder order) { wire::put(bytes, at, order, v); };
}

const float kNone = static_cast<float>(kNan);

/// Packets that are refused while the aircraft flies on.
const std::vector<DamagedPacket>& besideTheAircraft() {
  static const std::vector<DamagedPacket> table{
      {"head's pitch", kHead + 24, value(100.0F), "byte 96: view pitch"},
      {"head's yaw", kHead + 28, value(kNone), "byte 100: view yaw"},
      {"no near plane", kView + 8, value(0.0F), "byte 112: near plane: expected 1e-06..1e+06 m, found 0 m"},
      {"near plane behind", kView + 8, value(-2.5F), "byte 112: near plane"},
      {"right angle", kView + 20, value(90.0F), "byte 124: right half-angle: expected -89.9..89.9 deg"},
      {"half turn", kView + 16, value(-180.0F), "byte 120: left half-angle"},
      {"visibility", kAir + 8, value(-1.0F), "byte 144: global visibility"},
      {"severity 7", kSnow + 7, value(std::uint8_t{7U << 2U}), "byte 231: severity: expected 0..5, found 7"},
      {"layer's visibility", kSnow + 12, value(kNone), "byte 236: layer visibility"},
  };
  return table;
}

/// Packets of the own aircraft itself.
const std::vector<DamagedPacket>& ofTheAircraft() {
  static const std::vector<DamagedPacket> table{
      {"attached", kEntity + 4, value(std::uint8_t{5}), "byte 28: attach state"},
      {"latitude", kEntity + 24, value(90.5), "byte 48: latitude"},
      {"longitude", kEntity + 32, value(360.5), "byte 56: longitude: expected -360"},
      {"no longitude", kEntity + 32, value(kNan), "byte 56: longitude"},
      {"altitude", kEntity + 40, value(-kInfinity), "byte 64: altitude"},
      {"yaw", kEntity + 20, value(1e9F), "byte 44: yaw"},
  };
  return table;
}

class CigiPackets : public testing::TestWithParam<ByteOrder> {
 protected:
  Bytes message(std::uint32_t frame, const AircraftState& state = aFullState()) const {
    AircraftState s = state;
    s.time += 0.02 * frame;
    return encodeCigiHost(s, frame, 0, GetParam());
  }
  Bytes damaged(const DamagedPacket& bad, std::uint32_t frame) const {
    Bytes bytes = message(frame);
    bad.put(bytes, bad.offset, GetParam());
    return bytes;
  }
};
INSTANTIATE_TEST_SUITE_P(EitherOrder, CigiPackets, testing::Values(ByteOrder::big, ByteOrder::little));

TEST_P(CigiPackets, thatAreBadCostThemselvesAndNotTheMessage) {
  for (const DamagedPacket& bad : besideTheAircraft()) {
    SCOPED_TRACE(bad.name);
    // The first message says something else of all that the bad one repeats.
    AircraftState before = aFullState();
    before.head->pitch = Degrees{5};
    before.view->right = Degrees{20};
    before.visibility = Metres{900};
    before.weather->severity = 1;
    HostDecoder decoder;
    ASSERT_TRUE(feed(decoder, message(1, before), 1));
    const auto state = feed(decoder, damaged(bad, 2), 1.02);
    ASSERT_TRUE(state) << "the aircraft flies on";
    EXPECT_EQ(state->position, aFullState().position);
    // It keeps what was before, and all others say what is new.
    EXPECT_EQ(state->head == before.head, bad.offset < kView);
    EXPECT_EQ(state->view == before.view, bad.offset >= kView && bad.offset < kAir);
    EXPECT_EQ(state->visibility == before.visibility, bad.offset >= kAir && bad.offset < kRain);
    EXPECT_EQ(state->weather == before.weather, bad.offset >= kSnow);
    const HostStatistics& s = decoder.statistics();
    EXPECT_EQ(s.refusedPackets, 1U);
    EXPECT_EQ(s.bad + s.truncated + s.notForUs, 0U);
    EXPECT_THAT(s.firstRefusedReason, StartsWith(bad.reason));
    ASSERT_TRUE(s.newestRefused);
    EXPECT_THAT(toString(*s.newestRefused), StartsWith("127.0.0.1:8004: " + std::string(bad.reason)));
  }
}

TEST_P(CigiPackets, ofTheOwnAircraftThatAreBadYieldNoStateAndTheRestCounts) {
  for (const DamagedPacket& bad : ofTheAircraft()) {
    SCOPED_TRACE(bad.name);
    HostDecoder decoder;
    ASSERT_TRUE(feed(decoder, message(1, aState()), 1));
    EXPECT_FALSE(feed(decoder, damaged(bad, 2), 1.02)) << "it is nowhere known";
    EXPECT_EQ(decoder.statistics().refusedPackets, 1U);
    EXPECT_EQ(decoder.statistics().bad, 0U);
    ASSERT_TRUE(decoder.statistics().newestUnused);
    EXPECT_THAT(toString(*decoder.statistics().newestUnused), HasSubstr(bad.reason));
    const auto state = feed(decoder, message(3, aState()), 1.04);
    ASSERT_TRUE(state);
    EXPECT_EQ(state->position, aState().position);
    EXPECT_EQ(state->head, aFullState().head) << "which the message with the bad packet said";
    EXPECT_EQ(decoder.statistics().lost, 0U);
  }
}

TEST_P(CigiPackets, ofAnotherSizeAreRefusedAndThoseBehindThemAreRead) {
  for (const auto& [at, named] :
       {std::pair{kEntity, "byte 25: size of packet Entity Control (2): expected 48"},
        {kHead, "byte 73: size of packet View Control (16): expected 32"},
        {kAir, "byte 137: size of packet Atmosphere Control (10): expected 32"}}) {
    Bytes bytes = message(1);
    const auto size = std::to_integer<std::uint8_t>(bytes[at + 1]);
    bytes[at + 1] = static_cast<std::byte>(size + 8);
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at + size), 8, std::byte{0});
    HostDecoder decoder;
    const auto state = feed(decoder, bytes, 1);
    EXPECT_EQ(state.has_value(), at != kEntity);
    if (state) {
      EXPECT_EQ(state->weather, aFullState().weather);
    }
    EXPECT_EQ(decoder.statistics().refusedPackets, 1U);
    EXPECT_THAT(decoder.statistics().firstRefusedReason, StartsWith(named));
  }
}

TEST_P(CigiPackets, haveLongitudesOfEitherTurn) {
  for (const auto& [sent, meant] :
       {std::pair{181.25, -178.75}, {200.0, -160.0}, {359.5, -0.5}, {-250.0, 110.0}, {-181.0, 179.0}}) {
    Bytes bytes = message(1, aState());
    wire::put(bytes, kEntity + 32, GetParam(), sent);
    HostDecoder decoder;
    const auto state = feed(decoder, bytes, 1);
    ASSERT_TRUE(state) << sent;
    EXPECT_DOUBLE_EQ(state->position.longitude.value(), meant);
  }
}

TEST(NativeFdm, hasLongitudesOfEitherTurn) {
  for (const auto& [sent, meant] :
       {std::pair{4.5, 4.5 - 2 * 3.14159265358979}, {-3.5, 2 * 3.14159265358979 - 3.5}}) {
    Bytes bytes = encodeNativeFdm(aState());
    wire::put(bytes, 8, ByteOrder::big, sent);
    HostDecoder decoder;
    const auto state = feed(decoder, bytes, 1);
    ASSERT_TRUE(state) << sent;
    EXPECT_NEAR(state->position.longitude.in<Radians>(), meant, 1e-12);
  }
}

/// A message of the plain state whose entity has another number.
Bytes ofEntity(std::uint16_t entity, std::uint32_t frame, ByteOrder order) {
  Bytes bytes = encodeCigiHost(aFullState(), frame, 0, order);
  wire::put(bytes, kEntity + 2, order, entity);
  wire::put(bytes, kHead + 6, order, entity);
  return bytes;
}

TEST_P(CigiPackets, ofAnotherEntityAreTheOwnAircraftIfItIsChosen) {
  HostChoice choice;
  choice.entity = 12;
  HostDecoder chosen(choice), other;
  const auto state = feed(chosen, ofEntity(12, 1, GetParam()), 1);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->position, aState().position);
  EXPECT_EQ(state->head, aFullState().head) << "the eyepoint is attached to that entity";
  EXPECT_FALSE(feed(other, ofEntity(12, 1, GetParam()), 1));
  EXPECT_FALSE(feed(other, ofEntity(400, 2, GetParam()), 1.02));
  EXPECT_THAT(other.statistics().otherEntities, ElementsAre(12, 400));
  EXPECT_THAT(toString(*other.statistics().newestNotForUs),
              HasSubstr("no entity 0; seen: 12, 400; --entity"));
  chosen.reset();
  EXPECT_FALSE(feed(chosen, message(1), 2)) << "the choice stays";
  EXPECT_THAT(toString(*chosen.statistics().newestNotForUs), HasSubstr("no entity 12; seen: 0"));
}

TEST_P(CigiPackets, ofAViewAreFollowedIfItIsChosen) {
  const auto two = [&](std::uint32_t frame) {
    Bytes bytes = message(frame);
    AircraftState second = aFullState();
    second.head = Attitude{Degrees{77}, Degrees{3}, Degrees{0}};
    second.view->right = Degrees{33};
    Bytes more = encodeCigiHost(second, frame, 0, GetParam());
    wire::put(more, kHead + 2, GetParam(), std::uint16_t{5});
    wire::put(more, kView + 2, GetParam(), std::uint16_t{5});
    bytes.insert(bytes.end(), more.begin() + kHead, more.begin() + kAir);
    return bytes;
  };
  HostDecoder first;
  const auto seen = feed(first, two(1), 1);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->head, aFullState().head) << "the first one that the host controls";
  EXPECT_EQ(seen->view, aFullState().view);
  EXPECT_THAT(first.statistics().views, ElementsAre(0, 5));
  EXPECT_EQ(first.statistics().view, 0);
  HostChoice choice;
  choice.view = 5;
  HostDecoder fifth(choice);
  const auto state = feed(fifth, two(1), 1);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->head->heading, Degrees{77});
  EXPECT_EQ(state->view->right, Degrees{33});
  EXPECT_EQ(fifth.statistics().view, 5);
}

TEST_P(CigiPackets, withAFrameNumberThatStandsStillAreFlownAndCounted) {
  for (const std::uint32_t stands : {0U, 77U}) {
    HostDecoder decoder;
    AircraftState s = aState();
    std::uint64_t states = 0, lastPacket = 0;
    for (int i = 0; i < 100; ++i) {
      s.position.latitude = Degrees{36 + i * 1e-5};
      if (const auto state = feed(decoder, encodeCigiHost(s, stands, 0, GetParam()), 100 + i * 0.02)) {
        EXPECT_EQ(state->position.latitude, s.position.latitude) << "the newest";
        EXPECT_TRUE(states++ == 0 || state->packet > lastPacket) << "each has a number of its own";
        lastPacket = state->packet;
      }
    }
    EXPECT_EQ(states, 96U) << "four came like repeated datagrams";
    EXPECT_EQ(decoder.statistics().uncounted, 95U);
    EXPECT_EQ(decoder.statistics().repeated, 4U);
    EXPECT_FALSE(decoder.statistics().lost) << "nobody can tell";
    // The host begins to count after all.
    for (std::uint32_t i = 1; i <= 3; ++i)
      EXPECT_TRUE(feed(decoder, encodeCigiHost(s, stands + i, 0, GetParam()), 102 + i * 0.02));
    EXPECT_EQ(decoder.statistics().lost, 0U);
    EXPECT_EQ(decoder.statistics().uncounted, 95U);
  }
}

TEST_P(CigiPackets, whoseCountStandsFarFromTheLastOneAreFlownToo) {
  HostDecoder decoder;
  for (std::uint32_t frame = 5000; frame < 5010; ++frame)
    ASSERT_TRUE(feed(decoder, message(frame), 100 + (frame - 5000) * 0.02));
  int states = 0;
  for (int i = 0; i < 20; ++i) states += feed(decoder, message(0), 100.2 + i * 0.02).has_value();
  EXPECT_EQ(states, 15);
  EXPECT_EQ(decoder.statistics().implausible, 0U);
}

TEST_P(CigiPackets, thatRepeatEachFrameAFewTimesAreNotFlownTwice) {
  HostDecoder decoder;
  int states = 0;
  for (std::uint32_t frame = 1; frame <= 50; ++frame)
    for (int copy = 0; copy < 4; ++copy)
      states += feed(decoder, message(frame), 100 + frame * 0.02 + copy * 1e-4).has_value();
  EXPECT_EQ(states, 50);
  EXPECT_EQ(decoder.statistics().uncounted, 0U);
}

Bytes clampedPacket(std::uint16_t entity, float yaw, double latitude, double longitude, ByteOrder order) {
  Bytes bytes(24);
  wire::put(bytes, 0, order, std::uint8_t{3});
  wire::put(bytes, 1, order, std::uint8_t{24});
  wire::put(bytes, 2, order, entity);
  wire::put(bytes, 4, order, yaw);
  wire::put(bytes, 8, order, latitude);
  wire::put(bytes, 16, order, longitude);
  return bytes;
}

TEST_P(CigiPackets, thatClampTheAircraftSayWhereItsHeightCountsFrom) {
  for (const GroundClamp clamp : {GroundClamp::none, GroundClamp::level, GroundClamp::conformal}) {
    AircraftState s = aState();
    s.clamp = clamp;
    s.position.height = Metres{2.75};
    HostDecoder decoder;
    const auto state = feed(decoder, encodeCigiHost(s, 1, 0, GetParam()), 1);
    ASSERT_TRUE(state);
    EXPECT_EQ(state->clamp, clamp);
    EXPECT_EQ(state->position.height, Metres{2.75});
  }
  // A place and a heading alone, with the offset of the Entity Control before it.
  const Bytes place = clampedPacket(0, 215.5F, -33.25, 250, GetParam());
  Bytes alone = message(1, aState());
  alone.resize(kEntity);
  alone.insert(alone.end(), place.begin(), place.end());
  HostDecoder fresh;
  const auto first = feed(fresh, alone, 1);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->clamp, GroundClamp::conformal);
  EXPECT_EQ(first->position, (GeodeticPosition{Degrees{-33.25}, Degrees{-110}, Metres{0}}));
  EXPECT_EQ(first->attitude, (Attitude{Degrees{215.5}, {}, {}}));
  AircraftState parked = aState();
  parked.clamp = GroundClamp::level;
  parked.position.height = Metres{3.5};
  HostDecoder decoder;
  feed(decoder, encodeCigiHost(parked, 1, 0, GetParam()), 1);
  wire::put(alone, 8, GetParam(), std::uint32_t{2});
  const auto second = feed(decoder, alone, 1.02);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->position.height, Metres{3.5});
  EXPECT_EQ(second->attitude.pitch, parked.attitude.pitch);
  // That of another entity is not ours.
  const Bytes other = clampedPacket(9, 10, 0, 0, GetParam());
  Bytes both = message(3, parked);
  both.insert(both.end(), other.begin(), other.end());
  EXPECT_EQ(feed(decoder, both, 1.04)->position.latitude, parked.position.latitude);
}

TEST_P(CigiPackets, ofTypesThatAreNotReadAreListedOnceWithTheirCount) {
  HostDecoder decoder;
  for (std::uint32_t frame = 1; frame <= 7; ++frame) {
    Bytes bytes = message(frame);
    for (const int id : {8, 9, 8, 222}) {
      bytes.insert(bytes.end(), 24, std::byte{0});
      bytes[bytes.size() - 24] = static_cast<std::byte>(id);
      bytes[bytes.size() - 23] = std::byte{24};
    }
    ASSERT_TRUE(feed(decoder, bytes, 1 + frame * 0.02));
  }
  std::string list;
  for (const IgnoredPackets& each : decoder.statistics().ignored)
    list += cigiPacketName(each.id) + ": " + std::to_string(each.count) + "; ";
  EXPECT_EQ(list, "Rate Control (8): 14; Celestial Sphere Control (9): 7; user-defined (222): 7; ");
  EXPECT_EQ(decoder.statistics().refusedPackets, 0U);
}

}  // namespace
}  // namespace trimtab::test
