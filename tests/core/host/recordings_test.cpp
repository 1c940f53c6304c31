#include <cmath>

#include "host_support.h"
#include "tests/support.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/motion.h"

namespace trimtab::test {
namespace {

constexpr const char* kNativeFdm = "captures/fgfs-2020.3.16-native-fdm-v24-ufo-60hz.pcap";
constexpr const char* kCigi = "captures/ccl-3.3.3-minihost-dummyig-cigi33.pcap";
constexpr const char* kKeflavik = "data/flight-fg-keflavik/reg_flight.csv";

TEST(RecordedNativeFdm, decodesWholeAndItsFieldsComeBack) {
  TRIMTAB_NEEDS_SHARED(kNativeFdm);
  const auto datagrams = readPcap(sharedDir() / kNativeFdm);
  ASSERT_TRUE(datagrams) << toString(datagrams.findings());
  ASSERT_EQ(datagrams->size(), 1320U);
  HostDecoder decoder;
  AircraftState last;
  for (const CapturedDatagram& d : *datagrams) {
    const auto state = decoder.accept({d.bytes, d.time, d.from});
    ASSERT_TRUE(state) << decoder.statistics().firstBadReason;
    // FlightGear 2020.3 over San Francisco Bay at 3,000 ft.
    EXPECT_NEAR(state->position.latitude.value(), 37.55, 0.1);
    EXPECT_NEAR(state->position.longitude.value(), -122.33, 0.12);
    EXPECT_NEAR(state->position.height.in<Feet>(), 3000, 0.1);
    // What we send for the state has the recorded bytes in every field that carries state.
    const auto sent = encodeNativeFdm(*state);
    for (const std::size_t at : {8U, 16U, 24U})
      EXPECT_NEAR(wire::get<double>(sent, at, ByteOrder::big), wire::get<double>(d.bytes, at, ByteOrder::big),
                  1e-12);
    for (const std::size_t at : {32U, 36U, 40U, 44U, 364U})
      EXPECT_NEAR(wire::get<float>(sent, at, ByteOrder::big), wire::get<float>(d.bytes, at, ByteOrder::big),
                  1e-6F)
          << at;
    last = *state;
  }
  const HostStatistics& s = decoder.statistics();
  EXPECT_EQ(s.states, 1320U);
  EXPECT_EQ(s.silences, 1U);
  EXPECT_EQ(s.jumps, 1U);
  EXPECT_FALSE(s.lost);
  EXPECT_NEAR(s.rateHz, 60, 1);
}

TEST(RecordedNativeFdm, tellsOfItsSilenceAndJump) {
  TRIMTAB_NEEDS_SHARED(kNativeFdm);
  const auto flight = readFlight(sharedDir() / kNativeFdm);
  ASSERT_TRUE(flight) << toString(flight.findings());
  EXPECT_EQ(flight->states.size(), 1320U);
  EXPECT_EQ(flight->states.front().time, 0);
  EXPECT_NEAR(flight->durationS(), 41.125, 0.001);
  EXPECT_TRUE(mentions(flight.findings(), "silence of 18.1 s")) << toString(flight.findings());
  EXPECT_TRUE(mentions(flight.findings(), "jump of")) << toString(flight.findings());
  // Nobody glides through the silence: the state before it is held.
  const AircraftState held = stateAt(*flight, flight->states[119].time + 9);
  EXPECT_EQ(held.position, flight->states[119].position);
}

TEST(RecordedCigi, tellsTheHostFromTheImageGeneratorThatAnswersIt) {
  TRIMTAB_NEEDS_SHARED(kCigi);
  const auto datagrams = readPcap(sharedDir() / kCigi);
  ASSERT_TRUE(datagrams) << toString(datagrams.findings());
  HostDecoder decoder;
  for (const CapturedDatagram& d : *datagrams) decoder.accept({d.bytes, d.time, d.from});
  EXPECT_EQ(decoder.statistics().states, 234U);
  EXPECT_EQ(decoder.statistics().bad + decoder.statistics().notForUs, 0U);
  ASSERT_EQ(decoder.otherSenders().size(), 1U);
  EXPECT_EQ(decoder.otherSenders()[0].notForUs, 236U);
  EXPECT_EQ(decoder.otherSenders()[0].bad, 0U);
}

TEST(RecordedCigi, decodesWholeWithTheDissectorsCounts) {
  TRIMTAB_NEEDS_SHARED(kCigi);
  const auto datagrams = readPcap(sharedDir() / kCigi);
  ASSERT_TRUE(datagrams) << toString(datagrams.findings());
  EXPECT_EQ(datagrams->size(), 470U);
  const auto flight = readFlight(sharedDir() / kCigi);
  ASSERT_TRUE(flight) << toString(flight.findings());
  EXPECT_EQ(flight->states.size(), 234U);
  EXPECT_TRUE(mentions(flight.findings(), "236 Start of Frame"));

  if (run("tshark --version").exitCode != 0) GTEST_SKIP() << "needs tshark for the rest";
  const Ran ran =
      run("tshark -r '" + (sharedDir() / kCigi).string() +
          "' -d udp.port==8000,cigi -Y cigi.ig_control -T fields -e cigi.ig_control.host_frame_number -e "
          "cigi.entity_control.lat_xoff -e cigi.entity_control.lon_yoff -e cigi.entity_control.alt_zoff");
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  std::istringstream lines(ran.out);
  std::size_t row = 0;
  double latitude = 0, longitude = 0, altitude = 0;
  for (std::uint64_t frame = 0; lines >> frame >> latitude >> longitude >> altitude; ++row) {
    ASSERT_LT(row, flight->states.size());
    const AircraftState& s = flight->states[row];
    EXPECT_EQ(s.packet, frame);
    EXPECT_NEAR(s.position.latitude.value(), latitude, 1e-9);
    EXPECT_NEAR(s.position.longitude.value(), longitude, 1e-9);
    EXPECT_NEAR(s.position.height.value(), altitude, 1e-6);
  }
  EXPECT_EQ(row, 234U);
}

TEST(RecordedFlight, losesTheRowsBeforeItWasReadyAndGetsTimes) {
  TRIMTAB_NEEDS_SHARED(kKeflavik);
  const auto flight = readFlight(sharedDir() / kKeflavik);
  ASSERT_TRUE(flight) << toString(flight.findings());
  EXPECT_EQ(flight->states.size(), 2174U - 36U);
  EXPECT_TRUE(mentions(flight.findings(), "36 rows below -1000 ft")) << toString(flight.findings());
  EXPECT_TRUE(mentions(flight.findings(), "0.1 s apart"));
  EXPECT_EQ(flight->states[10].time, 1.0);
  for (const AircraftState& s : flight->states) {
    EXPECT_NEAR(s.position.latitude.value(), 63.98, 0.1);
    EXPECT_NEAR(s.position.longitude.value(), -22.6, 0.2);
    EXPECT_GT(s.position.height.in<Feet>(), 50);
    EXPECT_LT(s.position.height.in<Feet>(), 900);
  }
  EXPECT_EQ(flight->states[0].attitude.heading.value(), 180.011627);
  EXPECT_EQ(flight->states[0].attitude.pitch.value(), 5.245214);
  EXPECT_EQ(flight->states[0].attitude.roll.value(), 0.105229);
}

}  // namespace
}  // namespace trimtab::test
