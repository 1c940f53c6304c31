#include <chrono>
#include <thread>

#include "app/link/link.h"
#include "tests/app/link/udp_socket.h"
#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/host/encoder.h"
#include "trimtab/session/session.h"

/// Symbols all the way from a host's datagrams to pixels.
namespace trimtab::test {
namespace {

class HostSymbolsPicture : public SceneTest {
 protected:
  void SetUp() override {
    SceneTest::SetUp();
    if (IsSkipped()) return;
    link::ReceiverOptions options;
    options.bindAddress = "127.0.0.1";
    auto opened = link::Receiver::open(options);
    ASSERT_TRUE(opened) << toString(opened.findings());
    receiver_ = std::move(opened).value();
  }

  static ValidatedParameters parameters(bool show) {
    TuningParameters p;
    p.symbology.enabled = true;
    p.host.extrapolate = false;
    for (SymbolElement* e :
         {&p.symbolPitchLadder, &p.symbolAircraftReference, &p.symbolFlightPath, &p.symbolLineOfSight,
          &p.symbolHeadingTape, &p.symbolAirspeed, &p.symbolAltitude})
      e->show = false;
    p.symbolHost.show = show;
    return *validate(p);
  }

  /// Sends one message over UDP and returns the image after it.
  std::vector<std::uint8_t> sent(const std::vector<std::byte>& packets) {
    AircraftState state;
    state.time = 0.1;
    state.position = {Degrees{36.6}, Degrees{128.3}, Metres{3000}};
    auto bytes = encodeCigiHost(state, ++frame_, 0);
    bytes.insert(bytes.end(), packets.begin(), packets.end());
    socket_.send(receiver_->port(), bytes);
    std::vector<ReceivedState> states;
    for (int i = 0; i < 2000 && states.empty(); ++i) {
      receiver_->take(states);
      if (states.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_EQ(states.size(), 1u);
    session_.receive(states);
    return drawn();
  }
  std::vector<std::uint8_t> drawn() {
    FrameRequest request = *session_.request(link::now(), kWidth, kHeight);
    request.levers.drawn.blurStrength = 0;
    return picture(request, &result_);
  }
  static std::array<int, 3> pixel(const std::vector<std::uint8_t>& p, int x, int y) {
    const std::size_t at = (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)) * 4;
    return {p[at], p[at + 1], p[at + 2]};
  }

  std::unique_ptr<link::Receiver> receiver_;
  UdpSocket socket_;
  Session session_{parameters(true)};
  FrameResult result_;
  std::uint32_t frame_ = 0;
};

TEST_F(HostSymbolsPicture, changesWithTheDatagramsThatDefineControlAndDestroyThem) {
  use(test::syntheticMountains());
  const auto plain = sent({});
  HostSymbols symbols;
  symbols.surfaces = {{7, 0, 1, 0, 1, 0, 640, 0, 360}};
  HostShape square;
  square.primitive = HostPrimitive::triangle_fan;
  square.points = {{-20, -20}, {20, -20}, {20, 20}, {-20, 20}};
  HostSymbol symbol;
  symbol.id = 40;
  symbol.surface = 7;
  symbol.u = 100;
  symbol.v = 60;
  symbol.rgba = {255, 0, 0, 255};
  symbol.shape = std::make_shared<const HostShape>(square);
  symbols.symbols = {symbol};

  EXPECT_EQ(sent(encodeCigiSymbols(symbols)), plain) << "a symbol is hidden until it is shown";
  symbols.symbols[0].visible = true;
  const auto shown = sent(encodeCigiSymbols(symbols));
  const std::array<int, 3> red{255, 0, 0};
  EXPECT_EQ(pixel(shown, 100, 60), red);
  EXPECT_EQ(pixel(shown, 119, 79), red);
  EXPECT_EQ(pixel(shown, 121, 60), pixel(plain, 121, 60));
  const std::uint64_t redraws = result_.counters.symbologyRedraws;
  EXPECT_EQ(sent({}), shown) << "symbols last";
  EXPECT_EQ(sent(encodeCigiSymbols(symbols)), shown);
  EXPECT_EQ(result_.counters.symbologyRedraws, redraws) << "and cost nothing as long as they are the same";

  symbols.symbols[0].u = 300;
  const auto moved = sent(encodeCigiSymbols(symbols));
  EXPECT_EQ(pixel(moved, 100, 60), pixel(plain, 100, 60));
  EXPECT_EQ(pixel(moved, 300, 60), red);
  EXPECT_EQ(result_.counters.symbologyRedraws, redraws + 1);

  session_.setParameters(parameters(false));
  EXPECT_EQ(drawn(), plain) << "the preset hides them";
  session_.setParameters(parameters(true));
  EXPECT_EQ(drawn(), moved);

  auto destroyed = encodeCigiSymbols({{symbols.surfaces[0]}, {}});
  destroyed[4] |= std::byte{1};
  EXPECT_EQ(sent(destroyed), plain);
  EXPECT_EQ(receiver_->statistics().refusedPackets, 0u) << receiver_->statistics().firstRefusedReason;
}

TEST_F(HostSymbolsPicture, flashWithTheHostsClock) {
  use(test::syntheticMountains());
  HostSymbols symbols = exampleSymbols(0);
  sent(encodeCigiSymbols(symbols));
  auto request = *session_.request(link::now(), kWidth, kHeight);
  EXPECT_TRUE(request.symbology->dark.empty()) << "0.1 s into the flash of the weapon cue";
  AircraftState later;
  later.time = 0.7;
  later.position = {Degrees{36.6}, Degrees{128.3}, Metres{3000}};
  socket_.send(receiver_->port(), encodeCigiHost(later, ++frame_, 0));
  std::vector<ReceivedState> states;
  for (int i = 0; i < 2000 && states.empty(); ++i) {
    receiver_->take(states);
    if (states.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  session_.receive(states);
  request = *session_.request(link::now(), kWidth, kHeight);
  EXPECT_EQ(request.symbology->dark, (std::vector<std::uint16_t>{22}));
  session_.fly(later);
  EXPECT_FALSE((*session_.request(link::now(), kWidth, kHeight)).symbology->host)
      << "a flight has no host whose symbols could be shown";
}

}  // namespace
}  // namespace trimtab::test
