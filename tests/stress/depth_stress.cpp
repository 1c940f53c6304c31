#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/scene/gl/frame_buffer.h"
#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_program.h"
#include "quad.h"
#include "table.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/units/geodesy.h"

/// Which of two surfaces a GL draws in front: 32-bit float depth, reversed, zero to one, as the scene's.
namespace trimtab::stress {
namespace {

constexpr int kSize = 128;
constexpr double kNear = 1;

/// A sheet of triangles over the view, relative to the eye, world axes.
using Sheet = std::vector<Vec3>;

constexpr const char* kVertex = R"(#version 120
void main() { gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex; })";
constexpr const char* kFragment = R"(#version 120
uniform vec4 colour;
void main() { gl_FragColor = colour; })";

class DepthStress : public testing::Test {
 protected:
  void SetUp() override {
    auto created = scene::Offscreen::create(kSize, kSize);
    if (!created) GTEST_SKIP() << toString(created.findings());
    offscreen = std::move(created).value();
    offscreen->makeCurrent();
    buffer = std::make_unique<scene::FrameBuffer>();
    buffer->resize(kSize, kSize);
    program = scene::makeGlProgram(kVertex, kFragment);
    ASSERT_NE(program, 0u);
    glBindFramebuffer(GL_FRAMEBUFFER, buffer->id());
    glViewport(0, 0, kSize, kSize);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    glClearDepth(0);
    glUseProgram(program);
  }
  void TearDown() override {
    if (!offscreen) return;
    glUseProgram(0);
    glDeleteProgram(program);
    buffer.reset();
  }

  /// Rotation and reversed projection as one matrix in doubles, given to GL as floats.
  void useEye(const Mat3& axes, double tangent) {
    std::array<float, 16> m{};
    for (std::size_t column = 0; column < 3; ++column) {
      const auto part = [&](std::size_t row) {
        const Vec3& r = axes.row[row];
        return column == 0 ? r.x : column == 1 ? r.y : r.z;
      };
      m[column * 4 + 0] = static_cast<float>(part(0) / tangent);
      m[column * 4 + 1] = static_cast<float>(part(1) / tangent);
      m[column * 4 + 3] = static_cast<float>(-part(2));
    }
    m[14] = static_cast<float>(kNear);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glMatrixMode(GL_MODELVIEW);
    glLoadMatrixf(m.data());
  }

  void draw(const Sheet& sheet, double scale, float red, float green) {
    std::vector<float> floats;
    for (const Vec3& p : sheet)
      for (const double c : {p.x, p.y, p.z}) floats.push_back(static_cast<float>(c * scale));
    glUniform4f(glGetUniformLocation(program, "colour"), red, green, 0, 1);
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(3, GL_FLOAT, 0, floats.data());
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(sheet.size()));
    glDisableClientState(GL_VERTEX_ARRAY);
  }

  /// Pixels that show the farther of a sheet and its copy `scale` times as far, drawn in both orders; none
  /// where the sheet does not cover the picture.
  std::size_t wrong(const Sheet& sheet, double scale) {
    std::size_t bad = 0;
    for (const bool nearFirst : {true, false}) {
      glClearColor(0, 0, 1, 1);
      glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
      draw(sheet, nearFirst ? 1 : scale, nearFirst ? 0.0f : 1.0f, nearFirst ? 1.0f : 0.0f);
      draw(sheet, nearFirst ? scale : 1, nearFirst ? 1.0f : 0.0f, nearFirst ? 0.0f : 1.0f);
      std::vector<std::uint8_t> rgba(kSize * kSize * 4);
      glReadPixels(0, 0, kSize, kSize, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
      for (std::size_t i = 0; i < rgba.size(); i += 4) {
        bad += rgba[i] != 0;
        covered += rgba[i + 1] != 0;
      }
    }
    return bad;
  }

  std::unique_ptr<scene::Offscreen> offscreen;
  std::unique_ptr<scene::FrameBuffer> buffer;
  unsigned program = 0;
  std::size_t covered = 0;
};

