#include <algorithm>
#include <cmath>
#include <numbers>

#include "packet_writer.h"
#include "symbol_packets.h"
#include "trimtab/host/encoder.h"

namespace trimtab {
namespace {

constexpr std::size_t kMostPoints = 29, kMostArcs = 9, kMostText = 235;

void putSurface(PacketWriter& w, const HostSurface& s) {
  constexpr unsigned kToView = 2;
  w.begin(cigi3::kSurfaceDefinition, cigi3::kSurfaceDefinitionSize);
  w.put(2, s.id);
  w.put(4, bits(kToView));
  std::size_t at = 8;
  for (const float edge : {s.left, s.right, s.top, s.bottom}) w.put(std::exchange(at, at + 4), edge);
  at = 40;
  for (const float edge : {s.minU, s.maxU, s.minV, s.maxV}) w.put(std::exchange(at, at + 4), edge);
}

void putText(PacketWriter& w, std::uint16_t id, const HostShape& shape) {
  const std::size_t length = std::min(shape.text.size(), kMostText);
  const std::size_t size = (cigi3::kTextHeaderSize + length + 1 + 7) / 8 * 8;
  w.begin(cigi3::kTextDefinition, size);
  w.put(2, id);
  w.put(4, bits((static_cast<unsigned>(shape.orientation) << 4U) | shape.alignment));
  w.put(8, shape.fontSize);
  for (std::size_t i = 0; i < length; ++i)
    w.put(cigi3::kTextHeaderSize + i, static_cast<std::uint8_t>(shape.text[i]));
}

/// Writes what circles and lines have in common.
void beginShape(PacketWriter& w, std::uint8_t packet, std::size_t size, std::uint16_t id, float lineWidth) {
  constexpr std::uint16_t kSolid = 0xffff;
  w.begin(packet, size);
  w.put(2, id);
  w.put(6, kSolid);
  w.put(8, lineWidth);
}

void putCircles(PacketWriter& w, std::uint16_t id, const HostShape& shape) {
  const std::size_t count = std::min(shape.arcs.size(), kMostArcs);
  beginShape(w, cigi3::kCircleDefinition, cigi3::kShapeHeaderSize + count * cigi3::kArcSize, id,
             shape.lineWidth);
  w.put(4, bits(shape.filled ? 1 : 0));
  std::size_t at = cigi3::kShapeHeaderSize;
  for (std::size_t i = 0; i < count; ++i) {
    const HostArc& a = shape.arcs[i];
    for (const float value : {a.u, a.v, a.radius, a.innerRadius, a.startDeg, a.endDeg})
      w.put(std::exchange(at, at + 4), value);
  }
}

void putLines(PacketWriter& w, std::uint16_t id, const HostShape& shape) {
  const std::size_t count = std::min(shape.points.size(), kMostPoints);
  beginShape(w, cigi3::kLineDefinition, cigi3::kShapeHeaderSize + count * cigi3::kPointSize, id,
             shape.lineWidth);
  w.put(4, bits(static_cast<unsigned>(shape.primitive)));
  for (std::size_t i = 0; i < count; ++i) {
    w.put(cigi3::kShapeHeaderSize + i * cigi3::kPointSize, shape.points[i].u);
    w.put(cigi3::kShapeHeaderSize + i * cigi3::kPointSize + 4, shape.points[i].v);
  }
}

void putControl(PacketWriter& w, const HostSymbol& s) {
  w.begin(cigi3::kSymbolControl, cigi3::kSymbolControlSize);
  w.put(2, s.id);
  w.put(4, bits((s.visible ? 1U : 0U) | (s.attached ? 4U : 0U) | (s.inheritsColour ? 16U : 0U)));
  w.put(6, s.parent);
  w.put(8, s.surface);
  w.put(10, s.layer);
  w.put(11, s.dutyPercent);
  w.put(12, s.flashPeriodS);
  w.put(16, s.u);
  w.put(20, s.v);
  w.put(24, s.rotationDeg);
  for (std::size_t i = 0; i < 4; ++i) w.put(28 + i, s.rgba[i]);
  w.put(32, s.scaleU);
  w.put(36, s.scaleV);
}

HostSymbol symbolOf(std::uint16_t id, HostShape shape, std::array<std::uint8_t, 4> rgba) {
  HostSymbol s;
  s.id = id;
  s.surface = 1;
  s.visible = true;
  s.rgba = rgba;
  s.shape = std::make_shared<const HostShape>(std::move(shape));
  return s;
}

HostShape lines(HostPrimitive primitive, std::vector<HostPoint> points) {
  HostShape shape;
  shape.primitive = primitive;
  shape.points = std::move(points);
  shape.lineWidth = 0.01F;
  return shape;
}

HostShape text(std::string words, float size) {
  HostShape shape;
  shape.kind = HostShapeKind::text;
  shape.alignment = 4;
  shape.fontSize = size;
  shape.text = std::move(words);
  return shape;
}

HostSymbol at(HostSymbol symbol, float u, float v) {
  symbol.u = u;
  symbol.v = v;
  return symbol;
}

HostSymbol attachedTo(std::uint16_t parent, HostSymbol symbol) {
  symbol.attached = symbol.inheritsColour = true;
  symbol.parent = parent;
  return symbol;
}

}  // namespace

std::vector<std::byte> encodeCigiSymbols(const HostSymbols& symbols, ByteOrder order) {
  PacketWriter w(order);
  for (const HostSurface& surface : symbols.surfaces) putSurface(w, surface);
  for (const HostSymbol& s : symbols.symbols) {
    if (s.shape->kind == HostShapeKind::text) putText(w, s.id, *s.shape);
    if (s.shape->kind == HostShapeKind::circles) putCircles(w, s.id, *s.shape);
    if (s.shape->kind == HostShapeKind::lines) putLines(w, s.id, *s.shape);
  }
  // All symbols are defined by now, so that every parent exists, whatever its id.
  for (const HostSymbol& s : symbols.symbols) putControl(w, s);
  return w.take();
}

HostSymbols exampleSymbols(double timeS) {
  constexpr std::array<std::uint8_t, 4> kGreen{64, 255, 96, 255}, kRed{255, 56, 48, 255},
      kAmber{255, 176, 32, 255}, kCyan{64, 240, 255, 255}, kShade{0, 32, 0, 120};
  HostSymbols all;
  // A square in the lower left corner of a 16 by 9 image, and the whole image.
  all.surfaces = {{1, 0.02F, 0.2825F, 0.03F, 0.4967F, -1.1F, 1.1F, -1.1F, 1.1F},
                  {2, 0, 1, 0, 1, -16, 16, -9, 9}};
  HostShape disc, rings;
  disc.kind = rings.kind = HostShapeKind::circles;
  disc.filled = true;
  disc.arcs = {{0, 0, 1, 0, 0, 360}};
  rings.arcs = {{0, 0, 1, 0, 0, 360}, {0, 0, 0.5F, 0, 0, 360}};
  rings.lineWidth = 0.01F;
  const HostShape contact =
      lines(HostPrimitive::line_loop, {{-0.06F, 0}, {0, 0.06F}, {0.06F, 0}, {0, -0.06F}});
  all.symbols = {
      symbolOf(10, disc, kShade),
      symbolOf(11, rings, kGreen),
      symbolOf(12, lines(HostPrimitive::lines, {{0, 0}, {0, 1}}), kGreen),
      at(symbolOf(13, contact, kRed), 0.35F, 0.55F),
      attachedTo(13, at(symbolOf(14, text("H1", 0.16F), kRed), 0, 0.16F)),
      at(symbolOf(15, contact, kAmber), -0.5F, 0.2F),
      attachedTo(15, at(symbolOf(16, text("A2", 0.16F), kAmber), 0, 0.16F)),
      at(symbolOf(20, lines(HostPrimitive::triangles, {{-0.5F, -0.4F}, {0.5F, -0.4F}, {0, 0.5F}}), kCyan), 4,
         -1),
      attachedTo(20, at(symbolOf(21, text("WPT 7", 0.9F), kCyan), 0, -1)),
      at(symbolOf(22, text("SHOOT", 1.2F), kRed), 0, 4)};
  for (HostSymbol& s : all.symbols)
    if (s.id >= 20) s.surface = 2;
  for (HostSymbol& s : all.symbols)
    if (s.id == 12) s.rotationDeg = static_cast<float>(-std::fmod(std::max(timeS, 0.0) * 72, 360.0));
  HostSymbol& cue = all.symbols.back();
  cue.dutyPercent = 60;
  cue.flashPeriodS = 1;
  return all;
}

}  // namespace trimtab
