#include "draw_oracle.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "core/scene/gl/gl_api.h"

namespace trimtab::bench {
namespace {

using MultiDrawCall = void (*)(GLenum, const GLsizei*, GLenum, const void* const*, GLsizei, const GLint*);

DrawOracle::Impl* oracle = nullptr;

MultiDrawCall multiDraw() {
  static const auto call = reinterpret_cast<MultiDrawCall>(dlsym(RTLD_NEXT, "glMultiDrawElementsBaseVertex"));
  return call;
}

const char* const kOwnerFragment = R"(#version 430 compatibility
uniform int firstTriangle;
out uint owner;
void main() { owner = uint(firstTriangle + gl_PrimitiveID); }
)";

/// The values of all uniforms that both have.
void copyUniforms(GLuint from, GLuint to) {
  GLint count = 0;
  glGetProgramiv(to, GL_ACTIVE_UNIFORMS, &count);
  for (GLint i = 0; i < count; ++i) {
    char name[128];
    GLint size = 0;
    GLenum type = 0;
    glGetActiveUniform(to, static_cast<GLuint>(i), sizeof name, nullptr, &size, &type, name);
    const GLint there = glGetUniformLocation(from, name), here = glGetUniformLocation(to, name);
    if (there < 0 || here < 0) continue;
    const auto floats = [&](auto set) {
      GLfloat v[16];
      glGetUniformfv(from, there, v);
      set(to, here, 1, v);
    };
    const auto integers = [&](auto set) {
      GLint v[16];
      glGetUniformiv(from, there, v);
      set(to, here, 1, v);
    };
    switch (type) {
      case GL_FLOAT:
        floats(glProgramUniform1fv);
        break;
      case GL_FLOAT_VEC2:
        floats(glProgramUniform2fv);
        break;
      case GL_FLOAT_VEC3:
        floats(glProgramUniform3fv);
        break;
      case GL_FLOAT_VEC4:
        floats(glProgramUniform4fv);
        break;
      case GL_INT_VEC2:
        integers(glProgramUniform2iv);
        break;
      case GL_INT_VEC3:
        integers(glProgramUniform3iv);
        break;
      default:
        integers(glProgramUniform1iv);  // samplers too
    }
  }
}

/// The vertex shader of a program, with owners instead of colours.
GLuint ownersProgram(GLuint of) {
  std::array<GLuint, 4> shaders{};
  GLsizei count = 0;
  glGetAttachedShaders(of, static_cast<GLsizei>(shaders.size()), &count, shaders.data());
  const GLuint program = glCreateProgram(), fragment = glCreateShader(GL_FRAGMENT_SHADER);
  glShaderSource(fragment, 1, &kOwnerFragment, nullptr);
  glCompileShader(fragment);
  glAttachShader(program, fragment);
  glDeleteShader(fragment);
  for (GLsizei i = 0; i < count; ++i) {
    GLint type = 0;
    glGetShaderiv(shaders[static_cast<std::size_t>(i)], GL_SHADER_TYPE, &type);
    if (type == GL_VERTEX_SHADER) glAttachShader(program, shaders[static_cast<std::size_t>(i)]);
  }
  for (const char* name : {"vertexPosition", "vertexNormal", "vertexPost", "vertexColour"})
    if (const GLint at = glGetAttribLocation(of, name); at >= 0)
      glBindAttribLocation(program, static_cast<GLuint>(at), name);
  glLinkProgram(program);
  copyUniforms(of, program);
  return program;
}

template <class T>
std::vector<T> readBuffer(GLuint buffer) {
  GLint64 bytes = 0;
  glBindBuffer(GL_COPY_READ_BUFFER, buffer);
  glGetBufferParameteri64v(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &bytes);
  std::vector<T> data(static_cast<std::size_t>(bytes) / sizeof(T));
  glGetBufferSubData(GL_COPY_READ_BUFFER, 0, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data());
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
  return data;
}

}  // namespace

struct DrawOracle::Impl {
  static constexpr GLuint kNone = 0xffffffffu;
  bool learning = false;
  std::size_t calls = 0;  ///< of this picture

  struct Draw {
    GLint baseVertex;
    std::size_t first, count;  ///< of `corners`
  };
  std::vector<std::vector<Draw>> learnt;  ///< by call
  /// What is left of the calls, by how meshes are cut.
  struct Call {
    std::vector<GLsizei> counts;
    std::vector<const void*> offsets;
    std::vector<GLint> baseVertices;
  };
  struct Cut {
    std::vector<Call> calls;
    GLuint indices = 0;
    std::size_t triangles = 0;
  };
  std::map<int, Cut> cuts;
  const Cut* let = nullptr;
  std::vector<std::uint16_t> corners;        ///< three a triangle
  std::vector<std::array<float, 2>> places;  ///< of each triangle's middle, in its mesh's plan
  std::vector<std::uint8_t> owns;            ///< one a triangle

