#include "trimtab/scene/load_index.h"

#include "trimtab/terrain/format/object_terrain.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/format/static_lod_terrain.h"

namespace trimtab::scene {

std::shared_ptr<const LoadIndex> loadIndexOf(const std::shared_ptr<const terrain::Database>& database) {
  if (!database) return nullptr;
  auto index = std::make_shared<LoadIndex>();
  index->frame = database->index().frame;
  if (database->index().size() > 0)
    index->tiles = std::shared_ptr<const TerrainIndex>(database, &database->index());
  if (const auto patches = database->patches())
    index->patches = std::shared_ptr<const PatchIndex>(patches, &patches->index());
  if (const auto trees = database->staticLod())
    index->trees = std::shared_ptr<const StaticLodIndex>(trees, &trees->index);
  if (const auto objects = database->objects())
    index->objects =
        std::make_shared<const ObjectLoad>(std::shared_ptr<const ObjectIndex>(objects, &objects->index));
  return index;
}

}  // namespace trimtab::scene
