#include "world_models.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <system_error>
#include <vector>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/units/linear.h"

namespace trimtab::terrain {

namespace {

/// Colours of the models, sRGB 0 to 1.
constexpr const char* kWorldColours =
    "newmtl bark\nKd 0.27 0.21 0.16\n"
    "newmtl fir\nKd 0.13 0.22 0.13\n"
    "newmtl spruce\nKd 0.16 0.25 0.17\n"
    "newmtl pine\nKd 0.21 0.29 0.17\n"
    "newmtl oak\nKd 0.22 0.31 0.14\n"
    "newmtl birch\nKd 0.31 0.39 0.19\n"
    "newmtl poplar\nKd 0.25 0.35 0.16\n"
    "newmtl bush\nKd 0.27 0.34 0.18\n"
    "newmtl plaster\nKd 0.80 0.77 0.70\n"
    "newmtl brick\nKd 0.62 0.45 0.37\n"
    "newmtl tiles\nKd 0.52 0.28 0.21\n"
    "newmtl slate\nKd 0.33 0.35 0.38\n"
    "newmtl concrete\nKd 0.68 0.67 0.64\n"
    "newmtl glass\nKd 0.22 0.29 0.35\n"
    "newmtl metal\nKd 0.60 0.64 0.66\n"
    "newmtl steel\nKd 0.45 0.47 0.48\n"
    "newmtl white-light\nKd 1.00 0.96 0.85\n"
    "newmtl green-light\nKd 0.30 1.00 0.45\n"
    "newmtl red-light\nKd 1.00 0.20 0.15\n"
    "newmtl warm-light\nKd 1.00 0.78 0.45\n";

/// Collects triangles as text of an .obj, in axes east, north and up.
class ModelText {
 public:
  void paint(const char* colour) { text_ += std::string("usemtl ") + colour + "\n"; }

  /// A flat face, anticlockwise from outside.
  void face(const std::vector<Vec3>& corners) {
    const Vec3 n = cross(corners[1] - corners[0], corners[2] - corners[0]);
    for (const Vec3& corner : corners) vertex(corner, n);
    const int first = count_ - static_cast<int>(corners.size()) + 1;
    for (int i = 1; i + 1 < static_cast<int>(corners.size()); ++i) triangle(first, first + i, first + i + 1);
  }

  /// A solid between two rings of as many corners, both anticlockwise from above.
  void between(const std::vector<Vec3>& low, const std::vector<Vec3>& high) {
    const std::size_t n = low.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t k = (i + 1) % n;
      face({low[i], low[k], high[k], high[i]});
    }
    face(high);
    face({low.rbegin(), low.rend()});
  }

  void box(Vec3 low, Vec3 high) {
    const auto ring = [&](double z) {
      return std::vector<Vec3>{
          {low.x, low.y, z}, {high.x, low.y, z}, {high.x, high.y, z}, {low.x, high.y, z}};
    };
    between(ring(low.z), ring(high.z));
  }

  /// A solid of `sides` around the upright, of two radii.
  void drum(int sides, double lowR, double highR, double lowZ, double highZ) {
    between(ringOf(sides, lowR, lowZ), ringOf(sides, highR, highZ));
  }

  void cone(int sides, double radius, double lowZ, double highZ) {
    pointed(ringOf(sides, radius, lowZ), {0, 0, highZ});
  }

  void pointed(const std::vector<Vec3>& ring, Vec3 tip) {
    for (std::size_t i = 0; i < ring.size(); ++i) face({ring[i], ring[(i + 1) % ring.size()], tip});
    face({ring.rbegin(), ring.rend()});
  }

  /// A roof with its ridge along y, over a rectangle around `middle`.
  void gable(Vec3 middle, double halfX, double halfY, double rise) {
    const Vec3 a = middle + Vec3{-halfX, -halfY, 0}, b = middle + Vec3{halfX, -halfY, 0},
               c = middle + Vec3{halfX, halfY, 0}, d = middle + Vec3{-halfX, halfY, 0},
               front = middle + Vec3{0, -halfY, rise}, back = middle + Vec3{0, halfY, rise};
    face({a, b, front});
    face({c, d, back});
    face({b, c, back, front});
    face({d, a, front, back});
    face({d, c, b, a});
  }

  /// A rounded body of a crown: `rings` of `sides` between its ends.
  void lump(Vec3 middle, Vec3 radius, int sides, int rings) {
    const int base = count_;
    const auto at = [&](double turn, double rise) {
      const Vec3 d{std::cos(turn) * std::cos(rise), std::sin(turn) * std::cos(rise), std::sin(rise)};
      vertex(middle + Vec3{d.x * radius.x, d.y * radius.y, d.z * radius.z},
             {d.x / radius.x, d.y / radius.y, d.z / radius.z});
    };
    at(0, -std::numbers::pi / 2);
    for (int r = 1; r <= rings; ++r)
      for (int s = 0; s < sides; ++s)
        at(2 * std::numbers::pi * (s + 0.5 * (r % 2)) / sides,
           std::numbers::pi * (static_cast<double>(r) / (rings + 1) - 0.5));
    at(0, std::numbers::pi / 2);
    const int bottom = base + 1, top = count_;
    const auto ring = [&](int r, int s) { return bottom + 1 + r * sides + s % sides; };
    for (int s = 0; s < sides; ++s) {
      triangle(bottom, ring(0, s + 1), ring(0, s));
      triangle(top, ring(rings - 1, s), ring(rings - 1, s + 1));
      for (int r = 0; r + 1 < rings; ++r) {
        triangle(ring(r, s), ring(r, s + 1), ring(r + 1, s));
        triangle(ring(r, s + 1), ring(r + 1, s + 1), ring(r + 1, s));
      }
    }
  }

