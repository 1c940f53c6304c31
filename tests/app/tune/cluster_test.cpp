#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "tests/app/small_run.h"
#include "tests/child.h"

/// The scripts of resources/cluster, on a real Slurm of one node and by GNU parallel, with what is killed
/// there.
namespace trimtab::tune {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A Slurm of one node below a folder, which nothing outside this machine reaches.
class OneNodeSlurm {
 public:
  explicit OneNodeSlurm(const fs::path& folder) : folder_(folder) {
    for (const char* name : {"state", "spool", "log"}) fs::create_directories(folder / name);
    fs::permissions(folder, fs::perms::owner_all | fs::perms::group_exec | fs::perms::others_exec);
    const std::string in = folder.string();
    const int port = 20000 + ::getpid() % 20000;
    std::string host(256, '\0');
    ::gethostname(host.data(), host.size());
    host = host.substr(0, std::min(host.find('\0'), host.find('.')));
    test::writeFile(
        folder / "slurm.conf",
        "ClusterName=trimtab\nSlurmctldHost=" + host +
            "(127.0.0.1)\nSlurmUser=root\nSlurmdUser=root\nSlurmctldPort=" + std::to_string(port) +
            "\nSlurmdPort=" + std::to_string(port + 1) + "\nSrunPortRange=" + std::to_string(port + 2) + '-' +
            std::to_string(port + 40) +
            "\nCommunicationParameters=NoInAddrAny,NoCtldInAddrAny\nAuthInfo=socket=" + in +
            "/munge.sock\nStateSaveLocation=" + in + "/state\nSlurmdSpoolDir=" + in +
            "/spool\nSlurmctldPidFile=" + in + "/slurmctld.pid\nSlurmdPidFile=" + in +
            "/slurmd.pid\nSlurmctldLogFile=" + in + "/log/slurmctld\nSlurmdLogFile=" + in +
            "/log/slurmd\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/"
            "none\nJobAcctGatherType=jobacct_gather/none\n"
            "AccountingStorageType=accounting_storage/none\nJobCompType=jobcomp/none\nSwitchType=switch/"
            "none\n"
            "SchedulerType=sched/builtin\nSelectType=select/"
            "cons_tres\nSelectTypeParameters=CR_Core\nReturnToService=2\n"
            "JobRequeue=0\nKillWait=2\nSlurmdTimeout=60\nSchedulerParameters=sched_interval=1,batch_sched_"
            "delay=0\n"
            "NodeName=" +
            host + " NodeAddr=127.0.0.1 CPUs=" + std::to_string(cpus()) +
            " State=UNKNOWN\nPartitionName=main Nodes=" + host + " Default=YES MaxTime=INFINITE State=UP\n");
    ::setenv("SLURM_CONF", (folder / "slurm.conf").c_str(), 1);
    test::writeFile(folder / "munge.key", std::string(64, 'k') + std::to_string(port));
    fs::permissions(folder / "munge.key", fs::perms::owner_read | fs::perms::owner_write);
    const test::Ran munge =
        test::run("/usr/sbin/munged --force --key-file=" + in + "/munge.key --socket=" + in +
                  "/munge.sock --pid-file=" + in + "/munged.pid --log-file=" + in +
                  "/log/munged --seed-file=" + in + "/munge.seed");
    said_ = munge.err + test::run("slurmctld -c").err + startNode();
    ready_ = test::until([] { return test::run("sinfo -h -o %T").out == "idle\n"; });
  }
  ~OneNodeSlurm() {
    for (const char* daemon : {"slurmd", "slurmctld", "munged"}) kill(daemon, SIGKILL);
    for (const pid_t left : test::processesWith({folder_.string()})) ::kill(left, SIGKILL);
  }
  bool ready() const { return ready_; }
  const std::string& said() const { return said_; }
  std::string startNode() const { return test::run("slurmd").err; }
  void kill(const std::string& daemon, int signal) const {
    std::ifstream in(folder_ / (daemon + ".pid"));
    if (pid_t pid = 0; in >> pid) ::kill(pid, signal);
  }

