#include "surface_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

namespace trimtab::terrain {

namespace {

Vec3 positionOf(const SourceVertex& v) {
  return {v.position[0], v.position[1], v.position[2]};
}

/// Returns the square of the distance of a point from a triangle, by the region of the corner, edge or face
/// that is nearest (Ericson, Real-Time Collision Detection, 5.1.5).
double squareTo(Vec3 p, const Vec3 (&t)[3]) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return dot(ap, ap);
  const Vec3 bp = p - t[1];
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return dot(bp, bp);
  const auto squareOf = [](Vec3 v) { return dot(v, v); };
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return squareOf(ap - ab * (d1 / (d1 - d3)));
  const Vec3 cp = p - t[2];
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return dot(cp, cp);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return squareOf(ap - ac * (d2 / (d2 - d6)));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return squareOf(bp - (t[2] - t[1]) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
  const double whole = va + vb + vc;
  return whole > 0 ? squareOf(ap - ab * (vb / whole) - ac * (vc / whole)) : dot(ap, ap);
}

double squareTo(Vec3 p, Vec3 low, Vec3 high) {
  const auto beyond = [](double v, double a, double b) { return std::max({a - v, 0.0, v - b}); };
  const double x = beyond(p.x, low.x, high.x), y = beyond(p.y, low.y, high.y), z = beyond(p.z, low.z, high.z);
  return x * x + y * y + z * z;
}

constexpr std::uint32_t kLeafTriangles = 4;

}  // namespace

TriangleTree::TriangleTree(const SourceMesh& mesh) {
  triangles_.reserve(mesh.triangles());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    triangles_.push_back(
        {{positionOf(mesh.vertices[mesh.indices[i]]), positionOf(mesh.vertices[mesh.indices[i + 1]]),
          positionOf(mesh.vertices[mesh.indices[i + 2]])}});
  build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void TriangleTree::build(std::uint32_t first, std::uint32_t count) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Node node{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}, first, count, 0};
  for (std::uint32_t i = first; i < first + count; ++i)
    for (const Vec3& c : triangles_[i].corner) {
      node.low = {std::min(node.low.x, c.x), std::min(node.low.y, c.y), std::min(node.low.z, c.z)};
      node.high = {std::max(node.high.x, c.x), std::max(node.high.y, c.y), std::max(node.high.z, c.z)};
    }
  const std::size_t at = nodes_.size();
  nodes_.push_back(node);
  if (count <= kLeafTriangles) return;
  const Vec3 size = node.high - node.low;
  double Vec3::*const axis = size.x >= size.y && size.x >= size.z ? &Vec3::x
                             : size.y >= size.z                   ? &Vec3::y
                                                                  : &Vec3::z;
  const auto middle = [axis](const Triangle& t) {
    return t.corner[0].*axis + t.corner[1].*axis + t.corner[2].*axis;
  };
  const auto begin = triangles_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [&](const Triangle& a, const Triangle& b) { return middle(a) < middle(b); });
  nodes_[at].count = 0;
  build(first, count / 2);
  nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
  build(first + count / 2, count - count / 2);
}

double TriangleTree::distanceTo(Vec3 point, std::uint32_t triangle) const {
  return std::sqrt(squareTo(point, triangles_[triangle].corner));
}

TriangleTree::Nearest TriangleTree::nearest(Vec3 point, std::uint32_t guess) const {
  Nearest best{squareTo(point, triangles_[guess].corner), guess};
  // A tree of halves over 32-bit numbers is no deeper.
  struct Waiting {
    std::uint32_t node;
    double square;
  };
  std::array<Waiting, 64> waiting;
  std::size_t count = 0;
  waiting[count++] = {0, squareTo(point, nodes_[0].low, nodes_[0].high)};
  while (count > 0) {
    const auto [number, square] = waiting[--count];
    if (square >= best.distance) continue;
    const Node& node = nodes_[number];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (const double found = squareTo(point, triangles_[i].corner); found < best.distance)
        best = {found, i};
    if (node.count > 0) continue;
    const Node &left = nodes_[number + 1], &right = nodes_[node.right];
    const double toLeft = squareTo(point, left.low, left.high),
                 toRight = squareTo(point, right.low, right.high);
    const bool leftFirst = toLeft <= toRight;
    waiting[count++] = leftFirst ? Waiting{node.right, toRight} : Waiting{number + 1, toLeft};
    waiting[count++] = leftFirst ? Waiting{number + 1, toLeft} : Waiting{node.right, toRight};
  }
  best.distance = std::sqrt(best.distance);
  return best;
}

