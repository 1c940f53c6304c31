#include "mesher_check.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace trimtab::test {

namespace {

double lattice(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  std::uint32_t h = x * 0x9e3779b1u ^ y * 0x85ebca77u ^ seed * 0xc2b2ae3du;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  return static_cast<double>(h ^ (h >> 15)) / 4294967296.0 - 0.5;
}

double smooth(double t) {
  return t * t * t * (10 + t * (6 * t - 15));
}

std::int64_t turn(const Point& a, const Point& b, std::int64_t x, std::int64_t y) {
  return (std::int64_t{b.column} - a.column) * (y - a.row) - (std::int64_t{b.row} - a.row) * (x - a.column);
}

std::string name(const Point& p) {
  return "(" + std::to_string(p.column) + ", " + std::to_string(p.row) + ")";
}

}  // namespace

Field::Field(std::uint32_t c, std::uint32_t r, const std::function<double(int, int)>& height)
    : columns(c), rows(r), z(std::size_t{c} * r) {
  for (std::uint32_t y = 0; y < r; ++y)
    for (std::uint32_t x = 0; x < c; ++x)
      z[std::size_t{y} * c + x] = static_cast<float>(height(static_cast<int>(x), static_cast<int>(y)));
}

Field fractal(std::uint32_t columns, std::uint32_t rows, std::uint32_t seed, double relief, double gain) {
  return Field(columns, rows, [&](int column, int row) {
    double sum = 0, amplitude = relief;
    for (std::uint32_t cell = 256; cell >= 1; cell /= 2, amplitude *= gain) {
      const auto x = static_cast<std::uint32_t>(column), y = static_cast<std::uint32_t>(row);
      const double u = smooth(static_cast<double>(x % cell) / cell),
                   v = smooth(static_cast<double>(y % cell) / cell);
      const std::uint32_t i = x / cell, j = y / cell, s = seed + cell * 977;
      const double low = lattice(i, j, s) * (1 - u) + lattice(i + 1, j, s) * u;
      const double high = lattice(i, j + 1, s) * (1 - u) + lattice(i + 1, j + 1, s) * u;
      sum += amplitude * (low * (1 - v) + high * v);
    }
    return sum;
  });
}

MeshFacts checkMesh(const terrain::HeightField& field, const std::vector<Point>& border,
                    const std::vector<Point>& vertices, const std::vector<float>& z,
                    const std::vector<std::uint32_t>& indices, std::uint32_t step) {
  MeshFacts facts;
  const auto wrong = [&](const std::string& what) {
    if (facts.wrong.empty()) facts.wrong = what;
  };
  // Edges: each once a way, both ways inside, one way along the border.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  std::int64_t area = 0;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (indices[i + k] >= vertices.size()) return wrong("index out of range"), facts;
      if (++edges[{indices[i + k], indices[i + (k + 1) % 3]}] > 1)
        wrong("edge used twice at " + name(vertices[indices[i + k]]));
    }
    const Point &a = vertices[indices[i]], &b = vertices[indices[i + 1]], &c = vertices[indices[i + 2]];
    const std::int64_t here = turn(a, b, c.column, c.row);
    if (here <= 0) wrong("triangle without area, or turned, at " + name(a));
    area += here;
  }
  std::set<std::pair<std::uint32_t, std::uint32_t>> rim;
  for (const auto& [edge, count] : edges)
    if (!edges.contains({edge.second, edge.first})) rim.insert(edge);
  std::int64_t wanted = 0;
  const auto n = static_cast<std::uint32_t>(border.size());
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    if (!(vertices[i] == border[i])) wrong("border vertex moved: " + name(border[i]));
    if (!rim.contains({i, j})) wrong("border edge lost at " + name(border[i]));
    wanted += std::int64_t{border[i].column} * border[j].row - std::int64_t{border[j].column} * border[i].row;
  }
  if (rim.size() != n) wrong("border edges: " + std::to_string(rim.size()));
  if (area != wanted) wrong("area " + std::to_string(area) + " instead of " + std::to_string(wanted));
  std::set<std::pair<std::uint32_t, std::uint32_t>> places;
  for (const Point& p : vertices)
    if (!places.insert({p.column, p.row}).second) wrong("two vertices at " + name(p));

  // Posts: in every triangle whose closure holds them the mesh has one height.
  const std::size_t count = std::size_t{field.columns} * field.rows;
  std::vector<std::uint8_t> strictly(count, 0), touched(count, 0);
  std::vector<double> off(count, 0);
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const Point p[3] = {vertices[indices[i]], vertices[indices[i + 1]], vertices[indices[i + 2]]};
    const double zs[3] = {z[indices[i]], z[indices[i + 1]], z[indices[i + 2]]};
    const double whole = static_cast<double>(turn(p[0], p[1], p[2].column, p[2].row));
    const auto [x0, x1] = std::minmax({p[0].column, p[1].column, p[2].column});
    const auto [y0, y1] = std::minmax({p[0].row, p[1].row, p[2].row});
    for (std::uint32_t y = y0; y <= y1; ++y)
      for (std::uint32_t x = x0; x <= x1; ++x) {
        std::int64_t w[3];
        for (std::size_t k = 0; k < 3; ++k) w[k] = turn(p[(k + 1) % 3], p[(k + 2) % 3], x, y);
        if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
        const std::size_t at = std::size_t{y} * field.columns + x;
        if (w[0] > 0 && w[1] > 0 && w[2] > 0 && ++strictly[at] > 1)
          wrong("post covered twice: " + name({x, y}));
        touched[at] = 1;
        double height = 0;
        for (std::size_t k = 0; k < 3; ++k) height += static_cast<double>(w[k]) / whole * zs[k];
        off[at] = std::max(off[at], std::fabs(height - field.at(x, y)));
      }
  }
  double sum = 0;
  for (std::size_t at = 0; at < count; ++at) {
    if (touched[at] == 0) continue;
    if (at / field.columns % step != 0 || at % field.columns % step != 0) continue;
    ++facts.posts;
    sum += off[at] * off[at];
    facts.maxM = std::max(facts.maxM, off[at]);
  }
  facts.rmsM = std::sqrt(sum / static_cast<double>(std::max<std::uint64_t>(facts.posts, 1)));
  return facts;
}

MeshFacts checkMesh(const terrain::HeightField& field, const std::vector<Point>& border,
                    const terrain::PolygonMesher& mesher) {
  std::vector<std::uint32_t> indices;
  mesher.triangles(indices);
  std::vector<float> z;
  for (const Point& p : mesher.vertices()) z.push_back(field.at(p.column, p.row));
  return checkMesh(field, border, mesher.vertices(), z, indices);
}

}  // namespace trimtab::test
