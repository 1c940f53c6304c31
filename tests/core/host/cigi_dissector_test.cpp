#include <cmath>

#include "dissected.h"
#include "host_support.h"
#include "tests/support.h"

namespace trimtab::test {
namespace {

class SentCigi : public testing::TestWithParam<ByteOrder> {
 protected:
  void SetUp() override {
    if (run("tshark --version").exitCode != 0) GTEST_SKIP() << "needs tshark";
  }
};
INSTANTIATE_TEST_SUITE_P(EitherOrder, SentCigi, testing::Values(ByteOrder::big, ByteOrder::little));

TEST_P(SentCigi, isReadByTheDissectorFieldByField) {
  std::vector<CapturedDatagram> datagrams;
  std::vector<std::map<std::string, double>> expected;
  for (std::uint32_t i = 0; i < 40; ++i) {
    AircraftState s = aFullState();
    s.time = 7.25 + i * 300.125;
    s.position = {Degrees{-89.5 + 4.5 * i}, Degrees{-179.75 + 9.125 * i}, Metres{-250.5 + 333.25 * i}};
    s.attitude = {Degrees{9.0 * i}, Degrees{-80.5 + 4.0 * i}, Degrees{-170.0 + 8.5 * i}};
    s.head = Attitude{Degrees{-150.0 + 7.5 * i}, Degrees{-60.25 + 3.0 * i}, Degrees{0.5 * i}};
    s.visibility = Metres{50.0 + 800.0 * i};
    s.wind = Wind{MetresPerSecond{0.5 * i}, Degrees{5.0 * i}, MetresPerSecond{-0.125 * i}};
    s.view = HostView{Metres{0.25 + i}, Degrees{-10.5 - i}, Degrees{11.25 + i}, Degrees{-12.75 - i},
                      Degrees{13.5 + i}};
    const std::uint32_t frame = 4294967290U + i;
    datagrams.push_back(
        {1e9 + i, "127.0.0.1:40000", "127.0.0.1:8004", encodeCigiHost(s, frame, 1000 + i, GetParam())});
    expected.push_back({
        {"cigi.ig_control.ig_mode", 1},
        {"cigi.ig_control.minor_version", 3},
        {"cigi.ig_control.timestamp_valid", 1},
        {"cigi.ig_control.host_frame_number", frame},
        {"cigi.ig_control.timestamp", std::round(s.time * 1e5)},
        {"cigi.ig_control.last_ig_frame_number", 1000.0 + i},
        {"cigi.entity_control.entity_id", 0},
        {"cigi.entity_control.entity_state", 1},
        {"cigi.entity_control.attach_state", 0},
        {"cigi.entity_control.alpha", 255},
        {"cigi.entity_control.roll", s.attitude.roll.value()},
        {"cigi.entity_control.pitch", s.attitude.pitch.value()},
        {"cigi.entity_control.yaw", s.attitude.heading.value()},
        {"cigi.entity_control.lat_xoff", s.position.latitude.value()},
        {"cigi.entity_control.lon_yoff", s.position.longitude.value()},
        {"cigi.entity_control.alt_zoff", s.position.height.value()},
        {"cigi.view_control.view_id", 0},
        {"cigi.view_control.group_id", 0},
        {"cigi.view_control.entity_id", 0},
        {"cigi.view_control.xoff_enable", 0},
        {"cigi.view_control.roll_enable", 1},
        {"cigi.view_control.pitch_enable", 1},
        {"cigi.view_control.yaw_enable", 1},
        {"cigi.view_control.roll", s.head->roll.value()},
        {"cigi.view_control.pitch", s.head->pitch.value()},
        {"cigi.view_control.yaw", s.head->heading.value()},
        {"cigi.view_def.near_enable", 1},
        {"cigi.view_def.far_enable", 0},
        {"cigi.view_def.left_enable", 1},
        {"cigi.view_def.right_enable", 1},
        {"cigi.view_def.top_enable", 1},
        {"cigi.view_def.bottom_enable", 1},
        {"cigi.view_def.near", s.view->nearDistance->value()},
        {"cigi.view_def.left", s.view->left->value()},
        {"cigi.view_def.right", s.view->right->value()},
        {"cigi.view_def.top", s.view->top->value()},
        {"cigi.view_def.bottom", s.view->bottom->value()},
        {"cigi.atmosphere_control.atmospheric_model_enable", 1},
        {"cigi.atmosphere_control.visibility_range", s.visibility->value()},
        {"cigi.atmosphere_control.horiz_wind", s.wind->speed.value()},
        {"cigi.atmosphere_control.vert_wind", s.wind->up.value()},
        {"cigi.atmosphere_control.wind_direction", s.wind->from.value()},
        {"cigi.atmosphere_control.air_temp", 15},
        {"cigi.atmosphere_control.barometric_pressure", 1013.25},
    });
  }
  const auto rows = dissected(datagrams, names(expected.front()));
  ASSERT_EQ(rows.size(), expected.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(i);
    expectFields(rows[i], expected[i]);
  }
}

TEST_P(SentCigi, weatherIsReadByTheDissectorFieldByField) {
  std::vector<CapturedDatagram> datagrams;
  std::vector<std::map<std::string, double>> rain, snow;
  for (int i = 0; i < 18; ++i) {
    AircraftState s = aState();
    s.weather = HostWeather{static_cast<Precipitation>(i % 3), i / 3, std::nullopt};
    if (i % 2 == 0) s.weather->visibility = Metres{250.5 * (i + 1)};
    if (i % 4 != 3) s.wind = Wind{MetresPerSecond{1.5 * i}, Degrees{20.0 * i}, MetresPerSecond{0.25 * i - 1}};
    datagrams.push_back({1e9 + i, "127.0.0.1:40000", "127.0.0.1:8004",
                         encodeCigiHost(s, static_cast<std::uint32_t>(i), 0, GetParam())});
    const auto layer = [&](double id, Precipitation kind) {
      const bool falls = s.weather->precipitation == kind;
      const double visibility = s.weather->visibility.value_or(Metres{0}).value();
      const Wind wind = falls && s.wind ? *s.wind : Wind{};
      return std::map<std::string, double>{{"cigi.weather_control.layer_id", id},
                                           {"cigi.weather_control.entity_region_id", 0},
                                           {"cigi.weather_control.scope", 0},
                                           {"cigi.weather_control.weather_enable", falls},
                                           {"cigi.weather_control.severity", falls ? i / 3 : 0},
                                           {"cigi.weather_control.scud_enable", 0},
                                           {"cigi.weather_control.random_winds_enable", 0},
                                           {"cigi.weather_control.random_lightning_enable", 0},
                                           {"cigi.weather_control.coverage", falls ? 100 : 0},
                                           {"cigi.weather_control.horiz_wind", wind.speed.value()},
                                           {"cigi.weather_control.vert_wind", wind.up.value()},
                                           {"cigi.weather_control.wind_direction", wind.from.value()},
                                           {"cigi.weather_control.visibility_range", falls ? visibility : 0}};
    };
    rain.push_back(layer(4, Precipitation::rain));
    snow.push_back(layer(5, Precipitation::snow));
  }
  const auto first = dissected(datagrams, names(rain.front()), 'f');
  const auto last = dissected(datagrams, names(snow.front()), 'l');
  ASSERT_EQ(first.size(), rain.size());
  ASSERT_EQ(last.size(), snow.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    SCOPED_TRACE(i);
    expectFields(first[i], rain[i]);
    expectFields(last[i], snow[i]);
  }
}

/// The dissector's own readings differ from the standard in two places, which are left out here: it takes the
/// source type of a clone from another bit, and shows one bit of a line's primitive type.
TEST_P(SentCigi, symbolsAreReadByTheDissectorFieldByField) {
  HostSymbols symbols;
  symbols.surfaces = {{513, 0.125F, 0.75F, 0.25F, 0.875F, -4, 5.5F, -6, 7.25F}};
  HostShape text, circles, lines;
  text.kind = HostShapeKind::text;
  text.alignment = 7;
  text.orientation = 3;
  text.fontSize = 2.5F;
  text.text = "RDR 7";
  circles.kind = HostShapeKind::circles;
  circles.filled = true;
  circles.lineWidth = 0.5F;
  circles.arcs = {{1, 2, 3, 0.25F, 45, 90}, {-1, -2, 4, 0, 0, 360}};
  lines.primitive = HostPrimitive::line_loop;
  lines.lineWidth = 0.75F;
  lines.points = {{1, 2}, {-3, 4.5F}, {5, -6}};
  for (const HostShape& shape : {text, circles, lines}) {
    HostSymbol s;
    s.id = static_cast<std::uint16_t>(300 + symbols.symbols.size());
    s.shape = std::make_shared<const HostShape>(shape);
    symbols.symbols.push_back(s);
  }
  HostSymbol& last = symbols.symbols.back();
  last.parent = 300;
  last.surface = 513;
  last.visible = last.attached = last.inheritsColour = true;
  last.layer = 9;
  last.dutyPercent = 60;
  last.flashPeriodS = 1.25F;
  last.u = -2.5F;
  last.v = 3.5F;
  last.rotationDeg = 33;
  last.scaleU = 2;
  last.scaleV = 0.5F;
  last.rgba = {10, 20, 30, 40};
  auto bytes = encodeCigiHost(aState(), 7, 0, GetParam());
  const auto packets = encodeCigiSymbols(symbols, GetParam());
  bytes.insert(bytes.end(), packets.begin(), packets.end());
  const std::map<std::string, double> expected{{"cigi.symbl_srfc_def.surface_id", 513},
                                               {"cigi.symbl_srfc_def.surface_state", 0},
                                               {"cigi.symbl_srfc_def.attach_type", 1},
                                               {"cigi.symbl_srfc_def.billboard", 0},
                                               {"cigi.symbl_srfc_def.xoff_left", 0.125},
                                               {"cigi.symbl_srfc_def.yoff_right", 0.75},
                                               {"cigi.symbl_srfc_def.zoff_top", 0.875},
                                               {"cigi.symbl_srfc_def.yaw_bottom", 0.25},
                                               {"cigi.symbl_srfc_def.min_u", -4},
                                               {"cigi.symbl_srfc_def.max_u", 5.5},
                                               {"cigi.symbl_srfc_def.min_v", -6},
                                               {"cigi.symbl_srfc_def.max_v", 7.25},
                                               {"cigi.symbol_text_def.symbol_id", 300},
                                               {"cigi.symbol_text_def.alignment", 7},
                                               {"cigi.symbol_text_def.orientation", 3},
                                               {"cigi.symbol_text_def.font_size", 2.5},
                                               {"cigi.symbol_circle_def.symbol_id", 301},
                                               {"cigi.symbl_circle_def.drawing_style", 1},
                                               {"cigi.symbol_circle_def.stipple_pattern", 0xffff},
                                               {"cigi.symbol_circle_def.line_width", 0.5},
                                               {"cigi.symbol_circle_def.center_u1", 1},
                                               {"cigi.symbol_circle_def.center_v1", 2},
                                               {"cigi.symbol_circle_def.radius1", 3},
                                               {"cigi.symbol_circle_def.inner_radius1", 0.25},
                                               {"cigi.symbol_circle_def.start_angle1", 45},
                                               {"cigi.symbol_circle_def.end_angle1", 90},
                                               {"cigi.symbol_circle_def.radius2", 4},
                                               {"cigi.symbol_line_def.symbol_id", 302},
                                               {"cigi.symbol_line_def.stipple_pattern", 0xffff},
                                               {"cigi.symbol_line_def.line_width", 0.75},
                                               {"cigi.symbol_line_def.vertex_u1", 1},
                                               {"cigi.symbol_line_def.vertex_v1", 2},
                                               {"cigi.symbol_line_def.vertex_u3", 5},
                                               {"cigi.symbol_line_def.vertex_v3", -6},
                                               {"cigi.symbol_control.symbol_id", 302},
                                               {"cigi.symbol_control.symbol_state", 1},
                                               {"cigi.symbol_control.attach_state", 1},
                                               {"cigi.symbol_control.flash_control", 0},
                                               {"cigi.symbol_control.inherit_color", 1},
                                               {"cigi.symbol_control.parent_symbol_id", 300},
                                               {"cigi.symbol_control.surface_id", 513},
                                               {"cigi.symbol_control.layer", 9},
                                               {"cigi.symbol_control.flash_duty_cycle", 60},
                                               {"cigi.symbol_control.flash_period", 1.25},
                                               {"cigi.symbol_control.position_u", -2.5},
                                               {"cigi.symbol_control.position_v", 3.5},
                                               {"cigi.symbol_control.rotation", 33},
                                               {"cigi.symbol_control.red", 10},
                                               {"cigi.symbol_control.green", 20},
                                               {"cigi.symbol_control.blue", 30},
                                               {"cigi.symbol_control.alpha", 40},
                                               {"cigi.symbol_control.scale_u", 2},
                                               {"cigi.symbol_control.scale_v", 0.5}};
  const auto rows = dissected({{1e9, "127.0.0.1:40000", "127.0.0.1:8004", bytes}}, names(expected), 'l');
  ASSERT_EQ(rows.size(), 1U);
  expectFields(rows[0], expected);
}

TEST_P(SentCigi, startOfFrameIsReadByTheDissector) {
  const CapturedDatagram sent{1e9, "127.0.0.1:8004", "127.0.0.1:8005",
                              encodeCigiStartOfFrame(4294967295U, 123456, 42949.0, GetParam())};
  const std::map<std::string, double> expected{{"cigi.sof.ig_frame_number", 4294967295.0},
                                               {"cigi.sof.last_host_frame_number", 123456},
                                               {"cigi.sof.timestamp", 4294900000.0},
                                               {"cigi.sof.timestamp_valid", 1},
                                               {"cigi.sof.ig_mode", 1},
                                               {"cigi.sof.earth_reference_model", 0},
                                               {"cigi.sof.minor_version", 2},
                                               {"cigi.sof.ig_status", 0},
                                               {"cigi.sof.db_number", 0}};
  const auto rows = dissected({sent}, names(expected));
  ASSERT_EQ(rows.size(), 1U);
  expectFields(rows[0], expected);
}

}  // namespace
}  // namespace trimtab::test
