#include "symbol_packets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace trimtab::cigi3 {
namespace {

template <class T>
auto placeOf(std::vector<T>& sorted, std::uint16_t id) {
  return std::lower_bound(sorted.begin(), sorted.end(), id,
                          [](const T& t, std::uint16_t i) { return t.id < i; });
}

/// Names what Short Symbol Control may set, by its CIGI numbers.
enum Attribute : std::uint8_t {
  kNone,
  kSurface,
  kParent,
  kLayer,
  kDuty,
  kPeriod,
  kPositionU,
  kPositionV,
  kRotation,
  kColour,
  kScaleU,
  kScaleV
};

constexpr double kMostTurn = 3600, kMostScale = 1e4, kLongestFlashS = 3600, kMostFraction = 100;
constexpr unsigned kHidden = 0, kVisible = 1, kDestroyed = 2;

}  // namespace

/// One packet; fault offsets count from the start of the datagram.
struct SymbolEdit::Packet {
  std::span<const std::byte> datagram;
  std::size_t start, size;
  ByteOrder order;
  FieldReader read;
  std::optional<PacketFault> problem;  ///< other than of a number

  Packet(std::span<const std::byte> all, std::size_t at, ByteOrder o)
      : datagram(all), start(at), size(std::to_integer<std::size_t>(all[at + 1])), order(o), read(all, o) {}

  unsigned u8(std::size_t offset) const { return std::to_integer<unsigned>(datagram[start + offset]); }
  bool bit(std::size_t offset, unsigned n) const { return ((u8(offset) >> n) & 1U) != 0; }
  std::uint16_t u16(std::size_t offset) const { return read.raw<std::uint16_t>(start + offset); }
  float number(std::size_t offset, const char* field, double lowest, double highest, const char* unit) {
    return static_cast<float>(read.number<float>(start + offset, field, lowest, highest, unit));
  }
  float place(std::size_t offset, const char* field) {
    return number(offset, field, -kFurthestUnit, kFurthestUnit, "units");
  }
  float extent(std::size_t offset, const char* field) {
    return number(offset, field, 0, kFurthestUnit, "units");
  }
  void refuse(std::size_t offset, const char* field, std::string expected, std::string found) {
    if (!problem) problem = PacketFault{start + offset, field, std::move(expected), std::move(found)};
  }
  std::optional<PacketFault> fault() const { return read.fault() ? read.fault() : problem; }
  bool good() const { return !fault(); }
  /// Refuses a packet of another size; with `step`, one whose size is not `expected` and whole steps.
  bool hasSize(std::size_t expected, std::size_t step = 0) {
    if (size == expected || (step > 0 && size > expected && (size - expected) % step == 0)) return true;
    const std::string more = step > 0 ? " and a multiple of " + std::to_string(step) : std::string();
    refuse(1, "size of a symbol packet", std::to_string(expected) + more, std::to_string(size));
    return false;
  }
};

HostSymbols& SymbolEdit::edit() {
  if (!edited_) {
    edited_ = now_ ? std::make_shared<HostSymbols>(*now_) : std::make_shared<HostSymbols>();
    now_ = edited_;
  }
  return *edited_;
}

/// Adds a symbol, or replaces the one with its id.
void SymbolEdit::put(const HostSymbol& symbol) {
  if (const HostSymbol* old = now_ ? now_->symbol(symbol.id) : nullptr; old && *old == symbol) return;
  std::vector<HostSymbol>& all = edit().symbols;
  const auto at = placeOf(all, symbol.id);
  if (at != all.end() && at->id == symbol.id)
    *at = symbol;
  else
    all.insert(at, symbol);
}

/// Destroys a symbol and all that is attached to it, directly or not.
void SymbolEdit::destroy(std::uint16_t id) {
  std::vector<HostSymbol>& all = edit().symbols;
  std::vector<std::uint16_t> doomed{id};
  for (std::size_t next = 0; next < doomed.size(); ++next) {
    const auto at = placeOf(all, doomed[next]);
    if (at == all.end() || at->id != doomed[next]) continue;
    all.erase(at);
    for (const HostSymbol& s : all)
      if (s.attached && s.parent == doomed[next]) doomed.push_back(s.id);
  }
}

