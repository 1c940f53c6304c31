#include "symbology_pass.h"

#include <cmath>
#include <cstddef>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_program.h"
#include "core/scene/shaders/shaders.h"

namespace trimtab::scene {
namespace {

constexpr std::array<std::uint8_t, 4> kDark{0, 16, 8, 255}, kBright{235, 240, 235, 255};

std::array<std::uint8_t, 4> opaque(std::array<std::uint8_t, 3> rgb) {
  return {rgb[0], rgb[1], rgb[2], 255};
}

}  // namespace

SymbologyPass::SymbologyPass()
    : program_(makeGlProgram(shaderText("symbology.vert.glsl"), shaderText("symbology.frag.glsl"))) {
  if (program_ == 0) return;
  sizeUniform_ = glGetUniformLocation(program_, "size");
  glGenVertexArrays(1, &vertexArray_);
  glGenBuffers(1, &buffer_);
  glBindVertexArray(vertexArray_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  constexpr GLsizei kStride = sizeof(Vertex);
  const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, kStride, at(offsetof(Vertex, x)));
  glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, kStride, at(offsetof(Vertex, along)));
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride, at(offsetof(Vertex, rgba)));
  for (const GLuint attribute : {0u, 1u, 2u}) glEnableVertexAttribArray(attribute);
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

SymbologyPass::~SymbologyPass() {
  glDeleteBuffers(1, &buffer_);
  glDeleteVertexArrays(1, &vertexArray_);
  if (program_ != 0) glDeleteProgram(program_);
}

void SymbologyPass::add(const SymbolStroke& s, float halfWidth, std::array<std::uint8_t, 4> rgba) {
  const float dx = s.x1 - s.x0, dy = s.y1 - s.y0, length = std::hypot(dx, dy);
  const float ux = length > 0 ? dx / length : 1, uy = length > 0 ? dy / length : 0;
  const float reach = halfWidth + 1;  // the feather's half pixel, and that of the pixel's centre
  const auto vertex = [&](float along, float across) {
    return Vertex{s.x0 + ux * along - uy * across,
                  s.y0 + uy * along + ux * across,
                  along,
                  across,
                  length,
                  halfWidth,
                  {rgba[0], rgba[1], rgba[2], rgba[3]}};
  };
  const Vertex a = vertex(-reach, -reach), b = vertex(length + reach, -reach),
               c = vertex(length + reach, reach), d = vertex(-reach, reach);
  vertices_.insert(vertices_.end(), {a, b, c, a, c, d});
}

void SymbologyPass::add(const HostMark& m) {
  if (m.halfWidth != HostMark::kFilled)
    return add(SymbolStroke{m.x[0], m.y[0], m.x[1], m.y[1], Symbol::host}, m.halfWidth, m.rgba);
  // All of the mark lies within the width of a stroke of no length, so that it is covered whole.
  constexpr float kWhole = 1e6F;
  for (int i = 0; i < 3; ++i)
    vertices_.push_back({m.x[i], m.y[i], 0, 0, 0, kWhole, {m.rgba[0], m.rgba[1], m.rgba[2], m.rgba[3]}});
}

void SymbologyPass::rebuild() {
  drawSymbology(*shown_, view_, drawing_);
  vertices_.clear();
  const SymbologySetup& setup = shown_->setup;
  const float half = static_cast<float>(0.5 * setup.general.lineWidth.value());
  const float rim = half + static_cast<float>(setup.general.outline.value());
  // Symbol by symbol, the rims below all of its lines: so a symbol that is taken away uncovers only what it
  // hid.
  const auto& strokes = drawing_.strokes;
  for (std::size_t from = 0; from < strokes.size();) {
    const SymbolColour colour = setup.element[static_cast<std::size_t>(strokes[from].symbol)].colour;
    std::size_t to = from;
    while (to < strokes.size() && strokes[to].symbol == strokes[from].symbol) ++to;
    if (rim > half)
      for (std::size_t i = from; i < to; ++i)
        add(strokes[i], rim, colour == SymbolColour::black ? kBright : kDark);
    for (std::size_t i = from; i < to; ++i) add(strokes[i], half, opaque(symbolColour(colour)));
    from = to;
  }
  for (const HostMark& mark : drawing_.marks) add(mark);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices_.size() * sizeof(Vertex)), vertices_.data(),
               GL_DYNAMIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

bool SymbologyPass::draw(const SymbologyRequest& request, const ViewShape& view, bool anew) {
  if (program_ == 0) return false;
  const SymbologyRequest now = quantised(request, view);
  const bool changed = anew || shown_ != now || view_ != view;
  if (changed) {
    shown_ = now;
    view_ = view;
    rebuild();
  }
  if (vertices_.empty()) return changed;
  glViewport(0, 0, view.widthPx, view.heightPx);
  for (const GLenum off : {GL_DEPTH_TEST, GL_CULL_FACE, GL_SCISSOR_TEST}) glDisable(off);
  glEnable(GL_BLEND);
  // The image's alpha is not ours to change: windows are composed by it.
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glUseProgram(program_);
  glUniform2f(sizeUniform_, static_cast<float>(view.widthPx), static_cast<float>(view.heightPx));
  glBindVertexArray(vertexArray_);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices_.size()));
  glBindVertexArray(0);
  glUseProgram(0);
  glDisable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ZERO);
  return changed;
}

}  // namespace trimtab::scene
