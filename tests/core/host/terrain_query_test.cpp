#include "trimtab/host/terrain_query.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "dissected.h"
#include "host_support.h"
#include "tests/support.h"
#include "trimtab/units/not_finite.h"

/// What hosts ask about the terrain, and what they are answered.
namespace trimtab::test {
namespace {

using Bytes = std::vector<std::byte>;
using testing::HasSubstr;

/// A plane that rises to the north and to the east, with a wall across it, known north of 40 degrees south.
class Country : public GroundHeights {
 public:
  static constexpr double kBase = 240, kNorth = 0.03, kEast = -0.05;
  static constexpr double kWallFrom = 8.49, kWallTo = 8.51,
                          kWallHeight = 900;  ///< degrees of longitude, metres

  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override {
    if (latitude < Degrees{-40}) return std::nullopt;
    if (longitude.value() > kWallFrom && longitude.value() < kWallTo) return Metres{kWallHeight};
    const Vec3 local = frame_.fromGeodetic({latitude, longitude, Metres{0}});
    return Metres{kBase + kNorth * local.y + kEast * local.x};
  }
  std::optional<Metres> highest() const override { return Metres{20000}; }
  Metres postDistance() const override { return Metres{30}; }

 private:
  LocalFrame frame_{GeodeticPosition{Degrees{47.5}, Degrees{8.25}, Metres{0}}};
};

constexpr GeodeticPosition kPlace{Degrees{47.5}, Degrees{8.25}, Metres{1500}};

struct Question {
  Bytes packet;
  ByteOrder order;
  void put(std::size_t at, auto value) { wire::put(packet, at, order, value); }
};

Question question(std::uint8_t id, std::uint8_t size, std::uint16_t number, ByteOrder order) {
  Question q{Bytes(size), order};
  q.put(0, id);
  q.put(1, size);
  q.put(2, number);
  return q;
}

/// HAT/HOT Request of `type` 0, 1 or 2 at a place.
Question heightAt(const GeodeticPosition& p, std::uint8_t type, ByteOrder order) {
  Question q = question(24, 32, 7, order);
  q.put(4, type);
  q.put(8, p.latitude.value());
  q.put(16, p.longitude.value());
  q.put(24, p.height.value());
  return q;
}
Question segment(const GeodeticPosition& a, const GeodeticPosition& b, bool extended, ByteOrder order) {
  Question q = question(25, 64, 9, order);
  q.put(4, static_cast<std::uint8_t>(extended));
  std::size_t at = 8;
  for (const GeodeticPosition& p : {a, b}) {
    q.put(at, p.latitude.value());
    q.put(at + 8, p.longitude.value());
    q.put(at + 16, p.height.value());
    at += 24;
  }
  return q;
}
Question vectorFrom(const GeodeticPosition& p, float azimuth, float elevation, float nearest, float farthest,
                    ByteOrder order) {
  Question q = question(26, 56, 11, order);
  q.put(8, azimuth);
  q.put(12, elevation);
  q.put(16, nearest);
  q.put(20, farthest);
  q.put(24, p.latitude.value());
  q.put(32, p.longitude.value());
  q.put(40, p.height.value());
  return q;
}

class TerrainQueries : public testing::TestWithParam<ByteOrder> {
 protected:
  /// What comes back from a host's message of its aircraft and one request, as the decoder reads it.
  Bytes answer(const Question& q, const AircraftState& aircraft = aState()) {
    Bytes bytes = encodeCigiHost(aircraft, ++frame_, 0, GetParam());
    bytes.insert(bytes.end(), q.packet.begin(), q.packet.end());
    EXPECT_TRUE(feed(decoder_, bytes, 100 + frame_ * 0.02));
    std::vector<TerrainQuery> queries;
    decoder_.takeQueries(queries);
    EXPECT_EQ(queries.size(), 1U);
    return queries.empty() ? Bytes{} : answerOf(queries[0], &country_);
  }
  template <class T>
  T at(const Bytes& bytes, std::size_t offset) const {
    return wire::get<T>(bytes, offset, GetParam());
  }
  static int u8(const Bytes& bytes, std::size_t offset) { return std::to_integer<int>(bytes[offset]); }
  static int flags(const Bytes& bytes) { return u8(bytes, 4) & 15; }

