#include <gmock/gmock.h>
#include <unistd.h>

#include <QMimeDatabase>
#include <map>
#include <memory>
#include <set>

#include "tests/support.h"

// The Debian packages as cpack makes them of this build.
namespace trimtab::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

const std::vector<std::string> kPackages{"trimtab", "trimtab-cli", "libtrimtab1", "libtrimtab-dev"};

/// A root that holds nothing but Debian's essential packages and what ours depend on, with our .deb files in
/// /tmp.
class BareRoot {
 public:
  explicit BareRoot(const std::string& debs) {
    made_ = run("python3 " + scripts_ + "bare_root.py " + path() + debs + " && cp " + debs + ' ' + path() +
                "/tmp");
  }
  static bool allowed() { return ::geteuid() == 0 && run("unshare --mount true").exitCode == 0; }
  const Ran& made() const { return made_; }
  std::string path() const { return dir_.path().string(); }
  /// Runs a command there, under another one of this machine's such as xvfb-run.
  Ran inside(const std::string& command, const std::string& under = {}) const {
    return run(under + " bash " + scripts_ + "in_root.sh " + path() + " '" + command + "'");
  }
  /// The files and folders but those of a person, of dpkg itself, and caches.
  std::string files() const {
    return run("cd " + path() +
               " && find . -xdev \\( -path ./tmp -o -path ./root -o -path ./proc -o -path ./dev -o -path "
               "./var/lib/dpkg -o -path ./var/log -o -path ./var/cache \\) -prune -o -print | sort")
        .out;
  }

 private:
  ScratchDir dir_;
  const std::string scripts_ = (sourceDir() / "tests/packages/").string();
  Ran made_;
};

/// All four packages, made once, and unpacked each into a folder of its name.
class Packages : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = new ScratchDir;
    const Ran made = run("cd " TRIMTAB_BUILD_DIR " && cpack -G DEB -B " + (*dir_ / "made").string());
    ASSERT_EQ(made.exitCode, 0) << made.out << made.err;
    for (const std::string& package : kPackages)
      ASSERT_EQ(run("dpkg-deb -x " + deb(package) + ' ' + (*dir_ / package).string()).exitCode, 0)
          << made.out;
  }
  static void TearDownTestSuite() {
    root_.reset();
    delete dir_;
  }

  static std::string deb(const std::string& package) {
    const std::string architecture = run("dpkg --print-architecture").out;
    return (*dir_ / "made").string() + '/' + package + "_" TRIMTAB_VERSION "_" +
           architecture.substr(0, architecture.find('\n')) + ".deb";
  }
  static std::string debs() {
    std::string all;
    for (const std::string& package : kPackages) all += ' ' + deb(package);
    return all;
  }
  static std::string field(const std::string& package, const std::string& name) {
    return run("dpkg-deb -f " + deb(package) + ' ' + name).out;
  }
  static bool has(const std::string& package, const std::string& file) {
    return std::filesystem::exists(std::filesystem::symlink_status((*dir_ / package) / file));
  }

  /// Made once; each test leaves it as it found it.
  static const BareRoot& bareRoot() {
    if (!root_) root_ = std::make_unique<BareRoot>(debs());
    return *root_;
  }

  static ScratchDir* dir_;
  static std::unique_ptr<BareRoot> root_;
};
ScratchDir* Packages::dir_ = nullptr;
std::unique_ptr<BareRoot> Packages::root_;

TEST_F(Packages, haveNoErrorThatLintianFinds) {
  // All at once, because one takes as long as three of its kind on two cores.
  std::string command;
  for (const std::string& package : kPackages) command += "lintian --allow-root " + deb(package) + " & ";
  const Ran ran = run(command + "wait");
  EXPECT_EQ(ran.err, "") << "lintian itself failed";
  std::istringstream lines(ran.out);
  for (std::string line; std::getline(lines, line);) EXPECT_FALSE(line.starts_with("E:")) << line;
  // Without it nobody would know that lintian has looked at anything.
  EXPECT_THAT(ran.out, HasSubstr("W: libtrimtab1: maintscript-calls-ldconfig"));
}

