#include "trimtab/scene/symbology_geometry.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "host_symbol_marks.h"
#include "symbology_canvas.h"

namespace trimtab::scene {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// Slower than this an aircraft flies nowhere: noise of positions would throw the marker about.
constexpr double kSlowestMps = 1;
constexpr double kText = 0.055, kSmallText = 0.042;  ///< heights, half images
/// Bars farther from the image's middle would lie under the tape: half images.
constexpr double kLadderReach = 0.62;
constexpr double kFurthest = 1e9;  ///< readouts beyond are not finite numbers that anyone means

/// Axes of a view or body in a world of east, north and up: right, up, backward.
Mat3 axesOf(const Attitude& attitude) {
  static const LocalFrame kWorld{GeodeticPosition{}};
  return eyeAxes(kWorld, GeodeticPosition{}, attitude);
}

bool isKnown(const Attitude& a) {
  return std::isfinite(a.heading.value()) && std::isfinite(a.pitch.value()) && std::isfinite(a.roll.value());
}

/// Returns three digits, 000 to 359.
std::string_view headingText(double degrees, std::array<char, 16>& buffer) {
  const int whole = (static_cast<int>(std::lround(degrees)) % 360 + 360) % 360;
  return {buffer.data(),
          static_cast<std::size_t>(std::snprintf(buffer.data(), buffer.size(), "%03d", whole))};
}

class Drawer {
 public:
  Drawer(const SymbologyRequest& request, const ViewShape& view, SymbologyDrawing& drawing)
      : state_(request.state),
        setup_(request.setup),
        canvas_(view, request.setup.general.lineWidth.value() + request.setup.general.outline.value() + 1,
                drawing),
        worldToView_(axesOf(request.state.view)),
        bodyToView_(worldToView_ * transposed(axesOf(request.state.aircraft))) {}

  void drawAll() {
    if (shown(Symbol::pitch_ladder)) pitchLadder();
    if (shown(Symbol::aircraft_reference)) aircraftReference();
    if (shown(Symbol::flight_path)) flightPath();
    if (shown(Symbol::line_of_sight)) lineOfSight();
    if (shown(Symbol::heading_tape)) headingTape();
    if (shown(Symbol::airspeed)) airspeed();
    if (shown(Symbol::altitude)) altitude();
  }

 private:
  const SymbolElement& element(Symbol symbol) const {
    return setup_.element[static_cast<std::size_t>(symbol)];
  }
  bool shown(Symbol symbol) const { return element(symbol).show; }
  bool onAircraft() const { return setup_.general.frame == SymbologyFrame::aircraft; }
  double size(Symbol symbol) const { return element(symbol).size.value(); }

  /// Returns a sheet around a direction of the world, upright in the image, unit as of the image's middle.
  Sheet around(Vec3 direction, double scale) const {
    const double unit = canvas_.tangentPerUnit() * scale;
    Vec3 right = cross(direction, Vec3{0, 1, 0});
    // A direction along the image's own upward axis is far outside.
    right = length(right) > 1e-9 ? normalized(right) : Vec3{1, 0, 0};
    return {direction, right * unit, cross(right, direction) * unit};
  }
  /// Returns a sheet in the image, or in the image as it is when the head looks straight ahead.
  Sheet placed(Symbol symbol) const {
    const SymbolElement& e = element(symbol);
    Sheet sheet = canvas_.picture(e.x.value(), e.y.value());
    sheet.right = sheet.right * e.size.value();
    sheet.up = sheet.up * e.size.value();
    if (!onAircraft()) return sheet;
    return {bodyToView_ * sheet.origin, bodyToView_ * sheet.right, bodyToView_ * sheet.up};
  }
  void beginMoved(Symbol symbol) {
    canvas_.begin(symbol, element(symbol).x.value(), element(symbol).y.value());
  }

  void pitchLadder();
  void ladderBar(double elevationDeg, const Vec3& ahead, const Vec3& right);
  void aircraftReference();
  void flightPath();
  void lineOfSight();
  void headingTape();
  void airspeed();
  void altitude();
  void readout(Symbol symbol, std::string_view digits, std::string_view label, double width);

