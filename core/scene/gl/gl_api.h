#pragma once

// OpenGL 4.5 by prototypes: libOpenGL exports them all and dispatches to whichever context is current (EGL or
// GLX).
#ifndef GL_GLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES 1
#endif
#include <GL/gl.h>
#include <GL/glext.h>