/// A plane through the view's axis at a distance, tilted by so many degrees, in cells; `nearest` is the least
/// distance from the eye to any of it.
Sheet plane(const Mat3& axes, double distance, double tiltDeg, double turnDeg, double tangent, int cells,
            double& nearest) {
  const double tilt = tiltDeg * 0.017453292519943295, turn = turnDeg * 0.017453292519943295;
  const Vec3 right = axes.row[0], up = axes.row[1], ahead = -axes.row[2];
  const Vec3 along = right * std::cos(turn) + up * std::sin(turn),
             across = up * std::cos(turn) - right * std::sin(turn);
  const Vec3 slope = along * std::cos(tilt) + ahead * std::sin(tilt);
  // So wide that it covers the picture, and so that its near side is no nearer than half its middle.
  const double reach = std::min(1.6 * distance * tangent / std::max(std::cos(tilt), 0.05), 0.5 * distance);
  const auto at = [&](int i, int k) {
    return ahead * distance + (slope * (2.0 * i / cells - 1) + across * (2.0 * k / cells - 1)) * reach;
  };
  Sheet sheet;
  nearest = HUGE_VAL;
  for (int i = 0; i < cells; ++i)
    for (int k = 0; k < cells; ++k)
      for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}) {
        sheet.push_back(at(i + a, k + b));
        nearest = std::min(nearest, dot(sheet.back(), ahead));
      }
  return sheet;
}

/// The least gap at which no pixel shows the farther surface, in roundings of a float (2^-24 of the
/// distance), but never less than 5 mm.
class Gap {
 public:
  Gap(const char* name, double bound, const char* why)
      : bound_(bound),
        least_("depth", std::string(name) + ": least gap without a leak", bound,
               "distance x 2^-24, from 5 mm up", why),
        leaks_("depth", std::string(name) + ": leaks at that bound", 0, "px", "the same") {}

  template <class Wrong>
  void look(double nearest, const Wrong& wrong, const std::string& where) {
    double least = HUGE_VAL;
    for (const double roundings : {1.0, 0.9, 0.75, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1}) {
      const double gap = std::max(0.005 / nearest, roundings * bound_ * 0x1p-24);
      const std::size_t bad = wrong(1 + gap);
      if (roundings == 1) leaks_.see(static_cast<double>(bad), [&] { return where; });
      if (bad > 0) break;
      least = roundings * bound_;
      if (gap * nearest <= 0.005) break;  // smaller ones are no other gap
    }
    // Where the 5 mm are the larger, they hold or they do not.
    const bool floor = least * 0x1p-24 * nearest <= 0.005;
    least_.see(floor ? 0 : least, [&] { return where; });
  }

 private:
  double bound_;
  Case least_, leaks_;
};

TEST_F(DepthStress, surfacesAreDrawnInTheirOrder) {
  Gap along("across the view, along an axis, 1 m to 100 km", 4,
            "place and depth round once each, of either surface: distance x 2^-22");
  Gap across("across the view, any attitude", 16,
             "of either surface: place, matrix, product and two sums of the distance, quotient, depth, "
             "interpolation");
  Gap tilted("tilted by up to 85 degrees, any attitude", 24,
             "as across, with the interpolation's three terms up to twice as large, and their sums");
  std::mt19937_64 random(81);
  std::uniform_real_distribution<double> unit(-1, 1);
  const std::size_t count = samples(500, 20000);
  for (std::size_t i = 0; i < count; ++i) {
    const double distance = i < 3 ? 1.05 : i < 6 ? 1e5 : std::pow(10, 5 * std::sqrt(std::abs(unit(random))));
    const std::size_t kind = i % 3;
    if (kind == 2 && distance < 3) continue;
    const double tilt = kind == 2 ? 85 * std::abs(unit(random)) : 0,
                 tangent = 0.02 + 0.2 * std::abs(unit(random));
    Attitude attitude;
    if (kind > 0)
      attitude = {Degrees{180 * unit(random)}, Degrees{90 * unit(random)}, Degrees{180 * unit(random)}};
    const Mat3 axes = eyeAxes(LocalFrame(), GeodeticPosition{}, attitude);
    double nearest = 0;
    const Sheet sheet = plane(axes, distance, tilt, 180 * unit(random), tangent, 1 << (i % 5), nearest);
    useEye(axes, tangent);
    (kind == 0   ? along
     : kind == 1 ? across
                 : tilted)
        .look(
            nearest, [&](double scale) { return wrong(sheet, scale); },
            "distance " + digits(distance) + ", tilt " + digits(tilt));
  }
  EXPECT_GT(covered, count * kSize * kSize) << "the surfaces were hardly seen";
}

}  // namespace
}  // namespace trimtab::stress