  const SymbologyState& state_;
  const SymbologySetup& setup_;
  Canvas canvas_;
  Mat3 worldToView_, bodyToView_;
};

void Drawer::pitchLadder() {
  beginMoved(Symbol::pitch_ladder);
  const double heading = (onAircraft() ? state_.aircraft : state_.view).heading.in<Radians>();
  const Vec3 ahead{std::sin(heading), std::cos(heading), 0}, right{std::cos(heading), -std::sin(heading), 0};
  // The whole meridian, before and behind: over the top of a loop the heading turns round, the bars do not.
  for (int elevation = -85; elevation <= 85; elevation += 5) {
    ladderBar(elevation, ahead, right);
    ladderBar(elevation, -ahead, -right);
  }
  for (const double up : {1.0, -1.0}) {  // zenith and nadir, the nadir crossed out
    const double unit = canvas_.tangentPerUnit() * size(Symbol::pitch_ladder);
    const Sheet pole{worldToView_ * Vec3{0, 0, up}, worldToView_ * (right * unit),
                     worldToView_ * (ahead * unit)};
    canvas_.circle(pole, 0, 0, 0.06);
    if (up > 0) continue;
    canvas_.line(pole, -0.042, -0.042, 0.042, 0.042);
    canvas_.line(pole, -0.042, 0.042, 0.042, -0.042);
  }
}

/// Bars lie in planes through the eye, so they are straight, and the horizon's is exact from end to end.
void Drawer::ladderBar(double elevationDeg, const Vec3& ahead, const Vec3& right) {
  const double e = elevationDeg * kDegree, unit = canvas_.tangentPerUnit() * size(Symbol::pitch_ladder);
  const Vec3 up{0, 0, 1};
  const Sheet sheet{worldToView_ * (ahead * std::cos(e) + up * std::sin(e)), worldToView_ * (right * unit),
                    worldToView_ * ((up * std::cos(e) - ahead * std::sin(e)) * unit)};
  if (sheet.origin.z > 0.2) return;  // well behind the eye
  constexpr double kInner = 0.16, kOuter = 0.42, kHorizon = 0.85, kHook = 0.035;
  if (elevationDeg == 0) {
    for (const double side : {-1.0, 1.0}) canvas_.line(sheet, side * kInner, 0, side * kHorizon, 0);
    return;
  }
  if (!canvas_.isCentral(sheet.origin, kLadderReach)) return;
  const double toHorizon = elevationDeg > 0 ? -kHook : kHook;
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%d", static_cast<int>(std::abs(elevationDeg)));
  for (const double side : {-1.0, 1.0}) {
    if (elevationDeg > 0) {
      canvas_.line(sheet, side * kInner, 0, side * kOuter, 0);
    } else {
      constexpr int kDashes = 4;
      constexpr double kStep = (kOuter - kInner) / kDashes;
      for (int i = 0; i < kDashes; ++i)
        canvas_.line(sheet, side * (kInner + (i + 0.4) * kStep), 0, side * (kInner + (i + 1) * kStep), 0);
    }
    canvas_.line(sheet, side * kOuter, 0, side * kOuter, toHorizon);
    canvas_.text(sheet, side * (kOuter + 0.075), toHorizon * 0.5, kSmallText, text.data());
  }
}

/// Draws a W between two wings, where the nose points.
void Drawer::aircraftReference() {
  beginMoved(Symbol::aircraft_reference);
  const double unit = canvas_.tangentPerUnit() * size(Symbol::aircraft_reference);
  const Sheet s{bodyToView_ * Vec3{0, 0, -1}, bodyToView_ * Vec3{unit, 0, 0}, bodyToView_ * Vec3{0, unit, 0}};
  for (const double side : {-1.0, 1.0}) {
    canvas_.line(s, 0, 0, side * 0.03, -0.04);
    canvas_.line(s, side * 0.03, -0.04, side * 0.06, 0);
    canvas_.line(s, side * 0.06, 0, side * 0.12, 0);
  }
}

/// Draws a ring with wings and a fin.
void Drawer::flightPath() {
  if (!state_.velocity) return;
  const Velocity& v = *state_.velocity;
  const Vec3 direction{v.east.value(), v.north.value(), -v.down.value()};
  const double speed = length(direction);
  if (!(speed >= kSlowestMps) || !(speed < kFurthest)) return;
  beginMoved(Symbol::flight_path);
  const Vec3 seen = worldToView_ * (direction * (1 / speed));
  if (!(seen.z < 0)) return;
  const Sheet s = around(seen, size(Symbol::flight_path));
  constexpr double kRing = 0.03;
  canvas_.circle(s, 0, 0, kRing);
  canvas_.line(s, -0.085, 0, -kRing, 0);
  canvas_.line(s, kRing, 0, 0.085, 0);
  canvas_.line(s, 0, kRing, 0, 0.06);
}

/// Draws a cross in a broken ring where the eye looks, a pointer back to the nose, and the angles between the
/// two.
void Drawer::lineOfSight() {
  beginMoved(Symbol::line_of_sight);
  const Sheet s = around({0, 0, -1}, size(Symbol::line_of_sight));
  for (const double side : {-1.0, 1.0}) {
    canvas_.line(s, side * 0.015, 0, side * 0.05, 0);
    canvas_.line(s, 0, side * 0.015, 0, side * 0.05);
  }
  const Vec3 look = transposed(bodyToView_) * Vec3{0, 0, -1};  // body: right, up, backward
  const double across = std::atan2(look.x, -look.z) / kDegree;
  const double upwards = std::asin(std::clamp(look.y, -1.0, 1.0)) / kDegree;
  const int a = static_cast<int>(std::lround(across)), u = static_cast<int>(std::lround(upwards));
  if (a == 0 && u == 0) return;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%c%03d %c%02d", a < 0 ? 'L' : 'R', std::abs(a), u < 0 ? 'D' : 'U',
                std::abs(u));
  canvas_.text(s, 0, -0.15, kSmallText, text.data());
  const Vec3 nose = bodyToView_ * Vec3{0, 0, -1};
  const double off = std::hypot(nose.x, nose.y);
  if (off < 1e-6) return;  // straight behind: any way back is as long
  const double c = nose.x / off, d = nose.y / off;
  canvas_.line(s, c * 0.065, d * 0.065, c * 0.105, d * 0.105);
  canvas_.line(s, c * 0.105, d * 0.105, c * 0.085 - d * 0.014, d * 0.085 + c * 0.014);
  canvas_.line(s, c * 0.105, d * 0.105, c * 0.085 + d * 0.014, d * 0.085 - c * 0.014);
}

