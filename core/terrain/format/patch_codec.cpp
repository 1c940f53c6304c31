#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <utility>

#include "trimtab/terrain/format/patch_store.h"

namespace trimtab::terrain {

namespace {

constexpr std::uint32_t kBlobMagic = 0x32505454;  // TTP2
constexpr double kSteps = static_cast<double>(PostGeometry::kStepsPerMetre);
constexpr std::int32_t kOriginSteps = 16 * static_cast<std::int32_t>(PostGeometry::kStepsPerMetre);
constexpr std::size_t kMostVertices = 1u << 16;  ///< of a patch: indices have 16 bits

struct BlobHeader {
  std::uint32_t magic = kBlobMagic, page = 0, patches = 0, vertices = 0, indices = 0;
  std::uint32_t patchBytes = 0, vertexBytes = 0, indexBytes = 0, exceptions = 0;
  std::uint32_t postShift = 0;  ///< of columns and rows
  std::uint32_t inheritedBytes = 0;
};
static_assert(sizeof(BlobHeader) == 44);

/// Packed up to the triangles of the index's last variant.
struct PackedPatch {
  std::int32_t origin[3];
  std::uint32_t firstColumn, firstRow, vertices;
  std::uint32_t triangles[PatchIndex::kMostVariants];
};
static_assert(sizeof(PackedPatch) == 24 + 4 * PatchIndex::kMostVariants);
std::size_t packedPatchBytes(std::size_t variants) {
  return offsetof(PackedPatch, triangles) + variants * sizeof(std::uint32_t);
}

struct PackedVertex {
  std::uint16_t column = 0, row = 0;  ///< from the patch's square, shifted
  std::int32_t height = 0;            ///< steps of the lattice along the normal of the ellipsoid
  std::int8_t normalX = 0, normalY = 0;
  std::int8_t normalZ = 0;  ///< less what x and y leave
  std::uint8_t unused = 0;
};
static_assert(sizeof(PackedVertex) == 12);

/// A vertex whose place is not that of its post at a whole number of steps: by how much it is off.
struct Exception {
  std::uint32_t vertex = 0;
  std::int32_t by[3] = {};
};

using Place = std::array<std::int64_t, 3>;

Place placeOf(const PostGeometry& geometry, std::uint32_t row, std::uint32_t column, std::int32_t height) {
  const PostGeometry::Lattice at = geometry.lattice(row, column, height / kSteps);
  return {at.x, at.y, at.z};
}
Place placeOf(const PatchMesh& mesh, const PatchVertex& v) {
  // Whole numbers of steps, exact in a float.
  const auto steps = [](float metres) {
    return static_cast<std::int64_t>(static_cast<double>(metres) * kSteps);
  };
  return {mesh.origin[0] * std::int64_t{kOriginSteps} + steps(v.x),
          mesh.origin[1] * std::int64_t{kOriginSteps} + steps(v.y),
          mesh.origin[2] * std::int64_t{kOriginSteps} + steps(v.z)};
}
int steepness(std::int8_t x, std::int8_t y) {
  return static_cast<int>(std::lround(std::sqrt(std::max(0, 127 * 127 - x * x - y * y))));
}

/// Returns the height whose place is the vertex's, or comes nearest, and that place.
std::pair<std::int32_t, Place> heightOf(const PostGeometry& geometry, std::uint32_t row, std::uint32_t column,
                                        const Place& place) {
  const PostGeometry::Lattice ground = geometry.lattice(row, column, 0);
  const Vec3 up = geometry.normal(row, column, 0, 0);
  const double along = static_cast<double>(place[0] - ground.x) * up.x +
                       static_cast<double>(place[1] - ground.y) * up.y +
                       static_cast<double>(place[2] - ground.z) * up.z;
  const auto guess = static_cast<std::int32_t>(std::lround(along));
  std::pair<std::int32_t, Place> best;
  std::int64_t least = -1;
  for (const std::int32_t height : {guess, guess - 1, guess + 1}) {
    const Place there = placeOf(geometry, row, column, height);
    std::int64_t off = 0;
    for (std::size_t k = 0; k < 3; ++k) off += std::abs(there[k] - place[k]);
    if (least < 0 || off < least) least = off, best = {height, there};
    if (least == 0) break;
  }
  return best;
}

template <class T>
void append(std::vector<std::byte>& bytes, const T* data, std::size_t count) {
  const auto* from = reinterpret_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), from, from + count * sizeof(T));
}

