#include "core/scene/terrain/patches/patch_layer.h"

#include <map>
#include <random>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_program.h"
#include "core/scene/gl/range_allocator.h"
#include "tests/core/scene/scene_test.h"
#include "tests/core/terrain/bake/slow_patches.h"
#include "trimtab/terrain/format/patch_layout.h"

namespace trimtab {
namespace {

TEST(RangeAllocator, givesPlacesThatDoNotOverlapAndStaysDense) {
  scene::RangeAllocator places;
  places.growTo(1000);
  std::mt19937 random(1);
  std::map<std::uint32_t, std::uint32_t> taken;
  std::uint32_t used = 0;
  for (int step = 0; step < 200'000; ++step) {
    const auto units = 1 + static_cast<std::uint32_t>(random() % 24);
    // What is held stays at about 600 of 1,000.
    if (used + units < 600) {
      const auto first = places.take(units);
      ASSERT_TRUE(first) << "there is room at step " << step;
      const auto after = taken.lower_bound(*first);
      if (after != taken.end()) {
        ASSERT_LE(*first + units, after->first);
      }
      if (after != taken.begin()) {
        const auto before = std::prev(after);
        ASSERT_LE(before->first + before->second, *first);
      }
      taken.emplace(*first, units);
      used += units;
    } else {
      const auto gone = std::next(taken.begin(), static_cast<std::ptrdiff_t>(random() % taken.size()));
      places.give(gone->first, gone->second);
      used -= gone->second;
      taken.erase(gone);
    }
    ASSERT_EQ(places.used(), used);
  }
  for (const auto& [first, units] : taken) places.give(first, units);
  EXPECT_EQ(places.take(1000), 0u) << "all of it is one again";
  EXPECT_FALSE(places.take(1));
  places.growTo(1001);
  EXPECT_EQ(places.take(1), 1000u);
}

class PatchLayer : public test::SceneTest, public testing::WithParamInterface<std::uint32_t> {
 protected:
  /// Every patch seen from above, each pixel its number and variant's own place: what is drawn, exactly.
  std::vector<std::uint32_t> drawn(scene::PatchLayer& layer, const std::vector<TileDraw>& patches) {
    if (program_ == 0)
      program_ = scene::makeGlProgram(R"(#version 430 compatibility
layout(location = 0) in vec3 position;
layout(location = 2) in vec2 post;
uniform isamplerBuffer slots;
uniform vec2 size;
flat out uvec4 who;
void main() {
  ivec4 slot = texelFetch(slots, gl_VertexID / 32 * 2);
  ivec2 square = texelFetch(slots, gl_VertexID / 32 * 2 + 1).xy;
  who = uvec4(uint(slot.w) + 1u, floatBitsToUint(position.x + float(slot.x) * 16.0),
              floatBitsToUint(position.y + float(slot.y) * 16.0), floatBitsToUint(position.z + float(slot.z) * 16.0));
  gl_Position = vec4((vec2(square) + post) / size * 2.0 - 1.0, 0.0, 1.0);
})",
                                      R"(#version 430 compatibility
flat in uvec4 who;
out uvec4 is;
void main() { is = who; })");
    EXPECT_NE(program_, 0u);
    unsigned frame = 0, texture = 0;
    glGenFramebuffers(1, &frame);
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32UI, kSide, kSide, 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, nullptr);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glViewport(0, 0, kSide, kSide);
    glDisable(GL_DEPTH_TEST);
    const GLuint none[4] = {};
    glClearBufferuiv(GL_COLOR, 0, none);
    glUseProgram(program_);
    glUniform1i(glGetUniformLocation(program_, "slots"), 0);
    glUniform2f(glGetUniformLocation(program_, "size"), static_cast<float>(terrain_->index().columns - 1),
                static_cast<float>(terrain_->index().rows - 1));
    glBindTexture(GL_TEXTURE_BUFFER, layer.slotTexture());
    layer.draw(patches);
    std::vector<std::uint32_t> pixels(kSide * kSide * 4);
    glReadPixels(0, 0, kSide, kSide, GL_RGBA_INTEGER, GL_UNSIGNED_INT, pixels.data());
    glBindTexture(GL_TEXTURE_BUFFER, 0);
    glUseProgram(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &frame);
    glDeleteTextures(1, &texture);
    return pixels;
  }
  std::vector<TileDraw> ofPage(std::uint32_t page, std::uint8_t variant) const {
    const PatchIndex::Page& p = terrain_->index().pages[page];
    std::vector<TileDraw> patches;
    for (std::uint32_t i = 0; i < p.patches; ++i)
      patches.push_back({.node = p.firstPatch + i, .variant = PatchVariant(variant)});
    return patches;
  }

  static constexpr int kSide = 256;
  unsigned program_ = 0;
  std::shared_ptr<const terrain::PatchTerrain> terrain_ = test::smallPatches(1025, 1025, GetParam());
};
INSTANTIATE_TEST_SUITE_P(LeafCells, PatchLayer,
                         testing::Values(terrain::kFineLeafCells, terrain::kCoarseLeafCells));

