#include "host_support.h"
#include "tests/support.h"
#include "trimtab/host/flight.h"

namespace trimtab::test {
namespace {

constexpr std::size_t kRainAt = 72, kSnowAt = kRainAt + 56;  ///< in a message of state and weather alone

AircraftState withWeather(std::optional<HostWeather> weather) {
  AircraftState s = aState();
  s.weather = weather;
  return s;
}

/// A session of messages 20 ms apart.
class WeatherControl : public testing::TestWithParam<ByteOrder> {
 protected:
  std::optional<HostWeather> hear(std::vector<std::byte> bytes) {
    const double time = 100 + 0.02 * frame_;
    const auto state = feed(decoder_, bytes, time);
    EXPECT_TRUE(state) << decoder_.statistics().firstBadReason;
    return state ? state->weather : std::nullopt;
  }
  std::vector<std::byte> message(const std::optional<HostWeather>& weather) {
    AircraftState s = withWeather(weather);
    s.time += 0.02 * ++frame_;
    return encodeCigiHost(s, frame_, 0, GetParam());
  }
  HostDecoder decoder_;
  std::uint32_t frame_ = 0;
};
INSTANTIATE_TEST_SUITE_P(EitherOrder, WeatherControl, testing::Values(ByteOrder::big, ByteOrder::little));

TEST_P(WeatherControl, holdsUntilTheHostSaysOtherwise) {
  const HostWeather rain{Precipitation::rain, 2, Metres{4000}}, snow{Precipitation::snow, 5, std::nullopt};
  EXPECT_FALSE(hear(message({})));
  EXPECT_EQ(hear(message(rain)), rain);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(hear(message({})), rain) << "not sent again";
  EXPECT_EQ(hear(message(snow)), snow);
  EXPECT_EQ(hear(message({})), snow);
  EXPECT_EQ(hear(message(HostWeather{})), HostWeather{}) << "both layers off";
  EXPECT_EQ(hear(message({})), HostWeather{});
}

TEST_P(WeatherControl, hasItsFieldsWhereTheLayoutSays) {
  const auto bytes =
      encodeCigiHost(withWeather(HostWeather{Precipitation::snow, 5, Metres{750}}), 1, 0, GetParam());
  ASSERT_EQ(bytes.size(), kSnowAt + 56);
  const auto u8 = [&bytes](std::size_t at) { return std::to_integer<int>(bytes[at]); };
  EXPECT_EQ(u8(kRainAt), 12);
  EXPECT_EQ(u8(kRainAt + 1), 56);
  EXPECT_EQ(u8(kRainAt + 4), 4);
  EXPECT_EQ(u8(kRainAt + 6), 0);
  EXPECT_EQ(u8(kSnowAt + 4), 5);
  EXPECT_EQ(u8(kSnowAt + 6), 1);
  EXPECT_EQ(u8(kSnowAt + 7), 5 << 2);
  EXPECT_EQ(wire::get<float>(bytes, kSnowAt + 12, GetParam()), 750.0F);
}

TEST_P(WeatherControl, ofBothLayersTheMoreSevereFalls) {
  auto both = message(HostWeather{Precipitation::snow, 3, Metres{900}});
  both[kRainAt + 6] = std::byte{1};
  both[kRainAt + 7] = std::byte{4U << 2U};
  EXPECT_EQ(hear(both)->precipitation, Precipitation::rain);
  both = message(HostWeather{Precipitation::snow, 4, Metres{900}});
  both[kRainAt + 6] = std::byte{1};
  both[kRainAt + 7] = std::byte{4U << 2U};
  EXPECT_EQ(hear(both), (HostWeather{Precipitation::snow, 4, Metres{900}}));
}

TEST_P(WeatherControl, ofRegionsEntitiesAndOtherLayersIsCountedAndPassedOver) {
  const HostWeather rain{Precipitation::rain, 1, std::nullopt};
  ASSERT_EQ(hear(message(rain)), rain);
  for (const unsigned scope : {1U, 2U, 3U}) {
    auto bytes = message(HostWeather{Precipitation::snow, 5, Metres{10}});
    bytes[kRainAt + 7] = bytes[kSnowAt + 7] = static_cast<std::byte>(scope | 7U << 2U);
    wire::put(bytes, kSnowAt + 12, GetParam(), -1.0F);  // not ours to judge
    EXPECT_EQ(hear(bytes), rain) << scope;
  }
  EXPECT_EQ(decoder_.statistics().regionalWeather, 6U);
  EXPECT_EQ(decoder_.statistics().otherLayers, 0U);
  for (const int layer : {0, 1, 2, 3, 6, 7, 8, 9, 255}) {
    auto bytes = message(HostWeather{Precipitation::snow, 5, Metres{10}});
    bytes[kRainAt + 4] = bytes[kSnowAt + 4] = static_cast<std::byte>(layer);
    EXPECT_EQ(hear(bytes), rain) << layer;
  }
  EXPECT_EQ(decoder_.statistics().otherLayers, 18U);
  EXPECT_EQ(decoder_.statistics().bad, 0U);
}

TEST_P(WeatherControl, tellsTheWindOfTheLayerThatFallsElseOfTheAtmosphere) {
  const Wind west{MetresPerSecond{12}, Degrees{270}, MetresPerSecond{-0.5}},
      north{MetresPerSecond{30}, Degrees{0}, MetresPerSecond{0}};
  const auto heard = [&](const std::optional<HostWeather>& weather, std::optional<Metres> visibility,
                         const std::optional<Wind>& wind) {
    AircraftState s = withWeather(weather);
    s.visibility = visibility;
    s.wind = wind;
    s.time += 0.02 * ++frame_;
    const auto state = feed(decoder_, encodeCigiHost(s, frame_, 0, GetParam()), 100 + 0.02 * frame_);
    EXPECT_TRUE(state) << decoder_.statistics().firstBadReason;
    return state ? state->wind : std::nullopt;
  };
  const HostWeather snow{Precipitation::snow, 5, std::nullopt};
  EXPECT_FALSE(heard(std::nullopt, std::nullopt, west)) << "no packet holds it";
  EXPECT_EQ(heard(std::nullopt, Metres{9000}, west), west);
  EXPECT_EQ(heard(snow, std::nullopt, north), north) << "in the layer";
  EXPECT_EQ(heard(snow, std::nullopt, std::nullopt), west) << "calm in the layer";
  EXPECT_EQ(heard(HostWeather{}, std::nullopt, north), west) << "nothing falls";
}

TEST_P(WeatherControl, ofAWindThatIsNoneIsPassedOver) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const auto& [offset, value] : {std::pair{36, nan}, std::pair{36, 201.F}, std::pair{40, -201.F},
                                      std::pair{44, 361.F}, std::pair{44, nan}}) {
    auto bytes = message(HostWeather{Precipitation::snow, 5, Metres{10}});
    wire::put(bytes, kSnowAt + 36, GetParam(), 20.F);
    wire::put(bytes, kSnowAt + static_cast<std::size_t>(offset), GetParam(), value);
    const auto state = feed(decoder_, bytes, 100 + 0.02 * frame_);
    ASSERT_TRUE(state) << decoder_.statistics().firstBadReason;
    EXPECT_FALSE(state->wind) << offset << ' ' << value;
    EXPECT_TRUE(state->weather);
  }
}