void SymbolEdit::destroySurface(std::uint16_t id) {
  if (!now_ || !now_->surface(id)) return;
  edit().surfaces.erase(placeOf(edit().surfaces, id));
  std::vector<std::uint16_t> roots;
  for (const HostSymbol& s : now_->symbols)
    if (!s.attached && s.surface == id) roots.push_back(s.id);
  for (const std::uint16_t root : roots) destroy(root);
}

/// A definition takes the place of a symbol with its id, whose children it destroys (ICD 4.1.30 to 4.1.33).
void SymbolEdit::define(Packet& p, HostShape shape) {
  if (!p.good()) return;
  const std::uint16_t id = p.u16(2);
  const HostSymbol* old = now_ ? now_->symbol(id) : nullptr;
  if (!old && now_ && now_->symbols.size() >= HostSymbols::kMostSymbols)
    return p.refuse(2, "symbol", "at most " + std::to_string(HostSymbols::kMostSymbols) + " symbols",
                    "one more");
  HostSymbol symbol;
  symbol.id = id;
  symbol.shape =
      old && *old->shape == shape ? old->shape : std::make_shared<const HostShape>(std::move(shape));
  if (old) destroy(id);
  put(symbol);
}

void SymbolEdit::readSurface(Packet& p) {
  if (!p.hasSize(kSurfaceDefinitionSize)) return;
  HostSurface s;
  s.id = p.u16(2);
  if (p.bit(4, 0)) return destroySurface(s.id);
  if (!p.bit(4, 1)) return p.refuse(4, "attach type of a symbol surface", "a view", "an entity");
  s.left = p.number(8, "left", -kMostFraction, kMostFraction, "of the view");
  s.right = p.number(12, "right", -kMostFraction, kMostFraction, "of the view");
  s.top = p.number(16, "top", -kMostFraction, kMostFraction, "of the view");
  s.bottom = p.number(20, "bottom", -kMostFraction, kMostFraction, "of the view");
  s.minU = p.place(40, "min u");
  s.maxU = p.place(44, "max u");
  s.minV = p.place(48, "min v");
  s.maxV = p.place(52, "max v");
  if (!p.good()) return;
  if (!(s.left < s.right) || !(s.bottom < s.top))
    return p.refuse(8, "symbol surface", "left below right and bottom below top", "an empty surface");
  if (!(s.minU < s.maxU) || !(s.minV < s.maxV))
    return p.refuse(40, "symbol surface", "min u below max u and min v below max v", "no coordinates");
  const HostSurface* old = now_ ? now_->surface(s.id) : nullptr;
  if (old && *old == s) return;
  if (!old && now_ && now_->surfaces.size() >= HostSymbols::kMostSurfaces)
    return p.refuse(2, "symbol surface",
                    "at most " + std::to_string(HostSymbols::kMostSurfaces) + " surfaces", "one more");
  std::vector<HostSurface>& all = edit().surfaces;
  const auto at = placeOf(all, s.id);
  if (old)
    *at = s;
  else
    all.insert(at, s);
}

void SymbolEdit::readText(Packet& p) {
  if (p.size <= kTextHeaderSize)
    return p.refuse(1, "size of a symbol packet", "more than 12", std::to_string(p.size));
  HostShape shape;
  shape.kind = HostShapeKind::text;
  const unsigned alignment = p.u8(4) & 15U;
  if (alignment > 8) p.refuse(4, "alignment", "0..8", std::to_string(alignment));
  shape.alignment = static_cast<std::uint8_t>(alignment);
  shape.orientation = static_cast<std::uint8_t>((p.u8(4) >> 4U) & 3U);
  shape.fontSize = p.extent(8, "font size");
  std::size_t at = kTextHeaderSize;
  while (at < p.size && p.u8(at) != 0) shape.text += static_cast<char>(p.u8(at++));
  if (at == p.size) p.refuse(at - 1, "text", "a zero byte at its end", "none");
  define(p, std::move(shape));
}

