#include "trimtab/scene/osg_database.h"

#include <osg/Callback>
#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/PagedLOD>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <list>
#include <mutex>
#include <numbers>

#include "page_reads.h"
#include "trimtab/units/number.h"

namespace trimtab::scene {
namespace {

constexpr const char* kWithoutOrigin = "flat coordinates without an origin";

constexpr std::array kEndings{".ive", ".osgb", ".osgt", ".osg", ".osgx", ".txp"};

osg::Vec3d toOsg(Vec3 v) {
  return {v.x, v.y, v.z};
}
Vec3 fromOsg(const osg::Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// Visits every vertex that a node holds without reading pages, in its coordinates.
class Vertices final : public osg::NodeVisitor {
 public:
  Vertices() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
  void apply(osg::Drawable& drawable) override {
    const osg::Matrixd matrix = osg::computeLocalToWorld(getNodePath());
    const osg::Geometry* geometry = drawable.asGeometry();
    const auto* floats =
        geometry == nullptr ? nullptr : dynamic_cast<const osg::Vec3Array*>(geometry->getVertexArray());
    if (floats != nullptr)
      for (const osg::Vec3& vertex : *floats) all.push_back(fromOsg(osg::Vec3d(vertex) * matrix));
    else if (const osg::BoundingBox& box = drawable.getBoundingBox(); box.valid())
      for (unsigned i = 0; i < 8; ++i) all.push_back(fromOsg(osg::Vec3d(box.corner(i)) * matrix));
  }
  std::vector<Vec3> all;
};

/// Finds the files of the pages that a node names.
class PageNames final : public osg::NodeVisitor {
 public:
  PageNames() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
  void apply(osg::PagedLOD& node) override {
    for (unsigned i = 0; i < node.getNumFileNames(); ++i)
      if (!node.getFileName(i).empty()) all.push_back(node.getDatabasePath() + node.getFileName(i));
    traverse(node);
  }
  std::vector<std::string> all;
};

class FindsEllipsoid final : public osg::NodeVisitor {
 public:
  FindsEllipsoid() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
  void apply(osg::CoordinateSystemNode& node) override {
    found |= node.getEllipsoidModel() != nullptr;
    traverse(node);
  }
  bool found = false;
};

/// Reads pages for questions about heights and keeps the last ones used.
class KeptPages final : public osgUtil::IntersectionVisitor::ReadCallback {
 public:
  explicit KeptPages(PageReads& reads) : reads_(reads) {}
  osg::ref_ptr<osg::Node> readNodeFile(const std::string& name) override {
    const auto known =
        std::find_if(pages_.begin(), pages_.end(), [&](const Page& page) { return page.name == name; });
    if (known != pages_.end())
      pages_.splice(pages_.begin(), pages_, known);
    else
      pages_.push_front({name, reads_.readPage(name)});
    // A ray down goes through one page per level, so these serve a flight around several places.
    if (pages_.size() > 128) pages_.pop_back();
    return pages_.front().node;
  }

 private:
  struct Page {
    std::string name;
    osg::ref_ptr<osg::Node> node;  ///< null if it cannot be read: it is not tried again soon
  };
  PageReads& reads_;
  std::list<Page> pages_;
};

/// Sets the extent that the coarsest triangles have.
void setExtent(terrain::TerrainInfo& info, const std::vector<Vec3>& ecef) {
  double south = 90, north = -90, west = 0, east = 0, lowest = std::numeric_limits<double>::infinity(),
         highest = -lowest;
  const Degrees first = toGeodetic(ecef.front()).longitude;
  for (const Vec3 p : ecef) {
    const GeodeticPosition at = toGeodetic(p);
    const double away = wrapped180(at.longitude - first).value();
    south = std::min(south, at.latitude.value());
    north = std::max(north, at.latitude.value());
    west = std::min(west, away);
    east = std::max(east, away);
    lowest = std::min(lowest, at.height.value());
    highest = std::max(highest, at.height.value());
  }
  info.southWest = {Degrees{south}, wrapped180(first + Degrees{west}), Metres{0}};
  info.northEast = {Degrees{north}, wrapped180(first + Degrees{east}), Metres{0}};
  // A scene has no posts: its corners stand for them, as places are found by them.
  info.columns = info.rows = 2;
  info.postLongitude = Degrees{east - west};
  info.postLatitude = Degrees{north - south};
  info.lowest = Metres{lowest};
  info.highest = Metres{highest};
}

class OpenScene final : public OsgDatabase {
 public:
  explicit OpenScene(std::filesystem::path file)
      : file_(std::move(file)), reads_(new PageReads(file_)), kept_(new KeptPages(*reads_)) {}

  Findings open(const std::optional<GeodeticPosition>& origin);

  const terrain::TerrainInfo& info() const override { return info_; }
  const TerrainIndex& index() const override { return index_; }
  void buildTile(std::uint32_t, terrain::TileMesh&) const override {}
  const std::filesystem::path& file() const override { return file_; }
  bool geocentric() const override { return geocentric_; }
  Findings damage() const override { return reads_->findings(); }
  /// The coarsest triangles say how high the ground is, but finer ones may be higher.
  std::optional<Metres> highest() const override { return std::nullopt; }
  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override;
  std::optional<Metres> highestWithin(Degrees latitude, Degrees longitude, Metres radius) const override;

 private:
  osg::Vec3d inScene(const GeodeticPosition& place) const {
    return toOsg(geocentric_ ? toEcef(place) : index_.frame.fromGeodetic(place));
  }
  Finding refused(std::string expected, std::string found) const {
    return {Severity::error, file_.string(), {}, std::move(expected), std::move(found)};
  }

  std::filesystem::path file_;
  osg::ref_ptr<PageReads> reads_;
  osg::ref_ptr<KeptPages> kept_;
  osg::ref_ptr<osg::Node> root_;
  bool geocentric_ = false;
  terrain::TerrainInfo info_;
  TerrainIndex index_;
  mutable std::mutex mutex_;  ///< OSG computes bounds when it first needs them
};

Findings OpenScene::open(const std::optional<GeodeticPosition>& origin) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file_, error))
    return {refused("a file of an OpenSceneGraph scene", "none")};
  root_ = reads_->readRoot();
  if (!root_) {
    Findings findings = reads_->findings();
    findings.push_back(refused("a scene that OpenSceneGraph can read", "none"));
    return findings;
  }
  Vertices vertices;
  root_->accept(vertices);
  if (vertices.all.empty()) {
    PageNames names;
    root_->accept(names);
    for (const std::string& name : names.all)
      if (const osg::ref_ptr<osg::Node> page = reads_->readPage(name)) page->accept(vertices);
  }
  if (vertices.all.empty()) {
    Findings findings = reads_->findings();
    findings.push_back(refused("a scene with triangles, in the file or in the pages that it names",
                               "none: `osgviewer FILE` shows what OpenSceneGraph makes of it"));
    return findings;
  }
  if (std::any_of(vertices.all.begin(), vertices.all.end(),
                  [](Vec3 p) { return !std::isfinite(p.x + p.y + p.z); }))
    return {refused("vertices with finite coordinates", "one that is no number")};
  FindsEllipsoid ellipsoid;
  root_->accept(ellipsoid);
  geocentric_ = ellipsoid.found;
  if (geocentric_ && origin)
    return {refused("no origin, because the scene's coordinates are geocentric", "one (--origin)")};
  if (geocentric_) {
    // No ground is further than this from WGS 84.
    constexpr double kMostM = 20e3;
    for (const Vec3 p : vertices.all)
      if (!(std::abs(toGeodetic(p).height.value()) < kMostM))
        return {refused("geocentric coordinates (WGS 84, metres), as the scene's ellipsoid says",
                        "a vertex more than 20 km above or below the ellipsoid")};
  } else if (!origin) {
    return {refused(
        "geocentric coordinates (a CoordinateSystemNode with an ellipsoid), or the latitude and "
        "longitude of the place where flat coordinates are 0: give --origin LAT,LON if they are metres "
        "east, north and up",
        kWithoutOrigin)};
  } else {
    index_.frame = LocalFrame(*origin);
    for (Vec3& p : vertices.all) p = index_.frame.toEcef(p);
  }
  info_.name = file_.stem().string();
  info_.source = file_.string();
  info_.bytes = std::filesystem::file_size(file_, error);
  setExtent(info_, vertices.all);
  if (geocentric_)
    index_.frame = LocalFrame({(info_.southWest.latitude + info_.northEast.latitude) / 2,
                               wrapped180(info_.southWest.longitude + info_.postLongitude / 2), Metres{0}});
  return {};
}

