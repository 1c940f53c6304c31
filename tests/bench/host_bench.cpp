#include <algorithm>
#include <filesystem>

#include "row.h"
#include "tests/support.h"
#include "trimtab/host/protocol_names.h"

/// Group `host`: what decoding a datagram costs, for each protocol. A packet is seen in an image within two
/// frames only if none of this shows: the goal is a twentieth of the millisecond that a receiver has.
namespace trimtab::bench {
namespace {

/// Seconds that each of many datagrams takes, with what the decoder remembers of those before.
std::vector<double> secondsEach(const std::string& packet, WireProtocol protocol, int count) {
  const std::span<const char> text(packet);
  std::vector<std::byte> bytes(text.size());
  std::transform(text.begin(), text.end(), bytes.begin(), [](char c) { return static_cast<std::byte>(c); });
  HostDecoder decoder(nameOf(protocol)->wanted);
  std::vector<double> seconds;
  for (int i = 1; i <= count; ++i) {
    // CIGI counts frames from its eighth byte on; the others repeat themselves.
    if (isCigi(protocol)) wire::put(std::span(bytes), 8, ByteOrder::big, static_cast<std::uint32_t>(i));
    const double begin = monotonicSeconds();
    keep(decoder.accept({bytes, 1 + i / 60.0, "127.0.0.1:8004"}));
    seconds.push_back(monotonicSeconds() - begin);
  }
  if (decoder.statistics().states == 0) std::abort();
  return seconds;
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  using namespace trimtab;
  using namespace trimtab::bench;
  Report report(argc, argv);
  const std::pair<WireProtocol, const char*> packets[] = {{WireProtocol::cigi3, "cigi-full-big"},
                                                          {WireProtocol::cigi4, "cigi4-full-big"},
                                                          {WireProtocol::native_fdm, "native-fdm"},
                                                          {WireProtocol::dis, "dis-body"},
                                                          {WireProtocol::x_plane, "x-plane-rpos"}};
  for (const auto& [protocol, file] : packets) {
    const std::string name = nameOf(protocol)->option;
    if (!report.wants(name)) continue;
    const auto path = test::sourceDir() / "tests/data/host/packets" / (std::string(file) + ".bin");
    auto seconds = secondsEach(test::readFile(path), protocol, report.quick() ? 2000 : 200000);
    const auto p99 = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() * 99 / 100);
    std::nth_element(seconds.begin(), p99, seconds.end());
    report.add(
        valueAtMost(0.05, {.id = "host.decode_" + name,
                           .what = "Decoding a datagram, " + std::string(nameOf(protocol)->label) + ", p99",
                           .value = *p99 * 1e3,
                           .unit = "ms"}));
  }
  return report.finish();
}