void SymbolEdit::readCircles(Packet& p) {
  if (!p.hasSize(kShapeHeaderSize, kArcSize)) return;
  HostShape shape;
  shape.kind = HostShapeKind::circles;
  shape.filled = p.bit(4, 0);
  shape.lineWidth = p.extent(8, "line width");
  for (std::size_t at = kShapeHeaderSize; at < p.size; at += kArcSize) {
    HostArc arc;
    arc.u = p.place(at, "centre u");
    arc.v = p.place(at + 4, "centre v");
    arc.radius = p.extent(at + 8, "radius");
    arc.innerRadius = p.extent(at + 12, "inner radius");
    arc.startDeg = p.number(at + 16, "start angle", -kMostTurn, kMostTurn, "deg");
    arc.endDeg = p.number(at + 20, "end angle", -kMostTurn, kMostTurn, "deg");
    shape.arcs.push_back(arc);
  }
  define(p, std::move(shape));
}

void SymbolEdit::readLines(Packet& p) {
  if (!p.hasSize(kShapeHeaderSize, kPointSize)) return;
  HostShape shape;
  const unsigned primitive = p.u8(4) & 15U;
  constexpr auto kLast = static_cast<unsigned>(HostPrimitive::triangle_fan);
  if (primitive > kLast)
    return p.refuse(4, "primitive type", "0.." + std::to_string(kLast), std::to_string(primitive));
  shape.primitive = static_cast<HostPrimitive>(primitive);
  shape.lineWidth = p.extent(8, "line width");
  for (std::size_t at = kShapeHeaderSize; at < p.size; at += kPointSize) {
    const float u = p.place(at, "vertex u"), v = p.place(at + 4, "vertex v");
    shape.points.push_back({u, v});
  }
  define(p, std::move(shape));
}

void SymbolEdit::readClone(Packet& p) {
  if (!p.hasSize(kSymbolCloneSize)) return;
  if (p.bit(4, 0)) return p.refuse(4, "source type", "a symbol", "a template, of which there are none");
  const HostSymbol* source = now_ ? now_->symbol(p.u16(6)) : nullptr;
  if (!source) return p.refuse(6, "source of a clone", "a symbol that is defined", std::to_string(p.u16(6)));
  if (source->id != p.u16(2)) define(p, *source->shape);
}

void SymbolEdit::readControl(Packet& p) {
  if (!p.hasSize(kSymbolControlSize)) return;
  const HostSymbol* old = now_ ? now_->symbol(p.u16(2)) : nullptr;
  if (!old) return p.refuse(2, "symbol", "one that is defined", std::to_string(p.u16(2)));
  HostSymbol s = *old;
  if ((p.u8(4) & 3U) != kDestroyed) {
    s.parent = p.u16(6);
    s.surface = p.u16(8);
    s.layer = static_cast<std::uint8_t>(p.u8(10));
    s.dutyPercent = static_cast<std::uint8_t>(std::min(p.u8(11), 100U));
    s.flashPeriodS = p.number(12, "flash period", 0, kLongestFlashS, "s");
    s.u = p.place(16, "position u");
    s.v = p.place(20, "position v");
    s.rotationDeg = p.number(24, "rotation", -kMostTurn, kMostTurn, "deg");
    for (std::size_t i = 0; i < 4; ++i) s.rgba[i] = static_cast<std::uint8_t>(p.u8(28 + i));
    s.scaleU = p.number(32, "scale u", -kMostScale, kMostScale, "times");
    s.scaleV = p.number(36, "scale v", -kMostScale, kMostScale, "times");
  }
  control(p, std::move(s));
}

