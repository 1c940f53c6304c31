// SPDX-License-Identifier: GPL-3.0-or-later
#include <osg/Geode>
#include <osg/Geometry>
#include <osgDB/WriteFile>

#include "app/workbench/dialogs/bake_dialog.h"
#include "gui_support.h"
#include "tests/core/terrain/cdb/made_cdb.h"

namespace trimtab::test {
namespace {

class CdbInTheWorkbench : public Bench {
 protected:
  CdbInTheWorkbench() {
    cdb_.heights({48, 11, 1, 1, 1, -4, 0, 0}, [](int c, int r) { return 2.0 * c + r; });
    const fs::path models =
        cdb_.root / "GTModel" / "500_GTModelGeometry" / "A_Culture" / "L_Misc" / "030_Mast";
    fs::create_directories(models);
    const osg::ref_ptr<osg::Geode> mast = new osg::Geode;
    const osg::ref_ptr<osg::Geometry> side = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    for (const osg::Vec3& at : {osg::Vec3(-300, 0, 0), osg::Vec3(300, 0, 0), osg::Vec3(0, 0, 900)})
      corners->push_back(at);
    side->setVertexArray(corners);
    side->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    mast->addDrawable(side);
    EXPECT_TRUE(osgDB::writeNodeFile(*mast, (models / "D500_S001_T001_AL030_000_mast.flt").string()));
    cdb_.table({48, 11, 101, 1, 1, 0, 0, 0}, {"CNAM", "AO1"},
               {{std::array{11.5, 48.5, 0.0}, {{"CNAM", "mast"}, {"AO1", "90"}}},
                {std::array{11.4, 48.5, 0.0}, {{"CNAM", "gone"}}}},
               true);
    cdb_.table({48, 11, 101, 1, 2, 0, 0, 0}, {"CNAM", "FACC", "FSC", "MODL"},
               {{{}, {{"CNAM", "mast"}, {"FACC", "AL030"}, {"FSC", "0"}, {"MODL", "mast"}}}}, false);
  }
  std::string said() { return w().messages().text().toStdString(); }

  ScratchDir dir_;
  MadeCdb cdb_{dir_ / "Valley"};
};

TEST_F(CdbInTheWorkbench, opensWhereItIsDroppedWithWhatStandsInIt) {
  drop(cdb_.root);
  ASSERT_TRUE(waitFor([this] { return said().find("Terrain Valley") != std::string::npos; })) << said();
  EXPECT_NE(said().find("What the sources hold"), std::string::npos) << said();
  EXPECT_NE(said().find("1 by 1 models"), std::string::npos) << said();
  EXPECT_NE(said().find("none for 1 features"), std::string::npos) << said();
  EXPECT_TRUE(waitFor([this] {
    const auto& result = w().viewport().lastResult();
    return result && result->objects.all() == 1;
  })) << "the mast is not in the database";
}

TEST_F(CdbInTheWorkbench, isBakedByTheDialog) {
  workbench::BakeDialog dialog;
  dialog.addSources({QString::fromStdString(cdb_.root.string())});
  terrain::BakeOptions options = dialog.options();
  EXPECT_EQ(options.output, fs::path(cdb_.root.string() + "-terrain"));
  w().controllers().terrain->job().bake(options);
  ASSERT_TRUE(waitFor([&] { return !w().controllers().terrain->job().running(); })) << said();
  EXPECT_NE(said().find("1 by 1 models"), std::string::npos) << said();
  EXPECT_TRUE(fs::exists(options.output / "objects.bin")) << said();
}

}  // namespace
}  // namespace trimtab::test
