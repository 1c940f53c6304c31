// SPDX-License-Identifier: GPL-3.0-or-later
#include <QComboBox>
#include <QGroupBox>
#include <QLabel>
#include <QLineEdit>
#include <QMessageBox>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QRadioButton>
#include <QSettings>
#include <QTableWidget>

#include "app/workbench/controllers/saved_session.h"
#include "app/workbench/dialogs/column_dialog.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/window/session_keeper.h"
#include "gui_support.h"
#include "hand.h"
#include "trimtab/host/flight.h"
#include "views/panels/motion_panel.h"

namespace trimtab::test {
namespace {

using workbench::ColumnDialog;

/// Rows over the sample terrain whose altitude and time name no unit.
std::string ambiguousFlight() {
  std::string text = "t,Lat,Lon,Alt MSL,Theta_deg,Bank_deg,Psi_deg\n";
  for (int row = 0; row < 8; ++row)
    text += std::to_string(20 * row) + ",46.5,8.25," + (row < 7 ? "1500" : "1500.5") + ",2,-1,90\n";
  return text;
}

class Columns : public Bench {
 protected:
  void SetUp() override {
    QSettings().remove(QStringLiteral("columns"));
    Bench::SetUp();
    hand_.emplace(w());
    hand_->workIn({QStringLiteral("columns"), QStringLiteral("badRows")});
  }
  ColumnDialog* shown() {
    for (auto* dialog : w().findChildren<ColumnDialog*>())
      if (dialog->isVisible()) return dialog;
    return nullptr;
  }
  ColumnDialog& dialog() {
    EXPECT_TRUE(waitFor([this] { return shown() != nullptr; }, 10000)) << "no dialog opens";
    return *shown();
  }
  QPushButton& button(const QString& text) {
    for (auto* each : shown()->findChildren<QPushButton*>())
      if (plain(each->text()) == text) return *each;
    ADD_FAILURE() << text.toStdString();
    return *shown()->findChild<QPushButton*>();
  }
  template <class Widget>
  Widget& named(const QString& name) {
    for (auto* each : shown()->template findChildren<Widget*>())
      if (each->accessibleName() == name) return *each;
    ADD_FAILURE() << name.toStdString();
    return *shown()->template findChild<Widget*>();
  }
  QString reading() {
    shown()->readNow();
    return named<QLabel>("What is read").text();
  }
  QString says() {
    shown()->readNow();
    return named<QPlainTextEdit>("What the reader says").toPlainText();
  }
  QStringList choices() {
    QStringList texts;
    for (auto* each : shown()->findChildren<QRadioButton*>())
      if (each->isVisible()) texts << each->text();
    return texts;
  }
  void pressOpen() {
    shown()->readNow();
    hand_->press(dialog(), "Open");
    EXPECT_TRUE(waitFor([this] { return shown() == nullptr; }, 10000)) << says().toStdString();
  }
  void shoot(const char* name) {
    const QString folder = qEnvironmentVariable("TRIMTAB_SHOTS");
    if (folder.isEmpty()) return;
    QTest::qWait(300);
    shown()->grab().save(QStringLiteral("%1/%2.png").arg(folder, QLatin1String(name)));
    onDisplay(w()).save(QStringLiteral("%1/%2-window.png").arg(folder, QLatin1String(name)));
  }
  const Flight& flight() { return w().feed().playback().flight(); }
  std::string fileOf(const std::string& name, const std::string& text) {
    writeFile(dir_ / name, text);
    return (dir_ / name).string();
  }
  std::optional<Hand> hand_;
  const ScratchDir dir_;
};

TEST_F(Columns, areAskedForWhereTwoReadingsFitAndAreRemembered) {
  w().resize(1280, 720);
  drop(fileOf("ask.csv", ambiguousFlight()));
  ASSERT_NE(&dialog(), nullptr);
  EXPECT_FALSE(button("Open").isEnabled());
  EXPECT_EQ(named<QTableWidget>("The first rows of the file").item(7, 3)->text(), "1500.5");
  EXPECT_EQ(choices(), (QStringList{"Altitude above sea level = \"Alt MSL\" in ft",
                                    "Altitude above sea level = \"Alt MSL\" in m"}));
  hand_->press(dialog(), choices()[1]);
  shown()->readNow();
  ASSERT_EQ(choices().size(), 4) << "what is ambiguous behind it comes up: " << says().toStdString();
  shoot("columns-choices");
  EXPECT_FALSE(button("Open").isEnabled());
  hand_->press(dialog(), "Time = t in ms");
  EXPECT_TRUE(reading().startsWith("8 rows over 0.14 s: latitude 46.5 to 46.5°")) << reading().toStdString();
  EXPECT_TRUE(reading().contains("altitude 4,921 to 4,923 ft")) << reading().toStdString();
  hand_->press(dialog(), "Time = t in s");
  EXPECT_TRUE(reading().startsWith("8 rows over 140 s")) << reading().toStdString();
  shoot("columns-read");
  pressOpen();
  ASSERT_EQ(flight().states.size(), 8U);
  EXPECT_NEAR(flight().states[7].position.height.value(), 1500.5, 1e-6);
  EXPECT_EQ(flight().durationS(), 140);

  w().panels().flight->close();
  drop(fileOf("again.csv", ambiguousFlight()));
  EXPECT_EQ(flight().states.size(), 8U) << "the header says what was chosen";
  EXPECT_EQ(shown(), nullptr);
  EXPECT_TRUE(w().messages().text().contains("again.csv is read with the columns that were chosen"));

  hand_->press(*w().panels().flight, "Columns");
  EXPECT_EQ(named<QComboBox>("Unit of Time").currentText(), "s");
  hand_->press(dialog(), "As found");
  shown()->readNow();
  EXPECT_FALSE(button("Open").isEnabled()) << "nothing is chosen";
  hand_->press(dialog(), "Cancel");
}

TEST_F(Columns, ofAFileWithoutAHeaderAreChosenByNumberAndNeverRemembered) {
  std::string text;
  for (int row = 0; row < 6; ++row)
    text += std::to_string(46.4 + 0.001 * row) + ';' + std::to_string(8.2) + ';' +
            std::to_string(3000 + 10 * row) + '\n';
  const std::string file = fileOf("bare.csv", text);
  ASSERT_FALSE(w().controllers().flight->open(QString::fromStdString(file)));
  hand_->choose(dialog(), "Column of Latitude", "#1");
  hand_->choose(dialog(), "Column of Longitude", "#2");
  hand_->choose(dialog(), "Column of Altitude above sea level", "#3");
  EXPECT_TRUE(says().contains("Altitude above sea level: expected a unit")) << says().toStdString();
  EXPECT_FALSE(button("Open").isEnabled());
  hand_->choose(dialog(), "Unit of Altitude above sea level", "ft");
  auto& offset = named<QLineEdit>("Offset of Altitude above sea level");
  offset.setFocus();
  offset.selectAll();
  hand_->type("x");
  EXPECT_TRUE(says().contains("an offset that is a number")) << says().toStdString();
  offset.selectAll();
  hand_->type("-100");
  EXPECT_TRUE(reading().contains("altitude 2,900 to 2,950 ft")) << reading().toStdString();
  EXPECT_TRUE(reading().contains("6 rows over 0.5 s")) << "rows are 0.1 s apart";
  pressOpen();
  ASSERT_EQ(flight().states.size(), 6U);
  EXPECT_NEAR(flight().states[5].position.height.in<Feet>(), 2950, 1e-6);

  // The session says it, since nothing else does.
  const QString session = QString::fromStdString((dir_ / "s.session.json").string());
  ASSERT_TRUE(w().sessions().saveTo(session));
  EXPECT_EQ(workbench::readSession(session)->flightColumns,
            "altitude_ft=#3-100,latitude_deg=#1,longitude_deg=#2");
  w().panels().flight->close();
  ASSERT_TRUE(w().sessions().open(session)) << w().messages().text().toStdString();
  EXPECT_EQ(flight().states.size(), 6U);
  // A measurement, which knows of no map, is given what was read.
  const auto inputs = w().controllers().inputs->write(QString::fromStdString(dir_.path().string()));
  ASSERT_TRUE(inputs);
  const auto measured = readFlight(inputs->flight.toStdString());
  ASSERT_TRUE(measured) << toString(measured.findings());
  EXPECT_NEAR(measured->states[5].position.height.in<Feet>(), 2950, 1e-6);

  w().panels().flight->close();
  ASSERT_FALSE(w().controllers().flight->open(QString::fromStdString(file))) << "it has no header";
  EXPECT_TRUE(choices().isEmpty());
  dialog().close();
}

TEST_F(Columns, ofAHeadLogAreAskedForToo) {
  std::string text = "stamp_ms,yaw,pitch\n";
  for (int row = 0; row < 9; ++row)
    text += std::to_string(16 * row) + ',' + std::to_string(0.5 + 0.01 * row) + ",0.6\n";
  drop(fileOf("head.csv", text));
  EXPECT_TRUE(says().contains("time")) << says().toStdString();
  EXPECT_TRUE(choices().isEmpty()) << "there is no time yet";
  hand_->choose(dialog(), "Column of Time", "stamp_ms");
  EXPECT_EQ(named<QComboBox>("Unit of Time").currentText(), "ms") << "as the name of the column says";
  shown()->readNow();
  ASSERT_EQ(choices().size(), 3) << says().toStdString();
  hand_->press(dialog(), choices()[2]);
  EXPECT_TRUE(reading().contains("9 rows over 0.128 s: heading 0 to 28.8°, pitch 18 to 18°"))
      << reading().toStdString();
  EXPECT_EQ(named<QLineEdit>("Offset of Heading, to the right").text(), "-180");
  pressOpen();
  EXPECT_EQ(session().head().source(), workbench::Feed::Head::log);
  EXPECT_NEAR(session().head().log().samples.back().headingDeg, 28.8, 1e-9);
  // The person thinks again: the button of the panel leads back, to what was chosen.
  workbench::raiseDock(*w().panels().motion);
  hand_->press(*w().panels().motion, "Columns");
  EXPECT_EQ(named<QLineEdit>("Scale of Heading, to the right").text(), "360");
  hand_->press(dialog(), "As found");
  hand_->choose(dialog(), "Column of Time", "stamp_ms");
  shown()->readNow();
  ASSERT_EQ(choices().size(), 3) << says().toStdString();
  hand_->press(dialog(), choices()[0]);
  pressOpen();
  EXPECT_NEAR(session().head().log().samples.back().headingDeg, 0.58, 1e-9);
}

TEST_F(Columns, thatOpenAllButSomeRowsLeadToTheQuestionAboutThem) {
  std::string text = "when_ms,yaw_deg,pitch_deg\n";
  for (int row = 0; row < 9; ++row) text += std::to_string(16 * row) + (row == 4 ? ",x,6\n" : ",5,6\n");
  drop(fileOf("rows.csv", text));
  hand_->choose(dialog(), "Column of Time", "when_ms");
  EXPECT_TRUE(reading().startsWith("8 rows")) << reading().toStdString();
  pressOpen();
  auto* const box = w().findChild<QMessageBox*>(QStringLiteral("badRows"));
  ASSERT_NE(box, nullptr);
  hand_->press(*box, "Leave 1 row out");
  EXPECT_EQ(session().head().log().samples.size(), 8U);
}

TEST_F(Columns, stayAskedForIfTheFileIsRefusedBehindItsBeginning) {
  std::string text = "time_s,Lat,Lon,Alt\n";
  for (int row = 0; text.size() < kLogBeginning + 1000; ++row)
    text += std::to_string(row) + ",46.5,8.25,2000\n";
  drop(fileOf("long.csv", text + "5,46.5,8.25,broken\n"));
  hand_->press(dialog(), choices()[0]);
  EXPECT_TRUE(reading().startsWith("The first part of the file: ")) << reading().toStdString();
  hand_->press(dialog(), "Open");
  ASSERT_NE(shown(), nullptr);
  EXPECT_TRUE(named<QPlainTextEdit>("What the reader says").toPlainText().contains("broken"));
  EXPECT_FALSE(w().feed().playback().loaded());
  EXPECT_TRUE(QSettings().childGroups().filter("columns").isEmpty()) << "it is not remembered";
  hand_->press(dialog(), "Cancel");
}

TEST_F(Columns, areNotAskedForWhereThereAreNone) {
  drop(fileOf("t.gpx",
              "<gpx><trk><trkseg><trkpt lat='46.5' lon='8.25'><ele>3000</ele>"
              "<time>2022-02-03T04:05:06Z</time></trkpt><trkpt lat='46.51' lon='8.25'><ele>3000</ele>"
              "<time>2022-02-03T04:05:16Z</time></trkpt></trkseg></trk></gpx>"));
  ASSERT_EQ(flight().states.size(), 2U) << w().messages().text().toStdString();
  hand_->press(*w().panels().flight, "Columns");
  EXPECT_EQ(shown(), nullptr);
  EXPECT_TRUE(w().messages().text().contains("t.gpx has no columns to choose"));
}

TEST_F(Columns, thatWereFoundAreChangedByTheirUnitAlone) {
  drop(fileOf("deg.csv",
              "time_s,Lat,Lon,altitude_ft,pitch,roll,heading_deg\n0,46.5,8.25,3000,10,20,90\n"
              "1,46.5,8.26,3000,10,20,90\n2,46.5,8.27,3000,10,20,90\n"));
  ASSERT_EQ(flight().states.size(), 3U);
  EXPECT_EQ(flight().states[0].attitude.pitch.value(), 10);
  hand_->press(*w().panels().flight, "Columns");
  auto& scale = named<QLineEdit>("Scale of Pitch");
  scale.setFocus();
  scale.selectAll();
  hand_->type("-0.5");
  EXPECT_EQ(named<QComboBox>("Column of Pitch").currentText(), "pitch") << "the column that was found";
  EXPECT_TRUE(reading().contains("pitch -5 to -5°")) << reading().toStdString() << says().toStdString();
  pressOpen();
  EXPECT_EQ(flight().states[0].attitude.pitch.value(), -5);
}

TEST_F(Columns, ofAKnownProgramKeepTheirScaleWhenAnotherNumberChanges) {
  drop(fileOf("jsb.csv",
              "Time,Altitude ASL (ft),Altitude AGL (ft),Phi (deg),Theta (deg),Psi (deg),Latitude (deg),"
              "Longitude (deg)\n0.5,6000,1000,4,-2.5,271,46.5,8.25\n0.7,6002,1000,4,-2.5,271,46.5,8.25\n"));
  ASSERT_EQ(flight().states.size(), 2U) << w().messages().text().toStdString();
  hand_->press(*w().panels().flight, "Columns");
  EXPECT_EQ(named<QLineEdit>("Scale of Height above ground").text(), "0.3048");
  auto& offset = named<QLineEdit>("Offset of Height above ground");
  offset.setFocus();
  offset.selectAll();
  hand_->type("30.48");
  EXPECT_TRUE(reading().contains("above ground 1,100 to 1,100 ft")) << reading().toStdString();
  hand_->press(dialog(), "Cancel");
}

}  // namespace
}  // namespace trimtab::test
