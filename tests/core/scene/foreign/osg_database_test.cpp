#include "trimtab/scene/osg_database.h"

#include <osg/ClipControl>
#include <osg/Depth>
#include <osg/GLExtensions>
#include <osgDB/DatabasePager>
#include <osgDB/ReadFile>
#include <osgViewer/GraphicsWindow>
#include <osgViewer/Viewer>

#include <cmath>
#include <fstream>
#include <numbers>
#include <thread>

#include "core/scene/passes/scene_view.h"
#include "tests/core/scene/foreign/paged_scene.h"
#include "tests/core/scene/scene_test.h"
#include "trimtab/scene/error_meter.h"

namespace trimtab {
namespace {

double hills(int column, int row) {
  return 1500 + 600 * std::sin(column * 0.21) * std::cos(row * 0.17) +
         200 * std::sin(column * 0.9 + row * 0.7);
}

class OsgScene : public test::SceneTest {
 protected:
  void SetUp() override {
    SceneTest::SetUp();
    if (!offscreen) return;
    source = std::make_unique<test::SyntheticTerrain>(
        4, 0.002, GeodeticPosition{Degrees{46.2}, Degrees{7.9}, Metres{0}}, hills);
  }
  /// Writes the scene and opens it as the terrain.
  void open(const std::string& ending = ".osgb", const std::filesystem::path& folder = {}, int levels = 3) {
    scene = std::make_unique<test::PagedScene>(*source, folder.empty() ? dir.path() : folder, ending, true,
                                               levels);
    ASSERT_TRUE(scene->written());
    auto opened = scene::OsgDatabase::open(scene->file(), {});
    ASSERT_TRUE(opened) << toString(opened.findings());
    use(*opened);
  }
  FrameRequest view(double east, double north, double heading, double pitch, double aboveM = 700) {
    FrameRequest r = request(over(east, north, aboveM), {Degrees{heading}, Degrees{pitch}, Degrees{0}});
    r.overlays.showHoles = true;  // no sky, which OSG does not draw
    return r;
  }

  /// The image of OSG's own viewer: with our matrices, or `byOsg` with its own, a far plane and its usual
  /// depth.
  std::vector<std::uint8_t> plain(const FrameRequest& r, double lodScale = 1, bool byOsg = false) {
    offscreen->makeCurrent();
    osg::ref_ptr<osgViewer::Viewer> viewer = new osgViewer::Viewer;
    osg::ref_ptr<osgViewer::GraphicsWindowEmbedded> window =
        new osgViewer::GraphicsWindowEmbedded(0, 0, kWidth, kHeight);
    window->setDefaultFboId(offscreen->framebuffer());
    viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    osg::Camera* camera = viewer->getCamera();
    camera->setGraphicsContext(window);
    camera->setViewport(0, 0, kWidth, kHeight);
    camera->setClearColor({1, 0, 1, 1});
    camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera->setSmallFeatureCullingPixelSize(0);
    camera->setLODScale(static_cast<float>(lodScale));
    // Once by OSG's own mathematics; and once from our axes, so that no matrix differs by its last bit.
    const ViewShape& v = r.view;
    if (byOsg) {
      constexpr double kNear = 50, kFar = 400e3;
      camera->setProjectionMatrixAsFrustum(v.left * kNear, v.right * kNear, v.bottom * kNear, v.top * kNear,
                                           kNear, kFar);
      const osg::EllipsoidModel earth;
      osg::Matrixd ground;
      earth.computeLocalToWorldTransformFromLatLongHeight(
          r.eye.latitude.in<Radians>(), r.eye.longitude.in<Radians>(), r.eye.height.value(), ground);
      const double heading = r.attitude.heading.in<Radians>(), pitch = r.attitude.pitch.in<Radians>();
      const osg::Vec3d ahead(std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch),
                             std::sin(pitch));
      const osg::Vec3d eye = osg::Vec3d() * ground, up = osg::Vec3d(0, 0, 1) * ground - eye;
      camera->setViewMatrixAsLookAt(eye, ahead * ground, up);
    } else {
      camera->setProjectionMatrix(osg::Matrixd(scene::projectionMatrix(v).data()));
      camera->setClearDepth(0);
      osg::StateSet* state = camera->getOrCreateStateSet();
      state->setAttributeAndModes(new osg::Depth(osg::Depth::GEQUAL));
      state->setAttribute(new osg::ClipControl(osg::ClipControl::LOWER_LEFT, osg::ClipControl::ZERO_TO_ONE));
      const LocalFrame& frame = database->index().frame;
      const Mat3 axes = eyeAxes(frame, r.eye, r.attitude) * frame.ecefToLocal();
      const Vec3 eye = frame.toEcef(frame.fromGeodetic(r.eye));
      osg::Matrixd turned;
      for (unsigned i = 0; i < 3; ++i) {
        turned(0, i) = axes.row[i].x;
        turned(1, i) = axes.row[i].y;
        turned(2, i) = axes.row[i].z;
      }
      camera->setViewMatrix(osg::Matrixd::translate(-eye.x, -eye.y, -eye.z) * turned);
    }
    viewer->setSceneData(osgDB::readRefNodeFile(scene->file().string()));
    viewer->getDatabasePager()->setDoPreCompile(false);
    for (int still = 0; still < 5;) {
      viewer->frame();
      still = viewer->getDatabasePager()->getRequestsInProgress() ? 0 : still + 1;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    std::vector<std::uint8_t> pixels(std::size_t{kWidth} * kHeight * 4);
    window->getState()->get<osg::GLExtensions>()->glBindFramebuffer(GL_FRAMEBUFFER, offscreen->framebuffer());
    glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    viewer->getSceneData()->releaseGLObjects(window->getState());
    viewer = nullptr;
    // What the viewer left behind, as a program that shares a context would clean up.
    for (const GLenum off : {GL_LIGHTING, GL_CULL_FACE, GL_BLEND, GL_SCISSOR_TEST}) glDisable(off);
    return pixels;
  }

