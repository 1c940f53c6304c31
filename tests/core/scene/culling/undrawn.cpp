#include "undrawn.h"

#include <dlfcn.h>

#include <initializer_list>

#include "core/scene/gl/gl_api.h"

namespace trimtab::test {
namespace {

int undrawnWidth = 0, undrawnHeight = 0;
unsigned long undrawnCalls = 0;

bool leftOut() {
  if (undrawnWidth == 0) return false;
  GLint viewport[4] = {};
  glGetIntegerv(GL_VIEWPORT, viewport);
  // The picture's, or its guard band's.
  for (const int times : {1, 2, 4})
    if (viewport[2] == times * undrawnWidth && viewport[3] == times * undrawnHeight) return true;
  return false;
}

bool meshLeftOut() {
  const bool left = leftOut();
  undrawnCalls += left;
  return left;
}

template <class Function>
Function* real(const char* name, Function*) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

Undrawn::Undrawn(int widthPx, int heightPx) {
  undrawnWidth = widthPx;
  undrawnHeight = heightPx;
}
Undrawn::~Undrawn() {
  undrawnWidth = undrawnHeight = 0;
}
unsigned long Undrawn::calls() {
  return undrawnCalls;
}

}  // namespace trimtab::test

using trimtab::test::leftOut;
using trimtab::test::meshLeftOut;
using trimtab::test::real;

extern "C" {

void GLAPIENTRY glMultiDrawElementsBaseVertex(GLenum mode, const GLsizei* count, GLenum type,
                                              const void* const* indices, GLsizei draws,
                                              const GLint* baseVertex) {
  static const auto draw = real("glMultiDrawElementsBaseVertex", &glMultiDrawElementsBaseVertex);
  if (!meshLeftOut()) draw(mode, count, type, indices, draws, baseVertex);
}

void GLAPIENTRY glMultiDrawElementsIndirect(GLenum mode, GLenum type, const void* commands, GLsizei draws,
                                            GLsizei stride) {
  static const auto draw = real("glMultiDrawElementsIndirect", &glMultiDrawElementsIndirect);
  if (!meshLeftOut()) draw(mode, type, commands, draws, stride);
}

void GLAPIENTRY glDrawElementsInstancedBaseVertexBaseInstance(GLenum mode, GLsizei count, GLenum type,
                                                              const void* indices, GLsizei instances,
                                                              GLint baseVertex, GLuint baseInstance) {
  static const auto draw =
      real("glDrawElementsInstancedBaseVertexBaseInstance", &glDrawElementsInstancedBaseVertexBaseInstance);
  if (!meshLeftOut()) draw(mode, count, type, indices, instances, baseVertex, baseInstance);
}

void GLAPIENTRY glDrawElementsBaseVertex(GLenum mode, GLsizei count, GLenum type, const void* indices,
                                         GLint baseVertex) {
  static const auto draw = real("glDrawElementsBaseVertex", &glDrawElementsBaseVertex);
  if (!meshLeftOut()) draw(mode, count, type, indices, baseVertex);
}

void GLAPIENTRY glDrawArrays(GLenum mode, GLint first, GLsizei count) {
  static const auto draw = real("glDrawArrays", &glDrawArrays);
  if (!leftOut()) draw(mode, first, count);
}

}  // extern "C"
