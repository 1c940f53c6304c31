#include "gl_program.h"

#include <algorithm>
#include <cstdio>

#include "gl_api.h"

namespace trimtab::scene {
namespace {

void setUniform(GLint at, int v) {
  glUniform1i(at, v);
}
void setUniform(GLint at, float v) {
  glUniform1f(at, v);
}
void setUniform(GLint at, const std::array<int, 2>& v) {
  glUniform2iv(at, 1, v.data());
}
void setUniform(GLint at, const std::array<int, 3>& v) {
  glUniform3iv(at, 1, v.data());
}
void setUniform(GLint at, const std::array<float, 2>& v) {
  glUniform2fv(at, 1, v.data());
}
void setUniform(GLint at, const std::array<float, 3>& v) {
  glUniform3fv(at, 1, v.data());
}
void setUniform(GLint at, const std::array<float, 4>& v) {
  glUniform4fv(at, 1, v.data());
}

}  // namespace

unsigned makeGlProgram(const std::string& vertex, const std::string& fragment) {
  const unsigned program = glCreateProgram();
  for (const auto& [kind, text] :
       {std::pair{GL_VERTEX_SHADER, vertex.c_str()}, std::pair{GL_FRAGMENT_SHADER, fragment.c_str()}}) {
    const unsigned shader = glCreateShader(static_cast<GLenum>(kind));
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);
  }
  constexpr std::array kAttributes{"vertexPosition", "vertexNormal", "vertexPost", "vertexColour"};
  for (std::size_t i = 0; i < kAttributes.size(); ++i)
    glBindAttribLocation(program, static_cast<GLuint>(i), kAttributes[i]);
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked != 0) return program;
  std::array<char, 1024> log{};
  glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
  std::fprintf(stderr, "trimtab: a shader of this program is refused by the driver: %s\n", log.data());
  glDeleteProgram(program);
  return 0;
}

void Uniforms::set(const char* name, const Value& value) {
  const auto found =
      std::find_if(values_.begin(), values_.end(), [name](const auto& known) { return known.first == name; });
  if (found != values_.end())
    found->second = value;
  else
    values_.emplace_back(name, value);
}

GlProgram::GlProgram(const std::string& vertex, const std::string& fragment)
    : id_(makeGlProgram(vertex, fragment)) {}

GlProgram::~GlProgram() {
  glDeleteProgram(id_);
}

void GlProgram::use() const {
  glUseProgram(id_);
}

void GlProgram::set(const Uniforms& uniforms) {
  for (const auto& [name, value] : uniforms.all()) {
    const auto [known, isNew] = locations_.try_emplace(name, -1);
    if (isNew) known->second = glGetUniformLocation(id_, name);
    if (known->second >= 0) std::visit([at = known->second](const auto& v) { setUniform(at, v); }, value);
  }
}

}  // namespace trimtab::scene
