// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <QAction>
#include <QDir>
#include <QMessageBox>
#include <QPushButton>
#include <QStandardPaths>

#include "app/workbench/controllers/recent_files.h"
#include "app/workbench/dialogs/export_target.h"
#include "app/workbench/dialogs/notice_bar.h"
#include "gui_support.h"
#include "hand.h"
#include "trimtab/terrain/synthetic/sample.h"

namespace trimtab::test {
namespace {

constexpr auto kHysteresis = "fuzzy.hysteresis";

QString path(const std::filesystem::path& file) {
  return QString::fromStdString(file.string());
}

/// Presses a button of the next modal question.
void answer(QMessageBox::StandardButton button) {
  auto* timer = new QTimer(qApp);
  QObject::connect(timer, &QTimer::timeout, qApp, [timer, button] {
    auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
    if (box == nullptr) return;
    timer->deleteLater();
    QTest::mouseClick(box->button(button), Qt::LeftButton);
  });
  timer->start(20);
}

QPushButton* noticeButton(workbench::MainWindow& window, const QString& text) {
  for (QPushButton* button : window.notices().findChildren<QPushButton*>())
    if (button->isVisible() && button->text().remove('&').startsWith(text)) return button;
  return nullptr;
}

class WorkbenchFiles : public Bench {
 protected:
  void edit() { ASSERT_TRUE(w().draft().setText(kHysteresis, "0.04").empty()); }
  double hysteresis() { return w().draft().parameters().scheme.hysteresis.value(); }
  ScratchDir dir;
};

TEST_F(WorkbenchFiles, badFilesDroppedAreSaidAndChangeNothing) {
  const std::string good = exportText(defaultParameters(), "x", {}, ExportFormat::json);
  std::string damaged = good;
  damaged[damaged.find("8000")] = '9';
  struct Case {
    std::string name, bytes, says;
  };
  const std::vector<Case> cases = {
      {"cut.json", good.substr(0, 200), "cut.json"},
      {"damaged.json", damaged, "damaged.json"},
      {"range.json", R"({"format": "trimtab-preset", "version": 3, "parameters": {"fuzzy.hysteresis": 99}})",
       "range.json"},
      {"words.tif", "not an image", "words.tif"},
      {"noise.hgt", std::string(77, '\x17'), "noise.hgt"},
      {"header.csv", "a,b,c\n1,2,3\n", "header.csv"},
      {"cut.pcap", std::string("\xd4\xc3\xb2\xa1\x02\x00", 6), "cut.pcap"}};
  edit();
  ASSERT_TRUE(settle());
  const FrameDecision decision = session().decision();
  const TuningParameters before = w().draft().parameters();
  const QString title = w().windowTitle();
  for (const Case& c : cases) {
    writeFile(dir / c.name, c.bytes);
    const int messages = w().messages().count();
    if (c.name.ends_with(".json")) answer(QMessageBox::Discard);
    drop(dir / c.name);
    ASSERT_TRUE(waitFor([&] {
      return w().messages().count() > messages && !w().controllers().terrain->job().running();
    })) << c.name;
    EXPECT_TRUE(w().messages().text().contains(QString::fromStdString(c.says))) << c.name;
    EXPECT_TRUE(differences(before, w().draft().parameters()).empty()) << c.name;
    EXPECT_TRUE(w().draft().isDirty()) << c.name;
    EXPECT_EQ(w().draft().undoStack().count(), 1) << c.name;
    EXPECT_EQ(w().windowTitle(), title) << c.name;
    EXPECT_TRUE(w().controllers().terrain->database() != nullptr);
    EXPECT_EQ(session().decision(), decision) << c.name;
    EXPECT_FALSE(w().feed().playback().loaded()) << c.name;
  }
}

TEST_F(WorkbenchFiles, goodFilesDroppedAreOpened) {
  writeFile(dir / "mine.json", exportText(defaultParameters(), "mine", {}, ExportFormat::json));
  drop(dir / "mine.json");
  EXPECT_EQ(w().controllers().document->document().title(), "mine.json");
  drop(sampleFlight());
  EXPECT_TRUE(w().feed().playback().loaded());
  ASSERT_TRUE(terrain::writeSample(dir / "other.tif", {2, 12, 120, {}}));
  const std::uint64_t before = paints();
  drop(dir / "other.tif");
  ASSERT_TRUE(waitFor([&] { return w().windowTitle().contains("other"); }))
      << w().messages().text().toStdString();
  EXPECT_TRUE(waitFor([&] { return paints() > before; }));
}

TEST_F(WorkbenchFiles, saveUndoAndTheDirtyMarkAgree) {
  EXPECT_FALSE(w().isWindowModified());
  edit();
  EXPECT_TRUE(w().isWindowModified());
  w().draft().undoStack().undo();
  EXPECT_FALSE(w().isWindowModified());
  w().draft().undoStack().redo();
  ASSERT_TRUE(w().controllers().document->saveTo(path(dir / "p.json")));
  EXPECT_FALSE(w().isWindowModified());
  EXPECT_TRUE(w().windowTitle().contains("p.json"));
  const auto saved = loadPreset((dir / "p.json").string());
  ASSERT_TRUE(saved) << toString(saved.findings());
  EXPECT_EQ(saved->parameters.scheme.hysteresis.value(), 0.04);
  w().draft().undoStack().undo();
  EXPECT_TRUE(w().isWindowModified()) << "what is shown is not what is saved";
}

TEST_F(WorkbenchFiles, aSaveThatFailsKeepsTheEditsAndTheOldFile) {
  edit();
  EXPECT_FALSE(w().controllers().document->saveTo(path(dir / "no" / "such" / "p.json")));
  EXPECT_TRUE(w().draft().isDirty());
  EXPECT_TRUE(w().messages().text().contains("cannot be saved"));
  EXPECT_FALSE(w().controllers().document->exportTo("/proc/nowhere/e.json", ExportFormat::json, {}, {}));
}

TEST_F(WorkbenchFiles, anExportNamesItsTerrainAndWhatDependsOnTheMachine) {
  EXPECT_TRUE(w().controllers().document->exportTo(path(dir / "e.json"), ExportFormat::json, "me", "Mine."));
  const std::string text = readFile(dir / "e.json");
  EXPECT_NE(text.find("\"terrain\": \"" + w().controllers().terrain->database()->info().name + '"'),
            std::string::npos)
      << text.substr(0, 500);
  EXPECT_NE(text.find("\"comment\": \"Mine. culling.occlusion is auto"), std::string::npos);
  EXPECT_TRUE(loadPreset((dir / "e.json").string()));
}

TEST_F(WorkbenchFiles, anExportAgainGoesToTheLastTargetOfThisPresetWithoutAQuestion) {
  workbench::DocumentController& document = *w().controllers().document;
  ASSERT_TRUE(document.saveTo(path(dir / "mine.json")));
  workbench::rememberTarget(path(dir / "mine.json"),
                            {path(dir / "ig.ini"), ExportFormat::ini, "me", "Mine."});
  ASSERT_TRUE(document.open(path(dir / "mine.json"))) << "as in a later run";
  edit();
  ASSERT_NO_FATAL_FAILURE(activate());
  QTest::keyClick(&w(), Qt::Key_E, Qt::ControlModifier);
  ASSERT_TRUE(std::filesystem::exists(dir / "ig.ini")) << w().messages().text().toStdString();
  EXPECT_EQ(loadPreset((dir / "ig.ini").string())->parameters.scheme.hysteresis.value(), 0.04);
  EXPECT_NE(readFile(dir / "ig.ini").find("Mine."), std::string::npos);
  ASSERT_TRUE(document.saveTo(path(dir / "other.json")));
  EXPECT_EQ(workbench::targetOf(path(dir / "other.json"))->file, path(dir / "ig.ini"));
  std::filesystem::remove(dir / "ig.ini");
  document.startFrom("default");
  DialogCloser dialogs;
  QTest::keyClick(&w(), Qt::Key_E, Qt::ControlModifier);
  EXPECT_GT(dialogs.closed(), 0) << "another preset has no target yet";
  EXPECT_FALSE(std::filesystem::exists(dir / "ig.ini"));
}

TEST_F(WorkbenchFiles, anExportAsksInOneDialogOnceItsTargetIsKnown) {
  workbench::DocumentController& document = *w().controllers().document;
  ASSERT_TRUE(document.saveTo(path(dir / "mine.json")));
  workbench::rememberTarget(path(dir / "mine.json"),
                            {path(dir / "ig.ini"), ExportFormat::ini, "me", "Mine."});
  ASSERT_TRUE(document.open(path(dir / "mine.json")));
  Hand hand(w());
  hand.inDialog([&](QWidget& dialog) {
    auto* const format = dialog.findChild<QComboBox*>();
    format->setCurrentIndex(1);
    const auto* const file = dialog.findChild<QLineEdit*>(QStringLiteral("file"));
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(file->text(), path(dir / "ig.xml")) << "another format is another file";
    hand.press(dialog, "OK");
  });
  document.askExport();
  EXPECT_TRUE(hand.answered());
  EXPECT_TRUE(std::filesystem::exists(dir / "ig.xml")) << w().messages().text().toStdString();
  EXPECT_EQ(workbench::targetOf(path(dir / "mine.json"))->format, ExportFormat::xml);
}

TEST_F(WorkbenchFiles, aFlightIsLookedForWhereTheLastOneWas) {
  QSettings().remove(QStringLiteral("recent/flight"));
  EXPECT_EQ(QFileInfo(workbench::folderOfRecent("flight")).canonicalFilePath(),
            QFileInfo(QString::fromStdString(sampleFlight())).canonicalPath())
      << "the flights that ship";
  EXPECT_EQ(workbench::folderOfRecent("nothing"), QString());
  writeFile(dir / "low.csv", "");
  workbench::rememberRecent("flight", path(dir / "low.csv"));
  workbench::rememberRecent("flight", "/gone/high.csv");
  EXPECT_EQ(workbench::folderOfRecent("flight"), path(dir.path())) << "a folder that is gone is no help";
}

TEST_F(WorkbenchFiles, aSavedPresetHasItsFilesNameUnlessItHasAnother) {
  workbench::DocumentController& document = *w().controllers().document;
  const auto nameSavedAs = [&](const char* file) {
    EXPECT_TRUE(document.saveTo(path(dir / file)));
    return loadPreset((dir / file).string())->name;
  };
  w().draft().load(Preset{});
  EXPECT_EQ(nameSavedAs("first.json"), "first");
  EXPECT_EQ(nameSavedAs("second.json"), "second");
  document.startFrom("as-published");
  EXPECT_EQ(nameSavedAs("third.json"), "third");
  w().draft().describe("Kansai, winter", "");
  EXPECT_EQ(nameSavedAs("fourth.json"), "Kansai, winter");
}

TEST_F(WorkbenchFiles, asksBeforeEditsAreLost) {
  edit();
  answer(QMessageBox::Cancel);
  EXPECT_FALSE(w().close());
  EXPECT_TRUE(w().isVisible());
  EXPECT_EQ(hysteresis(), 0.04);
  ASSERT_TRUE(w().controllers().document->saveTo(path(dir / "p.json")));
  w().draft().undoStack().undo();
  answer(QMessageBox::Save);
  EXPECT_TRUE(w().close());
  EXPECT_EQ(loadPreset((dir / "p.json").string())->parameters.scheme.hysteresis,
            TuningParameters{}.scheme.hysteresis);
}

TEST_F(WorkbenchFiles, editsOfAProgramThatDiedAreOfferedAndComeBackAsOneStep) {
  edit();
  w().controllers().document->document().keepCopyNow();
  const QDir folder(QStandardPaths::writableLocation(QStandardPaths::AppLocalDataLocation) + "/recovery");
  const QString own = folder.filePath(QString::number(QCoreApplication::applicationPid()) + ".json");
  ASSERT_TRUE(QFile::exists(own));
  const pid_t dead = ::fork();
  if (dead == 0) ::_exit(0);
  ::waitpid(dead, nullptr, 0);
  ASSERT_TRUE(QFile::copy(own, folder.filePath(QString::number(dead) + ".json")));
  w().controllers().document->document().dropCopy();
  EXPECT_FALSE(QFile::exists(own));
  w().draft().undoStack().setClean();
  window.reset();

  SetUp();
  QPushButton* recover = nullptr;
  ASSERT_TRUE(waitFor([&] { return (recover = noticeButton(w(), "Recover")) != nullptr; }));
  EXPECT_NE(hysteresis(), 0.04);
  QTest::mouseClick(recover, Qt::LeftButton);
  EXPECT_EQ(hysteresis(), 0.04);
  EXPECT_TRUE(w().isWindowModified());
  w().draft().undoStack().undo();
  EXPECT_NE(hysteresis(), 0.04);
  EXPECT_TRUE(workbench::Document::abandoned().empty());
}

TEST_F(WorkbenchFiles, editsAreOfferedByWhoHoldsTheirLockAndNotByWhoHasTheNumber) {
  edit();
  w().controllers().document->document().keepCopyNow();
  const QDir folder(QStandardPaths::writableLocation(QStandardPaths::AppLocalDataLocation) + "/recovery");
  const QString own = folder.filePath(QString::number(QCoreApplication::applicationPid()));
  const QString other = folder.filePath(QString::number(::getppid()));  // lives, and is no workbench
  ASSERT_TRUE(QFile::copy(own + ".json", other + ".json"));
  EXPECT_TRUE(workbench::Document::abandoned().empty());
  const int lock = ::open(qPrintable(other + ".lock"), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  ASSERT_EQ(::flock(lock, LOCK_EX | LOCK_NB), 0);
  EXPECT_TRUE(workbench::Document::abandoned().empty());
  ::close(lock);
  const auto left = workbench::Document::abandoned();
  ASSERT_EQ(left.size(), 1U);
  workbench::Document::discard(left[0]);
  EXPECT_FALSE(QFile::exists(other + ".json") || QFile::exists(other + ".lock"));
  w().draft().undoStack().setClean();
  w().controllers().document->document().dropCopy();
  window.reset();
  EXPECT_FALSE(QFile::exists(own + ".lock"));
}

TEST_F(WorkbenchFiles, aFileChangedByAnotherProgramIsSaidAndReloadedOnRequest) {
  ASSERT_TRUE(w().controllers().document->saveTo(path(dir / "p.json")));
  Preset other;
  other.parameters.scheme.hysteresis = Membership{0.03};
  ASSERT_TRUE(writeAtomically(dir / "p.json", *presetText(other)));
  QPushButton* reload = nullptr;
  ASSERT_TRUE(waitFor([&] { return (reload = noticeButton(w(), "Reload")) != nullptr; }));
  EXPECT_NE(hysteresis(), 0.03) << "nothing happens unasked";
  QTest::mouseClick(reload, Qt::LeftButton);
  EXPECT_EQ(hysteresis(), 0.03);
  // Writing the same bytes again, and our own saves, must not raise the question.
  ASSERT_TRUE(writeAtomically(dir / "p.json", readFile(dir / "p.json")));
  const auto asks = [&] { return noticeButton(w(), "Reload") != nullptr; };
  EXPECT_FALSE(waitFor(asks, 400));
  edit();
  ASSERT_TRUE(w().controllers().document->saveTo(path(dir / "p.json")));
  EXPECT_FALSE(waitFor(asks, 400));
}

TEST_F(WorkbenchFiles, aFileChangedOnDiskIsReadWhileTheWindowIsAtWork) {
  ASSERT_TRUE(w().controllers().document->saveTo(path(dir / "p.json")));
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  std::filesystem::rename(dir / "pipe", dir / "p.json");
  // Nobody can open it for writing but while it is read, and this thread, which is the window's, does.
  int held = -1;
  ASSERT_TRUE(waitFor([&] { return (held = ::open((dir / "p.json").c_str(), O_WRONLY | O_NONBLOCK)) >= 0; }));
  EXPECT_EQ(::write(held, "other", 5), 5);
  ::close(held);
  EXPECT_TRUE(waitFor([&] { return noticeButton(w(), "Reload") != nullptr; }));
}

TEST_F(WorkbenchFiles, whatWasOnDiskBeforeASaveIsNoChangeByAnotherProgram) {
  ASSERT_TRUE(w().controllers().document->saveTo(path(dir / "p.json")));
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  std::filesystem::rename(dir / "pipe", dir / "p.json");
  int held = -1;
  ASSERT_TRUE(waitFor([&] { return (held = ::open((dir / "p.json").c_str(), O_WRONLY | O_NONBLOCK)) >= 0; }));
  // The file is being read: what is saved now is newer than what the reader gets.
  std::filesystem::rename(dir / "p.json", dir / "pipe");
  edit();
  ASSERT_TRUE(w().controllers().document->saveTo(path(dir / "p.json")));
  EXPECT_EQ(::write(held, "other", 5), 5);
  ::close(held);
  EXPECT_FALSE(waitFor([&] { return noticeButton(w(), "Reload") != nullptr; }, 1000));
}

TEST_F(WorkbenchFiles, foldersOfTheKernelAreNoTerrain) {
  for (const char* const folder : {"/proc", "/sys"}) {
    drop(folder);
    const QString refusal = QStringLiteral("error\t%1\t\ta folder on a disk").arg(folder);
    EXPECT_TRUE(waitFor([&] { return w().messages().text().contains(refusal); }))
        << w().messages().text().toStdString();
    EXPECT_FALSE(w().controllers().terrain->job().running()) << folder;
  }
}

TEST_F(WorkbenchFiles, bakingCanBeCancelledAndTheOldTerrainStays) {
  ASSERT_TRUE(terrain::writeSample(dir / "big.tif", {5, 60, 60, {}}));
  const QString title = w().windowTitle();
  w().controllers().terrain->open(path(dir / "big.tif"));
  EXPECT_TRUE(w().controllers().terrain->job().running());
  w().controllers().terrain->job().cancel();
  EXPECT_FALSE(w().controllers().terrain->job().running());
  EXPECT_TRUE(w().messages().text().contains("Cancelled"));
  EXPECT_EQ(w().windowTitle(), title);
  EXPECT_TRUE(w().controllers().terrain->database() != nullptr);
}

TEST(WorkbenchProgram, leavesWhatOthersPutBesideAnExportAndSaysWhenItMayNotBeSoLarge) {
  ScratchDir dir;
  const std::filesystem::path backup = dir / ".e.json.trimtab-backup", exported = dir / "e.json";
  writeFile(backup, "mine");
  const std::string command = program("trimtab").string() + " --size 900x700 --screenshot " +
                              (dir / "w.png").string() + " --after-s 0.1 --export " + exported.string();
  EXPECT_EQ(run(command).exitCode, 0);
  EXPECT_EQ(readFile(backup), "mine");
  EXPECT_FALSE(readFile(exported).empty());
  writeFile(exported, "old");
  const Ran ran = run("ulimit -f 8; " + command);
  EXPECT_EQ(ran.exitCode, 1) << "it ends by itself, not by a signal";
  EXPECT_NE(ran.err.find("File too large"), std::string::npos) << ran.err;
  EXPECT_EQ(readFile(exported), "old");
}

}  // namespace
}  // namespace trimtab::test