/// Appends so many values of `each` bytes.
std::uint32_t appendPacked(std::vector<std::byte>& bytes, const void* values, std::size_t count,
                           std::size_t each) {
  if (count == 0) return 0;
  const std::size_t most = meshopt_encodeVertexBufferBound(count, each);
  const auto packed = std::make_unique_for_overwrite<unsigned char[]>(most);
  const std::size_t size = meshopt_encodeVertexBuffer(packed.get(), most, values, count, each);
  append(bytes, packed.get(), size);
  return static_cast<std::uint32_t>(size);
}

bool unpack(void* values, std::size_t count, std::size_t each, const std::byte* bytes, std::size_t size) {
  return count == 0 || meshopt_decodeVertexBuffer(values, count, each,
                                                  reinterpret_cast<const unsigned char*>(bytes), size) == 0;
}

/// Writes which triangles are inherited, a bit or two each.
class InheritedWriter {
 public:
  void add(Inherited inheritance) {
    open_ |= std::uint64_t{inheritance == Inherited::same} << count_ |
             std::uint64_t{inheritance == Inherited::other} << (count_ + 1);
    count_ += 1 + (inheritance != Inherited::same);
    if (count_ >= 48) flush();
  }
  const std::vector<std::uint8_t>& finish() {
    flush();
    if (count_ > 0) bytes_.push_back(static_cast<std::uint8_t>(open_));
    return bytes_;
  }

 private:
  void flush() {
    for (; count_ >= 8; count_ -= 8, open_ >>= 8) bytes_.push_back(static_cast<std::uint8_t>(open_));
  }
  std::vector<std::uint8_t> bytes_;
  std::uint64_t open_ = 0;
  std::uint32_t count_ = 0;
};

class InheritedReader {
 public:
  explicit InheritedReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  /// Returns none beyond the end.
  Inherited next() { return bit() ? Inherited::same : bit() ? Inherited::other : Inherited::none; }
  /// Reports whether all bytes were read.
  bool isAtEnd() const { return (next_ + 7) / 8 == bytes_.size(); }

 private:
  bool bit() {
    const std::size_t at = next_++;
    return at / 8 < bytes_.size() && (std::to_integer<unsigned>(bytes_[at / 8]) >> at % 8 & 1) != 0;
  }
  std::span<const std::byte> bytes_;
  std::size_t next_ = 0;
};

/// Lists the triangles that are packed: all of the finest variant, and of each other variant those that the
/// one before does not have.
void split(const PatchMesh& mesh, std::size_t variants, std::vector<std::uint16_t>& packed,
           InheritedWriter& inherited) {
  const std::uint16_t* const all = mesh.indices.data();
  packed.assign(all, all + mesh.firstIndex[1]);
  for (std::size_t v = 1; v < variants; ++v) {
    const std::uint32_t end = mesh.firstIndex[v + 1];
    std::uint32_t own = mesh.firstIndex[v];
    std::size_t size = packed.size();
    packed.resize(size + (end - own) + 3);
    for (std::uint32_t t = mesh.firstIndex[v - 1] / 3; t < mesh.firstIndex[v] / 3; ++t) {
      const Inherited inheritance = mesh.inherited.empty() ? Inherited::none : mesh.inherited[t];
      inherited.add(inheritance);
      // The processor cannot predict whether a triangle is inherited, so there is no branch.
      const std::uint16_t* const from = all + std::min(own, end - 3);
      for (std::size_t k = 0; k < 3; ++k) packed[size + k] = from[k];
      size += std::size_t{3} * (inheritance == Inherited::other);
      own += 3u * (inheritance != Inherited::none);
    }
    packed.resize(size);
    packed.insert(packed.end(), all + own, all + end);
  }
}

