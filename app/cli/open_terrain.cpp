#include "open_terrain.h"

#include "app/models/read_model.h"
#include "commands.h"
#include "trimtab/scene/osg_database.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/bake/cache.h"

namespace trimtab::cli {

std::shared_ptr<const terrain::Database> openTerrain(const std::string& terrain, const std::string& origin,
                                                     const terrain::Progress& progress) {
  const auto opened = scene::isOsgScene(terrain)
                          ? scene::openOsgScene(terrain, origin)
                          : terrain::openOrBake(terrain, terrain::cacheFolder(), progress,
                                                terrain::BakeOptions{}.trianglesPerNode,
                                                terrain::ObjectsToBake{{}, models::readModel});
  report(opened.findings());
  return opened ? *opened : nullptr;
}

}  // namespace trimtab::cli