TEST_P(WeatherControl, thatIsSwitchedOffIsNotRead) {
  auto bytes = message(HostWeather{});
  bytes[kRainAt + 7] = std::byte{7U << 2U};
  wire::put(bytes, kRainAt + 12, GetParam(), -1.0F);
  EXPECT_EQ(hear(bytes), HostWeather{});
}

TEST_P(WeatherControl, isForgottenWhenTheHostCountsAnew) {
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(hear(message(HostWeather{Precipitation::rain, 1, std::nullopt})));
  AircraftState s = aState();
  const auto state = feed(decoder_, encodeCigiHost(s, 1, 0, GetParam()), 500);
  ASSERT_TRUE(state);
  EXPECT_FALSE(state->weather);
}

TEST(WeatherOfAFlight, comesBackFromARecordingOfItsPackets) {
  // A flight whose weather changes, as `feed play` sends it and `feed record` keeps it.
  const std::optional<HostWeather> course[] = {
      std::nullopt, HostWeather{Precipitation::rain, 1, Metres{8000}},
      HostWeather{Precipitation::rain, 4, std::nullopt}, HostWeather{Precipitation::snow, 5, Metres{600}},
      HostWeather{}};
  Flight flight;
  std::vector<CapturedDatagram> datagrams;
  for (std::uint32_t i = 0; i < 250; ++i) {
    AircraftState s = withWeather(course[i / 50]);
    s.time = 0.02 * i;
    s.packet = i;
    flight.states.push_back(s);
    datagrams.push_back({1000 + s.time, "127.0.0.1:4000", "127.0.0.1:8004", encodeCigiHost(s, i, 0)});
  }
  const auto recorded = flightFromDatagrams(datagrams, "recording");
  ASSERT_TRUE(recorded) << toString(recorded.findings());
  const auto again = parseFlightCsv(flightCsv(*recorded), "recording.csv");
  ASSERT_TRUE(again) << toString(again.findings());
  ASSERT_EQ(again->states.size(), flight.states.size());
  for (std::size_t i = 0; i < flight.states.size(); ++i)
    EXPECT_EQ(again->states[i].weather, flight.states[i].weather) << i;
}

}  // namespace
}  // namespace trimtab::test
