#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>

#include "triangles.h"
#include "trimtab/terrain/scenery/lines.h"
#include "trimtab/terrain/scenery/scenery.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

constexpr std::uint32_t kMagic = 0x5347;  ///< "SG" in the upper half of the first word
constexpr std::size_t kMostNameBytes = 128, kMostMaterials = 65535;
/// Widest real tiles reach some 60 km from their centre.
constexpr float kMostOffsetM = 300e3f;
/// Dead Sea to Everest with the ellipsoid's flattening and some room.
constexpr double kNearestM = 6.33e6, kFarthestM = 6.41e6;

enum Kind : std::uint8_t {
  kBoundingSphere = 0,
  kVertices = 1,
  kNormals = 2,
  kTexCoords = 3,
  kColours = 4,
  kFloatAttributes = 5,
  kIntegerAttributes = 6,
  kPoints = 9,
  kTriangles = 10,
  kStrips = 11,
  kFans = 12
};
enum PropertyKind : std::uint8_t { kMaterial = 0, kIndexTypes = 1, kVertexAttributes = 2 };
enum IndexMask : std::uint32_t {
  kVertexIndex = 1,
  kNormalIndex = 2,
  kColourIndex = 4,
  kTextureIndex = 8,
  kAllIndices = 0x7f
};

/// A number read past the end says so by making the reader fail; all that follows is not read.
class BtgReader {
 public:
  BtgReader(std::string_view bytes, const std::string& where, bool withTexture)
      : bytes_(bytes), where_(where), withTexture_(withTexture) {}

  Result<SceneryMesh> read();

