// SPDX-License-Identifier: GPL-3.0-or-later
#include <QCheckBox>
#include <QDockWidget>
#include <QLabel>
#include <QSlider>

#include "gui_support.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/terrain/static_lod/static_lod.h"
#include "views/panels/static_lod_panel.h"

namespace trimtab::test {
namespace {

class StaticLodDock : public Bench {
 protected:
  views::StaticLodPanel& panel() { return *w().panels().staticLod; }
  bool says(const QString& text) { return labelSays(panel(), text); }
  QString legend() const { return window->viewport().overlayContents().legendTitle; }
};

TEST_F(StaticLodDock, tellsOfTreesAndDrawsThemByDistanceByLevelAndAsDocumentEsPicture) {
  TRIMTAB_NEEDS_SHARED("data/fg-cologne/3056410.btg");
  workbench::raiseDock(panel());
  EXPECT_TRUE(says(QStringLiteral(".btg.gz"))) << "the sample terrain has no trees";
  w().controllers().terrain->open(
      QString::fromStdString((sharedDir() / "data/fg-cologne/3056410.btg").string()));
  ASSERT_TRUE(waitFor([this] { return !says(QStringLiteral(".btg.gz")); }))
      << w().messages().text().toStdString();
  ASSERT_TRUE(waitFor([this] { return says(QStringLiteral("tiled levels are drawn")); }));
  EXPECT_TRUE(says(QStringLiteral("126,520")));

  ASSERT_TRUE(w().draft().setText("terrain.form", "static_trees").empty());
  ASSERT_TRUE(waitFor([this] { return last().staticLod.drawn; }));
  ASSERT_TRUE(waitFor([this] { return says(QStringLiteral("static trees are drawn")); }));

  auto* picture = panel().findChildren<QCheckBox*>().back();
  picture->setChecked(true);
  ASSERT_TRUE(waitFor([this] { return legend().contains(QStringLiteral("published picture")); }));
  for (QSlider* slider : panel().findChildren<QSlider*>())
    if (slider->accessibleName().startsWith(QStringLiteral("Level"))) slider->setValue(1);
  const auto only = [this](std::size_t depth) {
    for (std::size_t d = 0; d < StaticLodFrame::kDepths; ++d)
      if (d > depth && last().staticLod.nodes[d] > 0) return false;
    return last().staticLod.nodes[depth] > 0;
  };
  ASSERT_TRUE(waitFor([&] { return only(1); }));

  ASSERT_TRUE(w().draft().setText("terrain.form", "tiles").empty());
  ASSERT_TRUE(settle());
  EXPECT_TRUE(last().staticLod.drawn) << "the picture is of the trees whatever the preset draws";
  for (QCheckBox* box : panel().findChildren<QCheckBox*>()) box->setChecked(false);
  ASSERT_TRUE(waitFor([this] { return !last().staticLod.drawn; }));
}

}  // namespace
}  // namespace trimtab::test