 private:
  static long cpus() { return ::sysconf(_SC_NPROCESSORS_ONLN); }
  fs::path folder_;
  std::string said_;
  bool ready_ = false;
};

class Cluster : public test::SmallRun {
 protected:
  static void SetUpTestSuite() {
    SmallRun::SetUpTestSuite();
    // A bake of the small terrain ends before anybody can kill it.
    ASSERT_EQ(test::run(cli() + " terrain sample --bare --size-km 24 --post-m 30 -o " + large()).exitCode, 0);
    const test::Ran single = test::run(tune(*shared_ / "single"));
    ASSERT_EQ(single.exitCode, 0) << single.err;
  }

  static std::string large() { return (*shared_ / "large.tif").string(); }
  static std::string tune(const fs::path& out) {
    return cli() + " tune --terrain " + database() + " --flight " + flight() +
           " --free 'lod.*' --size 160x96 --samples 3 --frames 4 --repeats 1 --points 2 --searches 8 "
           "--max-error 0.05"
           " --evaluations 20000 -o " +
           out.string();
  }
  /// Samples are times, which no second run repeats; what follows from them is the same anywhere.
  static void takeSamples(const fs::path& folder) {
    fs::create_directories(folder);
    for (const char* name : {"tune-plan.json", "samples-0.json"})
      fs::copy_file(*shared_ / "single" / name, folder / name);
  }
  static void expectTheSingleRunsSearches(const fs::path& folder) {
    for (int s = 0; s < 8; ++s) {
      const std::string name = "search-" + std::to_string(s) + ".json";
      EXPECT_EQ(test::readFile(folder / name), test::readFile(*shared_ / "single" / name)) << name;
    }
  }
  static std::string bake(const fs::path& out) {
    return cli() + " terrain bake " + large() + " --max-error-m 0 -o " + out.string();
  }
  static std::string bench(const fs::path& out) {
    return cli() + " bench --terrain " + database() + " --flight " + flight() +
           " --preset default high-cruise --size 96x64 --frames 24 --repeats 1 -o " + out.string();
  }
  /// Errors and counts of a bench; times differ from run to run.
  static std::string errorsOf(const fs::path& folder) {
    return test::run(
               "python3 -c \"import csv,sys\nfor r in csv.DictReader(open(sys.argv[1])): "
               "print(*[r[k] for k in ('flight','preset','row','flip','triangles','psnr_db')])\" " +
               (folder / "frames.csv").string())
        .out;
  }
  /// The bake is that of one process to the bit, and so is what a bench draws.
  static void expectTheSingleRuns(const fs::path& database, const fs::path& benched) {
    const test::ScratchDir dir;
    ASSERT_EQ(test::run(bake(dir / "db")).exitCode, 0);
    ASSERT_EQ(test::run(bench(dir / "bench")).exitCode, 0);
    const test::Ran compared = test::run("diff -r " + (dir / "db").string() + ' ' + database.string());
    EXPECT_EQ(compared.exitCode, 0) << compared.out << compared.err;
    EXPECT_EQ(errorsOf(benched), errorsOf(dir / "bench"));
    EXPECT_THAT(errorsOf(benched), HasSubstr("high-cruise"));
  }
  /// Kills a process that does a part of a run, or the batch shell that started it; waits for one.
  static void killPart(const fs::path& out, bool itsShell) {
    EXPECT_TRUE(test::until([&] {
      for (const pid_t part : test::processesWith({"trimtab-cli", "--part", out.string()})) {
        // What a shell that was killed has left behind has another parent.
        const pid_t shell = test::parentOf(part);
        if (test::commandOf(shell).find("slurm_script") == std::string::npos) continue;
        return ::kill(itsShell ? shell : part, SIGKILL) == 0;
      }
      return false;
    })) << out;
  }
  /// Returns how much of a run is finished: files or, of a bake, lines of its journal.
  static long finished(const fs::path& out) {
    std::error_code absent;
    long count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(out, absent))
      count += entry.path().extension() == ".json";
    const std::string lines =
        test::readFile(out.parent_path() / ('.' + out.filename().string() + ".work") / "journal");
    return count + std::count(lines.begin(), lines.end(), '\n');
  }
  /// Runs a command as arrays of a Slurm, in which what a task runs, a batch shell and the node's daemon are
  /// killed in turn, each in work that has gone on since the one before.
  static void survive(const OneNodeSlurm& slurm, int parts, const fs::path& out, const std::string& command) {
    const test::Ran submitted = test::run("bash " + script("slurm.sh") + ' ' + std::to_string(parts) + ' ' +
                                          out.string() + ' ' + command);
    ASSERT_EQ(submitted.exitCode, 0) << submitted.out << submitted.err;
    long before = finished(out);
    const auto waitForMore = [&] {
      EXPECT_TRUE(test::until([&] { return finished(out) > before; })) << out;
      before = finished(out);
    };
    killPart(out, false);
    waitForMore();
    killPart(out, true);
    waitForMore();
    EXPECT_TRUE(test::until([&] { return !test::processesWith({"--part", out.string()}).empty(); }));
    slurm.kill("slurmd", SIGKILL);
    EXPECT_EQ(slurm.startNode(), "");
    expectComplete(out);
  }
  /// Waits for some rounds of processes, which a busy machine takes its time for.
  static void expectComplete(const fs::path& out) {
    const std::string log = out.string() + ".log";
    const auto isDone = [&] { return test::readFile(log + "/state") == "complete\n"; };
    for (int i = 0; i < 3000 && !isDone(); ++i) {
      // Without this the controller believes for minutes that tasks of a killed daemon run; of those that had
      // just begun it asks again only when they are some seconds old.
      if (i % 50 == 0) test::run("scontrol reconfigure");
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    EXPECT_TRUE(isDone()) << test::readFile(log + "/state")
                          << test::run("squeue; tail -n 5 " + log + "/*").out;
  }
  static std::string script(const std::string& name) {
    return (test::sourceDir() / "resources/cluster" / name).string();
  }
};

TEST_F(Cluster, slurmGivesTheSingleRunsSearchesWhateverIsKilled) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs root, as which alone a private Slurm was tried";
  const test::ScratchDir dir;
  const OneNodeSlurm slurm(dir / "slurm");
  if (!slurm.ready()) GTEST_SKIP() << "needs a Slurm that starts here: " << slurm.said();
  const fs::path out = dir / "out";
  takeSamples(out);
  survive(slurm, 8, out, tune(out));
  expectTheSingleRunsSearches(out);
  EXPECT_TRUE(fs::exists(out / "tune.html"));
}

