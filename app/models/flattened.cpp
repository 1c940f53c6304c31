#include "app/models/flattened.h"

#include <osg/Billboard>
#include <osg/CullFace>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/Material>
#include <osg/NodeVisitor>
#include <osg/Sequence>
#include <osg/Switch>
#include <osg/Texture>
#include <osg/Transform>
#include <osg/TriangleIndexFunctor>
#include <osgSim/LightPointNode>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "app/models/image_pixels.h"

namespace trimtab::models {

namespace {

using terrain::SourceMesh;
using terrain::SourceVertex;

struct Range {
  double from = 0, to = std::numeric_limits<double>::infinity();
};

/// Where a child of a LOD is shown. Both ends 0 say nothing: such a child is always shown.
Range rangeOf(const osg::LOD& lod, unsigned child) {
  const auto low = static_cast<double>(lod.getMinRange(child)),
             high = static_cast<double>(lod.getMaxRange(child));
  if (child >= lod.getNumRanges() || !(high > 0)) return {};
  if (lod.getRangeMode() == osg::LOD::DISTANCE_FROM_EYE_POINT) return {low, high};
  return {1 / high, low > 0 ? 1 / low : std::numeric_limits<double>::infinity()};
}

class RangeVisitor final : public osg::NodeVisitor {
 public:
  RangeVisitor() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
  void apply(osg::LOD& lod) override {
    for (unsigned i = 0; i < lod.getNumChildren(); ++i) {
      const Range range = rangeOf(lod, i);
      for (const double end : {range.from, range.to})
        if (end > 0 && std::isfinite(end)) ends_.insert(end);
    }
    traverse(lod);
  }
  const std::set<double>& ends() const { return ends_; }

 private:
  std::set<double> ends_;
};

/// What of the state matters here.
struct Look {
  const osg::Image* image = nullptr;
  const osg::Material* material = nullptr;
  bool oneSided = false;

  void add(const osg::StateSet& state) {
    const auto* const texture =
        dynamic_cast<const osg::Texture*>(state.getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    if (texture != nullptr && texture->getImage(0) != nullptr) image = texture->getImage(0);
    const auto modes = state.getTextureModeList();
    if (!modes.empty())
      if (const auto mode = modes[0].find(GL_TEXTURE_2D);
          mode != modes[0].end() && (mode->second & osg::StateAttribute::ON) == 0)
        image = nullptr;
    if (const auto* const found =
            dynamic_cast<const osg::Material*>(state.getAttribute(osg::StateAttribute::MATERIAL)))
      material = found;
    if (const auto mode = state.getMode(GL_CULL_FACE); mode != osg::StateAttribute::INHERIT)
      oneSided = (mode & osg::StateAttribute::ON) != 0;
  }
};

struct TriangleList {
  std::vector<std::array<unsigned, 3>> triangles;
  void operator()(unsigned a, unsigned b, unsigned c) { triangles.push_back({a, b, c}); }
};

/// Reads number `i` of an array of vectors of any width; missing coordinates are those of `otherwise`.
osg::Vec4d elementOf(const osg::Array* array, unsigned i, osg::Vec4d otherwise) {
  if (array == nullptr || i >= array->getNumElements()) return otherwise;
  const void* const at = array->getDataPointer(i);
  const auto floats = [&](int count) {
    for (int k = 0; k < count; ++k) otherwise[k] = static_cast<double>(static_cast<const float*>(at)[k]);
    return otherwise;
  };
  const auto doubles = [&](int count) {
    for (int k = 0; k < count; ++k) otherwise[k] = static_cast<const double*>(at)[k];
    return otherwise;
  };
  switch (array->getType()) {
    case osg::Array::Vec2ArrayType:
      return floats(2);
    case osg::Array::Vec3ArrayType:
      return floats(3);
    case osg::Array::Vec4ArrayType:
      return floats(4);
    case osg::Array::Vec2dArrayType:
      return doubles(2);
    case osg::Array::Vec3dArrayType:
      return doubles(3);
    case osg::Array::Vec4dArrayType:
      return doubles(4);
    case osg::Array::Vec4ubArrayType:
      for (int k = 0; k < 4; ++k) otherwise[k] = static_cast<const std::uint8_t*>(at)[k] / 255.0;
      return otherwise;
    default:
      return otherwise;
  }
}

/// The number of a vertex in an array that may have one element for all.
unsigned elementFor(const osg::Array* array, unsigned vertex) {
  return array != nullptr && array->getBinding() == osg::Array::BIND_OVERALL ? 0 : vertex;
}

std::uint8_t byteOf(double share) {
  return static_cast<std::uint8_t>(std::lround(255 * (share > 0 ? std::min(share, 1.0) : 0)));
}

/// Collects triangles and lights along a path of transforms and states.
class Flattener final : public osg::NodeVisitor {
 public:
  Flattener(double distance, TextureList& textures)
      : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), distance_(distance), textures_(textures) {
    setNodeMaskOverride(0xffffffffu);
    out_.mesh.bothSides = false;
  }
  Flattened take() {
    if (out_.mesh.indices.empty()) out_.mesh.bothSides = true;
    return std::move(out_);
  }

