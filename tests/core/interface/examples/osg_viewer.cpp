// An image generator of osgViewer that follows a preset, over any geocentric scene that osgDB reads
// (osgdem's, TerraPage's). Trimtab sets its LOD scale and its far distance; osg_viewer.json is its profile. A
// budget holds by the triangles that OSG's statistics count, the sooner if a fit has been flown:
//
//     c++ -std=c++17 osg_viewer.cpp $(pkg-config --cflags --libs openscenegraph trimtab) -o osg_viewer
//     trimtab-cli fit --profile osg_viewer.json --preset P -o DIR -- osg_viewer {preset} SCENE TABLE
//     osg_viewer.json osg_viewer DIR/fitted.json SCENE TABLE osg_viewer.json DIR/fit.json
//
// A row of TABLE is: seconds, latitude, longitude (degrees), height (m), heading, pitch, roll, and head
// heading, pitch and roll (degrees, nan for none). It prints a line per image: LOD scale, triangles,
// milliseconds.
#include <trimtab/trimtab.h>
#include <osg/CoordinateSystemNode>
#include <osg/Timer>
#include <osgDB/ReadFile>
#include <osgViewer/Viewer>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace {

/// The matrix that takes earth-centred places to those of an eye, which looks along its -z.
osg::Matrixd viewOf(const trimtab_image& image) {
  osg::Matrixd toEarth;
  osg::EllipsoidModel().computeLocalToWorldTransformFromLatLongHeight(
      osg::DegreesToRadians(image.latitude_deg), osg::DegreesToRadians(image.longitude_deg), image.height_m,
      toEarth);
  const osg::Matrixd turned = osg::Matrixd::rotate(osg::DegreesToRadians(-image.roll_deg), osg::Z_AXIS) *
                              osg::Matrixd::rotate(osg::DegreesToRadians(90 + image.pitch_deg), osg::X_AXIS) *
                              osg::Matrixd::rotate(osg::DegreesToRadians(-image.heading_deg), osg::Z_AXIS);
  return osg::Matrixd::inverse(turned * toEarth);
}

/// What OSG's statistics say of the last image.
std::uint64_t trianglesOf(osgViewer::Viewer& viewer) {
  double triangles = 0;
  viewer.getCamera()->getStats()->getAttribute(viewer.getFrameStamp()->getFrameNumber(),
                                               "Visible number of GL_TRIANGLES", triangles);
  return static_cast<std::uint64_t>(triangles);
}

/// Gives a fit the image, before it is shown.
struct Picture : osg::Camera::DrawCallback {
  explicit Picture(trimtab_session* session) : session_(session) {}
  void operator()(osg::RenderInfo& info) const override {
    if (trimtab_session_fit_wants_picture(session_) == 0) return;
    const osg::Viewport& port = *info.getCurrentCamera()->getViewport();
    image_->readPixels(0, 0, port.width(), port.height(), GL_RGBA, GL_UNSIGNED_BYTE);
    trimtab_session_fit_picture(session_, image_->data(), image_->s(), image_->t());
  }
  trimtab_session* session_;
  osg::ref_ptr<osg::Image> image_ = new osg::Image;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return std::fputs("usage: osg_viewer PRESET SCENE TABLE PROFILE [FIT]\n", stderr), 2;
  trimtab_preset* loaded = nullptr;
  if (trimtab_preset_load(argv[1], &loaded, nullptr) != TRIMTAB_OK)
    return std::fputs("no preset\n", stderr), 1;
  const std::unique_ptr<trimtab_preset, void (*)(trimtab_preset*)> preset(loaded, trimtab_preset_free);
  trimtab_session* made = nullptr;
  if (trimtab_session_create(preset.get(), &made) != TRIMTAB_OK) return 1;
  const std::unique_ptr<trimtab_session, void (*)(trimtab_session*)> session(made, trimtab_session_free);
  const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(argv[2]);
  if (!scene) return std::fputs("no scene\n", stderr), 1;

  constexpr int kWidth = 640, kHeight = 360;
  osgViewer::Viewer viewer;
  viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
  viewer.setUpViewInWindow(0, 0, kWidth, kHeight);
  viewer.setSceneData(scene);
  viewer.realize();
  osg::Camera& camera = *viewer.getCamera();
  camera.setProjectionResizePolicy(osg::Camera::FIXED);
  camera.setComputeNearFarMode(
      osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);  // else OSG replaces the far plane
  camera.setCullingMode(camera.getCullingMode() | osg::CullSettings::FAR_PLANE_CULLING);
  camera.getStats()->collectStats("scene", true);

  trimtab_profile* profile = nullptr;
  trimtab_fit* fit = nullptr;
  if (trimtab_profile_load(argv[4], &profile, nullptr) != TRIMTAB_OK)
    return std::fputs("no profile\n", stderr), 1;
  if (argc > 5 && trimtab_fit_load(argv[5], &fit, nullptr) != TRIMTAB_OK)
    return std::fputs("no fit\n", stderr), 1;
  trimtab_session_set_profile(session.get(), profile, fit);  // not while it flies a fit
  trimtab_profile_free(profile);
  trimtab_fit_free(fit);
  double own[2];  // in the order of the profile's levers: LODScale, far distance
  camera.setFinalDrawCallback(new Picture(session.get()));
  trimtab_state s{};
  s.size = sizeof s;
  trimtab_state_clear(&s);
  trimtab_image image{};
  image.size = sizeof image;
  trimtab_frame frame{};
  frame.size = sizeof frame;
  trimtab_frame_clear(&frame);
  std::ifstream table(argv[3]);
  for (std::string word; table >> word && !viewer.done();) {  // as words, because a stream reads no "nan"
    std::vector<double> row{std::stod(word)};
    while (row.size() < 10 && table >> word) row.push_back(std::stod(word));
    if (row.size() < 10) return std::fputs("a cut row\n", stderr), 1;
    s.time_s = row[0], s.latitude_deg = row[1], s.longitude_deg = row[2], s.height_m = row[3];
    s.heading_deg = row[4], s.pitch_deg = row[5], s.roll_deg = row[6];
    s.head_heading_deg = row[7], s.head_pitch_deg = row[8], s.head_roll_deg = row[9];
    ++s.packet;
    trimtab_session_fly(session.get(), &s);
    trimtab_session_request(session.get(), s.time_s, kWidth, kHeight, &image);
    trimtab_session_own_levers(session.get(), own, 2);
    camera.setLODScale(static_cast<float>(own[0]));
    camera.setViewMatrix(viewOf(image));
    const double n = image.near_m;
    camera.setProjectionMatrixAsFrustum(image.left * n, image.right * n, image.bottom * n, image.top * n, n,
                                        own[1] * 1000);
    const osg::Timer_t start = osg::Timer::instance()->tick();
    viewer.frame();
    frame.total_ms = frame.draw_ms = osg::Timer::instance()->delta_m(start, osg::Timer::instance()->tick());
    frame.triangles = trianglesOf(viewer);
    trimtab_session_finished(session.get(), &frame, s.time_s);
    std::printf("%g %llu %.3f\n", own[0], static_cast<unsigned long long>(frame.triangles), frame.total_ms);
  }
}