TEST_F(Packages, bringWhatIsBesideTheProgramsAndTheLibrary) {
  const std::map<std::string, std::vector<std::string>> wanted{
      {"trimtab",
       {"usr/bin/trimtab", "usr/bin/trimtab-ig", "usr/share/applications/trimtab.desktop",
        "usr/share/icons/hicolor/scalable/apps/trimtab.svg",
        "usr/share/icons/hicolor/128x128/apps/trimtab.png", "usr/share/metainfo/trimtab.metainfo.xml",
        "usr/share/mime/packages/trimtab.xml", "usr/share/bash-completion/completions/trimtab",
        "usr/share/bash-completion/completions/trimtab-ig", "usr/share/man/man1/trimtab.1.gz",
        "usr/share/man/man1/trimtab-ig.1.gz", "usr/share/trimtab/flights/yecheon-circuit.csv"}},
      {"trimtab-cli",
       {"usr/bin/trimtab-cli", "usr/share/bash-completion/completions/trimtab-cli",
        "usr/share/man/man1/trimtab-cli.1.gz", "usr/share/man/man1/trimtab-cli-terrain-bake.1.gz"}},
      {"libtrimtab-dev",
       {"usr/include/trimtab/trimtab.h", "usr/include/trimtab/session/session.h",
        "usr/share/trimtab/presets/default.json", "usr/share/trimtab/presets/preset.schema.json",
        "usr/share/doc/trimtab/integrating.md"}}};
  for (const auto& [package, files] : wanted)
    for (const std::string& file : files) EXPECT_TRUE(has(package, file)) << package << " lacks " << file;
  for (const std::string& package : kPackages)
    for (const char* file : {"/copyright", "/changelog.gz"})
      EXPECT_TRUE(has(package, "usr/share/doc/" + package + file)) << package << " lacks " << file;

  // Every page that the program writes is in its package, and no other.
  ScratchDir manual;
  ASSERT_EQ(run(program("trimtab-cli").string() + " --write-manual " + manual.path().string()).exitCode, 0);
  std::set<std::string> pages, packed;
  for (const std::string& name : namesIn(manual.path()))
    if (name.ends_with(".1")) pages.insert(name + ".gz");
  for (const std::string& name : namesIn((*dir_ / "trimtab-cli") / "usr/share/man/man1")) packed.insert(name);
  EXPECT_EQ(packed, pages);

  // The link without a number is for building alone.
  const auto librariesOf = [](const std::string& package) {
    return run("cd " + (*dir_ / package).string() +
               " && find . -name 'libtrimtab.so*' -printf '%f %l\\n' | sort")
        .out;
  };
  EXPECT_EQ(librariesOf("libtrimtab1"), "libtrimtab.so.1 libtrimtab.so.1.0.0\nlibtrimtab.so.1.0.0 \n");
  EXPECT_EQ(librariesOf("libtrimtab-dev"), "libtrimtab.so libtrimtab.so.1\n");
}

TEST_F(Packages, dependOnWhatTheyRunAndLink) {
  const std::string same = " (= " TRIMTAB_VERSION ")";
  EXPECT_THAT(field("trimtab", "Depends"), HasSubstr("trimtab-cli" + same));
  EXPECT_THAT(field("libtrimtab-dev", "Depends"), HasSubstr("libtrimtab1" + same));
  EXPECT_THAT(field("libtrimtab-dev", "Depends"), HasSubstr("libpugixml-dev"));
  for (const char* library : {"libqt6widgets6", "libgdal32", "libopenscenegraph161", "libc6"})
    EXPECT_THAT(field("trimtab", "Depends"), HasSubstr(library)) << "dpkg-shlibdeps was not asked";
  EXPECT_EQ(field("libtrimtab1", "Depends").find("qt6"), std::string::npos);
}

TEST_F(Packages, shareNoFileAndCarryNoSymbols) {
  std::set<std::string> seen;
  for (const std::string& package : kPackages)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*dir_ / package)) {
      if (entry.is_directory()) continue;
      EXPECT_TRUE(seen.insert(entry.path().lexically_relative(*dir_ / package)).second)
          << entry.path() << " is in another package too";
    }
  EXPECT_GT(seen.size(), 100u);
  for (const char* file :
       {"trimtab/usr/bin/trimtab", "trimtab/usr/bin/trimtab-ig", "trimtab-cli/usr/bin/trimtab-cli"}) {
    const Ran ran = run("readelf -S " + (*dir_ / file).string());
    EXPECT_THAT(ran.out, HasSubstr(".text")) << ran.err;
    EXPECT_EQ(ran.out.find(".symtab"), std::string::npos) << file;
  }
}

TEST_F(Packages, tellTheDesktopWhatTrimtabOpens) {
  const std::string share = (*dir_ / "trimtab").string() + "/usr/share/";
  const Ran entry = run("desktop-file-validate " + share + "applications/trimtab.desktop");
  EXPECT_EQ(entry.out + entry.err, "");
  // That the identifier is no domain turned round is a warning; the project has no domain.
  const Ran described = run("appstreamcli validate --no-net " + share + "metainfo/trimtab.metainfo.xml");
  EXPECT_THAT(described.out, HasSubstr("cid-desktopapp-is-not-rdns")) << described.out << described.err;
  EXPECT_EQ(described.out.find("E:"), std::string::npos) << described.out;
  const std::string text = readFile(share + "applications/trimtab.desktop");

  ASSERT_EQ(::setenv("XDG_DATA_DIRS", (share + ":/usr/share").c_str(), 1), 0);
  QMimeDatabase types;
  for (const auto& [name, type] :
       std::map<std::string, std::string>{{"a.preset.json", "application/x-trimtab-preset"},
                                          {"a.session.json", "application/x-trimtab-session"},
                                          {"a.workspace.json", "application/x-trimtab-workspace"},
                                          {"manifest.json", "application/json"},
                                          {"a.fll", "application/x-fuzzylite"},
                                          {"a.fis", "application/x-fuzzy-inference-system"},
                                          {"a.osgb", "application/x-openscenegraph"},
                                          {"a.dt1", "application/x-dted"},
                                          {"a.gpx", "application/gpx+xml"},
                                          {"a.pcap", "application/vnd.tcpdump.pcap"},
                                          {"a.tif", "image/tiff"},
                                          {"a.csv", "text/csv"}}) {
    writeFile(*dir_ / name, "{}");
    EXPECT_EQ(types.mimeTypeForFile(QString::fromStdString(*dir_ / name)).name().toStdString(), type) << name;
    EXPECT_THAT(text, HasSubstr(type + ';')) << "the desktop entry does not offer Trimtab for it";
  }
}

