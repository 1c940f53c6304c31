#include "trimtab/scene/gl_objects.h"
#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_buffer.h"
#include "tests/core/scene/scene_test.h"
#include "tests/core/scene/terrain/patched_terrain.h"

namespace trimtab {
namespace {

/// What a context holds after much has changed in it.
class GlObjects : public test::SceneTest {
 protected:
  scene::GlObjects count() {
    offscreen->makeCurrent();
    return scene::glObjectsOfContext();
  }
};

TEST_F(GlObjects, areCountedByKind) {
  const scene::GlObjects before = count();
  GLuint buffer = 0, texture = 0, query = 0;
  glCreateBuffers(1, &buffer);
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  glCreateQueries(GL_TIME_ELAPSED, 1, &query);
  const GLuint program = glCreateProgram(), shader = glCreateShader(GL_VERTEX_SHADER);
  const scene::GlObjects with = count();
  EXPECT_EQ(with.buffers, before.buffers + 1);
  EXPECT_EQ(with.textures, before.textures + 1);
  EXPECT_EQ(with.queries, before.queries + 1);
  EXPECT_EQ(with.programs, before.programs + 1);
  EXPECT_EQ(with.shaders, before.shaders + 1);
  EXPECT_EQ(with.total(), before.total() + 5);
  glDeleteBuffers(1, &buffer);
  glDeleteTextures(1, &texture);
  glDeleteQueries(1, &query);
  glDeleteProgram(program);
  glDeleteShader(shader);
  EXPECT_EQ(count().total(), before.total());
  EXPECT_EQ(glGetError(), GL_NO_ERROR);
}

TEST_F(GlObjects, doNotGrowWhenTerrainFormAndCullingChange) {
  const std::shared_ptr<const terrain::Database> terrains[] = {test::syntheticMountains(),
                                                               test::patchedMountains(true)};
  const auto round = [&] {
    for (const auto& terrain : terrains) {
      use(terrain);
      for (const TerrainForm form : {TerrainForm::tiles, TerrainForm::patches})
        for (const CullingCase method : {CullingCase::view_frustum, CullingCase::proposed}) {
          auto r = request(over(0.5, 0.5, 300), {Degrees{30}, Degrees{-8}, Degrees{0}});
          r.terrain.form = form;
          r.cullingCase = method;
          picture(r);
        }
    }
    return count().total();
  };
  const std::size_t first = round();
  EXPECT_GT(first, 10u);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(round(), first) << i;
}

TEST_F(GlObjects, areGoneWhenTheRendererReleasesThem) {
  offscreen->makeCurrent();
  renderer.release();
  const std::size_t before = count().total();
  renderer.initialize();
  use(test::patchedMountains(true));
  picture(request(over(0.5, 0.5, 300), {Degrees{30}, Degrees{-8}, Degrees{0}}));
  EXPECT_GT(count().total(), before);
  renderer.release();
  EXPECT_EQ(count().total(), before);
}

}  // namespace
}  // namespace trimtab