std::optional<Metres> OpenScene::heightAt(Degrees latitude, Degrees longitude) const {
  // From above the highest ground of the earth to below the lowest.
  constexpr Metres kAbove{10e3}, kBelow{-2e3};
  osg::ref_ptr<osgUtil::LineSegmentIntersector> ray = new osgUtil::LineSegmentIntersector(
      inScene({latitude, longitude, kAbove}), inScene({latitude, longitude, kBelow}));
  if (!ray->getStart().valid() || !ray->getEnd().valid()) return std::nullopt;
  ray->setPrecisionHint(osgUtil::Intersector::USE_DOUBLE_CALCULATIONS);
  const std::lock_guard lock(mutex_);
  osgUtil::IntersectionVisitor visitor(ray.get(), kept_.get());
  root_->accept(visitor);
  if (!ray->containsIntersections()) return std::nullopt;
  const Vec3 hit = fromOsg(ray->getFirstIntersection().getWorldIntersectPoint());
  return (geocentric_ ? toGeodetic(hit) : index_.frame.toGeodetic(hit)).height;
}

std::optional<Metres> OpenScene::highestWithin(Degrees latitude, Degrees longitude, Metres radius) const {
  // Rays are slow, so a few directions stand for all.
  std::optional<Metres> highest = heightAt(latitude, longitude);
  const double north = radius.value() / 111e3,
               east = north / std::max(std::cos(latitude.in<Radians>()), 0.01);
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::numbers::pi / 4;
    const auto height = heightAt(latitude + Degrees{north * std::cos(angle)},
                                 wrapped180(longitude + Degrees{east * std::sin(angle)}));
    if (height && (!highest || *height > *highest)) highest = height;
  }
  return highest;
}

}  // namespace