  /// A square bar between two points.
  void beam(Vec3 from, Vec3 to, double wide) {
    const Vec3 along = to - from;
    const Vec3 aside = std::abs(along.z) > 0.9 * length(along) ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
    Vec3 u = cross(aside, along);
    u = u * (wide / 2 / length(u));
    Vec3 v = cross(along, u);
    v = v * (wide / 2 / length(v));
    const auto ring = [&](Vec3 p) { return std::vector<Vec3>{p - u - v, p + u - v, p + u + v, p - u + v}; };
    between(ring(from), ring(to));
  }

  /// A light so high above the ground.
  void light(const char* colour, double height) {
    paint(colour);
    row("v", {0, 0, height});
    ++count_;
    text_ += "p " + std::to_string(count_) + "\n";
  }

  std::string text() const { return "mtllib colours.mtl\n" + text_; }

 private:
  static std::vector<Vec3> ringOf(int sides, double radius, double z) {
    std::vector<Vec3> ring;
    for (int i = 0; i < sides; ++i) {
      const double turn = 2 * std::numbers::pi * i / sides;
      ring.push_back({radius * std::cos(turn), radius * std::sin(turn), z});
    }
    return ring;
  }
  void row(const char* what, Vec3 p) {
    // Millimetres, without the locale's comma; y of the file is up.
    text_ += what;
    for (const double value : {p.x, p.z, -p.y}) {
      const auto thousandths = static_cast<long>(std::lround(std::abs(value) * 1000));
      const std::string digits = std::to_string(1000 + thousandths % 1000).substr(1);
      text_ += (value < 0 ? " -" : " ") + std::to_string(thousandths / 1000) + "." + digits;
    }
    text_ += '\n';
  }
  void vertex(Vec3 place, Vec3 normal) {
    row("v", place);
    row("vn", normal * (1 / length(normal)));
    ++count_;
  }
  void triangle(int a, int b, int c) {
    text_ += 'f';
    for (const int i : {a, b, c}) text_ += " " + std::to_string(i) + "//" + std::to_string(i);
    text_ += '\n';
  }

  std::string text_;
  int count_ = 0;
};

void conifer(ModelText& m, const char* colour, int cones, double height, double radius) {
  m.paint("bark");
  m.drum(4, 0.35, 0.25, -1, 0.2 * height);
  m.paint(colour);
  for (int i = 0; i < cones; ++i) {
    const double low = height * (0.1 + 0.8 * i / cones);
    m.cone(7, radius * (1 - 0.75 * i / cones), low, std::min(height, low + 1.5 * height / cones));
  }
}

void house(ModelText& m, const char* wall, const char* roof, Vec3 half, double rise) {
  m.paint(wall);
  m.box({-half.x, -half.y, -2}, {half.x, half.y, half.z});
  m.paint(roof);
  m.gable({0, 0, half.z}, half.x + 0.5, half.y + 0.5, rise);
}

void pylon(ModelText& m) {
  const auto at = [](double x, double y, double z) {
    const double wide = z < 28 ? 4.0 - 3.1 * std::max(z, 0.0) / 28 : 0.9;
    return Vec3{x * wide, y * wide, z};
  };
  m.paint("steel");
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      m.beam(at(x, y, -2), at(x, y, 28), 0.4);
      m.beam(at(x, y, 28), at(x, y, 43), 0.3);
    }
  for (const double z : {0.0, 10.0, 19.0})
    for (const double s : {-1.0, 1.0}) {
      const double up = z + (z < 1 ? 10 : 9);
      m.beam(at(-1, s, z), at(1, s, up), 0.22);
      m.beam(at(s, 1, z), at(s, -1, up), 0.22);
    }
  for (const double z : {29.0, 35.0, 41.0})
    for (const double s : {-1.0, 1.0}) {
      const double reach = z == 35.0 ? 9 : 6.5;
      m.beam({0, 0, z}, {s * reach, 0, z}, 0.5);
      m.beam({0, 0, z + 2}, {s * reach, 0, z}, 0.25);
    }
  m.pointed({at(-1, -1, 43), at(1, -1, 43), at(1, 1, 43), at(-1, 1, 43)}, {0, 0, 45});
}

