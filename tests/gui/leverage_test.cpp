// SPDX-License-Identifier: GPL-3.0-or-later
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QSpinBox>
#include <QTableWidget>
#include <algorithm>

#include "app/workbench/controllers/flight_controller.h"
#include "app/workbench/docks/leverage_page.h"
#include "gui_support.h"

namespace trimtab::test {
namespace {

class LeveragePage : public Bench {
 protected:
  workbench::LeveragePage& page() { return *w().panels().leverage; }
  /// Starts a small and short run along the sample flight.
  void run() {
    page().findChild<QLineEdit*>()->setText(QStringLiteral("64x48"));
    page().findChild<QSpinBox*>()->setValue(1);
    ended_ = good_ = false;
    QObject::connect(
        &page(), &workbench::LeveragePage::finished, &page(),
        [this](bool good) {
          ended_ = true;
          good_ = good;
        },
        Qt::SingleShotConnection);
    page().run();
  }
  bool ends() {
    EXPECT_TRUE(waitFor([this] { return ended_; }, 180000));
    return good_;
  }

 private:
  bool ended_ = false, good_ = false;
};

TEST_F(LeveragePage, showsWhatEachLeverIsWorthInTheFlightAndKeepsItWhenCancelled) {
  run();
  EXPECT_FALSE(page().running());
  EXPECT_TRUE(labelSays(page(), "Ctrl+L opens one")) << "it needs a flight";
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  run();
  ASSERT_TRUE(ends()) << w().messages().text().toStdString();
  ASSERT_TRUE(page().report());
  EXPECT_EQ(page().report()->measured.rows.size(), 7u);
  EXPECT_EQ(page().findChild<QTableWidget*>()->rowCount(), 7);
  EXPECT_EQ(page().findChild<QComboBox*>()->count(), 3) << "plots";
  run();
  ASSERT_TRUE(page().running());
  page().cancel();
  EXPECT_FALSE(ends());
  EXPECT_EQ(page().report()->measured.rows.size(), 7u);
}

}  // namespace
}  // namespace trimtab::test
