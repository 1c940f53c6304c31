#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "bend.h"
#include "page.h"
#include "scan.h"
#include "trimtab/terrain/grid/post_gradient.h"
#include "trimtab/terrain/mesh/lanes.h"

namespace trimtab::terrain {

namespace {

constexpr std::size_t kStripPosts = std::size_t{1} << 20;
/// Heights as floats may be off by so many metres.
constexpr double kFloatM = 0.002;

struct VariantMeasure {
  double worst = 0, bilinear = 0, squares = 0;
  std::uint64_t posts = 0;
  double bend = 0;
  double sag = 0;  ///< how far below the curved earth its triangles may lie
};

struct PatchMeasure {
  std::array<VariantMeasure, PatchIndex::kMostVariants> variants;
  std::uint32_t firstRow = 0, lastRow = 0, firstColumn = 0, lastColumn = 0;
  float lowest = std::numeric_limits<float>::max(), highest = -std::numeric_limits<float>::max();
  std::uint32_t posts = 0, voids = 0;
  double rounding = 0;  ///< of vertices moved to the lattice, along the steepest slope
};

class PageMeasure {
 public:
  PageMeasure(const PatchIndex& index, const PatchIndex::Page& page, const HeightSource& heights,
              const PostGeometry& geometry, std::size_t patches, BuiltPage& built)
      : index_(index),
        page_(page),
        heights_(heights),
        geometry_(geometry),
        built_(built),
        window_(pageWindow(index, page)),
        stride_(meshStride(index, page.pair)),
        plane_(pagePlane(geometry, window_)),
        bound_(heights.posts(), geometry, window_),
        patches_(patches) {}

  bool run(const DraftOf& draftOf, const std::function<bool()>& carryOn) {
    // A page that is meshed on all posts is measured in one piece, each patch as soon as it is meshed.
    const auto rows =
        stride_ == 1
            ? window_.rows
            : static_cast<std::uint32_t>(std::max<std::size_t>(2, kStripPosts / (window_.columns + 2)));
    const std::uint32_t end = window_.row + window_.rows;
    for (std::uint32_t row = window_.row; row < end; row += rows) {
      read(row, std::min(row + rows, end));
      for (std::size_t i = 0; i < patches_.size(); ++i) {
        if (carryOn && !carryOn()) return false;
        const PatchDraft& draft = draftOf(i);
        if (row == window_.row) begin(draft, patches_[i]);
        measure(draft, patches_[i], i);
        if (end_ == end) finish(draft, patches_[i], i);
      }
    }
    return true;
  }

 private:
  void begin(const PatchDraft& draft, PatchMeasure& patch) {
    patch.firstRow = patch.firstColumn = std::numeric_limits<std::uint32_t>::max();
    for (const PatchEdge& e : draft.edges) {
      patch.firstRow = std::min(patch.firstRow, e.from.row);
      patch.lastRow = std::max(patch.lastRow, e.from.row);
      patch.firstColumn = std::min(patch.firstColumn, e.from.column);
      patch.lastColumn = std::max(patch.lastColumn, e.from.column);
    }
    bends(draft, patch);
    Box bounds;
    built_.meshes.patches.push_back(patchMesh(index_, geometry_, draft, bounds));
    built_.bounds.push_back(bounds);
  }

  /// Measures the errors that are not seen in heights above the plane. A vertex's slope is that of the
  /// steepest triangle about it in any variant.
  void bends(const PatchDraft& draft, PatchMeasure& patch) {
    slopes_.assign(draft.vertices.size(), 0.0);
    sideways_.clear();
    double sag = 0;
    for (std::size_t v = 0; v < draft.variants.size(); ++v) {
      draft.eachNew(v, [&](std::size_t, const std::uint32_t* c) {
        const double steep = bound_.steepness(draft, c);
        for (std::size_t k = 0; k < 3; ++k) slopes_[c[k]] = std::max(slopes_[c[k]], steep);
        const VerticalBound::Extent extent = bound_.extent(draft, c);
        sideways_.push_back(bound_.atMostSideways(extent));
        sag = std::max(sag, bound_.sagM(draft, c, extent));
      });
      patch.variants[v].sag = sag;
    }
    const double steepest = *std::max_element(slopes_.begin(), slopes_.end());
    const double mostLean = bound_.leaning(steepest);
    double worst = 0;
    const double* sideways = sideways_.data();
    for (std::size_t v = 0; v < draft.variants.size(); ++v) {
      draft.eachNew(v, [&](std::size_t, const std::uint32_t* c) {
        if (*sideways++ * mostLean <= worst) return;
        const double about = std::max({slopes_[c[0]], slopes_[c[1]], slopes_[c[2]]});
        worst = std::max(worst, bound_.sideways(bound_.extent(draft, c)) * bound_.leaning(about));
      });
      patch.variants[v].bend = worst;
    }
    const double slope = bound_.slope(steepest);
    patch.rounding = geometry_.roundingM() * std::sqrt(1 + slope * slope) + kFloatM;
  }

