#include "trimtab/scene/gl_objects.h"

#include "gl_api.h"

namespace trimtab::scene {

GlObjects glObjectsOfContext() {
  GlObjects objects;
  for (GLuint name = 1; name <= kNamesAsked; ++name) {
    objects.buffers += glIsBuffer(name) != GL_FALSE;
    objects.textures += glIsTexture(name) != GL_FALSE;
    objects.framebuffers += glIsFramebuffer(name) != GL_FALSE;
    objects.renderbuffers += glIsRenderbuffer(name) != GL_FALSE;
    objects.vertexArrays += glIsVertexArray(name) != GL_FALSE;
    objects.queries += glIsQuery(name) != GL_FALSE;
    objects.programs += glIsProgram(name) != GL_FALSE;
    objects.shaders += glIsShader(name) != GL_FALSE;
  }
  return objects;
}

}  // namespace trimtab::scene
