#include "host_support.h"
#include "tests/support.h"
#include "trimtab/host/flight.h"

namespace trimtab::test {
namespace {

std::vector<CapturedDatagram> someDatagrams() {
  std::vector<CapturedDatagram> datagrams;
  for (std::uint32_t i = 0; i < 5; ++i) {
    AircraftState s = aState();
    s.time = i * 0.02;
    datagrams.push_back(
        {1.7e9 + i * 0.020001, "10.1.2.3:40000", "192.168.255.1:8004", encodeCigiHost(s, i, 0)});
  }
  return datagrams;
}

std::string written(const std::vector<CapturedDatagram>& datagrams) {
  ScratchDir dir;
  EXPECT_TRUE(writePcap(dir / "x.pcap", datagrams));
  return readFile(dir / "x.pcap");
}

TEST(Pcap, readsBackWhatItWrote) {
  const auto sent = someDatagrams();
  const auto got = parsePcap(written(sent), "x.pcap");
  ASSERT_TRUE(got) << toString(got.findings());
  ASSERT_EQ(got->size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_NEAR((*got)[i].time, sent[i].time, 1e-6);
    EXPECT_EQ((*got)[i].from, sent[i].from);
    EXPECT_EQ((*got)[i].to, sent[i].to);
    EXPECT_EQ((*got)[i].bytes, sent[i].bytes);
  }
}

TEST(Pcap, isReadByTsharkWithoutComplaint) {
  if (run("tshark --version").exitCode != 0) GTEST_SKIP() << "needs tshark";
  ScratchDir dir;
  ASSERT_TRUE(writePcap(dir / "x.pcap", someDatagrams()));
  const Ran ran = run(
      "tshark -r '" + (dir / "x.pcap").string() +
      "' -o ip.check_checksum:TRUE -T fields -e ip.src -e udp.dstport -e udp.length -e ip.checksum.status -e "
      "_ws.malformed");
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  std::istringstream lines(ran.out);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count)
    EXPECT_EQ(line.substr(0, line.find_last_not_of('\t') + 1), "10.1.2.3\t8004\t80\t1");
  EXPECT_EQ(count, 5);
}

TEST(Pcap, isReadInEveryFormThatEditcapWrites) {
  if (run("editcap --version").exitCode != 0) GTEST_SKIP() << "needs editcap";
  ScratchDir dir;
  ASSERT_TRUE(writePcap(dir / "x.pcap", someDatagrams()));
  ASSERT_EQ(
      run("editcap -F nsecpcap " + (dir / "x.pcap").string() + ' ' + (dir / "nano.pcap").string()).exitCode,
      0);
  const auto nano = readPcap(dir / "nano.pcap");
  ASSERT_TRUE(nano) << toString(nano.findings());
  EXPECT_EQ(nano->size(), 5U);
  EXPECT_NEAR((*nano)[4].time, someDatagrams()[4].time, 1e-6);
  ASSERT_EQ(
      run("editcap -F pcapng " + (dir / "x.pcap").string() + ' ' + (dir / "new.pcap").string()).exitCode, 0);
  const auto newFormat = readPcap(dir / "new.pcap");
  ASSERT_TRUE(newFormat) << toString(newFormat.findings());
  ASSERT_EQ(newFormat->size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR((*newFormat)[i].time, someDatagrams()[i].time, 1e-6);
    EXPECT_EQ((*newFormat)[i].bytes, someDatagrams()[i].bytes);
  }
  EXPECT_TRUE(readFlight(dir / "new.pcap"));
  ASSERT_EQ(run("editcap -s 60 " + (dir / "x.pcap").string() + ' ' + (dir / "cut.pcapng").string()).exitCode,
            0);
  const auto cut = readPcap(dir / "cut.pcapng");
  ASSERT_TRUE(cut) << toString(cut.findings());
  EXPECT_NE(toString(cut.findings()).find("5 frames were cut by the capture, the longest of 100 bytes to 60"),
            std::string::npos)
      << toString(cut.findings());
}

TEST(Pcap, ofAHostBecomesAFlight) {
  ScratchDir dir;
  ASSERT_TRUE(writePcap(dir / "x.pcap", someDatagrams()));
  const auto flight = readFlight(dir / "x.pcap");
  ASSERT_TRUE(flight) << toString(flight.findings());
  ASSERT_EQ(flight->states.size(), 5U);
  EXPECT_NEAR(flight->states[4].time, 0.08, 1e-9) << "the host's timestamps, from 0";
  EXPECT_EQ(flight->states[4].packet, 4U);
}

TEST(Pcap, thatIsDamagedIsRefusedOrUsedUpToTheDamage) {
  const std::string good = written(someDatagrams());
  struct Case {
    const char* name;
    std::string bytes;
    const char* says;
  };
  std::string badMagic = good, badLink = good, badLength = good;
  badMagic[0] = 'x';
  badLink[20] = '\x7f';
  badLength[24 + 8 + 3] = '\x7f';
  const Case cases[] = {{"cut header", good.substr(0, 20), "24 bytes"},
                        {"magic", badMagic, "magic"},
                        {"link type", badLink, "byte 20"},
                        {"record length", badLength, "byte 24: record length"}};
  for (const Case& c : cases) {
    const auto got = parsePcap(c.bytes, "x.pcap");
    EXPECT_FALSE(got) << c.name;
    EXPECT_NE(toString(got.findings()).find(c.says), std::string::npos)
        << c.name << ": " << toString(got.findings());
  }
  const auto cut = parsePcap(good.substr(0, good.size() - 1), "x.pcap");
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->size(), 4U);
  EXPECT_EQ(cut.findings().size(), 1U);
  EXPECT_FALSE(flightFromDatagrams({}, "x.pcap"));
}

}  // namespace
}  // namespace trimtab::test
