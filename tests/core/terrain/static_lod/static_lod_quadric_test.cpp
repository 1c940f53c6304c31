#include "core/terrain/static_lod/quadric.h"

#include <array>
#include <random>
#include <vector>

#include "tests/support.h"

namespace trimtab::terrain {
namespace {

struct Plane {
  Vec3 normal, point;
  double weight;
};

std::vector<Plane> randomPlanes(std::mt19937& random, int count, double steep) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Plane> planes;
  for (int i = 0; i < count; ++i)
    planes.push_back({normalized({steep * unit(random), steep * unit(random), 1}),
                      {5000 + 80 * unit(random), -7000 + 80 * unit(random), 300 + 40 * unit(random)},
                      500 * (1.1 + unit(random))});
  return planes;
}

double directSum(const std::vector<Plane>& planes, Vec3 p) {
  double sum = 0;
  for (const Plane& plane : planes) sum += plane.weight * std::pow(dot(plane.normal, p - plane.point), 2);
  return sum;
}

/// Least squares of the rows sqrt(w) n.(x - centre) = sqrt(w) n.(p - centre), by Gram-Schmidt (QR), without
/// ever forming a quadric.
Vec3 directLeast(const std::vector<Plane>& planes, Vec3 centre) {
  std::array<std::vector<double>, 3> columns;
  std::vector<double> right;
  for (const Plane& plane : planes) {
    const double w = std::sqrt(plane.weight);
    columns[0].push_back(w * plane.normal.x);
    columns[1].push_back(w * plane.normal.y);
    columns[2].push_back(w * plane.normal.z);
    right.push_back(w * dot(plane.normal, plane.point - centre));
  }
  const auto times = [](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  };
  double r[3][3] = {}, y[3], x[3];
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < k; ++j) {
      r[j][k] = times(columns[j], columns[k]);
      for (std::size_t i = 0; i < right.size(); ++i) columns[k][i] -= r[j][k] * columns[j][i];
    }
    r[k][k] = std::sqrt(times(columns[k], columns[k]));
    for (double& v : columns[k]) v /= r[k][k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    y[k] = times(columns[k], right);
    for (std::size_t i = 0; i < right.size(); ++i) right[i] -= y[k] * columns[k][i];
  }
  for (std::size_t k = 3; k-- > 0;) {
    x[k] = y[k];
    for (std::size_t j = k + 1; j < 3; ++j) x[k] -= r[k][j] * x[j];
    x[k] /= r[k][k];
  }
  return centre + Vec3{x[0], x[1], x[2]};
}

Quadric quadricOf(const std::vector<Plane>& planes) {
  Quadric sum;
  for (const Plane& plane : planes) sum += Quadric::plane(plane.normal, plane.point, plane.weight);
  return sum;
}

TEST(Quadric, isTheWeightedSumOfSquaredDistances) {
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    const auto planes = randomPlanes(random, 7, 0.8);
    const Vec3 p{5010, -6990, 310};
    const double direct = directSum(planes, p);
    EXPECT_NEAR(quadricOf(planes).at(p), direct, 1e-9 * direct + 1e-3);
  }
}

TEST(Quadric, isLeastWhereLeastSquaresSaySo) {
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    const auto planes = randomPlanes(random, 4 + i % 9, 0.7);
    const Vec3 near{5000, -7000, 300};
    const auto least = quadricOf(planes).least(near);
    ASSERT_TRUE(least);
    const Vec3 direct = directLeast(planes, near);
    EXPECT_NEAR(length(*least - direct), 0, 1e-4 * (1 + length(direct - near))) << "case " << i;
    EXPECT_LE(directSum(planes, *least), directSum(planes, direct) * (1 + 1e-6) + 1e-3);
  }
}

TEST(Quadric, hasNoSinglePlaceOnAFlatOrAStraightSurface) {
  const Quadric flat =
      Quadric::plane({0, 0, 1}, {100, 200, 5}, 30) + Quadric::plane({0, 0, 1}, {150, 200, 5}, 12);
  EXPECT_FALSE(flat.least({120, 210, 5}));
  EXPECT_FALSE(
      (flat + Quadric::plane({0, 1, 0}, {0, 200, 0}, 9)).least({120, 210, 5}));  // a straight line left
  EXPECT_TRUE((flat + Quadric::plane({0, 1, 0}, {0, 200, 0}, 9) + Quadric::plane({1, 0, 0}, {130, 0, 0}, 9))
                  .least({120, 210, 5}));
  EXPECT_FALSE(Quadric{}.least({0, 0, 0}));
}

TEST(Quadric, isLeastBetweenTwoPlacesWhereASearchFindsIt) {
  std::mt19937 random(7);
  for (int i = 0; i < 50; ++i) {
    const auto planes = randomPlanes(random, 3, 0.9);
    const Quadric q = quadricOf(planes);
    const Vec3 a = planes[0].point, b = planes[1].point;
    double best = INFINITY;
    for (int k = 0; k <= 2000; ++k) best = std::min(best, directSum(planes, a + (k / 2000.0) * (b - a)));
    const Vec3 found = q.leastBetween(a, b);
    EXPECT_LE(directSum(planes, found), best * (1 + 1e-9) + 1e-3);
    EXPECT_NEAR(length(found - a) + length(b - found), length(b - a), 1e-6);
  }
}

}  // namespace
}  // namespace trimtab::terrain
