#include <cstring>

#include "core/terrain/objects/stand_ins.h"
#include "core/terrain/objects/surface_distance.h"
#include "model_support.h"
#include "tests/support.h"

namespace trimtab::terrain {
namespace {

TEST(SurfaceDistance, isTheBruteForceDistanceOrALittleMore) {
  for (const auto& [a, b] : {std::pair{test::ball(8, 4, 0.1f), test::ball(5, 4, 0.0f)},
                             {test::leaves(60, 1), test::leaves(40, 2)},
                             {test::ball(6, 4, 0.2f), test::leaves(30, 3)}}) {
    const double bound = farthestFrom(a, TriangleTree(b), 0.004), sampled = test::farthestSampled(a, b, 200);
    EXPECT_GE(bound, sampled);
    EXPECT_LE(bound, sampled * 1.03 + 0.01);
  }
}

TEST(SurfaceDistance, seesAHoleBetweenCorners) {
  // The middle of a square is 5 m from its frame; its corners and sides are on it.
  SourceMesh square, frame;
  test::addTriangle(square, {-5, -5, 0}, {5, -5, 0}, {5, 5, 0});
  test::addTriangle(square, {-5, -5, 0}, {5, 5, 0}, {-5, 5, 0});
  const test::Corner c[4] = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
  for (int i = 0; i < 4; ++i) {
    test::Corner up = c[i];
    up[2] = 1;
    test::addTriangle(frame, c[i], c[(i + 1) % 4], up);
  }
  EXPECT_NEAR(farthestFrom(square, TriangleTree(frame), 0.01), 5, 0.1);
  EXPECT_NEAR(farthestFrom(frame, TriangleTree(square), 0.01), 1, 0.02);
  EXPECT_LT(farthestFrom(square, TriangleTree(square), 0.01), 1e-6);
}

/// No sampled point of a level is farther from the first one than it says, nor the other way round; and the
/// error is not twice what it need be.
void expectBounds(const BuiltModel& model) {
  for (std::size_t i = 1; i < model.levels.size(); ++i) {
    const BuiltLevel &level = model.levels[i], &before = model.levels[i - 1];
    EXPECT_GT(level.errorM, before.errorM);
    EXPECT_LT(level.mesh.triangles(), before.mesh.triangles());
    const double there = test::farthestSampled(level.mesh, model.levels[0].mesh, 30),
                 back = test::farthestSampled(model.levels[0].mesh, level.mesh, 30);
    EXPECT_LE(there, double{level.errorM}) << model.name << " level " << i;
    EXPECT_LE(back, double{level.errorM}) << model.name << " level " << i;
    EXPECT_GE(std::max(there, back) * 1.2 + 0.02, double{level.errorM}) << model.name << " level " << i;
  }
}

TEST(BuildModel, makesLevelsWhoseErrorHolds) {
  for (const SourceModel& source :
       {test::modelOf("ball", {test::ball(12, 4, 0.15f)}), test::modelOf("leaves", {test::leaves(200, 7)})}) {
    const auto model = buildModel(source);
    ASSERT_TRUE(model) << toString(model.findings());
    EXPECT_TRUE(model.findings().empty()) << toString(model.findings());
    EXPECT_GE(model->levels.size(), 3u) << source.name;
    EXPECT_LE(model->levels.back().mesh.triangles(), 12u);
    for (std::size_t i = 1; i < model->levels.size(); ++i)
      EXPECT_LE(static_cast<double>(model->levels[i].mesh.triangles()),
                0.7 * static_cast<double>(model->levels[i - 1].mesh.triangles()));
    expectBounds(*model);
  }
}

TEST(BuildModel, keepsGivenLevelsWithTheirErrors) {
  const auto model = buildModel(test::modelOf("ball", {test::ball(12, 4, 0.05f), test::ball(7, 4, 0.05f),
                                                       test::ball(4, 4, 0), test::ball(9, 4, 0.05f)}));
  ASSERT_TRUE(model);
  ASSERT_GE(model->levels.size(), 3u);
  EXPECT_EQ(model->levels[1].mesh.triangles(), test::ball(7, 4, 0).triangles());
  EXPECT_EQ(model->levels[2].mesh.triangles(), test::ball(4, 4, 0).triangles());
  expectBounds(*model);
  // The last one has more triangles than the one before it.
  ASSERT_EQ(model.findings().size(), 1u);
  EXPECT_NE(toString(model.findings()).find("left out"), std::string::npos) << toString(model.findings());
}

TEST(BuildModel, leavesAModelOfFewTrianglesAsItIs) {
  SourceMesh hut = test::ball(2, 3, 0);
  const auto model = buildModel(test::modelOf("hut", {hut}));
  ASSERT_TRUE(model);
  EXPECT_EQ(model->levels[0].mesh.triangles(), hut.triangles());
  for (std::size_t i = 1; i < model->levels.size(); ++i)
    EXPECT_LE(model->levels[i].mesh.triangles(), 12u) << "only stand-ins";
  expectBounds(*model);
}

TEST(StandIns, faceOutwardsWithinTheBounds) {
  const SourceMesh ball = test::ball(6, 4, 0.1f);
  const std::vector<SourceMesh> all = standIns(ball, {10, 20, 30, 255});
  EXPECT_EQ(all.size(), 6u);
  int closed = 0;
  for (const SourceMesh& mesh : all) {
    EXPECT_LE(mesh.triangles(), 12u);
    for (const SourceVertex& v : mesh.vertices)
      EXPECT_EQ(v.colour, (std::array<std::uint8_t, 4>{10, 20, 30, 255}));
    // All points of the ball's box are within 12 m of its middle, those of stand-ins too.
    for (std::size_t k = 0; k < mesh.indices.size(); k += 3) {
      const Vec3 a = test::cornerOf(mesh, k), b = test::cornerOf(mesh, k + 1),
                 c = test::cornerOf(mesh, k + 2), middle = (a + b + c) * (1.0 / 3) - Vec3{0, 0, 4};
      EXPECT_LT(length(middle), 8);
      if (mesh.bothSides) continue;
      EXPECT_GT(dot(cross(b - a, c - a), middle), 0) << "a face that looks inwards";
    }
    closed += !mesh.bothSides;
  }
  EXPECT_EQ(closed, 4);
  SourceMesh flat;
  test::addTriangle(flat, {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  EXPECT_TRUE(standIns(flat, {1, 1, 1, 255}).empty());
}

TEST(BuildModel, isTheSameToTheBit) {
  const SourceModel source = test::modelOf("ball", {test::ball(10, 4, 0.15f)});
  const auto a = buildModel(source), b = buildModel(source);
  ASSERT_EQ(a->levels.size(), b->levels.size());
  for (std::size_t i = 0; i < a->levels.size(); ++i) {
    EXPECT_EQ(a->levels[i].errorM, b->levels[i].errorM);
    EXPECT_EQ(a->levels[i].mesh.indices, b->levels[i].mesh.indices);
  }
}

SourceModel damaged(float value, std::size_t every) {
  SourceModel model = test::modelOf("damaged", {test::ball(6, 4, 0)});
  for (std::size_t v = 0; v < model.levels[0].vertices.size(); v += every)
    model.levels[0].vertices[v].position[1] = value;
  return model;
}

TEST(BuildModel, refusesByNameWhatCannotBeDrawn) {
  SourceMesh line;
  test::addTriangle(line, {0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  for (const auto& [model, said] : {std::pair{test::modelOf("nothing", {SourceMesh{}}),
                                              "nothing: expected a model with at least one triangle"},
                                    {test::modelOf("no levels", {}), "at least one triangle"},
                                    {test::modelOf("line", {line}), "none that can be drawn"},
                                    {damaged(NAN, 1), "none that can be drawn"},
                                    {damaged(1e9f, 50), "metres and about its own origin"}}) {
    const auto built = buildModel(model);
    ASSERT_FALSE(built) << said;
    EXPECT_NE(toString(built.findings()).find(said), std::string::npos) << toString(built.findings());
  }
}

TEST(BuildModel, leavesOutSingleTrianglesByReason) {
  SourceModel model = damaged(INFINITY, 40);
  model.levels[0].indices[4] = 100000;
  test::addTriangle(model.levels[0], {0, 0, 0}, {1, 0, 0}, {1, 0, 0});
  model.levels[0].vertices[7].normal = {NAN, 0, 1};
  const auto built = buildModel(model);
  ASSERT_TRUE(built) << toString(built.findings());
  const std::string all = toString(built.findings());
  for (const char* said : {"corners that are numbers", "corners that are there", "triangles with an area"})
    EXPECT_NE(all.find(said), std::string::npos) << all;
  for (const BuiltLevel& level : built->levels)
    for (const SourceVertex& v : level.mesh.vertices)
      EXPECT_NEAR(std::hypot(double{v.normal[0]}, double{v.normal[1]}, double{v.normal[2]}), 1, 1e-3);
}

TEST(BuildModel, keepsTheTextureWhereItCan) {
  SourceModel model = test::modelOf("ball", {test::ball(12, 4, 0.1f)});
  model.textures = {{2, 1, {255, 0, 0, 255, 0, 0, 255, 255}}};
  for (SourceVertex& v : model.levels[0].vertices) {
    v.texture = 0;
    v.place = {v.position[2] / 8, v.position[0] / 8};
  }
  const auto built = buildModel(model);
  ASSERT_TRUE(built);
  ASSERT_EQ(built->textures.size(), 1u);
  const std::vector<std::uint8_t>& pixels = built->textures[0].pixels;
  ASSERT_EQ(pixels.size(), 4u * 256 * 256);
  EXPECT_EQ(pixels[0], 255);
  EXPECT_EQ(pixels[4 * 255], 0);
  EXPECT_EQ(pixels[4 * 255 + 2], 255);
  EXPECT_EQ(built->levels[1].mesh.vertices[0].texture, 0u);
  const SourceVertex& standIn = built->levels.back().mesh.vertices[0];
  EXPECT_EQ(standIn.texture, SourceVertex::kNoTexture);
  EXPECT_NEAR(standIn.colour[0], 128, 3);
  EXPECT_NEAR(standIn.colour[1], 0, 1);
}

TEST(SourceModel, hasAChecksumOfAllThatIsSeen) {
  SourceModel model = test::modelOf("a", {test::ball(4, 4, 0)});
  model.textures = {{1, 1, {1, 2, 3, 4}}};
  const std::uint64_t sum = checksumOf(model);
  SourceModel other = model;
  other.name = "b";
  EXPECT_EQ(checksumOf(other), sum);
  other.textures[0].pixels[2] = 9;
  EXPECT_NE(checksumOf(other), sum);
  other = model;
  other.levels[0].vertices[3].colour[1] = 7;
  EXPECT_NE(checksumOf(other), sum);
  other = model;
  other.levels.push_back({});
  EXPECT_NE(checksumOf(other), sum);
}

}  // namespace
}  // namespace trimtab::terrain
