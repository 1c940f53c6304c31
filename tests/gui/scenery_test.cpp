// SPDX-License-Identifier: GPL-3.0-or-later
#include <QCheckBox>
#include <QDialog>
#include <QLineEdit>
#include <QPushButton>
#include <QTimer>

#include "app/workbench/dialogs/bake_dialog.h"
#include "gui_support.h"
#include "tests/core/terrain/scenery/scenery_tiles.h"

namespace trimtab::test {
namespace {

/// Made scenery whose list places one shared model, and the base package that has it.
class SceneryInTheWorkbench : public Bench {
 protected:
  SceneryInTheWorkbench() {
    const fs::path lists = scenery() / "Terrain/e000n50/e007n50";
    fs::create_directories(lists);
    fs::create_directories(base() / "Models/Power");
    writeFile(lists / "3072816.btg", gridTile({}));
    writeFile(lists / "3072816.stg",
              "OBJECT_BASE 3072816.btg\nOBJECT_SHARED Models/Power/mast.ac 7.1 50.55 130 30\n");
    writeFile(base() / "Models/Power/mast.ac",
              "AC3Db\nMATERIAL \"m\" rgb 1 0 0 amb 1 1 1 emis 0 0 0 spec 0 0 0 shi 0 trans 0\nOBJECT world\n"
              "kids 1\nOBJECT poly\nnumvert 3\n-9 0 0\n9 0 0\n0 90 0\nnumsurf 1\nSURF 0x20\nmat 0\nrefs 3\n"
              "0 0 0\n1 0 0\n2 0 0\nkids 0\n");
    writeFile(dir_ / "grid.asc", "");
  }
  fs::path scenery() const { return dir_ / "fg"; }
  fs::path base() const { return dir_ / "base"; }
  std::string said() { return w().messages().text().toStdString(); }

  /// Opens the dialog by the command and has it filled in by `fill`, which presses its button.
  void bake(const std::function<void(workbench::BakeDialog&)>& fill) {
    bool filled = false;
    QTimer::singleShot(0, &w(), [&] {
      auto* const dialog = w().findChild<workbench::BakeDialog*>();
      ASSERT_NE(dialog, nullptr);
      fill(*dialog);
      filled = true;
      if (dialog->isVisible()) dialog->reject();  // where nothing was accepted, the test fails and goes on
    });
    trigger("Bake");
    ASSERT_TRUE(filled);
    ASSERT_TRUE(waitFor([&] { return !w().controllers().terrain->job().running(); })) << said();
  }
  static QLineEdit* line(QDialog& dialog, const char* name) {
    for (QLineEdit* each : dialog.findChildren<QLineEdit*>())
      if (each->accessibleName() == QLatin1String(name)) return each;
    return nullptr;
  }
  static QCheckBox* placing(QDialog& dialog) {
    for (QCheckBox* each : dialog.findChildren<QCheckBox*>())
      if (each->text().contains(QLatin1String("stands on the ground"))) return each;
    return nullptr;
  }
  static QPushButton* baking(QDialog& dialog) {
    for (QPushButton* each : dialog.findChildren<QPushButton*>())
      if (each->text() == QLatin1String("&Bake")) return each;
    return nullptr;
  }
  std::uint64_t objects() { return w().viewport().lastResult() ? last().objects.all() : 0; }

  ScratchDir dir_;
};

TEST_F(SceneryInTheWorkbench, isBakedWithTheModelsOfTheFolderThatTheDialogNames) {
  ASSERT_NO_FATAL_FAILURE(bake([&](workbench::BakeDialog& dialog) {
    QLineEdit* const models = line(dialog, "Shared models");
    QCheckBox* const place = placing(dialog);
    ASSERT_NE(models, nullptr);
    ASSERT_NE(place, nullptr);
    dialog.addSources({QString::fromStdString((dir_ / "grid.asc").string())});
    EXPECT_FALSE(models->isVisible()) << "elevation brings no objects";
    EXPECT_FALSE(place->isVisible());
    dialog.addSources({QString::fromStdString(scenery().string())});
    EXPECT_TRUE(models->isVisible());
    EXPECT_TRUE(place->isChecked() && place->isVisible());
    auto* const list = dialog.findChild<QListWidget*>();
    list->item(0)->setSelected(true);
    for (QPushButton* each : dialog.findChildren<QPushButton*>())
      if (each->text() == QLatin1String("&Remove")) each->click();
    EXPECT_EQ(list->count(), 1);
    models->setText(QString::fromStdString((scenery() / "Terrain").string()));
    EXPECT_FALSE(baking(dialog)->isEnabled()) << "it has no Models";
    models->setText(QString::fromStdString(base().string()));
    ASSERT_TRUE(baking(dialog)->isEnabled());
    if (const char* shots = std::getenv("TRIMTAB_SHOTS")) {
      QTest::qWait(100);
      EXPECT_TRUE(onDisplay(dialog).save(QString::fromLocal8Bit(shots) + "/bake-scenery.png"));
    }
    baking(dialog)->click();
  }));
  EXPECT_NE(said().find("1 by 1 models"), std::string::npos) << said();
  EXPECT_TRUE(waitFor([this] { return objects() == 1; })) << said();
}

TEST_F(SceneryInTheWorkbench, isBakedBareWhereTheBoxIsNotChecked) {
  ASSERT_NO_FATAL_FAILURE(bake([&](workbench::BakeDialog& dialog) {
    dialog.addSources({QString::fromStdString(scenery().string())});
    line(dialog, "Shared models")->setText(QString::fromStdString(base().string()));
    placing(dialog)->click();
    EXPECT_FALSE(line(dialog, "Shared models")->isEnabled());
    baking(dialog)->click();
  }));
  EXPECT_EQ(said().find("1 by 1 models"), std::string::npos) << said();
  EXPECT_NE(said().find("Terrain fg"), std::string::npos) << said();
  ASSERT_TRUE(settle());
  EXPECT_EQ(objects(), 0u);
}

}  // namespace
}  // namespace trimtab::test