  GLuint framebuffer = 0, owners = 0, depth = 0;
  int width = 0, height = 0;
  std::vector<float> vertices;
  std::size_t stride = 0;
  std::vector<std::uint16_t> elements;

  ~Impl();
  void target(int w, int h);
  void learn(const GLsizei* counts, const void* const* offsets, GLsizei n, const GLint* baseVertices);
  void finishLearning();
  void forget();
  const Cut& cut(int across);
  void blocksOf(const Draw& draw, int across, std::vector<std::vector<std::size_t>>& blocks) const;
  void draw(GLenum mode, const GLsizei* counts, GLenum type, const void* const* offsets, GLsizei n,
            const GLint* baseVertices);
};

DrawOracle::Impl::~Impl() {
  glDeleteFramebuffers(1, &framebuffer);
  for (const GLuint buffer : {owners, depth}) glDeleteRenderbuffers(1, &buffer);
  forget();
}

void DrawOracle::Impl::forget() {
  for (const auto& [across, cut] : cuts) glDeleteBuffers(1, &cut.indices);
  cuts.clear(), learnt.clear(), corners.clear(), places.clear(), owns.clear();
  let = nullptr;
}

void DrawOracle::Impl::target(int w, int h) {
  if (framebuffer == 0) {
    glGenFramebuffers(1, &framebuffer);
    glGenRenderbuffers(1, &owners);
    glGenRenderbuffers(1, &depth);
  }
  if (w == width && h == height) return;
  width = w, height = h;
  GLint before = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  const auto store = [&](GLuint buffer, GLenum format, GLenum place) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorage(GL_RENDERBUFFER, format, w, h);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
  };
  store(owners, GL_R32UI, GL_COLOR_ATTACHMENT0);
  store(depth, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
  glBindRenderbuffer(GL_RENDERBUFFER, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before));
}

/// Draws one call's triangles once more, each as its number.
void DrawOracle::Impl::learn(const GLsizei* counts, const void* const* offsets, GLsizei n,
                             const GLint* baseVertices) {
  GLint program = 0, before = 0, elementBuffer = 0, vertexBuffer = 0, step = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
  glGetIntegerv(GL_ELEMENT_ARRAY_BUFFER_BINDING, &elementBuffer);
  glGetVertexAttribiv(0, GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING, &vertexBuffer);
  glGetVertexAttribiv(0, GL_VERTEX_ATTRIB_ARRAY_STRIDE, &step);
  if (calls == 0) {
    elements = readBuffer<std::uint16_t>(static_cast<GLuint>(elementBuffer));
    vertices = readBuffer<float>(static_cast<GLuint>(vertexBuffer));
    stride = static_cast<std::size_t>(step) / sizeof(float);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  if (calls == 0) {
    const GLuint none[4] = {kNone, 0, 0, 0};
    const GLfloat far = 0;
    glClearBufferuiv(GL_COLOR, 0, none);
    glClearBufferfv(GL_DEPTH, 0, &far);
  }
  const GLuint own = ownersProgram(static_cast<GLuint>(program));
  glUseProgram(own);
  const GLint firstAt = glGetUniformLocation(own, "firstTriangle");
  std::vector<Draw>& draws = learnt.emplace_back();
  for (GLsizei i = 0; i < n; ++i) {
    const auto first = reinterpret_cast<std::uintptr_t>(offsets[i]) / sizeof(std::uint16_t);
    const auto count = static_cast<std::size_t>(counts[i]);
    glUniform1i(firstAt, static_cast<GLint>(corners.size() / 3));
    glDrawElementsBaseVertex(GL_TRIANGLES, counts[i], GL_UNSIGNED_SHORT, offsets[i], baseVertices[i]);
    draws.push_back({baseVertices[i], corners.size(), count});
    for (std::size_t k = 0; k < count; ++k) corners.push_back(elements[first + k]);
    for (std::size_t k = 0; k < count; k += 3) {
      std::array<float, 2> middle{};
      for (std::size_t c = 0; c < 3; ++c) {
        const float* v =
            vertices.data() + (static_cast<std::size_t>(baseVertices[i]) + elements[first + k + c]) * stride;
        middle[0] += v[0] / 3, middle[1] += v[1] / 3;
      }
      places.push_back(middle);
    }
  }
  glUseProgram(static_cast<GLuint>(program));
  glDeleteProgram(own);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before));
}

void DrawOracle::Impl::finishLearning() {
  GLint before = 0;
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &before);
  std::vector<GLuint> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, pixels.data());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(before));
  owns.assign(corners.size() / 3, 0);
  for (const GLuint triangle : pixels)
    if (triangle < owns.size()) owns[triangle] = 1;
  learning = false;
}

