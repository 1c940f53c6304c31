#include "osg_state.h"

#include "gl_api.h"

namespace trimtab::scene {

void settle(osg::State& state) {
  for (const GLenum off :
       {GL_BLEND, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_CULL_FACE, GL_DEPTH_TEST, GL_LIGHTING, GL_ALPHA_TEST,
        GL_DEPTH_CLAMP, GL_FRAMEBUFFER_SRGB, GL_VERTEX_PROGRAM_POINT_SIZE}) {
    glDisable(off);
    state.haveAppliedMode(off, false);
  }
  state.dirtyAllAttributes();
  state.dirtyAllVertexArrays();
  state.setLastAppliedProgramObject(nullptr);
}

}  // namespace trimtab::scene
