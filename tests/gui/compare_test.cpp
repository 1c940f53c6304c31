// SPDX-License-Identifier: GPL-3.0-or-later
#include <QDockWidget>
#include <QLabel>
#include <QRegularExpression>
#include <QScrollBar>
#include <QTableWidget>
#include <fstream>

#include "app/workbench/viewport/split_picture.h"
#include "app/workbench/viewport/split_view.h"
#include "app/workbench/window/workspaces.h"
#include "error_dock.h"
#include "trimtab/preset/preset.h"

namespace trimtab::test {
namespace {

using workbench::SplitView;

class SplitViewTest : public ErrorDock {
 protected:
  void SetUp() override {
    ErrorDock::SetUp();
    if (HasFatalFailure()) return;
    w().controllers().errors->compare();
    ASSERT_TRUE(waitFor([&] { return view().comparisons() > 0; }, 120000))
        << w().messages().text().toStdString();
  }
  SplitView& view() { return w().controllers().errors->splitView(); }
  bool compared(std::uint64_t more = 1) {
    const std::uint64_t before = view().comparisons();
    return waitFor([&] { return view().comparisons() >= before + more; }, 120000);
  }
  /// Waits until both sides show the presets that were chosen last.
  void choose(const QString& left, const QString& right) {
    ASSERT_TRUE(view().choose(SplitView::left, left));
    ASSERT_TRUE(view().choose(SplitView::right, right));
    ASSERT_TRUE(waitFor([&] { return view().upToDate(); }, 120000));
  }
  /// Whether no comparison begins within so many milliseconds.
  bool rests(int ms) {
    const std::uint64_t before = view().comparisons();
    return !waitFor([&] { return view().busy() || view().comparisons() > before; }, ms);
  }
  QString leftName() { return view().numbers().verticalHeaderItem(0)->text(); }
  QImage black() const {
    QImage image = window->controllers().errors->splitView().heatMap().map();
    image.fill(Qt::black);
    return image;
  }
};

TEST_F(SplitViewTest, theComparisonLiesOverTheImageOnTheDisplay) {
  auto* const overlay = w().findChild<QWidget*>("split_overlay");
  ASSERT_NE(overlay, nullptr);
  ASSERT_TRUE(overlay->isVisible());
  choose(SplitView::kDraft, "default");
  const auto seen = [&] {
    return onDisplay(*overlay) == overlay->grab().toImage().convertToFormat(QImage::Format_RGB32);
  };
  EXPECT_TRUE(waitFor(seen, 5000));
  w().viewport().invalidate();
  ASSERT_TRUE(settle());
  EXPECT_TRUE(seen()) << "the next image does not cover it";
  view().setOverViewport(false);
  EXPECT_TRUE(waitFor([&] { return !seen(); }, 5000)) << "the image of the viewport is back";
}

TEST_F(SplitViewTest, whileImagesAreOldTheLiveViewIsOnTheDisplay) {
  auto* const overlay = w().findChild<workbench::SplitPicture*>("split_overlay");
  ASSERT_NE(overlay, nullptr);
  choose(SplitView::kDraft, "default");
  const auto left = [](const QImage& image) {
    return image.copy(0, 0, image.width() / 2, image.height() / 2).convertToFormat(QImage::Format_RGB32);
  };
  const QImage live = left(w().viewport().grabFramebuffer());
  EXPECT_TRUE(waitFor([&] { return left(onDisplay(w().viewport())) != live; }, 5000))
      << "the comparison has a name at its corner";
  overlay->setOld(true, "comparing");
  ASSERT_TRUE(settle());
  EXPECT_TRUE(waitFor([&] { return left(onDisplay(w().viewport())) == live; }, 5000));
  EXPECT_TRUE(overlay->isVisible()) << "its text is still there";
}

TEST_F(SplitViewTest, equalPresetsHaveABlackMapAndOthersShowWhereTheyDiffer) {
  const ScratchDir dir;
  TuningParameters coarse = w().draft().parameters();
  Preset preset;
  preset.name = "coarse";
  preset.parameters = coarse;
  preset.parameters.lod.screenSpaceError = Pixels{64};
  const Result<std::string> text = presetText(preset);
  ASSERT_TRUE(text);
  std::ofstream(dir / "coarse.json") << *text;
  const QString file = QString::fromStdString((dir / "coarse.json").string());

  choose(SplitView::kDraft, "default");
  EXPECT_EQ(view().heatMap().largest(), 0);
  EXPECT_EQ(view().heatMap().map(), black());
  EXPECT_FALSE(view().heatMap().map().isNull());
  EXPECT_EQ(view().pictures().picture(0), view().pictures().picture(1));

  choose(SplitView::kDraft, file);
  EXPECT_GT(view().heatMap().largest(), 0.05);
  EXPECT_NE(view().heatMap().map(), black());
  EXPECT_NE(view().pictures().picture(0), view().pictures().picture(1));
  const auto number = [&](int row, int column) {
    return QLocale().toDouble(view().numbers().item(row, column)->text());
  };
  EXPECT_GT(number(1, 0), number(0, 0)) << "FLIP against the reference";
  EXPECT_LT(number(1, 5), number(0, 5)) << "triangles";
  EXPECT_GT(number(0, 6), 0) << "ms";
  // Not a ratio of two single times, of which the first one read pages: an interval of pairs drawn in turns.
  const QString ratio = view().numbers().item(2, 6)->text();
  EXPECT_TRUE(
      ratio.contains(QRegularExpression("^(no difference|.* (faster|slower|times as long))\n× .* to ")))
      << ratio.toStdString();

  choose(SplitView::kReference, SplitView::kReference);
  EXPECT_EQ(view().heatMap().map(), black());
}

TEST_F(SplitViewTest, rulesKnowWhatTheImagesOfTheirOwnPresetDraw) {
  const ScratchDir dir;
  const auto fileOf = [&](const char* name, const char* rule) {
    Preset preset;
    preset.name = name;
    preset.parameters = w().draft().parameters();
    preset.parameters.policy.enabled = true;
    preset.parameters.policy.terms.line = {"triangles some = ramp 0 1", "load some = ramp 0 0.001"};
    preset.parameters.policy.rules.line = {rule};
    std::ofstream(dir / (std::string(name) + ".json")) << *presetText(preset);
    return QString::fromStdString((dir / (std::string(name) + ".json")).string());
  };
  const QString counts = fileOf("counts", "if triangles is some then screen_space_error = 64"),
                loads = fileOf("loads", "if load is some then screen_space_error = 64");
  const auto triangles = [&](int row) {
    return QLocale().toULongLong(view().numbers().item(row, 5)->text());
  };
  choose("default", counts);
  EXPECT_LT(triangles(1), triangles(0));
  // Its time is known once the view rests.
  choose("default", loads);
  EXPECT_TRUE(waitFor([&] { return view().upToDate() && triangles(1) < triangles(0); }, 20000))
      << triangles(0) << " and " << triangles(1);
}

TEST_F(SplitViewTest, followsTheFrameAndRestsWhenHiddenOrNothingMoves) {
  ASSERT_TRUE(settle());
  ASSERT_TRUE(waitFor([&] { return view().upToDate(); }, 120000));
  w().viewport().invalidate();  // painted again, the same image
  EXPECT_TRUE(rests(1500)) << "nothing moves";
  const QImage before = view().pictures().picture(0);
  look(-20);
  ASSERT_TRUE(compared());
  ASSERT_TRUE(waitFor([&] { return view().pictures().picture(0) != before; }));

  QObject here;
  bool seen = true;
  QObject::connect(w().dock("errors"), &QDockWidget::visibilityChanged, &here, [&](bool is) { seen = is; });
  view().setOverViewport(false);
  w().dock("plots")->raise();
  // One comparison may have been under way.
  ASSERT_TRUE(waitFor([&] { return !seen && !view().busy(); }, 120000));
  const std::uint64_t painted = paints();
  look(-10);
  ASSERT_TRUE(waitFor([&] { return paints() > painted; }));
  EXPECT_TRUE(rests(1500)) << "nobody looks";
}

TEST_F(SplitViewTest, whatWasMeasuredOfAnOldChoiceIsNotShownAsTheNew) {
  ASSERT_TRUE(settle());
  choose("default", SplitView::kReference);
  // A machine may compare so fast that nobody sees it at work. Then it is asked again.
  QString asked = "default";
  ASSERT_TRUE(waitFor(
      [&] {
        if (view().busy()) return true;
        if (!view().upToDate()) return false;
        asked = asked == "default" ? "as-printed" : "default";
        EXPECT_TRUE(view().choose(SplitView::left, asked));
        return false;
      },
      120000));
  const QString shown = leftName();
  ASSERT_TRUE(view().choose(SplitView::left, "as-published"));
  EXPECT_EQ(leftName(), shown) << "that is still what is shown";
  QObject here;
  QString next;
  QObject::connect(&view(), &SplitView::compared, &here, [&] {
    if (next.isEmpty()) next = leftName();
  });
  ASSERT_TRUE(waitFor([&] { return !next.isEmpty(); }, 120000));
  EXPECT_EQ(next, "Left: as-published");
  ASSERT_TRUE(waitFor([&] { return view().upToDate(); }, 120000));
  EXPECT_EQ(leftName(), "Left: as-published");
}

TEST_F(ErrorDock, theSplitViewSaysWhatIsMissingWhereNothingCanBeDrawn) {
  workbench::DrawThread thread;
  QWidget viewport;
  SplitView view(
      thread, w().draft(), [] { return std::nullopt; }, viewport);
  EXPECT_TRUE(view.status().text().contains("Open a terrain"));
  emit thread.failed({{Severity::error, "EGL", "", "a surfaceless or device display", "none"}});
  EXPECT_TRUE(view.status().text().contains("surfaceless or device display"))
      << view.status().text().toStdString();
  EXPECT_FALSE(view.busy());
}

TEST_F(SplitViewTest, staysInTheWindowAndSaysWhatItWaitsFor) {
  EXPECT_TRUE(w().dock("errors")->isAncestorOf(&view())) << "another window would be buried by a click";
  EXPECT_FALSE(view().isWindow());
  EXPECT_FALSE(view().status().text().contains("Open a terrain")) << view().status().text().toStdString();
}

TEST_F(SplitViewTest, aViewAtRestIsComparedAtItsFullSizeHoweverLongThatTakes) {
  view().setLongestMs(0);
  QObject here;
  int whole = 0;
  bool smaller = false;
  QObject::connect(&view(), &SplitView::compared, &here,
                   [&] { smaller = smaller || view().pictures().picture(0).width() < whole; });
  ASSERT_TRUE(w().draft().setText("view.render_size", "fixed").empty());
  // A fast machine compares small images in no time and makes none smaller: they grow until it does.
  for (const char* side : {"1024", "2048", "4096"}) {
    for (const char* key : {"view.width_px", "view.height_px"})
      ASSERT_TRUE(w().draft().setText(key, side).empty());
    const QSize size(QString(side).toInt(), QString(side).toInt());
    const auto shows = [&] { return view().upToDate() && view().pictures().picture(0).size() == size; };
    ASSERT_TRUE(waitFor(shows, 120000)) << side;
    whole = size.width();
    const std::uint64_t before = view().comparisons();
    look(-14 - size.width() / 1024.0);
    ASSERT_TRUE(waitFor([&] { return view().comparisons() > before && view().upToDate(); }, 120000)) << side;
    EXPECT_EQ(view().pictures().picture(0).size(), size);
    EXPECT_FALSE(view().overlay().old());
    if (smaller) return;
  }
  GTEST_SKIP() << "this machine compares images of 4096 x 4096 px as fast as any";
}

TEST_F(SplitViewTest, symbolsHideNoDifferenceUnlessAPersonWantsThem) {
  const ScratchDir dir;
  Preset preset;
  preset.name = "symbols";
  preset.parameters = w().draft().parameters();
  preset.parameters.symbology.enabled = !preset.parameters.symbology.enabled;
  const Result<std::string> text = presetText(preset);
  ASSERT_TRUE(text);
  std::ofstream(dir / "symbols.json") << *text;
  choose(SplitView::kDraft, QString::fromStdString((dir / "symbols.json").string()));
  EXPECT_EQ(view().heatMap().largest(), 0);
  view().setSymbols(true);
  ASSERT_TRUE(waitFor([&] { return view().upToDate(); }, 120000));
  EXPECT_GT(view().heatMap().largest(), 0.1);
}

TEST_F(SplitViewTest, overTheViewportTheDividerMovesAndTheViewBelowStillTurns) {
  workbench::SplitPicture& over = view().overlay();
  ASSERT_TRUE(waitFor([&] { return view().upToDate(); }, 120000));
  ASSERT_TRUE(over.isVisible());
  EXPECT_EQ(over.size(), w().viewport().size());
  const QPoint middle = over.rect().center();
  QTest::mousePress(&over, Qt::LeftButton, Qt::NoModifier, middle);
  QTest::mouseMove(&over, middle + QPoint(over.width() / 4, 0));
  QTest::mouseRelease(&over, Qt::LeftButton, Qt::NoModifier, middle + QPoint(over.width() / 4, 0));
  EXPECT_NEAR(over.divider(), 0.75, 0.02);

  EXPECT_TRUE(over.valuesAt(middle).contains("pixel ")) << over.valuesAt(middle).toStdString();
  EXPECT_TRUE(over.valuesAt(middle).contains("FLIP"));
  view().flicker();
  EXPECT_EQ(over.form(), workbench::SplitPicture::Form::left);
  view().flicker();
  EXPECT_EQ(over.form(), workbench::SplitPicture::Form::right);
  view().toggleDifference();
  EXPECT_EQ(over.form(), workbench::SplitPicture::Form::difference);

  const double heading = w().viewport().camera().attitude().heading.value();
  const QPoint from(over.width() / 4, over.height() / 4);
  const std::uint64_t compared = view().comparisons();
  QTest::mousePress(&over, Qt::LeftButton, Qt::NoModifier, from);
  QTest::mouseMove(&over, from + QPoint(60, 0));
  QTest::mouseRelease(&over, Qt::LeftButton, Qt::NoModifier, from + QPoint(60, 0));
  EXPECT_NE(w().viewport().camera().attitude().heading.value(), heading);
  EXPECT_TRUE(waitFor([&] { return over.old() || view().comparisons() > compared; }))
      << "images of another view would hide the live one";
  view().setOverViewport(false);
  EXPECT_FALSE(over.isVisible());
}

TEST_F(SplitViewTest, whenItEndsTheDocksAreAsTheyWereBefore) {
  workbench::ErrorsController& errors = *w().controllers().errors;
  errors.endComparison();
  w().workspaces().show(1);
  w().workspaces().reset();
  w().dock("decision")->raise();
  ASSERT_TRUE(comesToFront("decision"));
  ASSERT_TRUE(w().dock("errors")->isHidden());
  trigger("In the viewport");
  ASSERT_TRUE(comesToFront(view()));
  EXPECT_TRUE(view().overViewport());
  trigger("In the viewport");
  EXPECT_TRUE(comesToFront("decision"));
  EXPECT_TRUE(w().dock("errors")->isHidden());
  w().workspaces().show(2);
  w().workspaces().reset();
  ASSERT_TRUE(comesToFront("errors"));
  trigger("In the viewport");
  ASSERT_TRUE(comesToFront(view()));
  trigger("In the viewport");
  EXPECT_TRUE(comesToFront(errors.dock())) << "the page that was there before";
  EXPECT_FALSE(w().dock("errors")->isHidden()) << "it is one of this workspace's docks";
}

TEST_F(SplitViewTest, fitsIntoTheFootOfTheSmallestWindow) {
  view().setOverViewport(false);
  w().resize(1280, 720);
  w().workspaces().show(1);
  w().workspaces().reset();
  trigger("In the viewport");
  ASSERT_TRUE(comesToFront(view()));
  ASSERT_TRUE(waitFor([&] { return view().upToDate(); }, 120000));
  QTest::qWait(200);
  for (const auto* bar : view().findChildren<QScrollBar*>()) {
    const bool sideways = bar->orientation() == Qt::Horizontal && bar->isVisible();
    EXPECT_FALSE(sideways) << "scrolls by " << bar->maximum() << " px";
  }
}

TEST_F(SplitViewTest, theDividerMovesByHandAndKeys) {
  view().setOverViewport(false);
  workbench::SplitPicture& pictures = view().pictures();
  pictures.setFocus();
  QTest::keyClick(&pictures, Qt::Key_Right);
  EXPECT_NEAR(pictures.divider(), 0.51, 1e-9);
  QTest::keyClick(&pictures, Qt::Key_Home);
  EXPECT_EQ(pictures.divider(), 0);
  const QPoint middle = pictures.rect().center();
  QTest::mousePress(&pictures, Qt::LeftButton, Qt::NoModifier, middle);
  QTest::mouseRelease(&pictures, Qt::LeftButton, Qt::NoModifier, middle);
  EXPECT_NEAR(pictures.divider(), 0.5, 0.02);
  EXPECT_FALSE(view().choose(SplitView::left, "/nowhere/preset.json"));
  EXPECT_TRUE(w().messages().text().contains("cannot be compared"));
}

}  // namespace
}  // namespace trimtab::test