void Drawer::headingTape() {
  canvas_.begin(Symbol::heading_tape);
  const Sheet s = placed(Symbol::heading_tape);
  const double heading = wrapped360((onAircraft() ? state_.aircraft : state_.view).heading).value();
  constexpr double kHalf = 0.5, kHalfDegrees = 20, kPerDegree = kHalf / kHalfDegrees;
  canvas_.line(s, -kHalf, 0, kHalf, 0);
  const int first = static_cast<int>(std::ceil((heading - kHalfDegrees) / 5));
  for (int mark = first; mark * 5 <= heading + kHalfDegrees; ++mark) {
    const double at = (mark * 5 - heading) * kPerDegree;
    const bool numbered = mark % 2 == 0;
    canvas_.line(s, at, 0, at, numbered ? 0.045 : 0.025);
    if (!numbered || std::abs(at) > kHalf - 0.03) continue;
    const int tens = ((mark / 2) % 36 + 36) % 36;
    const std::array<char, 3> text =
        tens % 9 == 0
            ? std::array<char, 3>{"NESW"[tens / 9], 0, 0}
            : std::array<char, 3>{static_cast<char>('0' + tens / 10), static_cast<char>('0' + tens % 10), 0};
    canvas_.text(s, at, 0.085, kSmallText, text.data());
  }
  canvas_.line(s, 0, -0.005, -0.02, -0.04);
  canvas_.line(s, 0, -0.005, 0.02, -0.04);
  std::array<char, 16> digits{};
  canvas_.rectangle(s, {-0.095, -0.135, 0.095, -0.045});
  canvas_.text(s, 0, -0.09, kText, headingText(heading, digits));
}

void Drawer::readout(Symbol symbol, std::string_view digits, std::string_view label, double width) {
  canvas_.begin(symbol);
  const Sheet s = placed(symbol);
  canvas_.rectangle(s, {-0.5 * width, -0.05, 0.5 * width, 0.05});
  canvas_.text(s, 0.5 * width - 0.025 - 0.5 * Canvas::widthOf(digits, kText), 0, kText, digits);
  canvas_.text(s, 0, -0.09, kSmallText, label);
}

