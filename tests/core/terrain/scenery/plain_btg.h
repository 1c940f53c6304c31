#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <set>
#include <string>
#include <vector>

/// A second reader of scenery, that shares nothing with ours: it knows single triangles with three columns,
/// as all real files have them, and trusts the file.
namespace trimtab::test {

struct PlainBtg {
  struct Triangle {
    std::array<std::uint64_t, 3> vertex;
    std::string material;
  };
  std::array<double, 3> centre{};
  std::vector<std::array<float, 3>> offsets;  ///< from the centre
  std::vector<Triangle> triangles;            ///< in the file's order; none that repeats a place
  std::uint64_t trianglesInFile = 0, degenerate = 0;

  std::array<double, 3> place(std::uint64_t vertex) const {
    const auto& o = offsets[vertex];
    return {centre[0] + double{o[0]}, centre[1] + double{o[1]}, centre[2] + double{o[2]}};
  }
};

inline PlainBtg decodedPlainly(const std::string& bytes) {
  PlainBtg file;
  std::size_t at = 0;
  const auto number = [&](std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
      value |= std::uint64_t{static_cast<unsigned char>(bytes.at(at + i))} << (8 * i);
    at += size;
    return value;
  };
  const std::size_t wide = number(2) == 10 ? 4 : 2;
  at = 8;
  for (auto objects = number(wide); objects > 0; --objects) {
    const auto kind = number(1);
    auto properties = number(wide);
    auto elements = number(wide);
    std::string material;
    for (; properties > 0; --properties) {
      const auto property = number(1);
      const auto size = number(4);
      if (property == 0) material = bytes.substr(at, size);
      at += size;
    }
    for (; elements > 0; --elements) {
      const auto size = number(4);
      const std::size_t end = at + size;
      if (kind == 0) std::memcpy(file.centre.data(), &bytes.at(at), 24);
      if (kind == 1) {
        file.offsets.resize(size / 12);
        std::memcpy(file.offsets.data(), &bytes.at(at), size);
      }
      for (; kind == 10 && at < end; ++file.trianglesInFile) {
        PlainBtg::Triangle triangle{{}, material};
        std::set<std::array<float, 3>> places;
        for (auto& vertex : triangle.vertex) {
          vertex = number(wide);
          places.insert(file.offsets.at(vertex));
          at += 2 * wide;
        }
        if (places.size() < 3)
          ++file.degenerate;
        else
          file.triangles.push_back(std::move(triangle));
      }
      at = end;
    }
  }
  return file;
}

}  // namespace trimtab::test
