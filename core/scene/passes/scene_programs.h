#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "core/scene/gl/gl_program.h"
#include "scene_view.h"

namespace trimtab::scene {

/// Shaders in the variants that frames ask for. A variant is compiled when it is first used.
class ShaderVariants {
 public:
  /// Each `#define` that a frame may ask for is a bit.
  enum Define : unsigned {
    in_weather = 1,
    air_cut = 2,
    air_layer = 4,
    ground_texture = 8,
    tinted = 16,
    on_grid = 32,
    wire = 64
  };
  /// `fixed` are defined in every variant.
  ShaderVariants(const char* vertexName, const char* fragmentName, std::vector<const char*> fixed = {});
  /// Returns the program with those of `defines` that its shaders ask for.
  GlProgram& with(unsigned defines);

 private:
  const char *vertexName_, *fragmentName_;
  std::vector<const char*> fixed_;
  unsigned vertexImports_, fragmentImports_;
  std::map<unsigned, GlProgram> variants_;
};

/// What a pass of the scene draws with.
enum class SceneShaders {
  tiles,
  patches,
  trees,
  tile_numbers,
  patch_numbers,
  tree_numbers,
  objects,
  textured_objects,
  object_numbers,
  textured_object_numbers,
  lights,
  tree_picture,
  lines,
  sky,
  occluders,
  depth_reduce,
  occlusion_test
};

/// The programs of the scene, and what a frame gives them: uniforms, matrices, and the state of GL.
/// The context must be current for all of its life.
class ScenePrograms {
 public:
  ScenePrograms();

  /// Takes the frame's view, and brings GL into the state that every pass of the scene begins with: depth is
  /// near / distance, whatever is nearer is drawn, and nothing is blended or cut off. Undoes what others who
  /// share the context, such as a widget's painter, have left.
  void begin(const SceneView& view);
  /// Sets the viewport, and clears depth and, unless the image is one of numbers, its colour.
  void clear(bool colour);
  /// Puts a program in use and returns it. `wire` chooses its variant for lines.
  unsigned use(SceneShaders shaders, bool wire = false);

 private:
  void setAir(const SceneView& view);
  void setDepthView(const DepthView& depth, const ViewShape& shape);

  std::array<ShaderVariants, 17> shaders_;
  Uniforms uniforms_, ofDepth_;
  unsigned defines_ = 0;
  SceneView view_;
};

}  // namespace trimtab::scene
