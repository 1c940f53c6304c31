#include "object_peer.h"

// Before OSG, which includes GL without prototypes.
#include "core/scene/gl/gl_api.h"

#include <osg/Depth>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/Program>
#include <osg/Stats>
#include <osgViewer/GraphicsWindow>
#include <osgViewer/Renderer>
#include <osgViewer/Viewer>

#include <algorithm>
#include <cmath>

#include "tests/bench/culling/osg_cull.h"
#include "tests/bench/row.h"

namespace trimtab::bench {
namespace {

constexpr double kNearM = 1, kFarM = 200e3;

constexpr const char* kVertex = R"(#version 120
uniform vec3 sun;
varying vec3 lit;
varying float clearness;
void main() {
  vec3 p = (gl_ModelViewMatrix * gl_Vertex).xyz;
  vec3 normal = normalize(gl_NormalMatrix * gl_Normal);
  lit = min(gl_Color.rgb * (0.42 + 1.05 * max(dot(normal, sun), 0.0)) * 1.15, vec3(1.0));
  clearness = exp(-length(p) * (1.0 / 110000.0));
  gl_Position = gl_ProjectionMatrix * vec4(p, 1.0);
})";
constexpr const char* kFragment = R"(#version 120
varying vec3 lit;
varying float clearness;
void main() { gl_FragColor = vec4(mix(vec3(0.74, 0.80, 0.86), lit, clearness), 1.0); }
)";

osg::ref_ptr<osg::Geometry> geometryOf(const terrain::ObjectTerrain& objects, std::size_t level) {
  const terrain::ObjectMesh& mesh = objects.meshes[level];
  osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
  osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array, normals = new osg::Vec3Array;
  osg::ref_ptr<osg::Vec4ubArray> colours = new osg::Vec4ubArray;
  for (std::uint32_t i = 0; i < objects.index.levels[level].vertices; ++i) {
    const terrain::ObjectVertex& v = objects.vertices[mesh.firstVertex + i];
    places->push_back({v.x, v.y, v.z});
    normals->push_back({v.normal[0] / 127.0f, v.normal[1] / 127.0f, v.normal[2] / 127.0f});
    colours->push_back({v.colour[0], v.colour[1], v.colour[2], v.colour[3]});
  }
  colours->setNormalize(true);
  geometry->setVertexArray(places);
  geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
  geometry->setColorArray(colours, osg::Array::BIND_PER_VERTEX);
  osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
  for (std::uint32_t i = 0; i < mesh.indices; ++i)
    triangles->push_back(static_cast<GLushort>(objects.indices[mesh.firstIndex + i]));
  geometry->addPrimitiveSet(triangles);
  geometry->setUseDisplayList(false);
  geometry->setUseVertexBufferObjects(true);
  return geometry;
}

}  // namespace

struct ObjectPeer::Impl {
  osg::ref_ptr<osgViewer::Viewer> viewer = new osgViewer::Viewer;
  osg::ref_ptr<osg::Group> root = new osg::Group;     ///< with the state
  osg::ref_ptr<osg::Group> planted = new osg::Group;  ///< of which all instances are children's children
  CullTraversal traversal;

  Impl(const terrain::ObjectTerrain& objects, const CutRule& rule, int width, int height) {
    osg::ref_ptr<osgViewer::GraphicsWindowEmbedded> window =
        new osgViewer::GraphicsWindowEmbedded(0, 0, width, height);
    osg::Camera* camera = viewer->getCamera();
    camera->setGraphicsContext(window);
    camera->setViewport(0, 0, width, height);
    camera->setProjectionResizePolicy(osg::Camera::FIXED);
    camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera->setCullingMode(osg::CullSettings::VIEW_FRUSTUM_CULLING |
                           osg::CullSettings::SMALL_FEATURE_CULLING);
    camera->setSmallFeatureCullingPixelSize(1);
    viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer->setReleaseContextAtEndOfFrameHint(false);
    viewer->setLightingMode(osg::View::NO_LIGHT);
    osg::StateSet* state = root->getOrCreateStateSet();
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, kVertex));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, kFragment));
    state->setAttributeAndModes(program);
    state->setAttributeAndModes(new osg::Depth(osg::Depth::LEQUAL, 0, 1, true));
    state->setMode(GL_CULL_FACE, osg::StateAttribute::ON);
    state->addUniform(new osg::Uniform("sun", osg::Vec3f(0.55f, -0.6f, 0.58f)));
    plant(objects, rule);
    viewer->setSceneData(root);
  }

  void plant(const terrain::ObjectTerrain& objects, const CutRule& rule) {
    const ObjectIndex& index = objects.index;
    const double perDistance = std::sqrt(rule.limit());
    std::vector<osg::ref_ptr<osg::Geometry>> meshes;
    for (std::size_t level = 0; level < objects.meshes.size(); ++level)
      meshes.push_back(geometryOf(objects, level));
    for (std::uint32_t number = 0; number < index.cells.size(); ++number) {
      const ObjectIndex::Cell& cell = index.cells[number];
      if (!cell.isLeaf(number)) continue;
      osg::ref_ptr<osg::Group> group = new osg::Group;
      for (std::uint32_t i = cell.firstInstance; i < cell.firstInstance + cell.instances; ++i) {
        const ObjectInstance& instance = index.instances[i];
        const ObjectIndex::Model& model = index.models[instance.model];
        osg::ref_ptr<osg::LOD> lod = new osg::LOD;
        for (std::uint32_t level = 0; level < model.levels; ++level) {
          const auto from = [&](std::uint32_t of) {
            return static_cast<float>(index.levels[model.firstLevel + of].errorM / perDistance);
          };
          const float end = level + 1 < model.levels ? from(level + 1) : 1e9f;
          lod->addChild(meshes[model.firstLevel + level], from(level), end);
        }
        osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
        const auto& q = instance.turn;
        place->setMatrix(
            osg::Matrixd::scale(instance.scale, instance.scale, instance.scale) *
            osg::Matrixd::rotate(osg::Quat(q[0] / 32767.0, q[1] / 32767.0, q[2] / 32767.0, q[3] / 32767.0)) *
            osg::Matrixd::translate(16.0 * cell.origin[0] + instance.x, 16.0 * cell.origin[1] + instance.y,
                                    16.0 * cell.origin[2] + instance.z));
        place->addChild(lod);
        group->addChild(place);
      }
      planted->addChild(group);
    }
    root->addChild(planted);
    root->getBound();
  }
};

ObjectPeer::ObjectPeer(const terrain::ObjectTerrain& objects, const CutRule& rule, int widthPx, int heightPx)
    : impl_(std::make_unique<Impl>(objects, rule, widthPx, heightPx)) {}
ObjectPeer::~ObjectPeer() = default;

ObjectPeer::Frame ObjectPeer::draw(const EyePose& eye, const ViewShape& view) {
  ViewShape shape = view;
  shape.nearM = kNearM;
  Frame frame;
  double start = monotonicSeconds();
  frame.drawables = impl_->traversal.cull(*impl_->planted, eye, shape);
  frame.cullMs = 1e3 * (monotonicSeconds() - start);
  osg::Camera* camera = impl_->viewer->getCamera();
  camera->setViewMatrix(viewOf(eye));
  camera->setProjectionMatrix(projectionOf(shape, kFarM));
  start = monotonicSeconds();
  const double before = processorMs();
  impl_->viewer->frame();
  glFinish();
  frame.frameProcessorMs = processorMs() - before;
  frame.frameMs = 1e3 * (monotonicSeconds() - start);
  return frame;
}

}  // namespace trimtab::bench