  static void save(const std::string& name, const std::vector<std::uint8_t>& pixels) {
    if (const char* shots = std::getenv("TRIMTAB_SHOTS")) {
      EXPECT_TRUE(scene::writePng(std::filesystem::path(shots) / (name + ".png"), pixels, kWidth, kHeight));
    }
  }

  test::ScratchDir dir;
  std::unique_ptr<test::SyntheticTerrain> source;
  std::unique_ptr<test::PagedScene> scene;
};

TEST_F(OsgScene, looksAsOsgsOwnViewerShowsIt) {
  for (const std::string ending : {".osgb", ".ive"}) {
    open(ending);
    int i = 0;
    for (const FrameRequest& r : {view(0.5, 0.5, 30, -10), view(0.2, 0.3, 75, -25), view(0.8, 0.7, 200, -5),
                                  view(0.5, 0.1, 350, -60, 3000)}) {
      FrameResult result;
      const auto ours = picture(r, &result);
      save("osg_scene" + ending + std::to_string(i), ours);
      const auto theirs = plain(r);
      save("osg_plain" + ending + std::to_string(i++), theirs);
      EXPECT_EQ(differing(ours, theirs), 0u) << ending << " view " << i;
      // Near and far planes, lookAt and depth of 24 bits: a few pixels at edges are rounded otherwise.
      EXPECT_LT(differing(ours, plain(r, 1, true)), 64u) << ending << " view " << i;
      EXPECT_GT(result.visible.triangles, 500u);
      EXPECT_TRUE(result.paging.settled);
      EXPECT_GT(result.paging.pagesRead, 1u);
    }
  }
}

TEST_F(OsgScene, hasTheSkyOfEveryTerrain) {
  open();
  const FrameRequest up = request(over(0.5, 0.5, 700), {Degrees{30}, Degrees{40}, Degrees{0}});
  const auto sky = picture(up);
  use({std::shared_ptr<void>(), source.get()});
  EXPECT_EQ(differing(sky, picture(up)), 0u) << "OSG left another viewport behind";
}

/// Six levels over 45 km of real mountains. With TRIMTAB_SHOTS the scene stays there, for measurements by
/// hand.
TEST_F(OsgScene, ofEverestLooksAsOsgsOwnViewerShowsIt) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  const auto dem = bakeShared("dem-srtm3-everest");
  ASSERT_TRUE(dem);
  constexpr double kStep = 1.0 / 1200;
  const GeodeticPosition corner{dem->info().southWest.latitude + Degrees{kStep},
                                dem->info().southWest.longitude + Degrees{kStep}, Metres{0}};
  source = std::make_unique<test::SyntheticTerrain>(16, kStep, corner, [&](int column, int row) {
    return dem->heightAt(corner.latitude + Degrees{row * kStep}, corner.longitude + Degrees{column * kStep})
        .value_or(Metres{0})
        .value();
  });
  const char* const shots = std::getenv("TRIMTAB_SHOTS");
  const std::filesystem::path folder = shots ? std::filesystem::path(shots) / "everest" : dir / "everest";
  std::filesystem::create_directories(folder);
  open(".osgb", folder, 6);
  EXPECT_GT(database->info().highest.value(), database->info().lowest.value() + 2000)
      << "these are no mountains";
  std::uint64_t fine = 0, coarse = 0;
  int i = 0;
  for (FrameRequest r :
       {view(0.5, 0.4, 30, -10), view(0.3, 0.3, 75, -20, 300), view(0.7, 0.8, 200, -5, 2500)}) {
    FrameResult result;
    const auto ours = picture(r, &result);
    save("osg_everest" + std::to_string(i++), ours);
    EXPECT_EQ(differing(ours, plain(r)), 0u) << "view " << i;
    fine += result.visible.triangles;
    r.levers.drawn.lodScale = 4;
    picture(r, &result);
    coarse += result.visible.triangles;
  }
  EXPECT_GT(fine, 3 * coarse / 2);
  std::printf("triangles: %llu at LOD scale 1, %llu at 4\n", static_cast<unsigned long long>(fine),
              static_cast<unsigned long long>(coarse));
}

TEST_F(OsgScene, followsItsLevers) {
  open();
  FrameRequest r = view(0.3, 0.3, 45, -20);
  FrameResult fine, coarse, byError, finer, near, far;
  const auto full = picture(r, &fine);
  r.levers.drawn.lodScale = 4;
  const auto rough = picture(r, &coarse);
  EXPECT_LT(coarse.visible.triangles, fine.visible.triangles);
  EXPECT_EQ(differing(rough, plain(r, 4)), 0u);
  r.levers.drawn.lodScale = 1;
  r.levers.drawn.errorPx = 4 * r.levers.preset.errorPx;
  EXPECT_EQ(differing(picture(r, &byError), rough), 0u) << "an allowed error acts as a factor on OSG's scale";
  r.levers.drawn.errorPx = r.levers.preset.errorPx / 8;
  EXPECT_EQ(differing(picture(r, &finer), full), 0u) << "nothing asks for more than the author's detail";
  r.levers.drawn = {};
  r.levers.drawn.farM = 8000;
  picture(r, &near);
  EXPECT_LT(near.visible.triangles, fine.visible.triangles);
  EXPECT_GT(near.visible.triangles, 0u);
  r.levers.drawn = {};
  r.levers.drawn.smallFeaturePx = 4000;
  picture(r, &far);
  EXPECT_LT(far.visible.triangles, fine.visible.triangles);
  r.levers.drawn = {};
  EXPECT_EQ(differing(picture(r), full), 0u);
  r.levers.drawn.renderScale = 0.5;
  EXPECT_GT(differing(picture(r), full), 1000u);
}

TEST_F(OsgScene, leavesOtherPassesAsTheyWere) {
  use(test::syntheticMountains());
  const auto mountains = request(over(0.4, 0.4, 400), {Degrees{30}, Degrees{-8}, Degrees{5}});
  const auto before = picture(mountains);
  open();
  FrameRequest r = view(0.3, 0.3, 45, -5);
  r.overlays.showHoles = false;
  const auto sky = picture(r);
  EXPECT_GT(differing(sky, picture(view(0.3, 0.3, 45, -5))), 1000u) << "the sky is ours";
  EXPECT_EQ(differing(sky, picture(r)), 0u);
  FrameRequest small = r;
  small.view.widthPx = kWidth / 2;
  small.view.heightPx = kHeight / 2;
  open();
  picture(small);
  EXPECT_EQ(differing(sky, picture(r)), 0u) << "after another size the sky fills the image";
  use(test::syntheticMountains());
  EXPECT_EQ(differing(picture(mountains), before), 0u);
}

TEST_F(OsgScene, knowsHeightsOfItsFinestTriangles) {
  open();
  for (const auto& [east, north] : {std::pair{0.5, 0.5}, {0.25, 0.75}, {0.125, 0.5}}) {
    const GeodeticPosition place = scene::placeIn(source->info(), east, north);
    const auto height = database->heightAt(place.latitude, place.longitude);
    ASSERT_TRUE(height);
    // Posts of the finest level are two of the source's apart, and these places are such posts.
    EXPECT_NEAR(height->value(), source->heightAt(place.latitude, place.longitude)->value(), 0.1);
  }
  EXPECT_FALSE(database->heightAt(Degrees{40}, Degrees{7.9}));
  EXPECT_NEAR(database->info().southWest.latitude.value(), source->info().southWest.latitude.value(), 1e-6);
  EXPECT_NEAR(database->info().northEast.longitude.value(), source->info().northEast.longitude.value(), 1e-6);
}

TEST_F(OsgScene, withFlatCoordinatesNeedsAnOrigin) {
  scene = std::make_unique<test::PagedScene>(*source, dir.path(), ".osgt", false);
  const auto refused = scene::OsgDatabase::open(scene->file(), {});
  ASSERT_FALSE(refused);
  EXPECT_NE(toString(refused.findings()).find("--origin LAT,LON"), std::string::npos);
  auto opened = scene::OsgDatabase::open(scene->file(), source->index().frame.origin());
  ASSERT_TRUE(opened) << toString(opened.findings());
  use(*opened);
  FrameRequest r = view(0.5, 0.5, 30, -10);
  const auto flat = picture(r);
  open();
  // Its pages have floats of other axes, so pixels at edges are rounded otherwise.
  EXPECT_LT(differing(flat, picture(r)), 1000u) << "the same ground in geocentric coordinates";
}

TEST_F(OsgScene, mayBeOpenFlightButNoRasterOfThatEnding) {
  const osg::ref_ptr<osg::Geode> roof = new osg::Geode;
  const osg::ref_ptr<osg::Geometry> side = new osg::Geometry;
  const osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
  for (const osg::Vec3& at : {osg::Vec3(-300, 0, 50), osg::Vec3(300, 0, 50), osg::Vec3(0, 400, 50)})
    corners->push_back(at);
  side->setVertexArray(corners);
  side->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
  roof->addDrawable(side);
  const auto file = dir.path() / "roof.flt";
  ASSERT_TRUE(osgDB::writeNodeFile(*roof, file.string()));
  EXPECT_TRUE(scene::isOsgScene(file));
  EXPECT_TRUE(scene::lacksOrigin(scene::openOsgScene(file, "").findings()));
  const auto opened = scene::openOsgScene(file, "36,128");
  ASSERT_TRUE(opened) << toString(opened.findings());
  EXPECT_NEAR((*opened)->heightAt(Degrees{36.001}, Degrees{128})->value(), 50, 0.1);
  std::ofstream(dir.path() / "grid.flt", std::ios::binary) << std::string(64, '\0');
  EXPECT_FALSE(scene::isOsgScene(dir.path() / "grid.flt"));
}

TEST_F(OsgScene, namesWhatIsNotThere) {
  open();
  FrameResult result;
  std::filesystem::remove(scene->page(1, 0, 0));
  std::ofstream(scene->page(1, 1, 0), std::ios::trunc) << "no page";
  const auto refusal = [&](const std::filesystem::path& file) {
    const auto opened = scene::OsgDatabase::open(file, {});
    return opened ? std::string("opened") : toString(opened.findings());
  };
  use(*scene::OsgDatabase::open(scene->file(), {}));
  picture(view(0.2, 0.2, 45, -40), &result);
  EXPECT_EQ(result.paging.failed, 2u);
  EXPECT_GT(result.visible.triangles, 500u) << "the coarser ground stays";
  const std::string named = toString(renderer.pageFailures());
  EXPECT_NE(named.find("page_1_0_0"), std::string::npos) << named;
  EXPECT_NE(named.find("page_1_1_0"), std::string::npos) << named;

  EXPECT_NE(refusal(dir.path() / "none.ive").find("found none"), std::string::npos);
  std::ofstream(dir.path() / "words.osgb") << "These are words.";
  EXPECT_NE(refusal(dir.path() / "words.osgb").find("scene that OpenSceneGraph can read"), std::string::npos);
  osgDB::writeNodeFile(*osg::ref_ptr<osg::Node>(new osg::Group), (dir.path() / "empty.osgb").string());
  EXPECT_NE(refusal(dir.path() / "empty.osgb").find("a scene with triangles"), std::string::npos);
  for (const std::string ending : {".osgb", ".ive"}) {
    const test::PagedScene whole(*source, dir.path(), ending, true);
    std::filesystem::resize_file(whole.file(), std::filesystem::file_size(whole.file()) / 2);
    EXPECT_NE(refusal(whole.file()), "opened") << ending;
  }
}

TEST(OriginOption, isLatitudeAndLongitude) {
  EXPECT_EQ(*scene::originFrom("46.5,-7.25"), (GeodeticPosition{Degrees{46.5}, Degrees{-7.25}, Metres{0}}));
  for (const char* text : {"", "46", "91,7", "46,181", "a,b", "46,7,3", "nan,7"})
    EXPECT_FALSE(scene::originFrom(text)) << text;
}

}  // namespace
}  // namespace trimtab