/// Returns where each of so many vertices goes to, counted from `first`: in the order of first use. `indices`
/// gets the packed ones.
void reorder(std::span<const std::uint16_t> packed, std::size_t vertices, std::uint32_t first,
             std::vector<std::uint32_t>& indices, std::vector<std::uint32_t>& goesTo) {
  goesTo.assign(vertices, PatchIndex::kNone);
  std::uint32_t next = first;
  const auto place = [&](std::uint32_t& to) {
    // The branch would be mispredicted, because a new vertex cannot be guessed: so there is none.
    const bool fresh = to == PatchIndex::kNone;
    to = fresh ? next : to;
    next += fresh ? 1 : 0;
  };
  const std::size_t before = indices.size();
  indices.resize(before + packed.size());
  for (std::size_t i = 0; i < packed.size(); ++i) {
    std::uint32_t& to = goesTo[packed[i]];
    place(to);
    indices[before + i] = to;
  }
  for (std::uint32_t& to : goesTo) place(to);
}

}  // namespace

std::vector<std::byte> encodePage(const PatchPage& page, const PatchIndex& index,
                                  const PostGeometry& geometry) {
  // Bytes must not depend on what the library's next version likes best.
  static const bool versioned = (meshopt_encodeIndexVersion(1), meshopt_encodeVertexVersion(0), true);
  static_cast<void>(versioned);
  BlobHeader header;
  header.page = page.page;
  header.patches = static_cast<std::uint32_t>(page.patches.size());
  std::uint32_t places = 1u << 15;
  for (const PatchMesh& mesh : page.patches)
    for (const PatchVertex& v : mesh.vertices) places |= v.column | std::uint32_t{v.row};
  header.postShift = static_cast<std::uint32_t>(std::countr_zero(places));

  const std::size_t variants = index.variants(), patchBytes = packedPatchBytes(variants);
  std::vector<std::byte> patches;
  std::vector<PackedVertex> vertices;
  std::vector<std::uint32_t> indices, goesTo;
  std::vector<std::uint16_t> packed;
  InheritedWriter inherited;
  std::vector<Exception> exceptions;
  for (const PatchMesh& mesh : page.patches) {
    PackedPatch patch{{mesh.origin[0], mesh.origin[1], mesh.origin[2]},
                      mesh.firstColumn,
                      mesh.firstRow,
                      static_cast<std::uint32_t>(mesh.vertices.size()),
                      {}};
    for (std::size_t v = 0; v < variants; ++v)
      patch.triangles[v] = (mesh.firstIndex[v + 1] - mesh.firstIndex[v]) / 3;
    append(patches, reinterpret_cast<const std::byte*>(&patch), patchBytes);
    const std::size_t first = vertices.size();
    split(mesh, variants, packed, inherited);
    reorder(packed, mesh.vertices.size(), static_cast<std::uint32_t>(first), indices, goesTo);
    vertices.resize(first + mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      const PatchVertex& v = mesh.vertices[i];
      const std::size_t to = goesTo[i];
      const Place place = placeOf(mesh, v);
      const std::uint32_t row = mesh.firstRow + v.row, column = mesh.firstColumn + v.column;
      const auto [height, there] = heightOf(geometry, row, column, place);
      vertices[to] = {static_cast<std::uint16_t>(v.column >> header.postShift),
                      static_cast<std::uint16_t>(v.row >> header.postShift),
                      height,
                      v.normal[0],
                      v.normal[1],
                      static_cast<std::int8_t>(v.normal[2] - steepness(v.normal[0], v.normal[1])),
                      0};
      if (there == place) continue;
      Exception exception{static_cast<std::uint32_t>(to), {}};
      for (std::size_t k = 0; k < 3; ++k) exception.by[k] = static_cast<std::int32_t>(place[k] - there[k]);
      exceptions.push_back(exception);
    }
  }
  std::sort(exceptions.begin(), exceptions.end(),
            [](const Exception& a, const Exception& b) { return a.vertex < b.vertex; });
  header.vertices = static_cast<std::uint32_t>(vertices.size());
  header.indices = static_cast<std::uint32_t>(indices.size());
  header.exceptions = static_cast<std::uint32_t>(exceptions.size());
  std::vector<std::byte> bytes(sizeof header);
  header.patchBytes = appendPacked(bytes, patches.data(), page.patches.size(), patchBytes);
  header.vertexBytes = appendPacked(bytes, vertices.data(), vertices.size(), sizeof(PackedVertex));
  if (!indices.empty()) {
    const std::size_t most = meshopt_encodeIndexBufferBound(indices.size(), vertices.size());
    const auto code = std::make_unique_for_overwrite<unsigned char[]>(most);
    const std::size_t size = meshopt_encodeIndexBuffer(code.get(), most, indices.data(), indices.size());
    append(bytes, code.get(), size);
    header.indexBytes = static_cast<std::uint32_t>(size);
  }
  append(bytes, exceptions.data(), exceptions.size());
  const std::vector<std::uint8_t>& inheritedBytes = inherited.finish();
  append(bytes, inheritedBytes.data(), inheritedBytes.size());
  header.inheritedBytes = static_cast<std::uint32_t>(inheritedBytes.size());
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

Result<PatchPage> decodePage(std::span<const std::byte> bytes, const PatchIndex& index, std::uint32_t page,
                             const PostGeometry& geometry, const std::string& where) {
  const auto wrong = [&](const std::string& key, const std::string& expected, const std::string& found) {
    return Finding{Severity::error, where, "page " + std::to_string(page) + ": " + key, expected, found};
  };
  const auto number = [](auto value) { return std::to_string(value); };
  BlobHeader header;
  if (bytes.size() < sizeof header)
    return wrong("size", number(sizeof header) + " bytes", number(bytes.size()) + " bytes");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.magic != kBlobMagic) return wrong("header", "a page of patches", "something else");
  if (header.page != page) return wrong("number", number(page), number(header.page));
  const PatchIndex::Page& expected = index.pages[page];
  if (header.patches != expected.patches)
    return wrong("patches", number(expected.patches), number(header.patches));
  const std::uint64_t size = std::uint64_t{sizeof header} + header.patchBytes + header.vertexBytes +
                             header.indexBytes + std::uint64_t{header.exceptions} * sizeof(Exception) +
                             header.inheritedBytes;
  if (size != bytes.size()) return wrong("size", number(size) + " bytes", number(bytes.size()) + " bytes");
  // These checks come before anything is allocated by what the header claims: sixteen packed vertices need
  // three bytes or more, a triangle one.
  if (header.postShift > 15 || header.vertices / 8 > header.vertexBytes || header.indices % 3 != 0 ||
      header.indices / 3 > header.indexBytes)
    return wrong("counts", "no more vertices and triangles than its bytes can hold",
                 number(header.vertices) + " and " + number(header.indices / 3));
  const std::size_t variants = index.variants(), patchBytes = packedPatchBytes(variants);
  std::vector<std::byte> patches(header.patches * patchBytes);
  std::vector<PackedVertex> vertices(header.vertices);
  std::vector<std::uint32_t> indices(header.indices);
  std::vector<Exception> exceptions(header.exceptions);
  const std::byte* from = bytes.data() + sizeof header;
  if (!unpack(patches.data(), header.patches, patchBytes, from, header.patchBytes))
    return wrong("patches", "packed patches", "something else");
  from += header.patchBytes;
  if (!unpack(vertices.data(), vertices.size(), sizeof(PackedVertex), from, header.vertexBytes))
    return wrong("vertices", "packed vertices", "something else");
  from += header.vertexBytes;
  if (!indices.empty() &&
      meshopt_decodeIndexBuffer(indices.data(), indices.size(), reinterpret_cast<const unsigned char*>(from),
                                header.indexBytes) != 0)
    return wrong("triangles", "packed triangles", "something else");
  from += header.indexBytes;
  if (!exceptions.empty()) std::memcpy(exceptions.data(), from, exceptions.size() * sizeof(Exception));
  InheritedReader inherited(bytes.last(header.inheritedBytes));

  PatchPage out;
  out.page = page;
  out.patches.resize(header.patches);
  std::uint64_t firstVertex = 0, next = 0;
  auto exception = exceptions.begin();
  for (std::size_t p = 0; p < out.patches.size(); ++p) {
    PackedPatch patch{};
    std::memcpy(&patch, patches.data() + p * patchBytes, patchBytes);
    const std::size_t own = expected.firstPatch + p;
    PatchMesh& mesh = out.patches[p];
    std::copy_n(patch.origin, 3, mesh.origin);
    mesh.firstColumn = patch.firstColumn;
    mesh.firstRow = patch.firstRow;
    for (std::size_t v = 0; v < variants; ++v) {
      if (patch.triangles[v] != index.triangles[own][v])
        return wrong("triangles of patch " + number(own), number(index.triangles[own][v]),
                     number(patch.triangles[v]));
      mesh.firstIndex[v + 1] = mesh.firstIndex[v] + 3 * patch.triangles[v];
    }
    std::fill(mesh.firstIndex.begin() + static_cast<std::ptrdiff_t>(variants), mesh.firstIndex.end(),
              mesh.firstIndex[variants]);
    if (patch.vertices > kMostVertices || firstVertex + patch.vertices > vertices.size())
      return wrong("patch " + number(own), "vertices that are there", number(patch.vertices));
    mesh.vertices.resize(patch.vertices);
    for (std::uint32_t i = 0; i < patch.vertices; ++i) {
      const PackedVertex& packed = vertices[firstVertex + i];
      const std::uint32_t c = std::uint32_t{packed.column} << header.postShift,
                          r = std::uint32_t{packed.row} << header.postShift;
      const std::uint64_t column = std::uint64_t{patch.firstColumn} + c,
                          row = std::uint64_t{patch.firstRow} + r;
      if (c > 0xffff || r > 0xffff || column >= index.columns || row >= index.rows)
        return wrong("vertex " + number(i) + " of patch " + number(own), "a post of the grid",
                     number(column) + ", " + number(row));
      Place place = placeOf(geometry, static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column),
                            packed.height);
      for (; exception != exceptions.end() && exception->vertex <= firstVertex + i; ++exception)
        if (exception->vertex == firstVertex + i)
          for (std::size_t k = 0; k < 3; ++k) place[k] += exception->by[k];
      const auto local = [&](std::size_t k) {
        return static_cast<float>(
            static_cast<double>(place[k] - mesh.origin[k] * std::int64_t{kOriginSteps}) / kSteps);
      };
      const int z = packed.normalZ + steepness(packed.normalX, packed.normalY);
      mesh.vertices[i] = {
          local(0),
          local(1),
          local(2),
          {packed.normalX, packed.normalY, static_cast<std::int8_t>(std::clamp(z, -127, 127))},
          0,
          static_cast<std::uint16_t>(c),
          static_cast<std::uint16_t>(r)};
    }
    mesh.indices.resize(mesh.firstIndex.back());
    std::uint16_t* to = mesh.indices.data();
    const auto takePacked = [&](std::size_t count) {
      for (; count > 0; --count, ++next) {
        if (next == indices.size() || indices[next] < firstVertex ||
            indices[next] - firstVertex >= patch.vertices)
          return false;
        *to++ = static_cast<std::uint16_t>(indices[next] - firstVertex);
      }
      return true;
    };
    bool sound = true;
    for (std::size_t v = 0; v < variants && sound; ++v) {
      const std::uint16_t* const end = mesh.indices.data() + mesh.firstIndex[v + 1];
      for (std::uint32_t t = 0; v > 0 && t < patch.triangles[v - 1] && sound; ++t) {
        const Inherited inheritance = inherited.next();
        if (inheritance == Inherited::none) continue;
        sound = to < end;
        if (sound && inheritance == Inherited::same)
          to = std::copy_n(mesh.indices.data() + mesh.firstIndex[v - 1] + 3 * t, 3, to);
        else
          sound = sound && takePacked(3);
      }
      sound = sound && takePacked(static_cast<std::size_t>(end - to));
    }
    if (!sound)
      return wrong("triangles of patch " + number(own), "as many as it has, of vertices of the patch",
                   "others");
    firstVertex += patch.vertices;
  }
  if (!inherited.isAtEnd()) return wrong("inherited triangles", "as many as there are triangles", "others");
  if (firstVertex != vertices.size() || next != indices.size())
    return wrong("counts", number(firstVertex) + " vertices, " + number(next / 3) + " triangles",
                 number(vertices.size()) + " and " + number(indices.size() / 3));
  return out;
}

}  // namespace trimtab::terrain