void SymbolEdit::readShortControl(Packet& p) {
  if (!p.hasSize(kShortSymbolControlSize)) return;
  const HostSymbol* old = now_ ? now_->symbol(p.u16(2)) : nullptr;
  if (!old) return p.refuse(2, "symbol", "one that is defined", std::to_string(p.u16(2)));
  HostSymbol s = *old;
  const bool destroyed = (p.u8(4) & 3U) == kDestroyed;
  for (std::size_t i = 0; i < 2 && !destroyed; ++i) {
    const std::size_t at = 8 + 4 * i;
    const auto whole = p.read.raw<std::uint32_t>(p.start + at);
    switch (p.u8(6 + i)) {
      case kNone:
        break;
      case kSurface:
        s.surface = static_cast<std::uint16_t>(whole);
        break;
      case kParent:
        s.parent = static_cast<std::uint16_t>(whole);
        break;
      case kLayer:
        s.layer = static_cast<std::uint8_t>(std::min(whole, 255U));
        break;
      case kDuty:
        s.dutyPercent = static_cast<std::uint8_t>(std::min(whole, 100U));
        break;
      case kPeriod:
        s.flashPeriodS = p.number(at, "flash period", 0, kLongestFlashS, "s");
        break;
      case kPositionU:
        s.u = p.place(at, "position u");
        break;
      case kPositionV:
        s.v = p.place(at, "position v");
        break;
      case kRotation:
        s.rotationDeg = p.number(at, "rotation", -kMostTurn, kMostTurn, "deg");
        break;
      case kColour:
        for (std::size_t c = 0; c < 4; ++c) s.rgba[c] = static_cast<std::uint8_t>(p.u8(at + c));
        break;
      case kScaleU:
        s.scaleU = p.number(at, "scale u", -kMostScale, kMostScale, "times");
        break;
      case kScaleV:
        s.scaleV = p.number(at, "scale v", -kMostScale, kMostScale, "times");
        break;
      default:
        return p.refuse(6 + i, "attribute select", "0..11", std::to_string(p.u8(6 + i)));
    }
  }
  control(p, std::move(s));
}

/// Applies what Symbol Control and Short Symbol Control have in common; `s` has the new attributes.
void SymbolEdit::control(Packet& p, HostSymbol s) {
  if (!p.good()) return;
  const unsigned state = p.u8(4) & 3U;
  if (state == kDestroyed) return destroy(s.id);
  if (state != kHidden && state != kVisible)
    return p.refuse(4, "symbol state", "0..2", std::to_string(state));
  s.visible = state == kVisible;
  s.attached = p.bit(4, 2);
  s.inheritsColour = p.bit(4, 4);
  if (s.attached) {
    if (!now_->symbol(s.parent))
      return p.refuse(6, "parent of a symbol", "a symbol that is defined", std::to_string(s.parent));
    if (closesCycle(s.id, s.parent))
      return p.refuse(6, "parent of a symbol", "none of its own descendants", std::to_string(s.parent));
  }
  put(s);
}

/// The walk ends, because no attachment so far closes a cycle.
bool SymbolEdit::closesCycle(std::uint16_t id, std::uint16_t parent) const {
  for (const HostSymbol* s = now_->symbol(parent); s; s = s->attached ? now_->symbol(s->parent) : nullptr)
    if (s->id == id) return true;
  return false;
}

std::optional<PacketFault> SymbolEdit::apply(std::span<const std::byte> datagram, std::size_t at,
                                             ByteOrder order) {
  using Reader = void (SymbolEdit::*)(Packet&);
  constexpr std::array<Reader, 7> kReaders{&SymbolEdit::readSurface,     &SymbolEdit::readText,
                                           &SymbolEdit::readCircles,     &SymbolEdit::readLines,
                                           &SymbolEdit::readClone,       &SymbolEdit::readControl,
                                           &SymbolEdit::readShortControl};
  Packet packet(datagram, at, order);
  (this->*kReaders[packet.u8(0) - kSurfaceDefinition])(packet);
  return packet.fault();
}

}  // namespace trimtab::cigi3