 private:
  template <class T>
  std::optional<T> take(const char* what) {
    if (bytes_.size() - at_ < sizeof(T)) {
      refuse(at_, what, std::to_string(sizeof(T)) + " bytes",
             std::to_string(bytes_.size() - at_) + " until the end of the file");
      return {};
    }
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  /// Reads a 16-bit number up to version 9, a 32-bit one from 10.
  std::optional<std::uint32_t> takeCount(const char* what) {
    if (wide_) return take<std::uint32_t>(what);
    const auto narrow = take<std::uint16_t>(what);
    return narrow ? std::optional<std::uint32_t>(*narrow) : std::nullopt;
  }
  std::optional<std::string_view> takeBlock(const char* what) {
    const std::size_t start = at_;
    const auto size = take<std::uint32_t>(what);
    if (!size) return {};
    if (bytes_.size() - at_ < *size) {
      refuse(start, what, "at most the " + std::to_string(bytes_.size() - at_) + " bytes that are left",
             std::to_string(*size));
      return {};
    }
    at_ += *size;
    return bytes_.substr(at_ - *size, *size);
  }
  void refuse(std::size_t offset, std::string key, std::string expected, std::string found) {
    findings_.push_back({Severity::error, where_ + ":" + std::to_string(offset),
                         object_.empty() ? std::move(key) : object_ + key, std::move(expected),
                         std::move(found)});
    failed_ = true;
  }
  void warn(std::size_t offset, std::string key, std::string expected, std::string found) {
    findings_.push_back({Severity::warning, where_ + ":" + std::to_string(offset), object_ + key,
                         std::move(expected), std::move(found)});
  }

  struct Object {
    std::uint8_t kind = 0;
    std::uint32_t indexMask = 0, attributeMask = 0;
    std::uint16_t material = 0;
  };
  bool readObject();
  bool readProperty(Object& object);
  bool readElement(const Object& object, std::string_view block, std::size_t offset);
  bool readIndices(const Object& object, std::string_view block, std::size_t offset);
  using Corners = std::array<std::uint32_t, 3>;
  void addTriangle(const Corners& vertex, const Corners& texture, std::uint16_t material);
  bool placeTexture();
  std::optional<std::uint16_t> materialOf(std::string_view name, std::size_t offset);
  bool placeVertices();

  std::string_view bytes_;
  std::string where_, object_;
  std::size_t at_ = 0;
  bool withTexture_, wide_ = false, failed_ = false;
  Findings findings_;
  SceneryMesh mesh_;
  std::map<std::string, std::uint16_t, std::less<>> materials_;
  std::optional<Vec3> centre_;
  std::vector<std::array<float, 3>> offsets_;  ///< of vertices from the centre
  std::size_t verticesAt_ = 0;
  std::size_t normals_ = 0, colours_ = 0, texCoords_ = 0;
  static constexpr std::uint32_t kNoTexture = 0xffffffffu;
  std::vector<TexturePlace> texturePlaces_;  ///< if asked for
  std::vector<Corners> textureCorners_;      ///< per triangle, of texturePlaces_ or kNoTexture; if asked for
  /// Largest index of each column of the masks, and where it stands: arrays may follow the triangles.
  struct Highest {
    std::uint32_t index = 0;
    std::size_t offset = 0;
    bool any = false;
  };
  std::array<Highest, 4> highest_;  ///< vertices, normals, colours, texture coordinates
  static constexpr std::array<const char*, 4> kColumnNames{"vertices", "normals", "colours",
                                                           "texture coordinates"};
};

std::optional<std::uint16_t> BtgReader::materialOf(std::string_view name, std::size_t offset) {
  name = name.substr(0, name.find('\0'));
  const bool printable = std::none_of(name.begin(), name.end(), [](char c) {
    const auto u = static_cast<unsigned char>(c);
    return u < 0x20 || u == 0x7f;
  });
  if (!printable || name.size() > kMostNameBytes) {
    refuse(offset, "material", "a printable name of at most " + std::to_string(kMostNameBytes) + " bytes",
           std::to_string(name.size()) + " bytes" + (printable ? "" : ", some of them control characters"));
    return {};
  }
  const auto known = materials_.find(name);
  if (known != materials_.end()) return known->second;
  if (mesh_.materials.size() >= kMostMaterials) {
    refuse(offset, "material", "at most " + std::to_string(kMostMaterials) + " materials", "more");
    return {};
  }
  const auto index = static_cast<std::uint16_t>(mesh_.materials.size());
  mesh_.materials.emplace_back(name);
  materials_.emplace(name, index);
  return index;
}

bool BtgReader::readProperty(Object& object) {
  const std::size_t start = at_;
  const auto kind = take<std::uint8_t>("property type");
  const auto block = kind ? takeBlock("property length") : std::nullopt;
  if (!block) return false;
  if (*kind == kMaterial && object.kind >= kTriangles && object.kind <= kFans) {
    const auto material = materialOf(*block, start);
    if (!material) return false;
    object.material = *material;
  } else if (*kind == kIndexTypes) {
    if (block->size() != 1) {
      refuse(start, "index types", "1 byte", std::to_string(block->size()));
      return false;
    }
    object.indexMask = static_cast<std::uint8_t>((*block)[0]);
  } else if (*kind == kVertexAttributes) {
    if (block->size() != 4) {
      refuse(start, "vertex attributes", "4 bytes", std::to_string(block->size()));
      return false;
    }
    std::memcpy(&object.attributeMask, block->data(), 4);
  }
  return true;
}

void BtgReader::addTriangle(const Corners& vertex, const Corners& texture, std::uint16_t material) {
  ++mesh_.trianglesInFile;
  const auto [a, b, c] = vertex;
  if (a == b || b == c || c == a) {
    ++mesh_.degenerate;
    return;
  }
  mesh_.triangles.push_back({vertex, material});
  if (withTexture_) textureCorners_.push_back(texture);
}

bool BtgReader::readIndices(const Object& object, std::string_view block, std::size_t offset) {
  if ((object.indexMask & kVertexIndex) == 0 || (object.indexMask & ~kAllIndices) != 0) {
    refuse(offset, "index types", "a mask of 1 to 127 with bit 0, vertices",
           std::to_string(object.indexMask));
    return false;
  }
  const std::size_t width = wide_ ? 4 : 2;
  const std::size_t columns =
      static_cast<std::size_t>(std::popcount(object.indexMask) + std::popcount(object.attributeMask));
  const std::size_t stride = width * columns;
  const std::size_t count = block.size() / stride;
  if (block.size() % stride != 0 || (object.kind == kTriangles && count % 3 != 0)) {
    refuse(offset, "length",
           "a multiple of " + std::to_string(object.kind == kTriangles ? 3 * stride : stride) + " bytes",
           std::to_string(block.size()));
    return false;
  }
  const auto at = [&](std::size_t row, std::size_t column) -> std::uint32_t {
    const char* from = block.data() + row * stride + column * width;
    if (wide_) {
      std::uint32_t value;
      std::memcpy(&value, from, 4);
      return value;
    }
    std::uint16_t value;
    std::memcpy(&value, from, 2);
    return value;
  };
  std::size_t column = 0;
  for (std::uint32_t bit = 0; bit < 7; ++bit) {
    if ((object.indexMask & 1u << bit) == 0) continue;
    Highest& highest = highest_[std::min<std::size_t>(bit, 3)];
    for (std::size_t i = 0; i < count; ++i)
      if (const std::uint32_t index = at(i, column); !highest.any || index > highest.index)
        highest = {index, offset + 4 + i * stride + column * width, true};
    ++column;
  }
  const bool textured = (object.indexMask & kTextureIndex) != 0;
  const auto textureColumn = static_cast<std::size_t>(std::popcount(object.indexMask & (kTextureIndex - 1)));
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    const auto texture = [&](std::size_t row) { return textured ? at(row, textureColumn) : kNoTexture; };
    addTriangle({at(a, 0), at(b, 0), at(c, 0)}, {texture(a), texture(b), texture(c)}, object.material);
  };
  switch (object.kind) {
    case kTriangles:
      for (std::size_t i = 0; i + 2 < count; i += 3) add(i, i + 1, i + 2);
      break;
    case kStrips:
      for (std::size_t i = 0; i + 2 < count; ++i) add(i, i + 1 + i % 2, i + 2 - i % 2);
      break;
    case kFans:
      for (std::size_t i = 1; i + 1 < count; ++i) add(0, i, i + 1);
      break;
    default:
      break;
  }
  return true;
}