  /// Rows of the strip, with those before and after where there are some.
  void read(std::uint32_t row, std::uint32_t end) {
    row_ = row;
    end_ = end;
    const PostGrid& posts = heights_.posts();
    block_.column = window_.column - (window_.column > 0 ? 1 : 0);
    block_.columns = std::min(posts.columns, window_.column + window_.columns + 1) - block_.column;
    block_.row = row - (row > 0 ? 1 : 0);
    block_.rows = std::min(posts.rows, end + 1) - block_.row;
    raw_.resize(block_.size());
    z_.resize(block_.size());
    voids_.resize(block_.size());
    heights_.read(block_, 1, raw_);
    heights_.readVoids(block_, 1, voids_);
    anyVoids_ = std::memchr(voids_.data(), 1, voids_.size()) != nullptr;
    for (std::uint32_t r = 0; r < block_.rows; ++r)
      plane_.row(block_.column, block_.row + r, 1,
                 std::span<const float>(raw_).subspan(std::size_t{r} * block_.columns, block_.columns),
                 &z_[std::size_t{r} * block_.columns]);
  }

  std::size_t at(std::uint32_t column, std::uint32_t row) const {
    return std::size_t{row - block_.row} * block_.columns + (column - block_.column);
  }

  void measure(const PatchDraft& draft, PatchMeasure& patch, std::size_t i) {
    if (patch.firstRow >= end_ || patch.lastRow < row_) return;
    posts(draft, patch);
    normals(draft, built_.meshes.patches[i]);
    errors(draft, patch);
  }

  /// Columns of a patch's posts in a row, both ends included.
  static std::pair<std::uint32_t, std::uint32_t> columnsOf(const PatchDraft& draft, std::uint32_t row) {
    std::uint32_t from = std::numeric_limits<std::uint32_t>::max(), to = 0;
    for (const PatchEdge& e : draft.edges) {
      const auto [low, high] = std::minmax(e.from.row, e.to.row);
      if (row < low || row > high) continue;
      std::uint32_t a = e.from.column, b = e.to.column;
      if (low != high) {
        const std::uint32_t along = row > e.from.row ? row - e.from.row : e.from.row - row;
        a = b = a == b ? a : a < b ? a + along : a - along;
      }
      from = std::min({from, a, b});
      to = std::max({to, a, b});
    }
    return {from, to};
  }

  /// Sums up the heights under a patch, and counts them: posts on its left and lower edges are its own, and
  /// those where the posts end.
  void posts(const PatchDraft& draft, PatchMeasure& patch) {
    LaneRange heights(patch.lowest, patch.highest);
    for (std::uint32_t r = std::max(row_, patch.firstRow); r <= std::min(end_ - 1, patch.lastRow); ++r) {
      const auto [from, to] = columnsOf(draft, r);
      const float* const z = &raw_[at(from, r)];
      heights.add(z, z + (to - from + 1));
      const bool top = r + 1 == index_.rows;
      if (r == patch.lastRow && !top) continue;
      std::uint32_t stop = to;
      if (to + 1 == index_.columns && columnsOf(draft, top ? r - 1 : r + 1).second == to) ++stop;
      if (anyVoids_)
        for (std::uint32_t c = from; c < stop; ++c) patch.voids += voids_[at(c, r)];
      patch.posts += stop - from;
    }
    patch.lowest = heights.low();
    patch.highest = heights.high();
  }

