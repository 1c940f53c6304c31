#include <cmath>
#include <string>
#include <vector>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_program.h"
#include "core/scene/shaders/light.h"
#include "core/scene/shaders/shaders.h"
#include "core/scene/terrain/ground/ground_texture.h"
#include "tests/bench/row.h"
#include "tests/core/terrain/ground/build_and_open.h"
#include "tests/support.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/terrain/ground/build.h"

/// Group `ground`: what the ground's colours cost to build, to read, to draw and to keep up with the eye.

namespace trimtab::bench {
namespace {

using namespace terrain;

struct Land {
  HeightGrid grid;
  PostGeometry geometry;
  GridHeights heights;

  explicit Land(std::uint32_t side)
      : grid{{8, 46, 1.0 / 3600, 1.0 / 3600, side, side}, {}, 0, {}}, geometry(grid.posts), heights(grid) {
    for (std::uint32_t r = 0; r < side; ++r)
      for (std::uint32_t c = 0; c < side; ++c)
        grid.heights.push_back(static_cast<float>(900 + 700 * std::sin(c * 0.021) * std::cos(r * 0.017) +
                                                  90 * std::sin(c * 0.13 + r * 0.09) +
                                                  8 * std::sin(c * 1.7) * std::cos(r * 1.9)));
  }
  GroundSources sources() const {
    GroundSources sources;
    sources.heights = &heights;
    sources.geometry = &geometry;
    return sources;
  }
};

double texelsOf(const GroundShape& shape) {
  double sum = 0;
  for (const auto& level : shape.levels) sum += double{1} * level.columns * level.rows;
  return sum;
}

void measureBuilding(Report& report, const Land& land) {
  test::ScratchDir dir;
  std::shared_ptr<const GroundPyramid> ground;
  const double seconds = leastSeconds(report.quick() ? 1 : 3, [&] {
    const auto done = buildGround(land.sources(), dir / "ground", {});
    if (!done) std::fputs(toString(done.findings()).c_str(), stderr);
  });
  const auto opened = openGround(dir / "ground", land.grid.posts);
  if (!opened) return;
  const double texels = texelsOf((*opened)->shape());
  report.add({.id = "ground.build",
              .what = "land cover and normals of a million texels, with their levels",
              .value = seconds / texels * 1e6,
              .unit = "s"});
  report.add({.id = "ground.bytes",
              .what = "on disk, a texel of any level",
              .value = static_cast<double>(std::filesystem::file_size(dir / "ground")) / texels,
              .unit = "bytes"});
  const double reading = leastSeconds(20, [&] { keep((*opened)->readTile(0, 1, 1)->data()); });
  report.add({.id = "ground.read",
              .what = "a tile of 65,536 texels, checked",
              .value = reading * 1e3,
              .unit = "ms"});
}

/// A plain seen from 600 m, its horizon above the picture: every pixel is ground.
constexpr const char* kPlain = R"(#version 430 compatibility
uniform ivec2 eyePost;
uniform vec2 eyeAt;
const float kHeight = 600.0, kPost = 30.0;
out vec3 relative;
#ifdef BY_VERTEX
out vec3 lit;
out float clearness;
#else
out vec3 upward;
out vec2 post;
flat out vec4 tint;
#endif
out vec2 ground;
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2, gl_VertexID & 2);
  // A triangle on the plain that covers the picture: x 12 km, y from 0.5 km away to 24 km.
  vec3 p = vec3(mix(-12000.0, 12000.0 * 3.0, corner.x * 0.5), mix(400.0, 60000.0, corner.y * 0.5), -kHeight);
  relative = p;
#ifdef BY_VERTEX
  lit = vec3(0.4, 0.5, 0.3);
  clearness = exp(-length(p) / 110e3);
#else
  upward = vec3(0.0, 0.0, 1.0);
  post = p.xy / kPost;
  tint = vec4(0.0);
#endif
  ground = p.xy;
  // Looking down by some degrees: y forward.
  float s = 0.34, c = 0.94;
  vec3 eye = vec3(p.x, c * p.z + s * p.y, s * p.z - c * p.y);
  gl_Position = vec4(eye.x * 1.1, eye.y * 1.95, -1.0, -eye.z);
}
)";

/// A shader with a line after its first one.
std::string with(std::string shader, const std::string& line) {
  return shader.insert(shader.find('\n') + 1, line + "\n");
}

unsigned programOf(bool byVertex, const std::string& fragment) {
  return scene::makeGlProgram(byVertex ? with(kPlain, "#define BY_VERTEX 1") : kPlain, fragment);
}