Result<std::shared_ptr<const terrain::Database>> OsgDatabase::open(
    const std::filesystem::path& file, const std::optional<GeodeticPosition>& origin) {
  auto scene = std::make_shared<OpenScene>(std::filesystem::absolute(file));
  Findings findings = scene->open(origin);
  if (!findings.empty()) return findings;
  return std::shared_ptr<const terrain::Database>(std::move(scene));
}

bool isOsgScene(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (ending == ".flt") {
    // Rasters of floats have this ending, too; an OpenFlight file begins with its header, record 1.
    std::array<char, 2> record{};
    return std::ifstream(file, std::ios::binary).read(record.data(), record.size()) &&
           record == std::array<char, 2>{0, 1};
  }
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

Result<std::shared_ptr<const terrain::Database>> openOsgScene(const std::filesystem::path& file,
                                                              const std::string& origin) {
  if (origin.empty()) return OsgDatabase::open(file, {});
  const Result<GeodeticPosition> place = originFrom(origin);
  if (!place) return place.findings();
  return OsgDatabase::open(file, *place);
}

bool lacksOrigin(const Findings& findings) {
  return findings.size() == 1 && findings.front().found == kWithoutOrigin;
}

Result<GeodeticPosition> originFrom(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma != std::string::npos) {
    const auto latitude = readNumber(text.substr(0, comma)), longitude = readNumber(text.substr(comma + 1));
    if (latitude && longitude && std::abs(*latitude) <= 90 && std::abs(*longitude) <= 180)
      return GeodeticPosition{Degrees{*latitude}, Degrees{*longitude}, Metres{0}};
  }
  return Finding{Severity::error, "--origin", {}, "LAT,LON in degrees, -90 to 90 and -180 to 180", text};
}

}  // namespace trimtab::scene