  /// Writes the normals of the finest surface, so that a post has the same normal in every patch.
  void normals(const PatchDraft& draft, PatchMesh& mesh) {
    for (std::size_t i = 0; i < draft.vertices.size(); ++i) {
      const PatchPoint p = draft.vertices[i];
      if (p.row < row_ || p.row >= end_) continue;
      const std::uint32_t west = p.column - (p.column > 0 ? 1 : 0),
                          east = std::min(p.column + 1, index_.columns - 1),
                          south = p.row - (p.row > 0 ? 1 : 0), north = std::min(p.row + 1, index_.rows - 1);
      const double x = (raw_[at(east, p.row)] - raw_[at(west, p.row)]) /
                       std::max(VerticalBound::kShortestM, (east - west) * geometry_.columnM(p.row));
      const double y =
          (raw_[at(p.column, north)] - raw_[at(p.column, south)]) / ((north - south) * geometry_.rowM(p.row));
      const Vec3 normal = geometry_.normal(p.row, p.column, x, y);
      PatchVertex& v = mesh.vertices[i];
      v.normal[0] = byteOf(normal.x);
      v.normal[1] = byteOf(normal.y);
      v.normal[2] = byteOf(normal.z);
    }
  }

  using Edge = std::array<std::uint32_t, 2>;
  /// Collects the edges of a variant that no finer one has, each once; those along rows and columns, where
  /// all is measured at posts, are left out. Sorted by how many cells they cross, as each sort is measured in
  /// a way of its own.
  std::span<const Edge> newEdges(const PatchDraft& draft, std::size_t v) {
    constexpr std::size_t kSorts = 4;  // two cells, three, more; left out
    const PatchDraft::Variant& of = draft.variants[v];
    const std::size_t most = 3 * of.fresh.size();
    if (edges_.size() < kSorts * most) edges_.resize(kSorts * most);
    std::array<Edge*, kSorts> end;
    for (std::size_t sort = 0; sort < kSorts; ++sort) end[sort] = edges_.data() + sort * most;
    draft.eachNew(v, [&](std::size_t t, const std::uint32_t* c) {
      for (std::size_t k = 0; k < 3; ++k) {
        // The wanted edges cannot be guessed, so this has no branch.
        const Edge edge{c[k], c[k == 2 ? 0 : k + 1]};
        const std::int32_t twin = of.twins[3 * t + k], other = twin >> 2;
        const bool isNew = of.inherited[static_cast<std::size_t>(std::max(other, 0))] == Inherited::other;
        const bool once = ((twin < 0) & (v == 0)) | ((static_cast<std::int32_t>(t) < other) & isNew);
        const ScanVertex &a = corners_[edge[0]], &b = corners_[edge[1]];
        const std::int32_t wide = std::abs(b.x - a.x), high = std::abs(b.y - a.y);
        const bool wanted = once & (wide != 0) & (high != 0);
        const int sort = std::clamp(wide + high - 2, 0, 2) | (3 * !wanted);
        *end[static_cast<std::size_t>(sort)]++ = edge;
      }
    });
    Edge* all = end[0];
    for (std::size_t sort = 1; sort + 1 < kSorts; ++sort)
      all = std::copy(edges_.data() + sort * most, end[sort], all);
    return {edges_.data(), all};
  }

  void errors(const PatchDraft& draft, PatchMeasure& patch) {
    const PostStrip strip{z_.data(), block_.columns, static_cast<std::int32_t>(block_.column),
                          static_cast<std::int32_t>(block_.row)};
    const auto first = static_cast<std::int32_t>(row_), end = static_cast<std::int32_t>(end_);
    const auto last = std::min(end, static_cast<std::int32_t>(block_.row + block_.rows) - 1);
    corners_.clear();
    for (std::size_t i = 0; i < draft.vertices.size(); ++i)
      corners_.push_back({static_cast<std::int32_t>(draft.vertices[i].column),
                          static_cast<std::int32_t>(draft.vertices[i].row), draft.z[i]});
    if (stride_ != 1) scanned_.assign(draft.variants[0].triangles.size() / 3, {});
    double worst = 0, bilinear = 0;
    for (std::size_t v = 0; v < draft.variants.size(); ++v) {
      for (const auto& [from, to] : newEdges(draft, v))
        bilinear = edgeError(corners_[from], corners_[to], strip, first, last, bilinear);
      if (stride_ != 1)
        draft.eachNew(v, [&](std::size_t t, const std::uint32_t* c) {
          scanned_[t] = {};
          const ScanTriangle triangle(corners_[c[0]], corners_[c[1]], corners_[c[2]]);
          const std::int32_t low = std::max(triangle.firstRow(), first),
                             high = std::min(triangle.lastRow(), last);
          if (low < end) triangle.scan(strip, low, high, end, scanned_[t]);
          worst = std::max(worst, scanned_[t].worst);
        });
      VariantMeasure& variant = patch.variants[v];
      variant.worst = std::max(variant.worst, worst);
      variant.bilinear = std::max(variant.bilinear, bilinear);
      if (stride_ == 1) continue;
      for (std::size_t t = 0; t < draft.variants[v].triangles.size() / 3; ++t) {
        variant.squares += scanned_[t].squares;
        variant.posts += scanned_[t].posts;
      }
    }
  }