void Drawer::airspeed() {
  std::array<char, 16> text{"---"};
  const double knots = state_.speed.value_or(Knots{std::nan("")}).value();
  if (std::abs(knots) < kFurthest) std::snprintf(text.data(), text.size(), "%ld", std::lround(knots));
  readout(Symbol::airspeed, text.data(), state_.groundSpeed ? "GS KT" : "CAS KT", 0.24);
}

void Drawer::altitude() {
  std::array<char, 16> text{"---"};
  const double feet = state_.altitude.in<Feet>();
  if (std::abs(feet) < kFurthest) std::snprintf(text.data(), text.size(), "%ld", std::lround(feet / 10) * 10);
  readout(Symbol::altitude, text.data(), "ALT FT", 0.36);
}

}  // namespace

SymbologyRequest quantised(const SymbologyRequest& request, const ViewShape& view) {
  SymbologyRequest q = request;
  // A tenth of a pixel where pixels are smallest in angle: in the corners.
  const double x = std::max(std::abs(view.left), std::abs(view.right)),
               y = std::max(std::abs(view.bottom), std::abs(view.top));
  const double tangent =
      std::min((view.right - view.left) / view.widthPx, (view.top - view.bottom) / view.heightPx);
  const double step = 0.1 * tangent / (1 + x * x + y * y);
  const auto rounded = [](double value, double to) { return std::round(value / to) * to + 0.0; };
  const auto angle = [&](Degrees d) { return Degrees{rounded(d.value(), step / kDegree)}; };
  const auto attitude = [&](const Attitude& a) {
    return Attitude{angle(wrapped360(a.heading)), angle(a.pitch), angle(a.roll)};
  };
  q.state.aircraft = attitude(request.state.aircraft);
  q.state.view = attitude(request.state.view);
  q.state.altitude = Feet{rounded(request.state.altitude.in<Feet>(), 10)}.as<Metres>();
  if (q.state.speed) q.state.speed = Knots{std::round(q.state.speed->value()) + 0.0};
  const auto shows = [&](Symbol s) { return q.setup.element[static_cast<std::size_t>(s)].show; };
  if (!shows(Symbol::host)) {
    q.host.reset();
    q.dark.clear();
  }
  if (!shows(Symbol::altitude)) q.state.altitude = {};
  if (!shows(Symbol::airspeed)) q.state.speed.reset();
  if (!shows(Symbol::flight_path)) q.state.velocity.reset();
  if (q.state.velocity) {
    const Velocity v = *q.state.velocity;
    const double speed = std::hypot(v.north.value(), v.east.value(), v.down.value());
    q.state.velocity.reset();
    if (speed >= kSlowestMps && speed < kFurthest) {
      // Its direction alone, at a speed of its own: nobody sees more.
      const double track = rounded(std::atan2(v.east.value(), v.north.value()), step);
      const double dive = rounded(std::asin(std::clamp(v.down.value() / speed, -1.0, 1.0)), step);
      constexpr double kAnySpeed = 100;
      q.state.velocity = Velocity{MetresPerSecond{kAnySpeed * std::cos(dive) * std::cos(track)},
                                  MetresPerSecond{kAnySpeed * std::cos(dive) * std::sin(track)},
                                  MetresPerSecond{kAnySpeed * std::sin(dive)}};
    }
  }
  return q;
}

void drawSymbology(const SymbologyRequest& request, const ViewShape& view, SymbologyDrawing& drawing) {
  drawing.strokes.clear();
  drawing.box.fill({});
  drawing.marks.clear();
  drawing.hostSymbolsLeftOut = 0;
  if (!request.setup.general.enabled || view.widthPx <= 0 || view.heightPx <= 0) return;
  if (isKnown(request.state.aircraft) && isKnown(request.state.view))
    Drawer(request, view, drawing).drawAll();
  drawHostSymbols(request, view, drawing);
}

std::array<std::uint8_t, 3> symbolColour(SymbolColour colour) {
  constexpr std::array<std::array<std::uint8_t, 3>, 8> kColours{{{64, 255, 96},
                                                                 {255, 255, 255},
                                                                 {255, 176, 32},
                                                                 {64, 240, 255},
                                                                 {255, 96, 255},
                                                                 {255, 56, 48},
                                                                 {255, 240, 48},
                                                                 {0, 0, 0}}};
  static_assert(static_cast<std::size_t>(SymbolColour::black) + 1 == kColours.size());
  return kColours[static_cast<std::size_t>(colour)];
}

}  // namespace trimtab::scene
