#include "gl_program.h"

#include <array>
#include <cstdio>

#include "gl_api.h"

namespace trimtab::scene {

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

}  // namespace trimtab::scene
