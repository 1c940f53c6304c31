#include "app/link/stop_signals.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <thread>

#include "tests/support.h"
#include "trimtab/preset/stop_request.h"

namespace trimtab {
namespace {

/// How a process of its own ends: its exit code, or 128 + signal.
int endOf(const std::function<int()>& program) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(program());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool readable(int descriptor) {
  pollfd polled{descriptor, POLLIN, 0};
  return ::poll(&polled, 1, 0) == 1;
}

TEST(StopSignals, askTheProgramAndWakeWhoWaits) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    EXPECT_EQ(endOf([number] {
                handleStopSignals();
                const int event = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
                countStopSignals(event);
                if (stopRequested() || readable(event)) return 1;
                ::raise(number);
                return stopRequested() && readable(event) ? 0 : 2;
              }),
              0);
}

TEST(StopSignals, wakeWhoBeginsToWaitTooLate) {
  EXPECT_EQ(endOf([] {
              handleStopSignals();
              ::raise(SIGTERM);
              const int event = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
              countStopSignals(event);
              return readable(event) ? 0 : 1;
            }),
            0);
}

TEST(StopSignals, ofOneRequestAreOneAndALaterOneEndsTheProgram) {
  EXPECT_EQ(endOf([] {
              handleStopSignals();
              ::raise(SIGTERM);
              ::raise(SIGHUP);
              return 0;
            }),
            0);
  EXPECT_EQ(endOf([] {
              handleStopSignals();
              ::raise(SIGTERM);
              ::usleep(1200000);
              ::raise(SIGTERM);
              return 0;
            }),
            128 + SIGTERM);
}

TEST(StopSignals, endWorkThatDoesNotLookAtThemEvenIfTheyCameBefore) {
  EXPECT_EQ(endOf([] {
              handleStopSignals();
              endAtStopSignals();
              ::raise(SIGINT);
              return 0;
            }),
            128 + SIGINT);
  EXPECT_EQ(endOf([] {
              handleStopSignals();
              ::raise(SIGTERM);
              endAtStopSignals();
              return 0;
            }),
            128 + SIGTERM);
}

TEST(StopSignals, leaveAloneWhatNohupIgnores) {
  EXPECT_EQ(endOf([] {
              ::signal(SIGHUP, SIG_IGN);
              handleStopSignals();
              ::raise(SIGHUP);
              if (stopRequested()) return 1;
              endAtStopSignals();
              ::raise(SIGHUP);
              return 0;
            }),
            0);
}

/// A program in a group of its own, as a shell starts one: a group without a shell cannot be paused.
pid_t inItsGroup(const std::function<int()>& program) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::setpgid(0, 0);
    ::_exit(program());
  }
  ::setpgid(child, child);
  return child;
}

TEST(StopSignals, pauseTheProgramOnlyWhereItLetsThem) {
  const pid_t child = inItsGroup([] {
    holdPauses();
    std::thread([] { ::kill(::getpid(), SIGTSTP); }).join();
    if (!pauseAsked()) return 1;
    pauseIfAsked();
    if (pauseAsked()) return 2;
    // SIGCONT takes back what has not stopped it yet.
    ::kill(::getpid(), SIGTSTP);
    ::kill(::getpid(), SIGCONT);
    if (pauseAsked()) return 3;
    pauseIfAsked();
    return 0;
  });
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, WUNTRACED), child);
  ASSERT_TRUE(WIFSTOPPED(status)) << status;
  ::kill(child, SIGCONT);
  ASSERT_EQ(::waitpid(child, &status, WUNTRACED), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST(StopSignals, areHandledBeforeAnythingElseInEveryProgram) {
  for (const char* const program : {"cli", "ig", "workbench"}) {
    const std::string text = test::readFile(test::sourceDir() / "app" / program / "main.cpp");
    const std::size_t body = text.find("int main(int argc, char** argv) {");
    ASSERT_NE(body, std::string::npos) << program;
    const std::size_t first = text.find_first_not_of(" \n", text.find('{', body) + 1);
    EXPECT_EQ(text.compare(first, 29, "trimtab::handleStopSignals();"), 0) << program;
  }
}

}  // namespace
}  // namespace trimtab