namespace {

/// A part of a triangle, and a distance that none of its points exceeds.
struct Piece {
  double most;
  std::uint32_t nearest;
  Vec3 corner[3];
};
bool operator<(const Piece& a, const Piece& b) {
  return a.most < b.most;
}

class FarthestPoint {
 public:
  FarthestPoint(const TriangleTree& to, double slackM) : to_(to), slackM_(slackM) {}

  /// Returns the triangle that is nearest to a point.
  std::uint32_t seePoint(Vec3 point) {
    const TriangleTree::Nearest nearest = to_.nearest(point, last_);
    last_ = nearest.triangle;
    found_ = std::max(found_, nearest.distance);
    return last_;
  }
  /// Bounds a piece by its distance to one triangle; returns whether that is enough. No search is needed, and
  /// where surfaces are near each other it does for most pieces.
  bool settles(Piece& piece, std::uint32_t triangle) {
    double atCorners = 0;
    for (const Vec3& c : piece.corner) atCorners = std::max(atCorners, to_.distanceTo(c, triangle));
    piece.most = std::min(piece.most, atCorners);
    if (piece.most > enough()) return false;
    settled_ = std::max(settled_, piece.most);
    return true;
  }
  void add(Piece piece) {
    if (settles(piece, piece.nearest)) return;
    const Vec3 middle = (piece.corner[0] + piece.corner[1] + piece.corner[2]) * (1.0 / 3);
    const TriangleTree::Nearest nearest = to_.nearest(middle, piece.nearest);
    found_ = std::max(found_, nearest.distance);
    double reach = 0;
    for (const Vec3& c : piece.corner) reach = std::max(reach, length(c - middle));
    piece.most = std::min(piece.most, nearest.distance + reach);
    piece.nearest = nearest.triangle;
    if (!settles(piece, nearest.triangle)) pieces_.push(piece);
  }
  double search(std::size_t mostPieces) {
    for (std::size_t divided = 0; !pieces_.empty(); ++divided) {
      const Piece piece = pieces_.top();
      if (piece.most <= enough()) break;
      if (divided >= mostPieces) break;
      pieces_.pop();
      const Vec3(&c)[3] = piece.corner;
      const double sides[3] = {length(c[1] - c[0]), length(c[2] - c[1]), length(c[0] - c[2])};
      const std::size_t a = static_cast<std::size_t>(std::max_element(sides, sides + 3) - sides);
      const Vec3 from = c[a], to = c[(a + 1) % 3], other = c[(a + 2) % 3], half = (from + to) * 0.5;
      add({piece.most, piece.nearest, {from, half, other}});
      add({piece.most, piece.nearest, {half, to, other}});
    }
    return std::max({found_, settled_, pieces_.empty() ? 0 : pieces_.top().most});
  }

 private:
  /// A piece that may reach no farther than this is not divided.
  double enough() const {
    constexpr double kShare = 0.02;
    return found_ + std::max(kShare * found_, slackM_);
  }

  const TriangleTree& to_;
  double slackM_;
  double found_ = 0;    ///< the farthest point so far
  double settled_ = 0;  ///< no point of the pieces that are not divided is farther
  std::uint32_t last_ = 0;
  std::priority_queue<Piece> pieces_;
};

}  // namespace

double farthestFrom(const SourceMesh& from, const TriangleTree& to, double slackM) {
  FarthestPoint farthest(to, slackM);
  std::vector<std::uint32_t> nearest;
  nearest.reserve(from.vertices.size());
  for (const SourceVertex& v : from.vertices) nearest.push_back(farthest.seePoint(positionOf(v)));
  for (std::size_t i = 0; i + 2 < from.indices.size(); i += 3) {
    const std::uint32_t *const corner = &from.indices[i], at = nearest[corner[0]];
    Piece piece{std::numeric_limits<double>::infinity(),
                at,
                {positionOf(from.vertices[corner[0]]), positionOf(from.vertices[corner[1]]),
                 positionOf(from.vertices[corner[2]])}};
    if (!farthest.settles(piece, nearest[corner[1]]) && !farthest.settles(piece, nearest[corner[2]]))
      farthest.add(piece);
  }
  return farthest.search(20000 + 4 * from.triangles());
}

}  // namespace trimtab::terrain
