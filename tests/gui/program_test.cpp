// SPDX-License-Identifier: GPL-3.0-or-later
#include <signal.h>
#include <sys/stat.h>

#include <QImage>
#include <QProcess>

#include "gui_support.h"
#include "tests/child.h"
#include "trimtab/preset/preset.h"

/// The program as a user starts and ends it.
namespace trimtab::test {
namespace {

TEST(WorkbenchProgram, withoutADisplayItSaysSoAndEndsWithOne) {
  const Ran ran = run("env -u DISPLAY -u WAYLAND_DISPLAY -u QT_QPA_PLATFORM " + program("trimtab").string());
  EXPECT_EQ(ran.exitCode, 1);
  EXPECT_NE(ran.err.find("display"), std::string::npos) << ran.err;
  const Ran gone = run("env DISPLAY=:4242 " + program("trimtab").string());
  EXPECT_EQ(gone.exitCode, 1) << "a display that is not there";
  EXPECT_NE(gone.err.find("display"), std::string::npos) << gone.err;
  const Ran noGl = run("env QT_XCB_GL_INTEGRATION=none " + program("trimtab").string());
  EXPECT_EQ(noGl.exitCode, 1) << "a display without OpenGL";
  EXPECT_NE(noGl.err.find("OpenGL"), std::string::npos) << noGl.err;
  EXPECT_EQ(run("env -u DISPLAY " + program("trimtab").string() + " --help").exitCode, 0);
  EXPECT_EQ(run("env -u DISPLAY " + program("trimtab").string() + " --wrong").exitCode, 2);
}

TEST(WorkbenchProgram, leavesAScreenshotAndAnExport) {
  ScratchDir dir;
  const Ran ran = run(program("trimtab").string() + " --terrain " + sampleTerrain().string() +
                      " --size 900x700 --screenshot " + (dir / "w.png").string() +
                      " --after-s 0.5 --export " + (dir / "e.json").string());
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  const QImage picture(QString::fromStdString((dir / "w.png").string()));
  EXPECT_EQ(picture.size(), QSize(900, 700));
  const auto exported = loadPreset((dir / "e.json").string());
  ASSERT_TRUE(exported) << toString(exported.findings());
  EXPECT_TRUE(differences(exported->parameters, TuningParameters{}).empty());
}

TEST(WorkbenchProgram, endsCleanlyOnASignal) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    QProcess process;
    process.start(QString::fromStdString(program("trimtab").string()),
                  {"--terrain", QString::fromStdString(sampleTerrain().string())});
    ASSERT_TRUE(process.waitForStarted());
    // How long a start takes depends on the machine; a signal before it is caught ends any program.
    ASSERT_TRUE(waitFor([&] { return catches(static_cast<pid_t>(process.processId()), number); }, 60000));
    QTest::qWait(500);
    ::kill(static_cast<pid_t>(process.processId()), number);
    ASSERT_TRUE(waitFor([&] { return process.state() == QProcess::NotRunning; }));
    EXPECT_EQ(process.exitStatus(), QProcess::NormalExit) << number;
    EXPECT_EQ(process.exitCode(), 0) << number;
  }
}

TEST(WorkbenchProgram, endsOnASignalWhateverItOpens) {
  const ScratchDir dir;
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  for (const QStringList& arguments :
       {QStringList{"--terrain", "/proc"}, {"--preset", QString::fromStdString((dir / "pipe").string())}}) {
    QProcess process;
    process.start(QString::fromStdString(program("trimtab").string()), arguments);
    ASSERT_TRUE(process.waitForStarted());
    ASSERT_TRUE(waitFor([&] { return catches(static_cast<pid_t>(process.processId()), SIGTERM); }, 60000));
    process.terminate();
    ASSERT_TRUE(waitFor([&] { return process.state() == QProcess::NotRunning; }))
        << arguments[1].toStdString();
    EXPECT_EQ(process.exitStatus(), QProcess::NormalExit);
    EXPECT_EQ(process.exitCode(), 0);
  }
}

TEST(WorkbenchProgram, outlivesItsTerminalUnderNohup) {
  QProcess process;
  process.start("nohup", {QString::fromStdString(program("trimtab").string()), "--terrain",
                          QString::fromStdString(sampleTerrain().string())});
  ASSERT_TRUE(process.waitForStarted());
  ASSERT_TRUE(waitFor([&] { return catches(static_cast<pid_t>(process.processId()), SIGTERM); }, 60000));
  EXPECT_FALSE(catches(static_cast<pid_t>(process.processId()), SIGHUP));
  process.terminate();
  ASSERT_TRUE(waitFor([&] { return process.state() == QProcess::NotRunning; }));
}

TEST(WorkbenchProgram, saysWhenItsHelpCannotBeWritten) {
  for (const char* command : {"trimtab --help", "trimtab --version", "trimtab-ig --help"}) {
    const Ran ran = run("( " + (program("trimtab").parent_path() / command).string() + " >/dev/full )");
    EXPECT_EQ(ran.exitCode, 1) << command;
    EXPECT_NE(ran.err.find("standard output"), std::string::npos) << command << ": " << ran.err;
  }
}

}  // namespace
}  // namespace trimtab::test
