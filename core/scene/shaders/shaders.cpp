#include "shaders.h"

#include <bit>
#include <cstdio>
#include <cstring>

#include "light.h"
#include "shared_constants.h"

namespace trimtab::scene {

/// The build writes this table from the files of this folder (embed_shaders in CMakeLists.txt).
struct ShaderFile {
  const char *name, *text;
};
extern const ShaderFile kShaderFiles[];
extern const std::size_t kShaderFileCount;

namespace {

const char* fileNamed(const std::string& name) {
  for (std::size_t i = 0; i < kShaderFileCount; ++i)
    if (name == kShaderFiles[i].name) return kShaderFiles[i].text;
  std::fprintf(stderr, "trimtab: there is no shader file %s\n", name.c_str());
  std::abort();
}

/// The only place where C++ passes constants to the shaders; whatever changes per frame is a uniform. A
/// uniform costs a software rasteriser a checked read in every pixel: the haze as one took a tenth of the
/// tiles' shader.
std::string sharedConstants() {
  std::string lines;
  const auto define = [&lines](const char* name, auto value) {
    lines += std::string("#define ") + name + " " + std::to_string(value) + "\n";
  };
  define("TILE_VERTICES", kTileVertices);
  define("PATCH_BLOCK", kPatchBlock);
  define("TREE_BLOCK", kTreeBlock);
  define("OCCLUDER_VERTICES", kOccluderVertices);
  define("PARTS", kParts);
  define("TESTED_PER_ROW", kTestedPerRow);
  define("GROUND_SIDE_BITS", std::countr_zero(static_cast<unsigned>(kGroundSide)));
  define("SKY_LIGHT", kSkyLight);
  define("UPWARD_LIGHT", kUpwardLight);
  define("SUN_LIGHT", kSunLight);
  define("MOST_LIGHT", kMostLight);
  define("HAZE_RED", kHaze[0]);
  define("HAZE_GREEN", kHaze[1]);
  define("HAZE_BLUE", kHaze[2]);
  define("HAZE_DISTANCE", kHazeDistanceM);
  return lines;
}

}  // namespace

std::string completeShader(std::string text, const std::vector<const char*>& defines) {
  constexpr const char* kInclude = "#include \"";
  for (std::size_t at; (at = text.find(kInclude)) != std::string::npos;) {
    const std::size_t name = at + std::strlen(kInclude), end = text.find('"', name);
    text.replace(at, text.find('\n', end) + 1 - at, fileNamed(text.substr(name, end - name)));
  }
  std::string constants = sharedConstants();
  for (const char* name : defines) constants += std::string("#define ") + name + " 1\n";
  return text.insert(text.find('\n') + 1, constants);
}

std::string shaderText(const char* name, const std::vector<const char*>& defines) {
  return completeShader(fileNamed(name), defines);
}

}  // namespace trimtab::scene
