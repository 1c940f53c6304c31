#pragma once

#include <array>
#include <string>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

namespace trimtab::scene {

/// Links a program from the texts of its shaders. The attributes vertexPosition, vertexNormal, vertexPost and
/// vertexColour are numbers 0 to 3. Returns 0 if the driver refuses the shaders, and prints its log.
unsigned makeGlProgram(const std::string& vertex, const std::string& fragment);

/// Values of uniforms by name, for any program that has some of them. Names must be string literals.
class Uniforms {
 public:
  using Value = std::variant<int, float, std::array<int, 2>, std::array<int, 3>, std::array<float, 2>,
                             std::array<float, 3>, std::array<float, 4>>;
  void set(const char* name, const Value& value);
  const std::vector<std::pair<const char*, Value>>& all() const { return values_; }

 private:
  std::vector<std::pair<const char*, Value>> values_;
};

/// A linked program. The context must be current for all of its life.
class GlProgram {
 public:
  GlProgram(const std::string& vertex, const std::string& fragment);
  ~GlProgram();
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;

  unsigned id() const { return id_; }
  void use() const;
  /// Sets those that the program has. It must be in use.
  void set(const Uniforms& uniforms);

 private:
  unsigned id_;
  std::unordered_map<const char*, int> locations_;
};

}  // namespace trimtab::scene