TEST_F(Cluster, parallelGivesTheSingleRunsSearches) {
  const test::ScratchDir dir;
  takeSamples(dir / "out");
  const test::Ran done =
      test::run("bash " + script("ssh.sh") + " 4 " + (dir / "out").string() + " : " + tune(dir / "out"));
  ASSERT_EQ(done.exitCode, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("Within a mean FLIP of 0.05"));
  expectTheSingleRunsSearches(dir / "out");
}

TEST_F(Cluster, parallelGivesTheSingleRunsBakeAndBench) {
  const test::ScratchDir dir;
  for (const auto& [name, command] : {std::pair{"db", bake(dir / "db")}, {"bench", bench(dir / "bench")}}) {
    const test::Ran done =
        test::run("bash " + script("ssh.sh") + " 3 " + (dir / name).string() + " : " + command);
    ASSERT_EQ(done.exitCode, 0) << done.err;
  }
  expectTheSingleRuns(dir / "db", dir / "bench");
}

TEST_F(Cluster, slurmGivesTheSingleRunsBakeAndBenchWhateverIsKilled) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs root, as which alone a private Slurm was tried";
  const test::ScratchDir dir;
  const OneNodeSlurm slurm(dir / "slurm");
  if (!slurm.ready()) GTEST_SKIP() << "needs a Slurm that starts here: " << slurm.said();
  survive(slurm, 3, dir / "db", bake(dir / "db"));
  survive(slurm, 3, dir / "bench", bench(dir / "bench"));
  expectTheSingleRuns(dir / "db", dir / "bench");
}

TEST_F(Cluster, aRefusedCommandIsNotSubmitted) {
  const test::ScratchDir dir;
  const std::string out = (dir / "out").string();
  for (const std::string& before :
       {script("slurm.sh") + " 2 " + out + ' ', script("ssh.sh") + " 2 " + out + " : "}) {
    const test::Ran refused = test::run("bash " + before + tune(dir / "out") + " --free nothing.here");
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_THAT(refused.err, HasSubstr("nothing.here"));
  }
}

}  // namespace
}  // namespace trimtab::tune