bool BtgReader::readElement(const Object& object, std::string_view block, std::size_t offset) {
  const auto whole = [&](std::size_t size, std::size_t& count) {
    if (block.size() % size != 0) {
      refuse(offset, "length", "a multiple of " + std::to_string(size) + " bytes",
             std::to_string(block.size()));
      return false;
    }
    count += block.size() / size;
    return true;
  };
  switch (object.kind) {
    case kBoundingSphere: {
      if (block.size() != 28) {
        refuse(offset, "length", "28 bytes", std::to_string(block.size()));
        return false;
      }
      Vec3 centre;
      float radius;
      std::memcpy(&centre.x, block.data(), 8);
      std::memcpy(&centre.y, block.data() + 8, 8);
      std::memcpy(&centre.z, block.data() + 16, 8);
      std::memcpy(&radius, block.data() + 24, 4);
      const double distance = length(centre);
      if (!(distance > 6e6 && distance < 7e6) || !(radius >= 0 && radius < 1e7f)) {
        refuse(offset, "bounding sphere", "a centre 6,000 to 7,000 km from the earth's, a radius in metres",
               numberText(distance / 1000, 6) + " km, radius " + numberText(radius, 6) + " m");
        return false;
      }
      centre_ = centre;
      return true;
    }
    case kVertices: {
      std::size_t count = offsets_.size();
      if (!whole(12, count)) return false;
      if (offsets_.empty()) verticesAt_ = offset + 4;
      const std::size_t before = offsets_.size();
      offsets_.resize(count);
      if (!block.empty()) std::memcpy(offsets_.data() + before, block.data(), block.size());
      return true;
    }
    case kNormals:
      return whole(3, normals_);
    case kTexCoords:
      if (!whole(8, texCoords_)) return false;
      if (withTexture_ && !block.empty()) {
        const std::size_t before = texturePlaces_.size();
        texturePlaces_.resize(texCoords_);
        std::memcpy(texturePlaces_.data() + before, block.data(), block.size());
      }
      return true;
    case kColours:
      return whole(16, colours_);
    case kPoints:
    case kTriangles:
    case kStrips:
    case kFans:
      return readIndices(object, block, offset);
    default:
      return true;
  }
}

bool BtgReader::readObject() {
  const std::size_t start = at_;
  const auto kind = take<std::uint8_t>("type");
  const auto properties = kind ? takeCount("number of properties") : std::nullopt;
  const auto elements = properties ? takeCount("number of elements") : std::nullopt;
  if (!elements) return false;
  if (*kind > kFans || *kind == 7 || *kind == 8)
    warn(start, "type", "0 to 6 or 9 to 12", std::to_string(*kind) + ", skipped");
  Object object{*kind, *kind == kPoints ? 1u : 9u, 0, 0};
  // A count that a flipped bit makes huge ends at the end of the file: each item takes bytes.
  for (std::uint32_t i = 0; i < *properties; ++i)
    if (!readProperty(object)) return false;
  if (object.kind >= kTriangles && object.kind <= kFans && mesh_.materials.empty()) materialOf("", start);
  for (std::uint32_t i = 0; i < *elements; ++i) {
    const std::size_t offset = at_;
    const auto block = takeBlock("element length");
    if (!block || !readElement(object, *block, offset)) return false;
  }
  return true;
}