  void apply(osg::Node& node) override {
    if (const auto* const lights = dynamic_cast<const osgSim::LightPointNode*>(&node)) add(*lights);
    const Look before = look_;
    if (node.getStateSet() != nullptr) look_.add(*node.getStateSet());
    traverse(node);
    look_ = before;
  }
  void apply(osg::Transform& node) override {
    const osg::Matrixd before = matrix_;
    node.computeLocalToWorldMatrix(matrix_, this);
    apply(static_cast<osg::Node&>(node));
    matrix_ = before;
  }
  void apply(osg::LOD& lod) override {
    visitSome(lod, [&](unsigned i) {
      const Range range = rangeOf(lod, i);
      return distance_ >= range.from && distance_ < range.to;
    });
  }
  void apply(osg::Switch& node) override {
    visitSome(node, [&](unsigned i) { return node.getValue(i); });
  }
  void apply(osg::Sequence& node) override {
    visitSome(node, [](unsigned i) { return i == 0; });
  }
  void apply(osg::Billboard& node) override {
    const Look before = look_;
    if (node.getStateSet() != nullptr) look_.add(*node.getStateSet());
    for (unsigned i = 0; i < node.getNumDrawables(); ++i) {
      const osg::Matrixd around = matrix_;
      matrix_.preMultTranslate(osg::Vec3d(node.getPosition(i)));
      node.getDrawable(i)->accept(*this);
      matrix_ = around;
    }
    look_ = before;
  }
  void apply(osg::Drawable& drawable) override {
    osg::Geometry* const geometry = drawable.asGeometry();
    if (geometry == nullptr) return;
    const Look before = look_;
    if (drawable.getStateSet() != nullptr) look_.add(*drawable.getStateSet());
    if (geometry->containsDeprecatedData()) geometry->fixDeprecatedData();
    add(*geometry);
    look_ = before;
  }

 private:
  template <class Shown>
  void visitSome(osg::Group& group, const Shown& shown) {
    const Look before = look_;
    if (group.getStateSet() != nullptr) look_.add(*group.getStateSet());
    for (unsigned i = 0; i < group.getNumChildren(); ++i)
      if (shown(i)) group.getChild(i)->accept(*this);
    look_ = before;
  }

  void addLight(osg::Vec3d place, osg::Vec4d colour) {
    const osg::Vec3d p = place * matrix_;
    out_.lights.push_back({{static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())},
                           {byteOf(colour.r()), byteOf(colour.g()), byteOf(colour.b()), 255}});
  }

  void add(const osgSim::LightPointNode& node) {
    for (const osgSim::LightPoint& light : node.getLightPointList()) {
      if (!light._on) continue;
      out_.moreOfLights |= light._sector.valid() || light._blinkSequence.valid();
      addLight(osg::Vec3d(light._position), osg::Vec4d(light._color) * double{light._intensity});
    }
  }

  void addPoints(const osg::Geometry& geometry) {
    const unsigned count = geometry.getVertexArray()->getNumElements();
    for (unsigned s = 0; s < geometry.getNumPrimitiveSets(); ++s) {
      const osg::PrimitiveSet& set = *geometry.getPrimitiveSet(s);
      if (set.getMode() != GL_POINTS) continue;
      for (unsigned k = 0; k < set.getNumIndices(); ++k) {
        const unsigned i = set.index(k);
        if (i >= count) continue;
        const osg::Vec4d p = elementOf(geometry.getVertexArray(), i, {0, 0, 0, 1});
        addLight({p.x(), p.y(), p.z()}, colourOf(geometry, i));
      }
    }
  }

