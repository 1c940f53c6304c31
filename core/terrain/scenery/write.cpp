#include "trimtab/terrain/scenery/write.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <new>
#include <numbers>

namespace trimtab::terrain {

namespace {

constexpr std::uint32_t kMagic = 0x53470000;  ///< "SG" in the upper half
/// Types of objects and properties, and the index types of a triangle's corner (SimGear's sg_binobj).
constexpr std::uint8_t kBoundingSphere = 0, kVertices = 1, kNormals = 2, kTexCoords = 3, kTriangles = 10;
constexpr std::uint8_t kMaterial = 0, kIndexTypes = 1;
constexpr std::uint8_t kVertexNormalTexture = 1 | 2 | 8;
/// FlightGear's radius of the equator.
constexpr double kEquatorM = 6378137.0;

class BtgWriter {
 public:
  explicit BtgWriter(bool wide) : wide_(wide) {}

  template <class T>
  void put(T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  /// Writes a count or an index: 16 bits in version 7, 32 in version 10.
  void putCount(std::size_t value) {
    if (wide_)
      put(static_cast<std::uint32_t>(value));
    else
      put(static_cast<std::uint16_t>(value));
  }
  void object(std::uint8_t type, std::size_t properties, std::size_t elements) {
    put(type);
    putCount(properties);
    putCount(elements);
  }
  void object(std::uint8_t type, const std::string& element) {
    object(type, 0, 1);
    block(element);
  }
  void property(std::uint8_t type, std::string_view value) {
    put(type);
    block(value);
  }
  void block(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size()));
    bytes += value;
  }

  std::string bytes;

 private:
  bool wide_;
};

Vec3 middleOf(const std::vector<Vec3>& places) {
  Vec3 low = places.front(), high = low;
  for (const Vec3 p : places) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return (low + high) * 0.5;
}

std::string sphereOf(const std::vector<Vec3>& vertices, Vec3 centre) {
  double radius = 0;
  for (const Vec3 v : vertices) radius = std::max(radius, length(v - centre));
  BtgWriter out(false);
  out.put(centre.x);
  out.put(centre.y);
  out.put(centre.z);
  out.put(std::nextafter(static_cast<float>(radius), std::numeric_limits<float>::infinity()));
  return out.bytes;
}

}  // namespace

std::string btgBytes(const BtgSurface& surface) {
  const SceneryMesh& mesh = surface.mesh;
  const Vec3 centre = middleOf(mesh.vertices);
  BtgWriter vertices(false), normals(false), texture(false);
  for (const Vec3 v : mesh.vertices)
    for (const double d : {v.x - centre.x, v.y - centre.y, v.z - centre.z})
      vertices.put(static_cast<float>(d));
  for (const Vec3 n : surface.normals)
    for (const double d : {n.x, n.y, n.z})
      normals.put(static_cast<std::uint8_t>(std::lround((std::clamp(d, -1.0, 1.0) + 1) * 127.5)));
  for (const auto& t : surface.texture)
    for (const float d : t) texture.put(d);

  std::vector<std::vector<std::uint32_t>> byMaterial(mesh.materials.size());
  for (const SceneryMesh::Triangle& t : mesh.triangles)
    byMaterial[t.material].insert(byMaterial[t.material].end(), t.vertex.begin(), t.vertex.end());
  std::size_t objects = 4;
  for (const auto& corners : byMaterial) objects += !corners.empty();

  const bool wide = std::max(mesh.vertices.size(), objects) > 0xffff;
  BtgWriter out(wide);
  out.put(kMagic + (wide ? 10u : 7u));
  out.put(std::uint32_t{0});  // creation time
  out.putCount(objects);
  out.object(kBoundingSphere, sphereOf(mesh.vertices, centre));
  out.object(kVertices, vertices.bytes);
  out.object(kNormals, normals.bytes);
  out.object(kTexCoords, texture.bytes);
  const char indexTypes = static_cast<char>(kVertexNormalTexture);
  for (std::size_t m = 0; m < byMaterial.size(); ++m) {
    if (byMaterial[m].empty()) continue;
    out.object(kTriangles, 2, 1);
    out.property(kMaterial, mesh.materials[m]);
    out.property(kIndexTypes, {&indexTypes, 1});
    BtgWriter corners(wide);
    for (const std::uint32_t v : byMaterial[m])
      for (int column = 0; column < 3; ++column) corners.putCount(v);
    out.block(corners.bytes);
  }
  return out.bytes;
}

std::string gzip(std::string_view bytes) {
  z_stream z{};
  constexpr int kGzip = 16 + MAX_WBITS, kMemory = 8;
  if (::deflateInit2(&z, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string out(::deflateBound(&z, bytes.size()), '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  ::deflate(&z, Z_FINISH);  // the bound leaves room for all of it
  out.resize(z.total_out);
  ::deflateEnd(&z);
  return out;
}

std::vector<std::array<float, 2>> textureByPlace(const std::vector<Vec3>& places) {
  const GeodeticPosition middle = toGeodetic(middleOf(places));
  const double west = std::floor(middle.longitude.value()), south = std::floor(middle.latitude.value());
  const double kmPerDegree = kEquatorM * std::numbers::pi / 180 / 1000;
  const double eastKm = kmPerDegree * std::cos((south + 0.5) * std::numbers::pi / 180);
  std::vector<std::array<float, 2>> texture;
  texture.reserve(places.size());
  for (const Vec3 p : places) {
    const GeodeticPosition at = toGeodetic(p);
    const double east = std::remainder(at.longitude.value() - west, 360.0);
    texture.push_back(
        {static_cast<float>(east * eastKm), static_cast<float>((at.latitude.value() - south) * kmPerDegree)});
  }
  return texture;
}

std::filesystem::path bucketFolder(long index) {
  const auto name = [](long longitude, long latitude) {
    char text[32];
    std::snprintf(text, sizeof text, "%c%03ld%c%02ld", longitude < 0 ? 'w' : 'e', std::labs(longitude),
                  latitude < 0 ? 's' : 'n', std::labs(latitude));
    return std::string(text);
  };
  const auto tens = [](long degrees) { return degrees - ((degrees % 10) + 10) % 10; };
  const long longitude = (index >> 14) - 180, latitude = (index >> 6 & 0xff) - 90;
  return std::filesystem::path(name(tens(longitude), tens(latitude))) / name(longitude, latitude);
}

}  // namespace trimtab::terrain
