#include "scene_programs.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/scene/gl/gl_api.h"
#include "core/scene/shaders/light.h"
#include "core/scene/shaders/shaders.h"

namespace trimtab::scene {
namespace {

/// Texels a side of the pyramid's level that a box is held against: more see more hidden, and cost more.
constexpr int kTestedSpan = 8;

constexpr std::array kDefineNames{"IN_WEATHER", "AIR_CUT", "AIR_LAYER", "GROUND_TEXTURE",
                                  "TINTED",     "ON_GRID", "WIRE"};

/// Returns the defines that a shader and what it includes name in `#pragma import_defines(...)`.
unsigned importedBy(const std::string& shader) {
  constexpr std::string_view kImport = "#pragma import_defines(";
  unsigned imported = 0;
  for (std::size_t at = 0; (at = shader.find(kImport, at)) != std::string::npos; ++at) {
    const std::string_view names = std::string_view(shader).substr(at, shader.find(')', at) - at);
    for (std::size_t i = 0; i < kDefineNames.size(); ++i)
      if (names.find(kDefineNames[i]) != std::string_view::npos) imported |= 1u << i;
  }
  return imported;
}

std::array<float, 3> toFloats(Vec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Gives the eye in whole units of 16 m and a rest of at most 8 m: relative_position.glsl says why.
void setEye(Uniforms& uniforms, Vec3 p) {
  const auto whole = [](double x) { return static_cast<int>(std::lround(x / 16)); };
  const int x = whole(p.x), y = whole(p.y), z = whole(p.z);
  uniforms.set("eyeHi", std::array{x, y, z});
  uniforms.set("eyeLo", toFloats(p - Vec3{16.0 * x, 16.0 * y, 16.0 * z}));
}

/// Returns how far the corner of a pixel is from its centre, at distance 1.
double halfDiagonal(const ViewShape& v, int widthPx, int heightPx) {
  return 0.5 * std::hypot((v.right - v.left) / widthPx, (v.top - v.bottom) / heightPx);
}

/// Sets the matrices of GL for an eye at the origin.
void loadMatrices(const Mat3& axes, const ViewShape& shape) {
  glMatrixMode(GL_PROJECTION);
  glLoadMatrixd(projectionMatrix(shape).data());
  glMatrixMode(GL_MODELVIEW);
  glLoadMatrixd(eyeMatrix(axes).data());
}

void setEnabled(GLenum what, bool on) {
  if (on)
    glEnable(what);
  else
    glDisable(what);
}

}  // namespace

ShaderVariants::ShaderVariants(const char* vertexName, const char* fragmentName,
                               std::vector<const char*> fixed)
    : vertexName_(vertexName),
      fragmentName_(fragmentName),
      fixed_(std::move(fixed)),
      vertexImports_(importedBy(shaderText(vertexName, fixed_))),
      fragmentImports_(importedBy(shaderText(fragmentName, fixed_))) {}

GlProgram& ShaderVariants::with(unsigned defines) {
  const unsigned key = defines & (vertexImports_ | fragmentImports_);
  if (const auto known = variants_.find(key); known != variants_.end()) return known->second;
  const auto text = [&](const char* name, unsigned imports) {
    std::vector<const char*> names = fixed_;
    for (std::size_t i = 0; i < kDefineNames.size(); ++i)
      if (key & imports & 1u << i) names.push_back(kDefineNames[i]);
    return shaderText(name, names);
  };
  return variants_.try_emplace(key, text(vertexName_, vertexImports_), text(fragmentName_, fragmentImports_))
      .first->second;
}

// In the order of SceneShaders.
ScenePrograms::ScenePrograms()
    : shaders_{{{"terrain.vert.glsl", "terrain.frag.glsl"},
                {"patch.vert.glsl", "patch.frag.glsl"},
                {"terrain.vert.glsl", "terrain.frag.glsl", {"STATIC_TREE"}},
                {"terrain.vert.glsl", "node.frag.glsl", {"NODE_IDS"}},
                {"patch.vert.glsl", "node.frag.glsl", {"NODE_IDS"}},
                {"terrain.vert.glsl", "node.frag.glsl", {"STATIC_TREE", "NODE_IDS"}},
                {"object.vert.glsl", "object.frag.glsl"},
                {"object.vert.glsl", "object.frag.glsl", {"TEXTURED"}},
                {"object.vert.glsl", "object.frag.glsl", {"NODE_IDS"}},
                {"object.vert.glsl", "object.frag.glsl", {"TEXTURED", "NODE_IDS"}},
                {"light_point.vert.glsl", "light_point.frag.glsl"},
                {"tree_flat.vert.glsl", "line.frag.glsl"},
                {"line.vert.glsl", "line.frag.glsl"},
                {"screen.vert.glsl", "sky.frag.glsl"},
                {"occluder.vert.glsl", "occluder.frag.glsl"},
                {"screen.vert.glsl", "depth_reduce.frag.glsl"},
                {"screen.vert.glsl", "occlusion_test.frag.glsl"}}} {
  uniforms_.set("sun", toFloats(normalized(kTowardsSun)));
  uniforms_.set("slots", kSlotUnit);
  uniforms_.set("tints", kTintUnit);
  ofDepth_.set("source", kDepthUnit);
  ofDepth_.set("depthMap", kDepthUnit);
  ofDepth_.set("pyramid", kPyramidUnit);
  ofDepth_.set("parts", kPartUnit);
  ofDepth_.set("tested", kTestedUnit);
  ofDepth_.set("span", kTestedSpan);
}

void ScenePrograms::begin(const SceneView& view) {
  view_ = view;
  setEye(uniforms_, view.eye.position);
  uniforms_.set("upInEye", toFloats(view.eye.axes * view.up));
  uniforms_.set("tangents",
                std::array{static_cast<float>(view.shape.left), static_cast<float>(view.shape.right),
                           static_cast<float>(view.shape.bottom), static_cast<float>(view.shape.top)});
  uniforms_.set("dip", static_cast<float>(view.horizonDip));
  uniforms_.set("textureSquares", static_cast<int>(view.textureSquares));
  uniforms_.set("inGuardBand", 1.0f / static_cast<float>(view.guardBand));
  defines_ = (view.groundTexture ? ShaderVariants::ground_texture : 0u) |
             (view.tinted ? ShaderVariants::tinted : 0u) |
             (view.gridStepsPerPixel > 0 ? ShaderVariants::on_grid : 0u);
  if (view.gridStepsPerPixel > 0) {
    const double steps = 0.5 * view.guardBand * view.gridStepsPerPixel;
    uniforms_.set("gridSteps", std::array{static_cast<float>(steps * view.shape.widthPx),
                                          static_cast<float>(steps * view.shape.heightPx)});
  }
  setAir(view);
  if (view.depth) setDepthView(*view.depth, view.shape);

  for (const GLenum off : {GL_BLEND, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_CULL_FACE, GL_LIGHTING,
                           GL_ALPHA_TEST, GL_DEPTH_CLAMP, GL_FRAMEBUFFER_SRGB, GL_VERTEX_PROGRAM_POINT_SIZE})
    glDisable(off);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glFrontFace(GL_CCW);
  glCullFace(GL_BACK);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthRange(0, 1);
}

void ScenePrograms::clear(bool colour) {
  glViewport(0, 0, view_.shape.widthPx, view_.shape.heightPx);
  glDepthMask(GL_TRUE);
  glClearDepth(0);
  if (view_.sky)
    glClearColor(kHaze[0], kHaze[1], kHaze[2], 1);
  else
    glClearColor(1, 0, 1, 1);
  glClear(colour ? GL_DEPTH_BUFFER_BIT | GL_COLOR_BUFFER_BIT : GL_DEPTH_BUFFER_BIT);
}

unsigned ScenePrograms::use(SceneShaders shaders, bool wire) {
  const bool ofMap = shaders >= SceneShaders::occluders, sky = shaders == SceneShaders::sky,
             surface = shaders <= SceneShaders::tree_numbers && !wire;
  GlProgram& program =
      shaders_[static_cast<std::size_t>(shaders)].with(defines_ | (wire ? ShaderVariants::wire : 0u));
  program.use();
  program.set(uniforms_);
  if (ofMap) program.set(ofDepth_);
  if (shaders == SceneShaders::occluders)
    loadMatrices(view_.depth->eye.axes, view_.shape);
  else if (!ofMap && !sky)
    loadMatrices(view_.eye.axes, view_.shape);
  setEnabled(GL_DEPTH_TEST, !ofMap || shaders == SceneShaders::occluders);
  // Where nothing was drawn, depth still is 0, infinitely far: there the sky passes.
  glDepthFunc(sky ? GL_GEQUAL : GL_GREATER);
  glDepthMask(sky ? GL_FALSE : GL_TRUE);
  // Far sides of mountains hide next to nothing that their near sides do not: without them the map's pass
  // costs less than the few more tiles that are drawn.
  setEnabled(GL_CULL_FACE, shaders == SceneShaders::occluders || (surface && view_.oneSided));
  return program.id();
}

/// Clear weather has shaders of its own, which know nothing of fog, and so have fog without a cut and fog
/// that is not a layer: nothing is paid for what the air is not.
void ScenePrograms::setAir(const SceneView& view) {
  const Air& air = view.air;
  if (air.clear) return;
  defines_ |= ShaderVariants::in_weather | (air.cutM < Air::kFarthest ? ShaderVariants::air_cut : 0u) |
              (air.layered ? ShaderVariants::air_layer : 0u);
  uniforms_.set("fog", air.colour);
  uniforms_.set("air", std::array{air.extinction, air.cutM, air.fadePerM});
  uniforms_.set("fogDepth",
                std::array{static_cast<float>(kFogTopM), static_cast<float>(std::max(view.heightM, 1.0))});
  if (!air.layered) return;
  const LayerRoots roots = layerRoots(view.heightM, double{air.topM});
  uniforms_.set("upInFrame", toFloats(view.up));
  uniforms_.set("layer", std::array{static_cast<float>(roots.fromCentre), static_cast<float>(roots.top)});
  uniforms_.set("lowest", static_cast<float>(roots.lowest));
}

void ScenePrograms::setDepthView(const DepthView& depth, const ViewShape& shape) {
  setEye(ofDepth_, depth.eye.position);
  ofDepth_.set("right", toFloats(depth.eye.axes.row[0]));
  ofDepth_.set("up", toFloats(depth.eye.axes.row[1]));
  ofDepth_.set("forward", toFloats(-depth.eye.axes.row[2]));
  ofDepth_.set("nearM", static_cast<float>(shape.nearM));
  ofDepth_.set("mapSize", std::array{depth.widthPx, depth.heightPx});
  ofDepth_.set("levels", depth.levels);
  ofDepth_.set("count", depth.tiles);
  // Rasterisers snap vertices to a fraction of a pixel, in the image and in the map: a tenth covers both.
  const double texel = halfDiagonal(shape, depth.widthPx, depth.heightPx);
  const double pixel = halfDiagonal(shape, shape.widthPx, shape.heightPx);
  ofDepth_.set("texelReach", static_cast<float>(texel * 1.04 + pixel * 0.1));
  const auto pad = [](int map, int image) {
    return 0.05f + 0.1f * static_cast<float>(map) / static_cast<float>(image);
  };
  ofDepth_.set("pad", std::array{pad(depth.widthPx, shape.widthPx), pad(depth.heightPx, shape.heightPx)});
  ofDepth_.set("loweringScale", static_cast<float>(depth.loweringScale));
  ofDepth_.set("shift", static_cast<float>(depth.shiftTexels));
}

}  // namespace trimtab::scene
