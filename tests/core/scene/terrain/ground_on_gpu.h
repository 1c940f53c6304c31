#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_program.h"
#include "core/scene/shaders/shaders.h"
#include "core/scene/shaders/shared_constants.h"
#include "core/scene/terrain/ground/ground_texture.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/terrain/ground/build.h"

/// Ground made of a formula, and a picture of nothing but the ground's colours.
namespace trimtab::scene {

using terrain::GroundPyramid;
using terrain::GroundShape;
using terrain::GroundTexel;
using terrain::GroundTile;

/// Ground by a formula: any size, no memory; tiles come as slowly as wanted, or not at all.
class Formula final : public GroundPyramid {
 public:
  Formula(std::uint32_t columns, std::uint32_t rows, double texelsPerPost = 1) {
    shape_ = terrain::makeGroundShape({0, 0, 1e-3, 1e-3, columns, rows}, texelsPerPost);
  }
  const GroundShape& shape() const override { return shape_; }
  Result<GroundTile> readTile(std::uint32_t level, std::uint32_t column, std::uint32_t row) const override {
    niceness = ::getpriority(PRIO_PROCESS, 0);
    // No longer than a test may take.
    for (int ms = 0; held && ms < 20'000; ++ms) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (level == brokenLevel) ++failed;
    if (level == brokenLevel) return Finding{Severity::error, "ground", "tile", "texels", "none"};
    constexpr std::int64_t kSide = GroundShape::kTile;
    GroundTile tile(std::size_t{kSide * kSide});
    // Along a row and a column each part of the formula is told once: sines are slow.
    std::vector<GroundTexel> across, up;
    for (std::int64_t i = 0; i < kSide; ++i) {
      across.push_back(texel(level, column * kSide + i, row * kSide));
      up.push_back(texel(level, column * kSide, row * kSide + i));
    }
    const auto& size = shape_.levels[level];
    for (std::int64_t r = 0; r < kSide; ++r)
      for (std::int64_t c = 0; c < kSide; ++c) {
        GroundTexel& t = tile[static_cast<std::size_t>(r * kSide + c)];
        t = across[static_cast<std::size_t>(c)];
        t.green = up[static_cast<std::size_t>(r)].green;
        t.normalX = slant(std::min<std::int64_t>(column * kSide + c, size.columns - 1) +
                          std::min<std::int64_t>(row * kSide + r, size.rows - 1));
      }
    ++read;
    return tile;
  }
  /// Smooth over a few texels, and another at every level.
  GroundTexel texel(std::uint32_t level, std::int64_t column, std::int64_t row) const {
    const auto& size = shape_.levels[level];
    const auto c = static_cast<double>(std::clamp<std::int64_t>(column, 0, size.columns - 1)),
               r = static_cast<double>(std::clamp<std::int64_t>(row, 0, size.rows - 1));
    const auto byte = [](double v) { return static_cast<std::uint8_t>(std::lround(v)); };
    return {byte(120 + 60 * std::sin(c * 0.9)),
            byte(120 + 60 * std::cos(r * 0.7 + level)),
            static_cast<std::uint8_t>(40 + 20 * (level % 8)),
            static_cast<std::uint8_t>(c < 40 ? 255 : 0),
            slant(static_cast<std::int64_t>(c + r)),
            static_cast<std::int8_t>(std::lround(50 * std::cos(c * 0.2)))};
  }
  static std::int8_t slant(std::int64_t sum) {
    static const std::vector<std::int8_t> table = [] {
      std::vector<std::int8_t> all;
      for (int i = 0; i < 200000; ++i)
        all.push_back(static_cast<std::int8_t>(std::lround(50 * std::sin(i * 0.3))));
      return all;
    }();
    return table[static_cast<std::size_t>(sum)];
  }
  mutable std::atomic<int> read{0}, failed{0};
  std::atomic<bool> held{false};
  mutable std::atomic<int> niceness{0};  ///< of the last thread that read
  std::uint32_t brokenLevel = 99;

 private:
  GroundShape shape_;
};

/// What a fragment sees: posts at a corner of the picture and its steps across and up.
struct View {
  double column = 0, row = 0;
  double acrossColumn = 1, acrossRow = 0, upColumn = 0, upRow = 1;
  double columnAt(double x, double y) const { return column + acrossColumn * x + upColumn * y; }
  double rowAt(double x, double y) const { return row + acrossRow * x + upRow * y; }
};

class GroundOnGpu : public ::testing::Test {
 protected:
  static constexpr int kWidth = 160, kHeight = 120;

  void SetUp() override {
    auto created = Offscreen::create(kWidth, kHeight);
    if (!created) GTEST_SKIP() << toString(created.findings());
    offscreen_ = std::move(created).value();
    const std::string fragment = completeShader(R"(#version 430 compatibility
#include "ground_colour.glsl"
      uniform vec2 first, across, up;
      uniform bool lightAlone;
      out vec4 colour;
      void main() {
        vec2 p = gl_FragCoord.xy;
        vec4 g = groundAt(first + across * p.x + up * p.y);
        colour = vec4(lightAlone ? vec3(g.a / 1.5) : g.rgb, 1.0);
      })");
    program_ = makeGlProgram(R"(#version 430 compatibility
      void main() {
        vec2 corner = vec2((gl_VertexID & 1) * 2, gl_VertexID & 2);
        gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
      })",
                             fragment);
    ASSERT_NE(program_, 0u);
    glGenVertexArrays(1, &array_);
    texture_ = std::make_unique<GroundTexture>();
  }
  void TearDown() override {
    if (!offscreen_) return;
    texture_.reset();
    glDeleteVertexArrays(1, &array_);
    glDeleteProgram(program_);
  }

  std::vector<std::uint8_t> draw(const View& view, bool lightAlone = false) {
    glBindFramebuffer(GL_FRAMEBUFFER, offscreen_->framebuffer());
    glViewport(0, 0, kWidth, kHeight);
    glUseProgram(program_);
    texture_->bind(program_);
    const auto uniform = [&](const char* name) { return glGetUniformLocation(program_, name); };
    glUniform2f(uniform("first"), static_cast<float>(view.column - texture_->eyeColumn()),
                static_cast<float>(view.row - texture_->eyeRow()));
    glUniform2f(uniform("across"), static_cast<float>(view.acrossColumn), static_cast<float>(view.acrossRow));
    glUniform2f(uniform("up"), static_cast<float>(view.upColumn), static_cast<float>(view.upRow));
    glUniform1i(uniform("lightAlone"), lightAlone ? 1 : 0);
    glBindVertexArray(array_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    texture_->unbind();
    glUseProgram(0);
    std::vector<std::uint8_t> pixels(std::size_t{kWidth} * kHeight * 4);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    return pixels;
  }

  /// Texture of a level, as it is on the GPU.
  std::vector<std::uint32_t> layers(std::size_t levels) {
    std::vector<std::uint32_t> all(levels * kGroundSide * kGroundSide);
    glUseProgram(program_);
    texture_->bind(program_);
    glActiveTexture(GL_TEXTURE0 + kGroundUnit);
    glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA, GL_UNSIGNED_BYTE, all.data());
    glActiveTexture(GL_TEXTURE0);
    texture_->unbind();
    glUseProgram(0);
    return all;
  }

  std::unique_ptr<Offscreen> offscreen_;
  std::unique_ptr<GroundTexture> texture_;
  unsigned program_ = 0, array_ = 0;
};

}  // namespace trimtab::scene