  void add(const osg::Geometry& geometry) {
    if (geometry.getVertexArray() != nullptr) addPoints(geometry);
    osg::TriangleIndexFunctor<TriangleList> list;
    geometry.accept(list);
    const osg::Array* const vertices = geometry.getVertexArray();
    if (list.triangles.empty() || vertices == nullptr) return;
    const unsigned count = vertices->getNumElements();
    // A mirror turns triangles round, which are anticlockwise from outside before it.
    const osg::Vec3d x(matrix_(0, 0), matrix_(0, 1), matrix_(0, 2)),
        y(matrix_(1, 0), matrix_(1, 1), matrix_(1, 2)), z(matrix_(2, 0), matrix_(2, 1), matrix_(2, 2));
    const bool mirrored = (x ^ y) * z < 0;
    const osg::Matrixd turned = osg::Matrixd::inverse(matrix_);
    const auto first = static_cast<std::uint32_t>(out_.mesh.vertices.size());
    const std::uint32_t texture =
        look_.image != nullptr ? textures_.numberOf(*look_.image) : SourceVertex::kNoTexture;
    for (unsigned i = 0; i < count; ++i) out_.mesh.vertices.push_back(vertexOf(geometry, i, turned, texture));
    for (const auto& [a, b, c] : list.triangles) {
      const bool inside = a < count && b < count && c < count;
      // What is not there is for the checks of the model to name.
      const auto at = [&](unsigned i) {
        return inside ? first + i : std::numeric_limits<std::uint32_t>::max();
      };
      out_.mesh.indices.insert(out_.mesh.indices.end(), {at(a), at(mirrored ? c : b), at(mirrored ? b : c)});
    }
    out_.mesh.bothSides |= !look_.oneSided;
  }

  SourceVertex vertexOf(const osg::Geometry& geometry, unsigned i, const osg::Matrixd& turned,
                        std::uint32_t texture) const {
    SourceVertex v;
    const osg::Vec4d place = elementOf(geometry.getVertexArray(), i, {0, 0, 0, 1});
    const osg::Vec3d p = osg::Vec3d(place.x(), place.y(), place.z()) * matrix_;
    const osg::Array* const normals = geometry.getNormalArray();
    const osg::Vec4d n = elementOf(normals, elementFor(normals, i), {0, 0, 0, 0});
    const osg::Vec3d normal = osg::Matrixd::transform3x3(turned, osg::Vec3d(n.x(), n.y(), n.z()));
    for (unsigned k = 0; k < 3; ++k) {
      v.position[k] = static_cast<float>(p[static_cast<int>(k)]);
      v.normal[k] = static_cast<float>(normal[static_cast<int>(k)]);
    }
    const osg::Vec4d colour = colourOf(geometry, i);
    for (unsigned k = 0; k < 4; ++k) v.colour[k] = byteOf(colour[static_cast<int>(k)]);
    v.texture = texture;
    const osg::Vec4d uv = elementOf(geometry.getTexCoordArray(0), i, {0, 0, 0, 0});
    v.place = {static_cast<float>(uv.x()), static_cast<float>(uv.y())};
    return v;
  }

  /// As the fixed pipeline lights it: a material's diffuse colour, unless it follows that of the vertices.
  osg::Vec4d colourOf(const osg::Geometry& geometry, unsigned i) const {
    const osg::Array* const colours = geometry.getColorArray();
    const osg::Vec4d own = elementOf(colours, elementFor(colours, i), {1, 1, 1, 1});
    if (look_.material == nullptr) return own;
    const auto mode = look_.material->getColorMode();
    const bool follows = mode == osg::Material::DIFFUSE || mode == osg::Material::AMBIENT_AND_DIFFUSE;
    return follows && colours != nullptr ? own : osg::Vec4d(look_.material->getDiffuse(osg::Material::FRONT));
  }

  double distance_;
  TextureList& textures_;
  osg::Matrixd matrix_;
  Look look_;
  Flattened out_;
};

}  // namespace

std::uint32_t TextureList::numberOf(const osg::Image& image) {
  const auto [known, isNew] = numbers_.try_emplace(&image, SourceVertex::kNoTexture);
  if (!isNew) return known->second;
  if (auto pixels = pixelsOf(image)) {
    known->second = static_cast<std::uint32_t>(textures_.size());
    textures_.push_back(std::move(*pixels));
  }
  return known->second;
}

std::vector<double> distancesOf(osg::Node& node) {
  RangeVisitor ranges;
  node.accept(ranges);
  std::vector<double> distances;
  double before = 0;
  for (const double end : ranges.ends()) {
    distances.push_back((before + end) / 2);
    before = end;
  }
  distances.push_back(2 * before + 1);
  return distances;
}

Flattened flattened(osg::Node& node, double distance, TextureList& textures) {
  Flattener flattener(distance, textures);
  node.accept(flattener);
  return flattener.take();
}

}  // namespace trimtab::models
