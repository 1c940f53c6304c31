#include <algorithm>
#include <cmath>
#include <map>

#include "app/models/read_model.h"
#include "tests/support.h"
#include "trimtab/host/placement_list.h"
#include "trimtab/terrain/objects/build_model.h"
#include "trimtab/terrain/objects/build_objects.h"
#include "trimtab/terrain/synthetic/sample.h"

namespace trimtab::models {
namespace {

/// Ground of one height everywhere.
class Level final : public GroundHeights {
 public:
  std::optional<Metres> heightAt(Degrees, Degrees) const override { return Metres{100}; }
};

class SampleWorld : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = std::make_unique<test::ScratchDir>();
    const std::filesystem::path tif = *dir_ / "land.tif", list = terrain::sampleObjects(tif);
    terrain::SampleOptions options;
    options.postM = 120;
    options.objects = true;
    const auto written = terrain::writeSample(tif, options);
    ASSERT_TRUE(written) << toString(written.findings());
    auto read = readPlacementList(test::readFile(list), list.string());
    ASSERT_TRUE(read) << toString(read.findings());
    EXPECT_TRUE(read.findings().empty()) << toString(read.findings());
    list_ = std::make_unique<PlacementList>(std::move(read).value());
    for (const std::string& name : list_->models) {
      auto source = readModel(list.parent_path() / name);
      ASSERT_TRUE(source) << toString(source.findings());
      EXPECT_TRUE(source.findings().empty()) << toString(source.findings());
      auto model = terrain::buildModel(*source);
      ASSERT_TRUE(model) << toString(model.findings());
      EXPECT_TRUE(model.findings().empty()) << toString(model.findings());
      models_.push_back(std::move(model).value());
    }
  }
  static void TearDownTestSuite() {
    models_.clear();
    list_.reset();
    dir_.reset();
  }
  static inline std::unique_ptr<test::ScratchDir> dir_;
  static inline std::unique_ptr<PlacementList> list_;
  static inline std::vector<std::optional<terrain::BuiltModel>> models_;
};

TEST_F(SampleWorld, eachOfADozenModelsHasLevelsForNearAndFar) {
  ASSERT_GE(models_.size(), 12u);
  for (std::size_t i = 0; i < models_.size(); ++i) {
    if (!models_[i]->lights.empty()) continue;
    const auto& levels = models_[i]->levels;
    ASSERT_GE(levels.size(), 2u) << list_->models[i];
    EXPECT_LE(levels.back().mesh.triangles(), 12u) << list_->models[i];
    EXPECT_GT(levels.back().errorM, 0) << list_->models[i];
  }
}

TEST_F(SampleWorld, standsUprightInItsHundredThousands) {
  EXPECT_GT(list_->placements.size(), 150000u);
  std::map<std::uint32_t, std::size_t> counts;
  for (const ListedPlacement& placement : list_->placements) ++counts[placement.model];
  EXPECT_EQ(counts.size(), models_.size()) << "each model stands somewhere";
  const ListedPlacement& first = list_->placements.front();
  const LocalFrame frame(GeodeticPosition{first.latitude, first.longitude, Metres{0}});
  const auto built = terrain::buildObjects(models_, *list_, Level(), frame, "list");
  ASSERT_TRUE(built) << toString(built.findings());
  EXPECT_TRUE(built.findings().empty()) << toString(built.findings());
  const ObjectIndex& index = built->index;
  ASSERT_EQ(index.instances.size() + built->lights.points.size(), list_->placements.size());
  EXPECT_GT(built->lights.points.size(), 400u);
  double worst = 1;
  for (std::uint32_t number = 0; number < index.cells.size(); ++number) {
    const ObjectIndex::Cell& cell = index.cells[number];
    if (!cell.isLeaf(number)) continue;
    const Vec3 origin{16.0 * cell.origin[0], 16.0 * cell.origin[1], 16.0 * cell.origin[2]};
    for (std::uint32_t i = cell.firstInstance; i < cell.firstInstance + cell.instances; ++i) {
      const ObjectInstance& instance = index.instances[i];
      // The third axis of the model, from the unit quaternion.
      const double x = instance.turn[0] / 32767.0, y = instance.turn[1] / 32767.0,
                   z = instance.turn[2] / 32767.0, w = instance.turn[3] / 32767.0;
      const Vec3 up{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
      const GeodeticPosition place = frame.toGeodetic(origin + Vec3{instance.x, instance.y, instance.z});
      const Vec3 zenith = frame.ecefToLocal() * eastNorthUp(place.latitude, place.longitude).row[2];
      worst = std::min(worst, dot(up, zenith));
      ASSERT_NEAR(place.height.value(), 100, 0.05);
    }
  }
  EXPECT_GT(worst, std::cos(1e-3)) << "the most inclined of all";
}

}  // namespace
}  // namespace trimtab::models
