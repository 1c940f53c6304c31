// An image generator of osgViewer that follows a preset, over any geocentric scene that osgDB reads
// (osgdem's, TerraPage's). Trimtab sets its LOD scale and its far distance; a budget holds by the triangles
// that OSG's statistics count.
//
//     c++ -std=c++17 osg_viewer.cpp $(pkg-config --cflags --libs openscenegraph trimtab) -o osg_viewer
//     osg_viewer PRESET SCENE TABLE
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

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::fputs("usage: osg_viewer PRESET SCENE TABLE\n", stderr), 2;
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
  camera.getStats()->collectStats("scene", true);

  const std::size_t lodScale = trimtab_lever_find("lod_scale"),
                    error = trimtab_lever_find("screen_space_error"),
                    farM = trimtab_lever_find("far_distance");
  std::vector<double> asked(trimtab_lever_count()), drawn(asked.size());
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
    trimtab_session_levers(session.get(), TRIMTAB_STEP_PRESET, asked.data(), asked.size());
    trimtab_session_levers(session.get(), TRIMTAB_STEP_BUDGET, drawn.data(), drawn.size());
    // The budget allows a larger error; the ranges of OSG's levels shrink by the same factor.
    const double scale = drawn[lodScale] * drawn[error] / asked[error];
    camera.setLODScale(static_cast<float>(scale));
    camera.setViewMatrix(viewOf(image));
    const double n = image.near_m, most = std::isfinite(drawn[farM]) ? drawn[farM] : 1e6;
    camera.setProjectionMatrixAsFrustum(image.left * n, image.right * n, image.bottom * n, image.top * n, n,
                                        most);
    const osg::Timer_t start = osg::Timer::instance()->tick();
    viewer.frame();
    frame.total_ms = frame.draw_ms = osg::Timer::instance()->delta_m(start, osg::Timer::instance()->tick());
    frame.triangles = trianglesOf(viewer);
    trimtab_session_finished(session.get(), &frame, s.time_s);
    std::printf("%g %llu %.3f\n", scale, static_cast<unsigned long long>(frame.triangles), frame.total_ms);
  }
}
