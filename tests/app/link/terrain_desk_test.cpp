#include <gmock/gmock.h>

#include <map>

#include "app/link/terrain_desk.h"
#include "link_support.h"
#include "udp_socket.h"

/// A host asks a real receiver about the terrain and waits for the answers, as it would an image generator.
namespace trimtab::test {
namespace {

class Hill : public GroundHeights {
 public:
  explicit Hill(double heightM) : height_(heightM) {}
  std::optional<Metres> heightAt(Degrees, Degrees) const override { return Metres{height_}; }
  std::optional<Metres> highest() const override { return Metres{height_}; }

 private:
  double height_;
};

std::vector<std::byte> heightRequest(std::uint16_t number, std::uint8_t everyFrame, ByteOrder order) {
  std::vector<std::byte> bytes(32);
  wire::put(bytes, 0, order, std::uint8_t{24});
  wire::put(bytes, 1, order, std::uint8_t{32});
  wire::put(bytes, 2, order, number);
  wire::put(bytes, 4, order, std::uint8_t{1});
  wire::put(bytes, 5, order, everyFrame);
  wire::put(bytes, 8, order, 40.0);
  wire::put(bytes, 16, order, 9.0);
  return bytes;
}

/// Nobody takes the answers: what cannot wait is dropped and counted, so that memory has a bound.
TEST(TerrainDesk, holdsNoMoreThanItMay) {
  link::TerrainDesk desk;
  constexpr std::size_t kAsked = 10000;
  desk.ask(std::vector<TerrainQuery>(kAsked), true);
  EXPECT_EQ(desk.questions().asked, kAsked);
  EXPECT_GT(desk.questions().dropped, kAsked / 2);
}

class TerrainDeskTest : public testing::TestWithParam<ByteOrder> {
 protected:
  TerrainDeskTest() {
    link::ReceiverOptions options;
    options.reply = link::Endpoint{"127.0.0.1", host_.port()};
    options.replyRateHz = 200;
    receiver_ = opened(options);
    receiver_->setGround(std::make_shared<Hill>(432.5));
  }
  void ask(std::initializer_list<std::vector<std::byte>> requests) {
    AircraftState state;
    state.time = 0.02 * ++frame_;
    auto bytes = encodeCigiHost(state, frame_, 0, GetParam());
    for (const auto& request : requests) bytes.insert(bytes.end(), request.begin(), request.end());
    host_.send(receiver_->port(), bytes);
  }
  /// Collects what the next so many messages answer: heights by the number of their question, and how often.
  void listen(int messages) {
    for (int i = 0; i < messages; ++i) {
      const auto bytes = host_.receive(2000);
      ASSERT_GE(bytes.size(), 24U);
      ASSERT_EQ(std::to_integer<int>(bytes[0]), 101) << "each begins with Start of Frame";
      ASSERT_LE(bytes.size(), 1472U);
      for (std::size_t at = 24; at < bytes.size(); at += 16) {
        ASSERT_EQ(std::to_integer<int>(bytes[at]), 102);
        const auto number = wire::get<std::uint16_t>(bytes, at + 2, GetParam());
        heights_[number] = wire::get<double>(bytes, at + 8, GetParam());
        valid_[number] = (std::to_integer<int>(bytes[at + 4]) & 1) != 0;
        ++times_[number];
      }
    }
  }

  UdpSocket host_;
  std::unique_ptr<link::Receiver> receiver_;
  std::uint32_t frame_ = 0;
  std::map<int, double> heights_;
  std::map<int, bool> valid_;
  std::map<int, int> times_;
};
INSTANTIATE_TEST_SUITE_P(EitherOrder, TerrainDeskTest, testing::Values(ByteOrder::big, ByteOrder::little));

TEST_P(TerrainDeskTest, answersWithTheNextStartsOfFrame) {
  ask({heightRequest(3, 0, GetParam()), heightRequest(4, 0, GetParam())});
  listen(20);
  EXPECT_EQ(times_, (std::map<int, int>{{3, 1}, {4, 1}}));
  EXPECT_EQ(heights_[3], 432.5);
  EXPECT_TRUE(valid_[3]);
  // Another terrain answers from then on, and none says so.
  receiver_->setGround(std::make_shared<Hill>(-12));
  ask({heightRequest(3, 0, GetParam())});
  listen(20);
  EXPECT_EQ(heights_[3], -12);
  receiver_->setGround(nullptr);
  ask({heightRequest(3, 0, GetParam())});
  listen(20);
  EXPECT_FALSE(valid_[3]);
  const link::Questions q = receiver_->questions();
  EXPECT_EQ(q.asked, 4U);
  EXPECT_EQ(q.answered, 4U);
  EXPECT_FALSE(q.nowhereToAnswer);
}

TEST_P(TerrainDeskTest, answersAgainEverySoManyFramesUntilItIsAskedNot) {
  ask({heightRequest(8, 5, GetParam())});
  listen(60);
  EXPECT_GE(times_[8], 8);
  EXPECT_LE(times_[8], 13);
  ask({heightRequest(8, 0, GetParam())});
  listen(10);
  times_.clear();
  listen(30);
  EXPECT_TRUE(times_.empty());
}

TEST_P(TerrainDeskTest, splitsManyAnswersOverFrames) {
  for (int message = 0; message < 5; ++message) {
    std::vector<std::byte> many;
    for (std::uint16_t i = 0; i < 100; ++i) {
      const auto one = heightRequest(static_cast<std::uint16_t>(message * 100 + i), 0, GetParam());
      many.insert(many.end(), one.begin(), one.end());
    }
    ask({many});
  }
  listen(60);
  EXPECT_EQ(times_.size(), 500U);
  EXPECT_EQ(receiver_->questions().dropped, 0U);
}

TEST(Questions, thatNobodyCanAnswerAreCounted) {
  const auto receiver = opened();
  UdpSocket host;
  auto bytes = encodeCigiHost(AircraftState{}, 1, 0);
  const auto request = heightRequest(1, 0, ByteOrder::big);
  bytes.insert(bytes.end(), request.begin(), request.end());
  host.send(receiver->port(), bytes);
  gathered(*receiver, count(1));
  EXPECT_EQ(receiver->questions().asked, 1U);
  EXPECT_TRUE(receiver->questions().nowhereToAnswer);
}

}  // namespace
}  // namespace trimtab::test