void measureDrawing(Report& report, const std::shared_ptr<const GroundPyramid>& ground) {
  constexpr int kWidth = 1280, kHeight = 720;
  auto offscreen = scene::Offscreen::create(kWidth, kHeight);
  if (!offscreen) return;
  const unsigned byVertex = programOf(true, scene::shaderText("terrain.frag.glsl"));
  const std::string ofTexels =
      with(scene::shaderText("patch.frag.glsl"), "#define GROUND_TEXTURE 1");
  const unsigned byTexel = programOf(false, ofTexels);
  const unsigned inFog = programOf(false, with(ofTexels, "#define IN_WEATHER 1"));
  const unsigned plain = programOf(true,
                                   "#version 430 compatibility\nin vec3 lit; out vec4 c;\n"
                                   "void main() { c = vec4(lit, 1.0); }");
  if (byVertex == 0 || byTexel == 0 || inFog == 0 || plain == 0) return;
  scene::GroundTexture texture;
  texture.setGround(ground);
  const double middle = ground->shape().levels[0].columns / 2.0;
  texture.update(middle, middle, true, 0);
  unsigned array = 0;
  glGenVertexArrays(1, &array);
  glBindVertexArray(array);
  glBindFramebuffer(GL_FRAMEBUFFER, (*offscreen)->framebuffer());
  glViewport(0, 0, kWidth, kHeight);
  const Vec3 sun = normalized(scene::kTowardsSun);
  const auto draw = [&](unsigned program) {
    glUseProgram(program);
    glUniform3f(glGetUniformLocation(program, "sun"), static_cast<float>(sun.x), static_cast<float>(sun.y),
                static_cast<float>(sun.z));
    glUniform3f(glGetUniformLocation(program, "fog"), 0.7f, 0.72f, 0.74f);
    glUniform3f(glGetUniformLocation(program, "air"), 2e-4f, 1e30f, 1);
    texture.bind(program);
    for (int i = 0; i < 4; ++i) glDrawArrays(GL_TRIANGLES, 0, 3);
    glFinish();
    texture.unbind();
  };
  const auto seconds = leastInTurn(report.quick() ? 3 : 12, std::pair(1, [&] { draw(byVertex); }),
                                   std::pair(1, [&] { draw(byTexel); }), std::pair(1, [&] { draw(inFog); }),
                                   std::pair(1, [&] { draw(plain); }));
  const auto each = [&](double s) { return s / 4 * 1e3; };
  report.add({.id = "ground.fill_plain",
              .what = "1280 x 720 pixels of one colour",
              .value = each(seconds[3]),
              .unit = "ms"});
  report.add(ratioAtMost(1.6, {.id = "ground.fill",
                               .what = "1280 x 720 pixels of ground by two levels of texels",
                               .value = each(seconds[1]),
                               .unit = "ms",
                               .peer = "colours of vertices and hashed noise",
                               .peerValue = each(seconds[0]),
                               .peerFrom = "run"}));
  report.add(ratioAtMost(1.1, {.id = "ground.fill_fog",
                               .what = "the same pixels in fog that cuts nothing",
                               .value = each(seconds[2]),
                               .unit = "ms",
                               .peer = "the same pixels in clear air",
                               .peerValue = each(seconds[1]),
                               .peerFrom = "run"}));
  glBindVertexArray(0);
  glDeleteVertexArrays(1, &array);
  for (const unsigned program : {byVertex, byTexel, inFog, plain}) glDeleteProgram(program);

  // A minute at 600 kt, sixty frames a second.
  constexpr double kPostM = 30.9, kSpeed = 600 * 1852.0 / 3600 / 60;
  const std::uint64_t before = texture.bytesUploaded();
  std::uint64_t most = 0;
  const int frames = report.quick() ? 600 : 3600;
  double longest = 0, all = 0;
  for (int frame = 0; frame < frames; ++frame) {
    const std::uint64_t had = texture.bytesUploaded();
    const double start = monotonicSeconds();
    texture.update(middle - 500 + frame * kSpeed / kPostM, middle, true, 0);
    const double took = monotonicSeconds() - start;
    longest = std::max(longest, took), all += took;
    most = std::max(most, texture.bytesUploaded() - had);
  }
  report.add({.id = "ground.upload",
              .what = "uploaded a frame at 600 kt and 60 frames a second, 30 m texels",
              .value = static_cast<double>(texture.bytesUploaded() - before) / frames,
              .unit = "bytes"});
  report.add({.id = "ground.upload_most",
              .what = "in one frame of them, without a budget",
              .value = static_cast<double>(most),
              .unit = "bytes"});
  report.add({.id = "ground.update",
              .what = "a frame's share of keeping the texture up, tiles read as well",
              .value = all / frames * 1e3,
              .unit = "ms"});
  report.add({.id = "ground.update_longest",
              .what = "the longest of them, waiting for tiles",
              .value = longest * 1e3,
              .unit = "ms"});
}

int main(int argc, char** argv) {
  Report report(argc, argv);
  const Land land(report.quick() ? 2049 : 4097);
  measureBuilding(report, land);
  const auto ground = test::buildAndOpenGround(land.sources());
  if (ground) measureDrawing(report, *ground);
  return report.finish();
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  return trimtab::bench::main(argc, argv);
}