bool BtgReader::placeVertices() {
  object_.clear();
  const std::array<std::size_t, 4> sizes{offsets_.size(), normals_, colours_, texCoords_};
  for (std::size_t k = 0; k < sizes.size(); ++k)
    if (highest_[k].any && highest_[k].index >= sizes[k])
      refuse(highest_[k].offset, std::string("index of ") + kColumnNames[k],
             "below " + std::to_string(sizes[k]) + ", their number", std::to_string(highest_[k].index));
  if (failed_) return false;
  if (offsets_.empty()) return true;
  if (!centre_) {
    refuse(bytes_.size(), "bounding sphere", "one, as the vertices are relative to its centre", "none");
    return false;
  }
  mesh_.vertices.reserve(offsets_.size());
  std::size_t bad = 0, firstBad = 0;
  for (const auto& o : offsets_) {
    const Vec3 p = *centre_ + Vec3{o[0], o[1], o[2]};
    const double distance = length(p);
    const bool near =
        std::abs(o[0]) < kMostOffsetM && std::abs(o[1]) < kMostOffsetM && std::abs(o[2]) < kMostOffsetM;
    if (!near || !(distance > kNearestM && distance < kFarthestM)) {
      if (bad++ == 0) firstBad = mesh_.vertices.size();
    }
    mesh_.vertices.push_back(p);
  }
  if (bad > 0)
    refuse(verticesAt_ + 12 * firstBad, "vertex " + std::to_string(firstBad),
           "a place within 300 km of the tile's centre and on the earth",
           numberText(length(mesh_.vertices[firstBad]), 8) + " m from the earth's centre" +
               (bad > 1 ? ", and " + std::to_string(bad - 1) + " more like it" : ""));
  return bad == 0;
}

bool BtgReader::placeTexture() {
  if (texturePlaces_.empty()) return true;
  for (std::size_t i = 0; i < texturePlaces_.size(); ++i)
    if (const auto [u, v] = texturePlaces_[i]; !std::isfinite(u) || !std::isfinite(v)) {
      refuse(bytes_.size(), "texture coordinates " + std::to_string(i), "finite numbers",
             numberText(u, 6) + " " + numberText(v, 6));
      return false;
    }
  mesh_.texture.resize(textureCorners_.size());
  for (std::size_t t = 0; t < textureCorners_.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (const std::uint32_t at = textureCorners_[t][k]; at != kNoTexture)
        mesh_.texture[t][k] = texturePlaces_[at];
  return true;
}

Result<SceneryMesh> BtgReader::read() {
  std::string name = std::filesystem::path(where_).filename().string();
  for (const std::string_view ending : {".gz", ".btg"})
    if (name.size() > ending.size() && name.ends_with(ending)) name.resize(name.size() - ending.size());
  mesh_.name = name;
  mesh_.airport = isAirport(name);

  const auto header = take<std::uint32_t>("magic number and version");
  if (!header) return findings_;
  if (*header >> 16 != kMagic) {
    refuse(0, "magic number", "\"SG\" in bytes 2 and 3, zipped or not", "something else");
    return findings_;
  }
  mesh_.version = static_cast<int>(*header & 0xffff);
  if (mesh_.version != 6 && mesh_.version != 7 && mesh_.version != 10) {
    refuse(0, "version", "6, 7 or 10", std::to_string(mesh_.version));
    return findings_;
  }
  // Version 6 has the layout of 7.
  wide_ = mesh_.version == 10;
  if (!take<std::uint32_t>("creation time")) return findings_;
  const auto objects = takeCount("number of objects");
  if (!objects) return findings_;
  for (std::uint32_t i = 0; i < *objects; ++i) {
    object_ = "object " + std::to_string(i) + ": ";
    if (!readObject()) return findings_;
  }
  object_.clear();
  if (at_ < bytes_.size())
    warn(at_, "", "the end of the file", std::to_string(bytes_.size() - at_) + " bytes more");
  if (!placeVertices() || !placeTexture()) return findings_;
  tidyTriangles(mesh_);
  return Result<SceneryMesh>(std::move(mesh_), std::move(findings_));
}

}  // namespace

Result<SceneryMesh> parseBtg(std::string_view bytes, const std::string& where, bool withTexture) {
  return BtgReader(bytes, where, withTexture).read();
}

}  // namespace trimtab::terrain
