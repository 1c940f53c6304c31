#include <cmath>
#include <functional>
#include <limits>

#include "core/host/symbol_packets.h"
#include "host_support.h"
#include "tests/support.h"

namespace trimtab::test {
namespace {

using Bytes = std::vector<std::byte>;
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN(),
                kInfinityF = std::numeric_limits<float>::infinity();

/// The message of a state, followed by packets.
Bytes message(std::uint32_t frame, const Bytes& packets, ByteOrder order = ByteOrder::big) {
  Bytes bytes = encodeCigiHost(aState(), frame, 0, order);
  bytes.insert(bytes.end(), packets.begin(), packets.end());
  return bytes;
}
template <class T>
Bytes with(Bytes bytes, std::size_t offset, T value, ByteOrder order = ByteOrder::big) {
  wire::put<T>(bytes, offset, order, value);
  return bytes;
}
Bytes joined(std::initializer_list<Bytes> all) {
  Bytes bytes;
  for (const Bytes& b : all) bytes.insert(bytes.end(), b.begin(), b.end());
  return bytes;
}

HostSymbol symbol(std::uint16_t id, HostShape shape = {}) {
  HostSymbol s;
  s.id = id;
  s.shape = std::make_shared<const HostShape>(std::move(shape));
  return s;
}
/// The packets of one symbol: its definition, then its control.
Bytes packetsOf(const HostSymbol& s) {
  return encodeCigiSymbols({{}, {s}});
}
constexpr std::size_t kEmptyLines = cigi3::kShapeHeaderSize;

HostSymbols aSet() {
  HostSymbols all = exampleSymbols(0.7);
  all.symbols[3].layer = 7;
  all.symbols[3].scaleU = -2.5F;
  all.symbols[4].inheritsColour = false;
  return all;
}

class Symbols : public testing::TestWithParam<ByteOrder> {};
INSTANTIATE_TEST_SUITE_P(EitherOrder, Symbols, testing::Values(ByteOrder::big, ByteOrder::little));

TEST_P(Symbols, comeBackAsTheyWereSent) {
  HostDecoder decoder;
  EXPECT_EQ(decoder.symbols(), nullptr);
  const HostSymbols sent = aSet();
  EXPECT_TRUE(feed(decoder, message(1, encodeCigiSymbols(sent, GetParam()), GetParam()), 1));
  ASSERT_NE(decoder.symbols(), nullptr);
  EXPECT_EQ(*decoder.symbols(), sent);
  EXPECT_EQ(decoder.statistics().symbolPackets, 2 * sent.symbols.size() + sent.surfaces.size());
  EXPECT_EQ(decoder.statistics().refusedPackets, 0U) << decoder.statistics().firstRefusedReason;
}

TEST(SymbolStore, staysTheSameOneUntilSomethingChanges) {
  HostDecoder decoder;
  feed(decoder, message(1, encodeCigiSymbols(exampleSymbols(1))), 1);
  const auto first = decoder.symbols();
  feed(decoder, message(2, {}), 1.01);
  EXPECT_EQ(decoder.symbols(), first) << "symbols last";
  feed(decoder, message(3, encodeCigiSymbols(exampleSymbols(1))), 1.02);
  EXPECT_EQ(decoder.symbols(), first) << "all defined again, and equal";
  feed(decoder, message(4, encodeCigiSymbols(exampleSymbols(2))), 1.03);
  EXPECT_NE(decoder.symbols(), first);
  EXPECT_EQ(*first, exampleSymbols(1)) << "what somebody holds does not change";
  EXPECT_EQ(*decoder.symbols(), exampleSymbols(2));
}

TEST(SymbolStore, isEmptyAfterTheHostStartsAnew) {
  HostDecoder decoder;
  for (std::uint32_t i = 0; i < 10; ++i) feed(decoder, message(1000 + i, packetsOf(symbol(1))), 1 + i * 0.01);
  ASSERT_NE(decoder.symbols(), nullptr);
  HostDecoder other = std::move(decoder);
  decoder = HostDecoder();
  for (std::uint32_t i = 0; i < 10; ++i) feed(decoder, message(1000 + i, packetsOf(symbol(1))), 1 + i * 0.01);
  feed(decoder, message(1, {}), 20);
  EXPECT_EQ(decoder.statistics().restarts, 1U);
  EXPECT_EQ(decoder.symbols(), nullptr);
  feed(other, message(1, {}), 1.2, "127.0.0.1:9");
  EXPECT_EQ(other.symbols(), nullptr) << "at another port";
}

TEST(SymbolStore, followsShortControls) {
  HostDecoder decoder;
  feed(decoder, message(1, joined({packetsOf(symbol(3)), packetsOf(symbol(9))})), 1);
  std::uint32_t frame = 1;
  const auto control = [&](unsigned state, unsigned one, std::uint32_t value1, unsigned two,
                           std::uint32_t value2) {
    Bytes p(cigi3::kShortSymbolControlSize);
    p[0] = std::byte{cigi3::kShortSymbolControl};
    p[1] = static_cast<std::byte>(p.size());
    p = with(with(with(p, 2, std::uint16_t{9}), 8, value1), 12, value2);
    p[4] = static_cast<std::byte>(state);
    p[6] = static_cast<std::byte>(one);
    p[7] = static_cast<std::byte>(two);
    ++frame;
    feed(decoder, message(frame, p), 1 + frame * 0.01);
    return decoder.symbols()->symbol(9);
  };
  const auto real = [](float value) { return std::bit_cast<std::uint32_t>(value); };
  EXPECT_TRUE(control(1, 0, 0, 0, 0)->visible);
  EXPECT_EQ(control(1, 1, 77, 3, 250)->surface, 77);
  EXPECT_EQ(decoder.symbols()->symbol(9)->layer, 250);
  EXPECT_EQ(control(1, 4, 30, 5, real(1.5F))->dutyPercent, 30);
  EXPECT_EQ(decoder.symbols()->symbol(9)->flashPeriodS, 1.5F);
  EXPECT_EQ(control(1, 6, real(-3), 7, real(4))->u, -3);
  EXPECT_EQ(decoder.symbols()->symbol(9)->v, 4);
  EXPECT_EQ(control(1, 8, real(30), 9, 0x01020304)->rotationDeg, 30);
  EXPECT_EQ(decoder.symbols()->symbol(9)->rgba, (std::array<std::uint8_t, 4>{1, 2, 3, 4}));
  EXPECT_EQ(control(1, 10, real(2), 11, real(0.5F))->scaleU, 2);
  EXPECT_EQ(decoder.symbols()->symbol(9)->scaleV, 0.5F);
  EXPECT_TRUE(control(5, 2, 3, 0, 0)->attached);
  EXPECT_EQ(decoder.symbols()->symbol(9)->parent, 3);
  EXPECT_FALSE(control(0, 0, 0, 0, 0)->visible);
  EXPECT_EQ(control(2, 0, 0, 0, 0), nullptr) << "destroyed";
  EXPECT_EQ(decoder.statistics().refusedPackets, 0U) << decoder.statistics().firstRefusedReason;
}

TEST(SymbolStore, destroysChildrenWithTheirParentAndSymbolsWithTheirSurface) {
  HostSymbols all;
  all.surfaces = {{1}, {2}};
  for (std::uint16_t id = 1; id <= 5; ++id) all.symbols.push_back(symbol(id));
  for (const std::size_t child : {1U, 2U}) {  // 3 hangs on 2, and 2 on 1
    all.symbols[child].attached = true;
    all.symbols[child].parent = static_cast<std::uint16_t>(child);
  }
  all.symbols[3].surface = 2;
  HostDecoder decoder;
  feed(decoder, message(1, encodeCigiSymbols(all)), 1);
  ASSERT_EQ(*decoder.symbols(), all);
  Bytes destroyed = encodeCigiSymbols({{all.surfaces[1]}, {}});
  destroyed[4] |= std::byte{1};
  feed(decoder, message(2, destroyed), 1.01);
  EXPECT_EQ(decoder.symbols()->symbol(4), nullptr);
  EXPECT_EQ(decoder.symbols()->surface(2), nullptr);
  EXPECT_EQ(decoder.symbols()->symbols.size(), 4U);
  HostSymbol again = symbol(1);
  again.u = 1;
  feed(decoder, message(3, packetsOf(again)), 1.02);
  ASSERT_EQ(decoder.symbols()->symbols.size(), 2U)
      << "a definition takes a symbol's and its children's place";
  EXPECT_EQ(decoder.symbols()->symbols[0], again);
}

TEST(SymbolStore, clonesTheShapeAlone) {
  HostShape shape;
  shape.points = {{1, 2}, {3, 4}};
  HostSymbol source = symbol(7, shape);
  source.visible = true;
  source.u = 5;
  Bytes clone(cigi3::kSymbolCloneSize);
  clone[0] = std::byte{cigi3::kSymbolClone};
  clone[1] = static_cast<std::byte>(clone.size());
  clone = with(with(clone, 2, std::uint16_t{8}), 6, std::uint16_t{7});
  HostDecoder decoder;
  feed(decoder, message(1, joined({packetsOf(source), clone})), 1);
  ASSERT_NE(decoder.symbols()->symbol(8), nullptr);
  EXPECT_EQ(*decoder.symbols()->symbol(8), symbol(8, shape));
}

struct Hostile {
  const char* name;
  std::function<Bytes()> make;
  const char* reason;
};

/// What follows IG Control (24 bytes) and Entity Control (48) begins at byte 72.
const std::vector<Hostile>& hostile() {
  const auto surface = [] { return encodeCigiSymbols({{{5}}, {}}); };
  const auto lines = [] {
    HostShape shape;
    shape.points = {{1, 2}, {3, 4}};
    return packetsOf(symbol(6, shape));
  };
  const auto circles = [] {
    HostShape shape;
    shape.kind = HostShapeKind::circles;
    shape.arcs = {{0, 0, 1, 0, 0, 90}};
    return packetsOf(symbol(6, shape));
  };
  const auto text = [] {
    HostShape shape;
    shape.kind = HostShapeKind::text;
    shape.text = "ABC";
    return packetsOf(symbol(6, shape));
  };
  const auto control = [] {
    const Bytes all = packetsOf(symbol(6));
    return Bytes(all.begin() + kEmptyLines, all.end());
  };
  static const std::vector<Hostile> table{
      {"surface cut",
       [=] {
         Bytes bytes = surface();
         bytes.resize(48);
         return with(bytes, 1, std::uint8_t{48});
       },
       "byte 73: size of a symbol packet: expected 56, found 48"},
      {"surface of an entity", [=] { return with(surface(), 4, std::uint8_t{0}); },
       "byte 76: attach type of a symbol surface: expected a view"},
      {"billboard of an entity", [=] { return with(surface(), 4, std::uint8_t{4}); }, "byte 76: attach type"},
      {"surface inside out", [=] { return with(surface(), 8, 2.0F); }, "byte 80: symbol surface"},
      {"surface no number", [=] { return with(surface(), 12, kNanF); }, "byte 84: right"},
      {"no coordinates", [=] { return with(surface(), 44, 0.0F); }, "byte 112: symbol surface"},
      {"coordinates beyond all", [=] { return with(surface(), 44, 3e38F); }, "byte 116: max u"},
      {"half a point", [=] { return with(lines(), 1, std::uint8_t{24 + 8 * 5 + 4}); }, nullptr},
      {"primitive", [=] { return with(lines(), 4, std::uint8_t{7}); },
       "byte 76: primitive type: expected 0..6, found 7"},
      {"line width", [=] { return with(lines(), 8, -1.0F); }, "byte 80: line width"},
      {"point no number", [=] { return with(lines(), 16, kNanF); }, "byte 88: vertex u"},
      {"point infinite", [=] { return with(lines(), 28, kInfinityF); }, "byte 100: vertex v"},
      {"half a circle", [=] { return with(circles(), 1, std::uint8_t{32}); },
       "byte 73: size of a symbol packet: expected 16 and a multiple of 24, found 32"},
      {"radius", [=] { return with(circles(), 24, 1e30F); }, "byte 96: radius"},
      {"radius below 0", [=] { return with(circles(), 24, -1.0F); }, "byte 96: radius"},
      {"angle", [=] { return with(circles(), 32, kInfinityF); }, "byte 104: start angle"},
      {"text without end", [=] { return with(text(), 15, std::uint8_t{'D'}); },
       "byte 87: text: expected a zero byte at its end"},
      {"text of no length", [=] { return with(text(), 1, std::uint8_t{8}); },
       "byte 73: size of a symbol packet: expected more than 12"},
      {"alignment", [=] { return with(text(), 4, std::uint8_t{9}); }, "byte 76: alignment"},
      {"font size", [=] { return with(text(), 8, kNanF); }, "byte 80: font size"},
      {"symbol not defined", control, "byte 74: symbol: expected one that is defined, found 6"},
      {"clone of nothing",
       [] { return Bytes{std::byte{33}, std::byte{8}, {}, std::byte{1}, {}, {}, {}, std::byte{2}}; },
       "byte 78: source of a clone"},
      {"template", [] { return Bytes{std::byte{33}, std::byte{8}, {}, {}, std::byte{1}, {}, {}, {}}; },
       "byte 76: source type"},
  };
  return table;
}

TEST(HostileSymbols, areCountedWithPlaceAndReasonAndCostTheirMessageNothing) {
  for (const Hostile& h : hostile()) {
    SCOPED_TRACE(h.name);
    HostDecoder decoder;
    const auto state = feed(decoder, message(1, h.make()), 1);
    const HostStatistics& s = decoder.statistics();
    if (!h.reason) {  // not a packet any more: the message is cut there
      EXPECT_EQ(s.truncated, 1U);
      continue;
    }
    EXPECT_TRUE(state) << "the aircraft flies on";
    EXPECT_EQ(s.bad, 0U) << s.firstBadReason;
    EXPECT_GE(s.refusedPackets, 1U);
    EXPECT_EQ(s.firstRefusedReason.rfind(h.reason, 0), 0U) << s.firstRefusedReason;
    if (decoder.symbols()) {
      EXPECT_TRUE(decoder.symbols()->symbols.empty() && decoder.symbols()->surfaces.empty());
    }
  }
}

TEST(HostileSymbols, controlsWithNumbersThatNobodyMeansChangeNothing) {
  HostDecoder decoder;
  feed(decoder, message(1, packetsOf(symbol(6))), 1);
  const auto before = decoder.symbols();
  std::uint32_t frame = 1;
  for (const std::size_t offset : {12, 16, 20, 24, 32, 36})
    for (const float value : {kNanF, kInfinityF, -kInfinityF, 1e30F}) {
      Bytes control = packetsOf(symbol(6));
      control.erase(control.begin(), control.begin() + kEmptyLines);
      ++frame;
      feed(decoder, message(frame, with(control, offset, value)), 1 + frame * 0.01);
      EXPECT_EQ(decoder.symbols(), before) << offset << ' ' << value;
      EXPECT_EQ(decoder.statistics().refusedPackets, frame - 1);
    }
}

TEST(HostileSymbols, neverAttachInACircle) {
  HostDecoder decoder;
  const auto attach = [](std::uint16_t id, std::uint16_t parent) {
    HostSymbol s = symbol(id);
    s.attached = true;
    s.parent = parent;
    const Bytes all = packetsOf(s);
    return Bytes(all.begin() + kEmptyLines, all.end());
  };
  feed(decoder,
       message(1, joined({packetsOf(symbol(1)), packetsOf(symbol(2)), packetsOf(symbol(3)), attach(1, 1),
                          attach(1, 2), attach(2, 3), attach(3, 1), attach(3, 9)})),
       1);
  EXPECT_EQ(decoder.statistics().refusedPackets, 3U) << "itself, its own descendant, and nothing";
  EXPECT_FALSE(decoder.symbols()->symbol(3)->attached);
  EXPECT_TRUE(decoder.symbols()->symbol(2)->attached);
}

TEST(HostileSymbols, areNoMoreThanTheStoreHolds) {
  HostDecoder decoder;
  for (std::uint32_t frame = 1; frame <= 30; ++frame) {
    HostSymbols many;
    for (std::uint32_t i = 0; i < 100; ++i)
      many.symbols.push_back(symbol(static_cast<std::uint16_t>(frame * 100 + i)));
    for (std::uint32_t i = 0; i < 10; ++i)
      many.surfaces.push_back({static_cast<std::uint16_t>(frame * 10 + i)});
    EXPECT_TRUE(feed(decoder, message(frame, encodeCigiSymbols(many)), 1 + frame * 0.01));
  }
  EXPECT_EQ(decoder.symbols()->symbols.size(), HostSymbols::kMostSymbols);
  EXPECT_EQ(decoder.symbols()->surfaces.size(), HostSymbols::kMostSurfaces);
  EXPECT_EQ(decoder.statistics().refusedPackets,
            2 * (3000 - HostSymbols::kMostSymbols) + 300 - HostSymbols::kMostSurfaces);
}

TEST(DarkSymbols, areThoseInTheDarkPartOfTheirFlash) {
  HostSymbols all;
  all.symbols = {symbol(1), symbol(2), symbol(3), symbol(4)};
  for (HostSymbol& s : all.symbols) s.visible = s.id != 4;
  all.symbols[1].dutyPercent = 25;
  all.symbols[1].flashPeriodS = 2;
  all.symbols[2].dutyPercent = 0;
  all.symbols[3].dutyPercent = 0;
  using Ids = std::vector<std::uint16_t>;
  EXPECT_EQ(darkSymbols(all, 10.49), Ids{3});
  EXPECT_EQ(darkSymbols(all, 10.51), (Ids{2, 3}));
  EXPECT_EQ(darkSymbols(all, 12), Ids{3});
  EXPECT_EQ(darkSymbols(all, kNanF), Ids{3});
}

}  // namespace
}  // namespace trimtab::test
