#pragma once

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osgDB/WriteFile>

#include <filesystem>
#include <string>

#include "tests/core/scene/terrain/synthetic_terrain.h"

/// Writes a terrain as a tool like osgdem does: a quadtree of osg::PagedLOD in files of its own.
namespace trimtab::test {

class PagedScene {
 public:
  static constexpr int kCells = 16;

  /// Says how finely a scene is drawn, and whether its levels look alike, as imagery makes them, or each has
  /// a colour.
  struct Look {
    float radii = 1.5f;  ///< a page is drawn nearer than so many of its tile's radii
    bool alike = false;
  };

  /// Writes `folder`/scene.ENDING and its pages; `geocentric`, or else metres of the terrain's own frame.
  PagedScene(const SyntheticTerrain& terrain, std::filesystem::path folder, std::string ending,
             bool geocentric, int levels = 3, Look look = {1.5f, false})
      : terrain_(terrain),
        folder_(std::move(folder)),
        ending_(std::move(ending)),
        geocentric_(geocentric),
        levels_(levels),
        look_(look) {
    osg::ref_ptr<osg::Group> root = geocentric ? new osg::CoordinateSystemNode : new osg::Group;
    if (geocentric)
      static_cast<osg::CoordinateSystemNode*>(root.get())->setEllipsoidModel(new osg::EllipsoidModel);
    root->addChild(tile(0, 0, 0));
    written_ = osgDB::writeNodeFile(*root, file().string());
  }
  std::filesystem::path file() const { return folder_ / ("scene" + ending_); }
  std::filesystem::path page(int level, int column, int row) const {
    return folder_ / nameOf(level, column, row);
  }
  bool written() const { return written_; }

 private:
  std::string nameOf(int level, int column, int row) const {
    return "page_" + std::to_string(level) + "_" + std::to_string(column) + "_" + std::to_string(row) +
           ending_;
  }

  /// A texture of some posts' length, which coarser levels sample at their posts.
  static float shadeAt(int column, int row) {
    return 0.5f +
           0.45f * std::sin(0.13f * static_cast<float>(column)) * std::cos(0.11f * static_cast<float>(row));
  }

  osg::ref_ptr<osg::Node> surface(int level, int column, int row) const {
    const int posts = (terrain_.posts() - 1) >> level, step = posts / kCells;
    const auto at = [&](int x, int y) {
      const Vec3 local = terrain_.post(column * posts + x * step, row * posts + y * step);
      const Vec3 p = geocentric_ ? terrain_.index().frame.toEcef(local) : local;
      return osg::Vec3d(p.x, p.y, p.z);
    };
    const osg::Vec3d middle = at(kCells / 2, kCells / 2);
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colours = new osg::Vec4Array;
    for (int y = 0; y <= kCells; ++y)
      for (int x = 0; x <= kCells; ++x) {
        vertices->push_back(at(x, y) - middle);
        osg::Vec3d normal = (at(std::min(x + 1, kCells), y) - at(std::max(x - 1, 0), y)) ^
                            (at(x, std::min(y + 1, kCells)) - at(x, std::max(y - 1, 0)));
        normal.normalize();
        normals->push_back(normal);
        const float shade = look_.alike ? shadeAt(column * posts + x * step, row * posts + y * step)
                                        : 0.3f + static_cast<float>((x * 37 + y * 91) % 120) / 200;
        colours->push_back(
            {shade, 1 - shade, look_.alike ? 0.3f : 0.2f + 0.25f * static_cast<float>(level), 1});
      }
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (int y = 0; y < kCells; ++y)
      for (int x = 0; x < kCells; ++x) {
        const int a = y * (kCells + 1) + x, above = a + kCells + 1;
        for (const int i : {a, a + 1, above, a + 1, above + 1, above})
          triangles->push_back(static_cast<GLushort>(i));
      }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    geometry->setColorArray(colours, osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(triangles);
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(geometry);
    osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(osg::Matrixd::translate(middle));
    place->addChild(geode);
    return place;
  }

  /// Returns a tile; below the last level it names its page, which is written too.
  osg::ref_ptr<osg::Node> tile(int level, int column, int row) {
    osg::ref_ptr<osg::Node> own = surface(level, column, row);
    if (level + 1 == levels_) return own;
    osg::ref_ptr<osg::Group> finer = new osg::Group;
    for (int i = 0; i < 4; ++i) finer->addChild(tile(level + 1, 2 * column + i % 2, 2 * row + i / 2));
    osgDB::writeNodeFile(*finer, page(level, column, row).string());
    const osg::BoundingSphere bound = own->getBound();
    osg::ref_ptr<osg::PagedLOD> lod = new osg::PagedLOD;
    lod->setCenter(bound.center());
    lod->setRadius(bound.radius());
    lod->addChild(own, look_.radii * bound.radius(), 1e10f);
    lod->setFileName(1, nameOf(level, column, row));
    lod->setRange(1, 0, look_.radii * bound.radius());
    return lod;
  }

  const SyntheticTerrain& terrain_;
  std::filesystem::path folder_;
  std::string ending_;
  bool geocentric_, written_ = false;
  int levels_;
  Look look_;
};

}  // namespace trimtab::test