const DrawOracle::Impl::Cut& DrawOracle::Impl::cut(int across) {
  const auto [place, isNew] = cuts.try_emplace(across);
  Cut& cut = place->second;
  if (!isNew) return cut;
  std::vector<std::uint16_t> kept;
  std::vector<std::vector<std::size_t>> blocks;
  for (const std::vector<Draw>& draws : learnt) {
    Call& call = cut.calls.emplace_back();
    for (const Draw& draw : draws) {
      const std::size_t before = kept.size();
      blocksOf(draw, across, blocks);
      for (const std::vector<std::size_t>& block : blocks) {
        if (std::none_of(block.begin(), block.end(), [&](std::size_t t) { return owns[t] != 0; })) continue;
        for (const std::size_t t : block)
          if (across > 0 || owns[t] != 0)
            for (std::size_t k = 3 * t; k < 3 * t + 3; ++k) kept.push_back(corners[k]);
      }
      if (kept.size() == before) continue;
      call.counts.push_back(static_cast<GLsizei>(kept.size() - before));
      call.offsets.push_back(reinterpret_cast<const void*>(before * sizeof(std::uint16_t)));
      call.baseVertices.push_back(draw.baseVertex);
    }
  }
  cut.triangles = kept.size() / 3;
  glGenBuffers(1, &cut.indices);
  glBindBuffer(GL_COPY_WRITE_BUFFER, cut.indices);
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(kept.size() * sizeof(std::uint16_t)),
               kept.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
  return cut;
}

/// Triangles of a mesh by squares of its extent.
void DrawOracle::Impl::blocksOf(const Draw& draw, int across,
                                std::vector<std::vector<std::size_t>>& blocks) const {
  const std::size_t first = draw.first / 3, end = first + draw.count / 3,
                    n = static_cast<std::size_t>(std::max(across, 1));
  std::array<float, 2> low{1e30f, 1e30f}, high{-1e30f, -1e30f};
  for (std::size_t t = first; t < end; ++t)
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], places[t][k]);
      high[k] = std::max(high[k], places[t][k]);
    }
  blocks.assign(n * n, {});
  for (std::size_t t = first; t < end; ++t) {
    std::array<std::size_t, 2> at{};
    for (std::size_t k = 0; k < 2; ++k) {
      const float share = (places[t][k] - low[k]) / std::max(high[k] - low[k], 1e-6f);
      at[k] = std::min(static_cast<std::size_t>(static_cast<float>(n) * share), n - 1);
    }
    blocks[at[1] * n + at[0]].push_back(t);
  }
}

void DrawOracle::Impl::draw(GLenum mode, const GLsizei* counts, GLenum type, const void* const* offsets,
                            GLsizei n, const GLint* baseVertices) {
  if (learning) learn(counts, offsets, n, baseVertices);
  const std::size_t number = calls++;
  if (!let || number >= let->calls.size()) return multiDraw()(mode, counts, type, offsets, n, baseVertices);
  const Call& owned = let->calls[number];
  if (owned.counts.empty()) return;
  GLint before = 0;
  glGetIntegerv(GL_ELEMENT_ARRAY_BUFFER_BINDING, &before);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, let->indices);
  multiDraw()(mode, owned.counts.data(), type, owned.offsets.data(),
              static_cast<GLsizei>(owned.counts.size()), owned.baseVertices.data());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLuint>(before));
}

DrawOracle::DrawOracle() : impl_(std::make_unique<Impl>()) {
  oracle = impl_.get();
}

DrawOracle::~DrawOracle() {
  oracle = nullptr;
}

void DrawOracle::learn(int width, int height) {
  impl_->forget();
  impl_->target(width, height);
  impl_->calls = 0;
  impl_->learning = true;
}

void DrawOracle::letAll() {
  if (impl_->learning) impl_->finishLearning();
  impl_->calls = 0;
  impl_->let = nullptr;
}

void DrawOracle::letOwners(int blocksAcross) {
  if (impl_->learning) impl_->finishLearning();
  impl_->calls = 0;
  impl_->let = &impl_->cut(blocksAcross);
}

std::size_t DrawOracle::triangles() const {
  return impl_->corners.size() / 3;
}
std::size_t DrawOracle::drawn(int blocksAcross) const {
  return impl_->cuts.at(blocksAcross).triangles;
}

}  // namespace trimtab::bench

/// Takes the place of GL's own, which it calls.
extern "C" void glMultiDrawElementsBaseVertex(GLenum mode, const GLsizei* count, GLenum type,
                                              const void* const* indices, GLsizei drawcount,
                                              const GLint* basevertex) {
  using namespace trimtab::bench;
  if (oracle)
    oracle->draw(mode, count, type, indices, drawcount, basevertex);
  else
    multiDraw()(mode, count, type, indices, drawcount, basevertex);
}