void hangar(ModelText& m) {
  constexpr int kSteps = 10;
  std::vector<Vec3> front, back;
  for (int i = 0; i <= kSteps; ++i) {
    const double turn = std::numbers::pi * i / kSteps;
    front.push_back({18 * std::cos(turn), -25, 12 * std::sin(turn)});
    back.push_back({18 * std::cos(turn), 25, 12 * std::sin(turn)});
  }
  m.paint("metal");
  for (std::size_t i = 0; i < kSteps; ++i) m.face({front[i], back[i], back[i + 1], front[i + 1]});
  m.face(front);
  m.face({back.rbegin(), back.rend()});
  m.face({front[0], front[kSteps], back[kSteps], back[0]});
  m.paint("slate");
  m.box({-12, 24.5, -1}, {12, 25.3, 7.5});
}

std::string textOf(WorldModel model) {
  ModelText m;
  switch (model) {
    case WorldModel::fir:
      conifer(m, "fir", 3, 17, 3.2);
      break;
    case WorldModel::spruce:
      conifer(m, "spruce", 4, 22, 2.8);
      break;
    case WorldModel::pine:
      m.paint("bark");
      m.drum(5, 0.35, 0.2, -1, 11);
      m.paint("pine");
      m.lump({0, 0, 12}, {3.2, 3.2, 3}, 6, 3);
      m.lump({0.9, 0.4, 14.5}, {2, 2, 1.8}, 5, 2);
      break;
    case WorldModel::oak:
      m.paint("bark");
      m.drum(5, 0.5, 0.35, -1, 5);
      m.paint("oak");
      m.lump({0, 0, 8.5}, {5, 4.6, 4.5}, 7, 3);
      m.lump({2.2, 1.4, 10.5}, {3, 3, 3}, 6, 2);
      m.lump({-2, -1.2, 10}, {3, 2.8, 2.6}, 6, 2);
      break;
    case WorldModel::birch:
      m.paint("bark");
      m.drum(4, 0.25, 0.15, -1, 5);
      m.paint("birch");
      m.lump({0, 0, 9}, {2.8, 2.6, 5.5}, 6, 3);
      break;
    case WorldModel::poplar:
      m.paint("bark");
      m.drum(4, 0.35, 0.25, -1, 4);
      m.paint("poplar");
      m.lump({0, 0, 12}, {2.2, 2.2, 10}, 6, 4);
      break;
    case WorldModel::bush:
      m.paint("bush");
      m.lump({0, 0, 0.8}, {1.7, 1.5, 1.4}, 6, 2);
      break;
    case WorldModel::house:
      house(m, "plaster", "tiles", {4.5, 5.5, 4}, 3.2);
      m.paint("brick");
      m.box({1.2, 1, 4.5}, {2, 1.8, 8});
      break;
    case WorldModel::largeHouse:
      house(m, "brick", "slate", {5.5, 9, 6}, 3.8);
      m.paint("brick");
      m.box({4, -3.5, -2}, {9.5, 3.5, 5});
      m.paint("slate");
      m.box({3.8, -3.8, 5}, {9.8, 3.8, 5.4});
      break;
    case WorldModel::flats:
      for (int floor = 0; floor < 6; ++floor) {
        const double z = 3.0 * floor;
        m.paint("concrete");
        m.box({-7, -16, floor == 0 ? -2 : z}, {7, 16, z + 1.4});
        m.paint("glass");
        m.box({-6.8, -15.8, z + 1.4}, {6.8, 15.8, z + 3});
      }
      m.paint("concrete");
      m.box({-7, -16, 18}, {7, 16, 19});
      break;
    case WorldModel::church:
      house(m, "plaster", "slate", {6, 14, 9}, 6);
      m.paint("plaster");
      m.box({-3, -19, -2}, {3, -13, 22});
      m.paint("slate");
      m.pointed({{-3.4, -19.4, 22}, {3.4, -19.4, 22}, {3.4, -12.6, 22}, {-3.4, -12.6, 22}}, {0, -16, 36});
      break;
    case WorldModel::hangar:
      hangar(m);
      break;
    case WorldModel::controlTower:
      m.paint("concrete");
      m.drum(8, 3.5, 3, -1, 22);
      m.paint("glass");
      m.drum(8, 4, 5.2, 22, 26);
      m.paint("concrete");
      m.drum(8, 5.4, 4.6, 26, 27);
      m.paint("steel");
      m.drum(4, 0.2, 0.1, 27, 32);
      break;
    case WorldModel::pylon:
      pylon(m);
      break;
    case WorldModel::runwayLight:
      m.light("white-light", 0.5);
      break;
    case WorldModel::thresholdLight:
      m.light("green-light", 0.5);
      break;
    case WorldModel::runwayEndLight:
      m.light("red-light", 0.5);
      break;
    case WorldModel::streetLight:
      m.light("warm-light", 7);
      break;
  }
  return m.text();
}

}  // namespace

Result<Done> writeWorldModels(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (const auto can = canWriteIn(folder); !can) return can;
  if (const auto done = writeAtomically(folder / "colours.mtl", kWorldColours); !done) return done;
  int number = 0;
  for (const std::string name : kWorldModelNames) {
    const std::string text = textOf(static_cast<WorldModel>(number++));
    if (const auto done = writeAtomically(folder / (name + ".obj"), text); !done) return done;
  }
  return Done{};
}

}  // namespace trimtab::terrain
