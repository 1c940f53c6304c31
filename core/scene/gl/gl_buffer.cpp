#include "gl_buffer.h"

#include <limits>

#include "gl_api.h"

namespace trimtab::scene {
namespace {

std::size_t mostBytes = std::numeric_limits<std::size_t>::max();

}  // namespace

ScarceMemory::ScarceMemory(std::size_t most) : before_(mostBytes) {
  mostBytes = most;
}

ScarceMemory::~ScarceMemory() {
  mostBytes = before_;
}

bool growBuffer(unsigned& buffer, std::size_t before, std::size_t after) {
  if (after > mostBytes) return false;
  // Errors of before are not this one's; a lost context has no end of them.
  for (int i = 0; i < 8 && glGetError() != GL_NO_ERROR; ++i) {
  }
  GLuint larger = 0;
  glGenBuffers(1, &larger);
  glBindBuffer(GL_COPY_WRITE_BUFFER, larger);
  // It is written in parts for as long as it lives. As a GL_STATIC_DRAW buffer of glBufferData it lost some of
  // them on an NVIDIA H200 with driver 580.159, and patches had holes.
  glBufferStorage(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(after), nullptr, GL_DYNAMIC_STORAGE_BIT);
  if (glGetError() != GL_NO_ERROR) {
    glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
    glDeleteBuffers(1, &larger);
    return false;
  }
  if (buffer != 0) {
    glBindBuffer(GL_COPY_READ_BUFFER, buffer);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, static_cast<GLsizeiptr>(before));
    glBindBuffer(GL_COPY_READ_BUFFER, 0);
    glDeleteBuffers(1, &buffer);
  }
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
  buffer = larger;
  return true;
}

void uploadBuffer(unsigned buffer, const void* data, std::size_t bytes) {
  glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_DYNAMIC_DRAW);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

void uploadPart(unsigned buffer, std::size_t offset, const void* data, std::size_t bytes) {
  glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
  glBufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

void attachBuffer(unsigned texture, unsigned format, unsigned buffer) {
  glBindTexture(GL_TEXTURE_BUFFER, texture);
  glTexBuffer(GL_TEXTURE_BUFFER, format, buffer);
  glBindTexture(GL_TEXTURE_BUFFER, 0);
}

}  // namespace trimtab::scene
