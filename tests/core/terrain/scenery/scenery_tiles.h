#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support.h"
#include "trimtab/terrain/scenery/scenery.h"

/// Scenery that tests make for themselves.
namespace trimtab::test {

/// Bytes of a .btg, object by object; nothing is checked, so that tests can write what is wrong.
class BtgWriter {
 public:
  struct Property {
    std::uint8_t kind;
    std::string bytes;
  };

  explicit BtgWriter(int version) : version_(version) {}

  template <class T>
  static std::string raw(T value) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    return bytes;
  }
  std::string count(std::size_t value) const {
    return version_ >= 10 ? raw(static_cast<std::uint32_t>(value)) : raw(static_cast<std::uint16_t>(value));
  }
  std::string indices(const std::vector<std::size_t>& values) const {
    std::string bytes;
    for (const std::size_t value : values) bytes += count(value);
    return bytes;
  }
  BtgWriter& object(std::uint8_t kind, const std::vector<Property>& properties,
                    const std::vector<std::string>& elements) {
    body_ += static_cast<char>(kind) + count(properties.size()) + count(elements.size());
    for (const Property& p : properties)
      body_ += static_cast<char>(p.kind) + raw(static_cast<std::uint32_t>(p.bytes.size())) + p.bytes;
    for (const std::string& e : elements) body_ += raw(static_cast<std::uint32_t>(e.size())) + e;
    ++objects_;
    return *this;
  }
  /// Bounding sphere and vertices of places.
  BtgWriter& places(const std::vector<GeodeticPosition>& places) {
    const Vec3 centre = toEcef(places.at(places.size() / 2));
    std::string offsets;
    for (const GeodeticPosition& place : places) {
      const Vec3 offset = toEcef(place) - centre;
      for (const double x : {offset.x, offset.y, offset.z}) offsets += raw(static_cast<float>(x));
    }
    object(0, {}, {raw(centre.x) + raw(centre.y) + raw(centre.z) + raw(20000.0f)});
    return object(1, {}, {offsets});
  }
  std::string bytes() const {
    return raw(static_cast<std::uint32_t>(0x53470000 + version_)) + raw(std::uint32_t{1700000000}) +
           count(objects_) + body_;
  }

 private:
  int version_;
  std::size_t objects_ = 0;
  std::string body_;
};

struct TileRecipe {
  int version = 7, cells = 4;
  std::uint8_t kind = 10;  ///< 10 triangles, 11 strips, 12 fans
  double west = 7, south = 50.5, width = 0.25, height = 0.125;
  std::function<double(double longitude, double latitude)> heightM = [](double, double) { return 100.0; };
  bool hole = false;  ///< the cell in the south-west, but one, is left out
};

/// A tile of equal cells of two triangles: western half "Lake", eastern half "EvergreenForest".
inline std::string gridTile(const TileRecipe& recipe) {
  BtgWriter writer(recipe.version);
  const int n = recipe.cells;
  std::vector<GeodeticPosition> places;
  for (int r = 0; r <= n; ++r)
    for (int c = 0; c <= n; ++c) {
      const double longitude = recipe.west + recipe.width * c / n,
                   latitude = recipe.south + recipe.height * r / n;
      places.push_back({Degrees{latitude}, Degrees{longitude}, Metres{recipe.heightM(longitude, latitude)}});
    }
  writer.places(places);
  writer.object(3, {}, {std::string(places.size() * 8, '\0')});
  const auto at = [&](int r, int c) { return static_cast<std::size_t>(r * (n + 1) + c); };
  const auto both = [](std::vector<std::size_t> corners) {  // vertex and texture coordinate alike
    std::vector<std::size_t> all;
    for (const std::size_t corner : corners) all.insert(all.end(), 2, corner);
    return all;
  };
  for (const bool east : {false, true}) {
    std::vector<std::string> elements;
    std::string triangles;
    for (int r = 0; r < n; ++r)
      for (int c = east ? n / 2 : 0; c < (east ? n : n / 2); ++c) {
        if (recipe.hole && r == 1 && c == 1) continue;
        const std::size_t sw = at(r, c), se = at(r, c + 1), nw = at(r + 1, c), ne = at(r + 1, c + 1);
        if (recipe.kind == 10)
          triangles += writer.indices(both({sw, se, ne, sw, ne, nw}));
        else if (recipe.kind == 11)
          elements.push_back(writer.indices(both({nw, sw, ne, se})));
        else
          elements.push_back(writer.indices(both({sw, se, ne, nw})));
      }
    if (recipe.kind == 10) elements.push_back(triangles);
    writer.object(recipe.kind, {{0, east ? "EvergreenForest" : "Lake"}, {1, std::string(1, '\x9')}},
                  elements);
  }
  return writer.bytes();
}

inline std::string gzipped(const std::string& bytes) {
  z_stream z{};
  if (deflateInit2(&z, 9, Z_DEFLATED, 31, 8, Z_DEFAULT_STRATEGY) != Z_OK) std::abort();
  std::string out(deflateBound(&z, static_cast<uLong>(bytes.size())) + 32, '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  if (deflate(&z, Z_FINISH) != Z_STREAM_END) std::abort();
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

/// A mesh that anything may be done with: no index points nowhere, every vertex is on the earth.
inline bool isSound(const terrain::SceneryMesh& mesh) {
  for (const Vec3& v : mesh.vertices)
    if (!(length(v) > 6.3e6 && length(v) < 6.5e6)) return false;
  for (const auto& t : mesh.triangles) {
    if (t.material >= mesh.materials.size()) return false;
    for (const std::uint32_t v : t.vertex)
      if (v >= mesh.vertices.size()) return false;
  }
  return mesh.trianglesInFile == mesh.degenerate + mesh.triangles.size();
}

/// What a refusal must be: at least one error, each with a place, what was expected and what was there.
inline bool tellsWhy(const Findings& findings) {
  bool error = false;
  for (const Finding& f : findings) {
    error = error || f.severity == Severity::error;
    if (f.where.empty() || f.expected.empty() || f.found.empty()) return false;
  }
  return error;
}

}  // namespace trimtab::test