TEST_P(PatchLayer, drawsThePagesThatAreThereWhateverCameAndWent) {
  const PatchIndex& index = terrain_->index();
  ASSERT_GT(index.pages.size(), 20u);
  std::vector<terrain::PatchPage> pages;
  for (std::uint32_t page = 0; page < index.pages.size(); ++page)
    pages.push_back(terrain_->readPage(page).value());
  // Each page as a layer of its own draws it.
  std::vector<std::vector<std::uint32_t>> alone;
  for (const terrain::PatchPage& page : pages) {
    scene::PatchLayer layer;
    layer.setTerrain(&index);
    layer.add(page);
    alone.push_back(drawn(layer, ofPage(page.page, static_cast<std::uint8_t>(page.page % index.variants()))));
    EXPECT_NE(alone.back(), std::vector<std::uint32_t>(alone.back().size())) << "page " << page.page;
  }
  scene::PatchLayer layer;
  layer.setTerrain(&index);
  std::mt19937 random(2);
  std::vector<std::uint8_t> there(pages.size());
  std::size_t settled = 0;
  for (int step = 0; step < 3000; ++step) {
    const auto page = static_cast<std::uint32_t>(random() % pages.size());
    if (there[page]) {
      layer.drop(page);
    } else if (static_cast<std::size_t>(std::count(there.begin(), there.end(), 1)) < pages.size() / 3) {
      layer.add(pages[page]);
      layer.add(pages[page]);
    } else {
      continue;
    }
    there[page] = !there[page];
    ASSERT_EQ(layer.has(page), there[page] == 1);
    if (step >= 1000 && settled == 0) settled = layer.reservedBytes();
    if (step % 100 != 0) continue;
    for (std::uint32_t p = 0; p < pages.size(); ++p)
      if (p % 5 == static_cast<std::uint32_t>(step / 100) % 5) {
        const auto now = drawn(layer, ofPage(p, static_cast<std::uint8_t>(p % index.variants())));
        ASSERT_EQ(now, there[p] ? alone[p] : std::vector<std::uint32_t>(now.size()))
            << "page " << p << " at step " << step;
      }
  }
  EXPECT_LE(layer.reservedBytes(), settled + settled / 2) << "coming and going does not cost room";
  for (std::uint32_t p = 0; p < pages.size(); ++p)
    if (there[p]) layer.drop(p);
  EXPECT_EQ(layer.bytes(), 0u);
  layer.setTerrain(nullptr);
  EXPECT_EQ(layer.reservedBytes(), 0u);
}

TEST_P(PatchLayer, keepsWhatItHasWhereThereIsNoMemoryForMore) {
  scene::PatchLayer layer;
  layer.setTerrain(&terrain_->index());
  ASSERT_TRUE(layer.add(terrain_->readPage(0).value()));
  const auto before = drawn(layer, ofPage(0, 0));
  const std::size_t room = layer.reservedBytes();
  layer.reserve(std::size_t{1} << 37, std::size_t{1} << 36);
  EXPECT_EQ(layer.reservedBytes(), room);
  EXPECT_EQ(drawn(layer, ofPage(0, 0)), before);
  ASSERT_TRUE(layer.add(terrain_->readPage(1).value()));
  EXPECT_EQ(drawn(layer, ofPage(0, 0)), before);
}

TEST_P(PatchLayer, tintsFollowThePatch) {
  const PatchIndex& index = terrain_->index();
  scene::PatchLayer layer;
  layer.setTerrain(&index);
  for (std::uint32_t page = 0; page < 3; ++page) layer.add(terrain_->readPage(page).value());
  std::vector<TileDraw> patches = ofPage(1, 0);
  std::vector<std::uint32_t> colours;
  for (const TileDraw& patch : patches) colours.push_back(0x01000000u + patch.node);
  layer.setTints(patches, colours);
  glBindTexture(GL_TEXTURE_BUFFER, layer.tintTexture());
  GLint buffer = 0;
  glGetTexLevelParameteriv(GL_TEXTURE_BUFFER, 0, GL_TEXTURE_BUFFER_DATA_STORE_BINDING, &buffer);
  glBindTexture(GL_TEXTURE_BUFFER, layer.slotTexture());
  GLint slots = 0;
  glGetTexLevelParameteriv(GL_TEXTURE_BUFFER, 0, GL_TEXTURE_BUFFER_DATA_STORE_BINDING, &slots);
  glBindTexture(GL_TEXTURE_BUFFER, 0);
  const auto contents = [](GLint of) {
    GLint bytes = 0;
    glBindBuffer(GL_COPY_READ_BUFFER, static_cast<GLuint>(of));
    glGetBufferParameteriv(GL_COPY_READ_BUFFER, GL_BUFFER_SIZE, &bytes);
    std::vector<std::int32_t> values(static_cast<std::size_t>(bytes) / 4);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, bytes, values.data());
    glBindBuffer(GL_COPY_READ_BUFFER, 0);
    return values;
  };
  const auto tints = contents(buffer), slot = contents(slots);
  std::size_t blocks = 0;
  for (std::size_t block = 0; block < tints.size(); ++block) {
    if (tints[block] == 0) continue;
    ++blocks;
    EXPECT_EQ(tints[block], 0x01000000 + slot[block * 8 + 3]);
  }
  EXPECT_GE(blocks, patches.size());
}

}  // namespace
}  // namespace trimtab
