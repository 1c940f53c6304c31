// SPDX-License-Identifier: GPL-3.0-or-later
#include <QAbstractSpinBox>
#include <QPushButton>

#include "app/workbench/controllers/terrain_controller.h"
#include "app/workbench/viewport/viewport.h"
#include "gui_support.h"
#include "trimtab/culling/select_objects.h"
#include "trimtab/terrain/format/object_terrain.h"
#include "views/panels/culling_panel.h"

namespace trimtab::test {
namespace {

/// The sample with its world, opened by the command of the menu, in a window of a usual size.
class ObjectsInTheWorkbench : public Bench {
 protected:
  void SetUp() override {
    ASSERT_NO_FATAL_FAILURE(Bench::SetUp());
    ASSERT_NO_FATAL_FAILURE(trigger("Open sample terrain"));
    ASSERT_TRUE(waitFor([this] { return last().objects.all() > 150000; }, 120000))
        << w().messages().text().toStdString();
  }
  const terrain::ObjectTerrain& objects() { return *w().controllers().terrain->database()->objects(); }
  void shoot(const char* name) {
    ASSERT_TRUE(settle());
    if (const char* shots = std::getenv("TRIMTAB_SHOTS")) {
      EXPECT_TRUE(onDisplay(w()).save(QString::fromLocal8Bit(shots) + "/" + name));
    }
  }
  /// Looks to the north at the first object whose model's file is called so, from so far.
  void lookAt(const std::string& model, double fromM, double aboveM) {
    const ObjectIndex& index = objects().index;
    for (std::uint32_t i = 0; i < index.instances.size(); ++i) {
      if (objects().names[index.instances[i].model].find(model) == std::string::npos) continue;
      GeodeticPosition eye = index.frame.toGeodetic(placeOfObject(index, i));
      eye.latitude = eye.latitude - Degrees{fromM / 111e3};
      eye.height = eye.height + Metres{aboveM};
      // The middle of the image is two metres above the ground under the object.
      w().viewport().camera().place(eye, {.heading = Degrees{0},
                                          .pitch = Degrees{-57.3 * std::atan((aboveM - 2) / fromM)},
                                          .roll = Degrees{0}});
      w().feed().look(w().viewport().camera());
      return;
    }
    FAIL() << "no model " << model;
  }
};

TEST_F(ObjectsInTheWorkbench, aClickNamesTheObjectUnderItAndALargerErrorDrawsFewerTriangles) {
  ASSERT_NO_FATAL_FAILURE(lookAt("house", 40, 12));
  ASSERT_TRUE(settle());
  EXPECT_GT(last().objects.drawn, 0u);
  auto& panel = *w().panels().culling;
  ASSERT_TRUE(w().dock("culling") != nullptr);
  w().dock("culling")->raise();
  for (QPushButton* button : panel.findChildren<QPushButton*>())
    if (button->text().contains("Pick")) button->click();
  ASSERT_TRUE(panel.picking());
  workbench::Viewport& view = w().viewport();
  QTest::mouseClick(&view, Qt::LeftButton, {}, QPoint(view.width() / 2, view.height() / 2));
  ASSERT_TRUE(waitFor([&] { return !panel.picking(); }));
  EXPECT_TRUE(waitFor([&] { return labelSays(panel, "Model") && labelSays(panel, "house"); }))
      << "the house in the middle is not named";
  shoot("objects-picked.png");

  ASSERT_NO_FATAL_FAILURE(lookAt("house", 1500, 300));
  ASSERT_TRUE(settle());
  const FrameResult fine = last();
  w().dock("preset")->raise();
  QAbstractSpinBox* error = nullptr;
  for (QAbstractSpinBox* box : w().dock("preset")->findChildren<QAbstractSpinBox*>())
    if (box->accessibleName() == "Allowed error of objects") error = box;
  ASSERT_NE(error, nullptr);
  error->setFocus();
  error->selectAll();
  QTest::keyClicks(error, "40");
  QTest::keyClick(error, Qt::Key_Return);
  EXPECT_EQ(w().draft().parameters().objects.errorPx.value(), 40);
  ASSERT_TRUE(settle());
  EXPECT_LT(last().objects.triangles, fine.objects.triangles * 19 / 20);
  EXPECT_EQ(last().objects.all(), fine.objects.all());
  shoot("objects-coarse.png");
}

}  // namespace
}  // namespace trimtab::test
