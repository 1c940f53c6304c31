#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "queue.h"
#include "trimtab/terrain/mesh/mesher.h"
#include "trimtab/terrain/mesh/triangulation.h"

namespace trimtab::terrain {

struct PostRows;

/// Over the posts of a triangle.
struct PostSum {
  double squares = 0, worst = 0;
  static constexpr PostSum unknown() { return {-1, 0}; }
  bool known() const { return squares >= 0; }
};

/// What PolygonMesher does, open for what builds whole fields from it. Places are counted from `origin`.
class GreedyMesh {
 public:
  using Point = PolygonMesher::Point;

  void begin(const HeightField& field, std::span<const Point> border, std::span<const float> borderZ = {});
  /// One more vertex of the border, on its edge that leaves `from`; before further refinement.
  std::uint32_t addBorder(std::uint32_t from, Point at);
  /// A vertex that is inserted stays up to `ease` short of its post, but between that and the mesh: where the
  /// mesh fits the land, a post that is too far off stands out from its neighbours.
  void refine(double tolerance, std::size_t mostVertices, double ease = 0);
  /// Takes note of vertices that were moved since: `sums` are those of now, one a triangle. An error above
  /// `tolerance` may be given as more than it is: refinement measures it.
  void know(std::span<const PostSum> sums, double tolerance);

  const Triangulation& mesh() const { return mesh_; }
  Triangulation& mesh() { return mesh_; }
  /// One a triangle, largest at its posts; of the last refinement.
  std::span<const double> errors() const { return error_; }
  /// The same with the sums of squares.
  std::vector<PostSum> sums() const {
    std::vector<PostSum> all(error_.size());
    for (std::size_t t = 0; t < all.size(); ++t) all[t] = {squares_[t], error_[t]};
    return all;
  }
  Point origin() const { return {originX_, originY_}; }
  const std::vector<Point>& points() const { return points_; }
  double maxErrorM() const;
  double rmsErrorM() const;
  std::uint64_t posts() const;

 private:
  static constexpr double kUnknown = -1;
  /// Of a triangle: its post that is furthest off, and the sum of squares.
  struct Scan {
    double worst = 0, squares = 0;
    std::int32_t x = 0, y = 0;
  };
  static Scan scanPosts(const Triangulation::Vertex* const corner[3], const bool border[3],
                        const PostRows& posts, std::int32_t everyRow);
  Scan scanSteps(const Triangulation::Vertex* const corner[3], const bool border[3]) const;
  /// Looks at all posts, or only so far as to know that one is too far off.
  void scan(std::int32_t t, bool all);
  void scanAbout(std::int32_t t);
  /// Posts of the field, from the origin.
  const float* row(std::int32_t y) const { return z_ + static_cast<std::size_t>(y) * stride_; }
  template <class Visit>
  void eachBorderPost(const Visit& visit) const;
  template <class Visit>
  void eachInnerPost(const Visit& visit) const;
  const PostSum& border() const;
  std::uint64_t countPosts() const;

  Triangulation mesh_;
  ErrorQueue queue_;
  std::vector<double> error_;    ///< one a triangle, largest at its posts
  std::vector<double> squares_;  ///< their sum, one a triangle; kUnknown where only some rows were looked at
  std::vector<Point> points_;
  const float* z_ = nullptr;  ///< of the origin
  std::size_t stride_ = 0;
  std::uint32_t originX_ = 0, originY_ = 0;
  std::int32_t step_ = 1, columns_ = 0;
  double tolerance_ = 0;
  bool unknown_ = false;  ///< some errors are kUnknown
  // Refinement changes neither: found once.
  mutable std::optional<PostSum> border_;
  mutable std::uint64_t posts_ = 0;
};

/// Difference of a post from a facet: what is below rounding is none, so that planes are flat.
inline double roundedError(double difference, double scale) {
  return difference <= scale * 0x1p-38 ? 0.0 : difference;
}

}  // namespace trimtab::terrain
