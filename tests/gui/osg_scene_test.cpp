// SPDX-License-Identifier: GPL-3.0-or-later
#include <QDialog>
#include <QLineEdit>
#include <QPushButton>

#include "app/workbench/dialogs/origin_dialog.h"
#include "gui_support.h"
#include "tests/core/scene/foreign/paged_scene.h"
#include "trimtab/scene/osg_database.h"
#include "views/panels/plots_panel.h"
#include "views/panels/terrain_panel.h"

namespace trimtab::test {
namespace {

/// Paged scenes of OpenSceneGraph in the window: hills of 6 km near the sample's middle.
class OsgSceneInTheWorkbench : public Bench {
 protected:
  PagedScene write(const char* folder, bool geocentric) {
    std::filesystem::create_directories(dir_ / folder);
    return {ground_, dir_ / folder, ".osgb", geocentric};
  }
  std::string said() { return w().messages().text().toStdString(); }
  std::shared_ptr<const scene::OsgDatabase> opened() {
    return std::dynamic_pointer_cast<const scene::OsgDatabase>(w().controllers().terrain->database());
  }
  void shoot(const QWidget& what, const char* name) {
    QTest::qWait(200);
    if (const char* shots = std::getenv("TRIMTAB_SHOTS")) {
      EXPECT_TRUE(onDisplay(what).save(QString::fromLocal8Bit(shots) + "/" + name));
    }
  }
  static QPushButton* button(const QDialog& dialog, const char* text) {
    for (QPushButton* each : dialog.findChildren<QPushButton*>())
      if (each->text().remove('&') == QLatin1String(text)) return each;
    return nullptr;
  }
  /// Waits for the dialog that asks where a scene is.
  workbench::OriginDialog* asked() {
    workbench::OriginDialog* dialog = nullptr;
    EXPECT_TRUE(waitFor([&] {
      dialog = w().findChild<workbench::OriginDialog*>();
      return dialog != nullptr && dialog->isVisible();
    })) << said();
    return dialog;
  }
  static QLineEdit* line(const QDialog& dialog, const char* name) {
    for (QLineEdit* each : dialog.findChildren<QLineEdit*>())
      if (each->accessibleName() == QLatin1String(name)) return each;
    return nullptr;
  }

  ScratchDir dir_;
  SyntheticTerrain ground_{4, 0.001, {Degrees{36.57}, Degrees{128.29}, Metres{0}}, [](int column, int row) {
                             return 200 + 100 * std::sin(column * 0.3 + row * 0.2);
                           }};
};

TEST_F(OsgSceneInTheWorkbench, isOpenedAndItsTrianglesAreInThePlot) {
  const PagedScene scene = write("geocentric", true);
  ASSERT_TRUE(scene.written());
  drop(scene.file());
  ASSERT_TRUE(waitFor([this] { return opened() != nullptr; })) << said();
  views::PlotsPanel& plots = *w().panels().plots;
  w().dock("plots")->show();
  w().dock("plots")->raise();
  GeodeticPosition eye{Degrees{36.6}, Degrees{128.32}, Metres{900}};
  w().viewport().camera().place(eye, {.heading = Degrees{0}, .pitch = Degrees{-10}, .roll = Degrees{0}});
  w().feed().look(w().viewport().camera());
  ASSERT_TRUE(settle());
  // More than the root's triangles, and at most those of its 16 finest tiles; the sample has far more.
  const auto triangles = [&] {
    return plots.buffer().value(views::Trace::triangles, plots.buffer().end() - 1);
  };
  EXPECT_TRUE(waitFor([&] { return triangles() > 512 && triangles() <= 16 * 512; })) << triangles();
  w().dock("terrain")->raise();
  const auto* const panel = w().dock("terrain")->findChild<views::TerrainPanel*>();
  EXPECT_TRUE(labelSays(*panel, "A scene of OpenSceneGraph"));
  EXPECT_TRUE(labelSays(*panel, QString::fromStdString(scene.file().string())));
  EXPECT_FALSE(labelSays(*panel, "2 × 2"));
  EXPECT_TRUE(labelSays(*panel, "OpenSceneGraph chooses its levels"));
  ASSERT_TRUE(settle());
  shoot(w(), "osg-scene.png");
}

TEST_F(OsgSceneInTheWorkbench, thatIsFlatIsOpenedWhereAPersonSaysItIs) {
  const PagedScene scene = write("flat", false);
  ASSERT_TRUE(scene.written());
  const auto before = w().controllers().terrain->database();
  const QString path = QString::fromStdString(scene.file().string());
  w().controllers().terrain->open(path);
  workbench::OriginDialog* dialog = asked();
  ASSERT_NE(dialog, nullptr);
  EXPECT_FALSE(button(*dialog, "Open")->isEnabled()) << "nothing is given yet";
  line(*dialog, "Latitude")->setText("95");
  line(*dialog, "Longitude")->setText("128.29");
  EXPECT_FALSE(button(*dialog, "Open")->isEnabled());
  button(*dialog, "Cancel")->click();
  ASSERT_TRUE(waitFor([this] { return w().findChild<workbench::OriginDialog*>() == nullptr; }));
  EXPECT_EQ(w().controllers().terrain->database(), before);
  EXPECT_NE(said().find("the terrain is unchanged"), std::string::npos) << said();
  EXPECT_EQ(said().find("cannot be opened"), std::string::npos) << said();

  w().controllers().terrain->open(path);
  ASSERT_NE(dialog = asked(), nullptr);
  EXPECT_TRUE(line(*dialog, "Latitude")->text().isEmpty()) << "what was cancelled is not kept";
  line(*dialog, "Latitude")->setText("36.57");
  line(*dialog, "Longitude")->setText("128.29");
  ASSERT_TRUE(button(*dialog, "Open")->isEnabled());
  shoot(*dialog, "origin.png");
  button(*dialog, "Open")->click();
  ASSERT_TRUE(waitFor([this] { return opened() != nullptr; })) << said();
  EXPECT_FALSE(opened()->geocentric());
  EXPECT_NEAR(opened()->index().frame.origin().latitude.value(), 36.57, 1e-9);
  EXPECT_NEAR(opened()->index().frame.origin().longitude.value(), 128.29, 1e-9);

  ASSERT_TRUE(waitFor([this] { return w().findChild<workbench::OriginDialog*>() == nullptr; }));
  w().controllers().terrain->open(path);
  ASSERT_NE(dialog = asked(), nullptr);
  EXPECT_EQ(line(*dialog, "Longitude")->text(), "128.29") << "it is proposed again";
  button(*dialog, "Cancel")->click();
}

}  // namespace
}  // namespace trimtab::test