#define TRIMTAB_NEEDS_ROOT() \
  if (!BareRoot::allowed())  \
  GTEST_SKIP() << "needs root, who may mount, to install packages in a root of their own"

TEST_F(Packages, flyTheSampleInABareRootAndLeaveNoFile) {
  TRIMTAB_NEEDS_ROOT();
  const BareRoot& root = bareRoot();
  ASSERT_EQ(root.made().exitCode, 0) << root.made().out << root.made().err;
  const std::string before = root.files();
  const Ran installed = root.inside("dpkg --force-unsafe-io -i *.deb");
  ASSERT_EQ(installed.exitCode, 0) << installed.out << installed.err;

  const Ran flown = root.inside(
      "trimtab-cli terrain sample --size-km 6 -o s.tif && trimtab-cli terrain bake s.tif --objects "
      "s-objects.csv -o db && "
      "trimtab-ig --headless --terrain db --preset low-level --flight "
      "/usr/share/trimtab/flights/yecheon-circuit.csv "
      "--frames 5 --size 320x240 --screenshot ig.png --json >ig.json");
  EXPECT_EQ(flown.exitCode, 0) << flown.err;
  EXPECT_THAT(readFile(root.path() + "/tmp/ig.json"), HasSubstr("\"frames\": 5"));
  EXPECT_TRUE(std::filesystem::exists(root.path() + "/tmp/ig.png"));

  const Ran shown = root.inside("trimtab --terrain db --size 1280x800 --screenshot window.png",
                                "xvfb-run -a -s \"-screen 0 1600x1000x24\"");
  EXPECT_EQ(shown.exitCode, 0) << shown.err;
  EXPECT_TRUE(std::filesystem::exists(root.path() + "/tmp/window.png"));

  // A program that was linked elsewhere finds the shared library by its soname.
  const std::string usr = root.path() + "/usr";
  const Ran linked =
      run("export PKG_CONFIG_PATH=$(dirname $(find " + usr + " -name trimtab.pc)); cc -std=c99 " + usr +
          "/share/doc/trimtab/examples/decide.c $(pkg-config --cflags --libs trimtab) -o " + root.path() +
          "/tmp/decide");
  ASSERT_EQ(linked.exitCode, 0) << linked.err;
  writeFile(root.path() + "/tmp/states", "0 36.6 128.3 900 90 -5 0 nan nan nan\n");
  const Ran decided = root.inside("./decide /usr/share/trimtab/presets/default.json states");
  EXPECT_EQ(decided.exitCode, 0) << decided.err;
  EXPECT_EQ(std::count(decided.out.begin(), decided.out.end(), '\n'), 1) << decided.out;

  const Ran removed = root.inside("dpkg --purge trimtab trimtab-cli libtrimtab1 libtrimtab-dev");
  ASSERT_EQ(removed.exitCode, 0) << removed.out << removed.err;
  const std::string after = root.files();
  EXPECT_TRUE(after == before) << [&] {
    writeFile(root.path() + "/tmp/before", before);
    writeFile(root.path() + "/tmp/after", after);
    return run("diff " + root.path() + "/tmp/before " + root.path() + "/tmp/after | head -20").out;
  }();
}

TEST_F(Packages, areRefusedWithoutWhatTheyDependOn) {
  TRIMTAB_NEEDS_ROOT();
  const BareRoot& root = bareRoot();
  ASSERT_EQ(root.made().exitCode, 0) << root.made().out << root.made().err;
  const Ran ran = root.inside("dpkg --force-unsafe-io -i trimtab_*.deb libtrimtab-dev_*.deb");
  EXPECT_NE(ran.exitCode, 0);
  EXPECT_THAT(ran.err, HasSubstr("trimtab depends on trimtab-cli"));
  EXPECT_THAT(ran.err, HasSubstr("libtrimtab-dev depends on libtrimtab1"));
  EXPECT_EQ(root.inside("dpkg --purge trimtab libtrimtab-dev").exitCode, 0);
}

}  // namespace
}  // namespace trimtab::test