  Country country_;
  HostDecoder decoder_;
  std::uint32_t frame_ = 0x20;
};
INSTANTIATE_TEST_SUITE_P(EitherOrder, TerrainQueries, testing::Values(ByteOrder::big, ByteOrder::little));

TEST_P(TerrainQueries, ofHeightsAreAnsweredFromTheTerrain) {
  const Bytes above = answer(heightAt(kPlace, 0, GetParam()));
  ASSERT_EQ(above.size(), 16U);
  EXPECT_EQ(u8(above, 0), 102);
  EXPECT_EQ(at<std::uint16_t>(above, 2), 7);
  EXPECT_EQ(flags(above), 1) << "valid, a height above terrain";
  EXPECT_EQ(u8(above, 4) >> 4, 1) << "the last digit of the host's frame 0x21";
  EXPECT_NEAR(at<double>(above, 8), 1500 - 240, 1e-6);
  Question unimportant = heightAt(kPlace, 1, GetParam());
  unimportant.put(24, kNan);
  const Bytes of = answer(unimportant);
  EXPECT_EQ(flags(of), 3) << "valid, a height of terrain, whatever the altitude";
  EXPECT_NEAR(at<double>(of, 8), 240, 1e-6);
  const Bytes both = answer(heightAt(kPlace, 2, GetParam()));
  ASSERT_EQ(both.size(), 40U);
  EXPECT_EQ(u8(both, 0), 103);
  EXPECT_NEAR(at<double>(both, 8), 1260, 1e-6);
  EXPECT_NEAR(at<double>(both, 16), 240, 1e-6);
  // The normal leans away from where the ground rises: to the east by 0.05, to the south by 0.03.
  EXPECT_NEAR(at<float>(both, 28), std::atan2(0.05, -0.03) * 180 / std::numbers::pi, 0.05);
  EXPECT_NEAR(at<float>(both, 32), 90 - std::atan(std::hypot(0.05, 0.03)) * 180 / std::numbers::pi, 0.01);
}

TEST_P(TerrainQueries, outsideTheTerrainOrOfNoPlaceAreAnsweredAsInvalid) {
  const GeodeticPosition outside{Degrees{-50}, Degrees{8}, Metres{100}};
  EXPECT_EQ(flags(answer(heightAt(outside, 0, GetParam()))), 0);
  EXPECT_EQ(flags(answer(heightAt({Degrees{95}, Degrees{8}, Metres{100}}, 1, GetParam()))), 2);
  EXPECT_EQ(flags(answer(heightAt({Degrees{kNan}, Degrees{8}, Metres{100}}, 0, GetParam()))), 0);
  Question ofSomebody = heightAt({Degrees{3}, Degrees{2}, Metres{1}}, 0, GetParam());
  ofSomebody.put(4, std::uint8_t{4});
  ofSomebody.put(6, std::uint16_t{31});
  EXPECT_EQ(flags(answer(ofSomebody)), 0) << "nobody knows where entity 31 is";
  EXPECT_EQ(flags(answer(vectorFrom(kPlace, 0, -95, 0, 100, GetParam()))), 0);
  EXPECT_EQ(flags(answer(vectorFrom(kPlace, 0, -30, 500, 100, GetParam()))), 0);
  TerrainQuery query;
  query.from = kPlace;
  EXPECT_EQ(flags(answerOf(query, nullptr)), 0) << "no terrain";
  // Longitudes count in either turn.
  EXPECT_EQ(flags(answer(
                heightAt({kPlace.latitude, kPlace.longitude + Degrees{-360}, Metres{900}}, 0, GetParam()))),
            1);
}

TEST_P(TerrainQueries, relativeToTheAircraftMoveAndTurnWithIt) {
  AircraftState aircraft = aState();
  aircraft.position = kPlace;
  aircraft.attitude = {Degrees{90}, Degrees{0}, Degrees{90}};
  // 400 m ahead is east; right of an aircraft on its right wing is down, below it is north-bound... left.
  Question q = heightAt({}, 2, GetParam());
  q.put(4, std::uint8_t{2 | 4});
  q.put(8, 400.0);
  q.put(16, 100.0);
  q.put(24, 0.0);
  const Bytes both = answer(q, aircraft);
  EXPECT_EQ(flags(both), 1);
  EXPECT_NEAR(at<double>(both, 16), 240 - 0.05 * 400, 0.02);
  EXPECT_NEAR(at<double>(both, 8) + at<double>(both, 16), 1400, 0.05);
}

TEST_P(TerrainQueries, ofSegmentsSayWhatIsHiddenAndWhere) {
  const auto over = [](double longitude, double height) {
    return GeodeticPosition{Degrees{47.5}, Degrees{longitude}, Metres{height}};
  };
  // Over the plane it is free; through the wall it is not; over the wall it is.
  const Bytes free = answer(segment(over(8.25, 400), over(8.45, 400), false, GetParam()));
  ASSERT_EQ(free.size(), 16U);
  EXPECT_EQ(u8(free, 0), 104);
  EXPECT_EQ(at<std::uint16_t>(free, 2), 9);
  EXPECT_EQ(flags(free), 4) << "visible, and no range";
  EXPECT_EQ(u8(free, 5), 1) << "one response";
  const GeodeticPosition from = over(8.45, 700), to = over(8.55, 700);
  const Bytes hidden = answer(segment(from, to, false, GetParam()));
  EXPECT_EQ(flags(hidden), 1) << "hidden, and the range is valid";
  const double wall = length(toEcef(over(Country::kWallFrom, 700)) - toEcef(from));
  EXPECT_NEAR(at<double>(hidden, 8), wall, 0.1);
  EXPECT_EQ(flags(answer(segment(over(8.45, 950), over(8.55, 950), false, GetParam()))), 4);
  const Bytes where = answer(segment(from, to, true, GetParam()));
  ASSERT_EQ(where.size(), 56U);
  EXPECT_EQ(u8(where, 0), 105);
  EXPECT_EQ(flags(where), 5) << "valid, with a range, hidden";
  EXPECT_NEAR(at<double>(where, 8), wall, 0.1);
  EXPECT_NEAR(at<double>(where, 24), Country::kWallFrom, 1e-6);
  EXPECT_NEAR(at<double>(where, 32), 700, 1.2) << "the chord dips below the curve of the earth";
  const Bytes target = answer(segment(over(8.25, 400), over(8.45, 400), true, GetParam()));
  EXPECT_EQ(flags(target), 1 | 8) << "valid and visible: the target itself";
  EXPECT_NEAR(at<double>(target, 24), 8.45, 1e-9);
  // What stands on the ground sees, and is seen.
  GeodeticPosition a = over(8.26, 0), b = over(8.26, 0);
  b.latitude = Degrees{47.503};
  a.height = *country_.heightAt(a.latitude, a.longitude);
  b.height = *country_.heightAt(b.latitude, b.longitude) + Metres{2};
  a.height = a.height + Metres{2};
  EXPECT_EQ(flags(answer(segment(a, b, false, GetParam()))), 4);
  b.height = b.height - Metres{4};
  EXPECT_EQ(flags(answer(segment(a, b, false, GetParam()))), 1) << "two metres under ground";
}

TEST_P(TerrainQueries, ofVectorsSayHowFarTheGroundIs) {
  // Downwards at 30 degrees to the west, over a ground that rises there: h - x/tan... solved below.
  const double down = 30 * std::numbers::pi / 180, height = 1500 - 240;
  const double range = height / (std::sin(down) + 0.05 * std::cos(down));
  const Bytes hit = answer(vectorFrom(kPlace, 270, -30, 10, 10000, GetParam()));
  EXPECT_EQ(flags(hit) & 1, 1);
  EXPECT_NEAR(at<double>(hit, 8), range, 1) << "the earth's curve takes half a metre";
  EXPECT_EQ(flags(answer(vectorFrom(kPlace, 270, -30, 10, 2000, GetParam()))) & 1, 0) << "too short";
  EXPECT_EQ(flags(answer(vectorFrom(kPlace, 270, -30, 3000, 10000, GetParam()))) & 1, 0)
      << "it begins under ground";
  EXPECT_EQ(flags(answer(vectorFrom(kPlace, 270, 5, 10, 10000, GetParam()))) & 1, 0) << "the sky";
  // The same relative to an aircraft that banks: straight out of its right wing.
  AircraftState aircraft = aState();
  aircraft.position = kPlace;
  aircraft.attitude = {Degrees{180}, Degrees{0}, Degrees{30}};
  Question q = vectorFrom({}, 90, 0, 10, 10000, GetParam());
  q.put(4, std::uint8_t{1 | 2});
  const Bytes wing = answer(q, aircraft);
  ASSERT_EQ(wing.size(), 56U);
  EXPECT_NEAR(at<double>(wing, 8), range, 1);
}

TEST_P(TerrainQueries, areAskedAndAnsweredInTheLayoutOfTheDissector) {
  if (run("tshark --version").exitCode != 0) GTEST_SKIP() << "needs tshark";
  const auto order = GetParam();
  Bytes asked = encodeCigiHost(aState(), 0x1234, 0, order);
  Question height = heightAt({Degrees{47.625}, Degrees{8.125}, Metres{812.5}}, 2, order);
  height.put(5, std::uint8_t{12});
  height.put(6, std::uint16_t{77});
  Question line = segment({Degrees{47.25}, Degrees{8.5}, Metres{100.5}},
                          {Degrees{48.75}, Degrees{9.25}, Metres{3}}, true, order);
  line.put(60, std::uint8_t{34});
  const Question ray =
      vectorFrom({Degrees{46.5}, Degrees{7.5}, Metres{55.5}}, 33.5F, -12.25F, 5, 4500, order);
  for (const Question& q : {height, line, ray}) asked.insert(asked.end(), q.packet.begin(), q.packet.end());
  HostDecoder decoder;
  ASSERT_TRUE(feed(decoder, asked, 1));
  std::vector<TerrainQuery> queries;
  decoder.takeQueries(queries);
  ASSERT_EQ(queries.size(), 3U);
  EXPECT_EQ(queries[0].from, (GeodeticPosition{Degrees{47.625}, Degrees{8.125}, Metres{812.5}}));
  EXPECT_EQ(queries[0].everyFrame, 12);
  EXPECT_EQ(queries[1].to, (GeodeticPosition{Degrees{48.75}, Degrees{9.25}, Metres{3}}));
  EXPECT_EQ(queries[1].everyFrame, 34);
  EXPECT_EQ(queries[2].nearest, Metres{5});
  EXPECT_NEAR(length(toEcef(*queries[2].to) - toEcef(*queries[2].from)), 4500, 1e-3);
  const std::map<std::string, double> read{{"cigi.hat_hot_request.hat_hot_id", 7},
                                           {"cigi.hat_hot_request.type", 2},
                                           {"cigi.hat_hot_request.update_period", 12},
                                           {"cigi.hat_hot_request.entity_id", 77},
                                           {"cigi.hat_hot_request.lat_xoff", 47.625},
                                           {"cigi.hat_hot_request.alt_zoff", 812.5},
                                           {"cigi.los_segment_request.los_id", 9},
                                           {"cigi.los_segment_request.type", 1},
                                           {"cigi.los_segment_request.source_lon_yoff", 8.5},
                                           {"cigi.los_segment_request.destination_alt_zoff", 3},
                                           {"cigi.los_segment_request.update_period", 34},
                                           {"cigi.los_vector_request.azimuth", 33.5},
                                           {"cigi.los_vector_request.elevation", -12.25},
                                           {"cigi.los_vector_request.min_range", 5},
                                           {"cigi.los_vector_request.max_range", 4500},
                                           {"cigi.los_vector_request.source_lat_xoff", 46.5}};
  const auto requests = dissected({{1e9, "127.0.0.1:40000", "127.0.0.1:8004", asked}}, names(read));
  ASSERT_EQ(requests.size(), 1U);
  expectFields(requests[0], read);

  Bytes told = encodeCigiStartOfFrame(5, 0x1234, 1, order);
  const auto add = [&](const Bytes& answer) { told.insert(told.end(), answer.begin(), answer.end()); };
  queries[0].height = TerrainQuery::Height::of_terrain;
  add(answerOf(queries[0], &country_));
  queries[0].height = TerrainQuery::Height::both;
  add(answerOf(queries[0], &country_));
  add(answerOf(queries[1], &country_));
  add(answerOf(queries[2], &country_));
  const double of = country_.heightAt(Degrees{47.625}, Degrees{8.125})->value();
  const std::map<std::string, double> answered{{"cigi.hat_hot_response.hat_hot_id", 7},
                                               {"cigi.hat_hot_response.valid", 1},
                                               {"cigi.hat_hot_response.type", 1},
                                               {"cigi.hat_hot_response.height", of},
                                               {"cigi.hat_hot_response.host_frame_number_lsn", 4},
                                               {"cigi.hat_hot_ext_response.hot", of},
                                               {"cigi.hat_hot_ext_response.hat", 812.5 - of},
                                               {"cigi.hat_hot_ext_response.host_frame_number_lsn", 4},
                                               {"cigi.3_2_los_ext_response.los_id", 9},
                                               {"cigi.3_2_los_ext_response.valid", 1},
                                               {"cigi.3_2_los_ext_response.range_valid", 1},
                                               {"cigi.3_2_los_ext_response.visible", 0},
                                               {"cigi.3_2_los_ext_response.response_count", 1},
                                               {"cigi.3_2_los_ext_response.alpha", 255},
                                               {"cigi.los_response.los_id", 11},
                                               {"cigi.los_response.count", 1}};
  const auto responses = dissected({{1e9, "127.0.0.1:8004", "127.0.0.1:40000", told}}, names(answered));
  ASSERT_EQ(responses.size(), 1U);
  expectFields(responses[0], answered);
}

TEST(GroundAlong, findsTheFirstGroundOfALineWhateverItsLength) {
  const Country country;
  // The sky has no ground, and a line far above it is not searched at all.
  EXPECT_FALSE(groundAlong(country, {Degrees{47}, Degrees{8}, Metres{30000}},
                           {Degrees{48}, Degrees{8}, Metres{30000}}));
  // Straight down, and from below.
  const auto down = groundAlong(country, kPlace, {kPlace.latitude, kPlace.longitude, Metres{-100}});
  ASSERT_TRUE(down);
  EXPECT_NEAR(*down, 1260, 0.02);
  EXPECT_EQ(groundAlong(country, {kPlace.latitude, kPlace.longitude, Metres{100}}, kPlace), 0.0);
  // A point sees itself.
  EXPECT_FALSE(groundAlong(country, kPlace, kPlace));
}

}  // namespace
}  // namespace trimtab::test