  void finish(const PatchDraft& draft, PatchMeasure& patch, std::size_t i) {
    const PatchMesh& mesh = built_.meshes.patches[i];
    const auto up = [](double x) {
      return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::max());
    };
    PatchFacts facts;
    std::array<float, PatchIndex::kMostVariants> errorM{};
    const double rise = static_cast<double>(patch.highest) - patch.lowest;
    for (std::size_t v = 0; v < draft.variants.size(); ++v) {
      const VariantMeasure& variant = patch.variants[v];
      const bool measured = stride_ != 1;
      const double shown = measured ? variant.worst : draft.variants[v].worst;
      // A post and the surface above or below it lie between the lowest and the highest post of the patch,
      // but for the sag of triangles and the lattice that vertices are moved to.
      const double most = rise + variant.sag + geometry_.roundingM() + kFloatM;
      const auto stated = [&](double shownM) {
        return std::min(shownM / bound_.cosLean() + variant.bend + patch.rounding, most);
      };
      const double worst = stated(shown), between = stated(variant.bilinear);
      errorM[v] = up(worst);
      facts.bilinearErrorM[v] = up(std::max(worst, between));
      facts.rmsErrorM[v] = static_cast<float>(
          !measured
              ? draft.variants[v].rms
              : std::sqrt(variant.squares / static_cast<double>(std::max<std::uint64_t>(1, variant.posts))));
    }
    facts.lowestM = patch.lowest;
    facts.highestM = patch.highest;
    facts.posts = patch.posts;
    facts.voids = patch.voids;
    facts.vertices = static_cast<std::uint32_t>(mesh.vertices.size());
    facts.bytes = static_cast<std::uint32_t>(mesh.vertices.size() * sizeof(PatchVertex) +
                                             mesh.indices.size() * sizeof(std::uint16_t));
    built_.errorM.push_back(std::span(errorM).first(draft.variants.size()));
    built_.facts.push_back(facts);
    built_.cones.push_back(patchCone(draft, mesh));
  }

  const PatchIndex& index_;
  const PatchIndex::Page& page_;
  const HeightSource& heights_;
  const PostGeometry& geometry_;
  BuiltPage& built_;
  PostWindow window_;
  std::uint32_t stride_;
  PostPlane plane_;
  VerticalBound bound_;
  std::vector<PatchMeasure> patches_;

  std::vector<double> slopes_;    ///< one a vertex: steepness of the steepest triangle about it
  std::vector<double> sideways_;  ///< one a triangle that is new in its variant: no less than it is
  std::vector<ScanVertex> corners_;
  std::vector<Edge> edges_;
  std::vector<ScanResult> scanned_;  ///< one a triangle

  // The strip.
  std::uint32_t row_ = 0, end_ = 0;
  PostWindow block_;
  std::vector<float> raw_, z_;
  std::vector<std::uint8_t> voids_;
  bool anyVoids_ = false;
};

}  // namespace

bool measurePage(const PatchIndex& index, const PatchIndex::Page& page, const HeightSource& heights,
                 const PostGeometry& geometry, std::size_t patches, const DraftOf& draftOf,
                 const std::function<bool()>& carryOn, BuiltPage& built) {
  return PageMeasure(index, page, heights, geometry, patches, built).run(draftOf, carryOn);
}

}  // namespace trimtab::terrain
