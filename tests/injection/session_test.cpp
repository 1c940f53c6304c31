// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/workbench/controllers/saved_session.h"
#include "injection.h"

/// The session file of the workbench.
namespace trimtab {
namespace {

namespace fs = std::filesystem;
using test::Injection;

workbench::SavedSession session() {
  workbench::SavedSession session;
  session.preset = QStringLiteral("default");
  session.workspace = QStringLiteral("Fly");
  session.views = {{QStringLiteral("here"), {Degrees{36.6}, Degrees{128.3}, Metres{2000}}, {}}};
  return session;
}

TEST_F(Injection, ofASavedSession) {
  const auto file = [](const fs::path& folder) {
    return QString::fromStdString((folder / "s.session.json").string());
  };
  writes("saved session",
         {.begin = [](const fs::path& folder) { test::writeFile(folder / "s.session.json", "{}"); },
          .work =
              [&](const fs::path& folder) {
                const auto done = workbench::writeSession(file(folder), session());
                return done ? Findings{} : done.findings();
              },
          .mayStay = [](const std::string& name) { return name.starts_with(".s.session.json.trimtab-"); }});
  reads("reading a saved session",
        {[&](const fs::path& folder) { EXPECT_TRUE(workbench::writeSession(file(folder), session())); },
         [&](const fs::path& folder) -> Result<std::string> {
           const auto read = workbench::readSession(file(folder));
           if (!read) return read.findings();
           return read->preset.toStdString() + ' ' + std::to_string(read->views.size());
         }});
}

}  // namespace
}  // namespace trimtab
