// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <QApplication>
#include <clocale>
#include <cstdlib>

#include "app/workbench/viewport/gl_setup.h"
#include "tests/support.h"

/// Settings, recovered edits and baked terrain of these tests stay in a folder of their own.
int main(int argc, char** argv) {
  const trimtab::test::ScratchDir home;
  for (const char* name : {"XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME", "XDG_RUNTIME_DIR", "HOME"})
    ::setenv(name, home.path().c_str(), 1);
  ::testing::InitGoogleTest(&argc, argv);
  trimtab::workbench::prepareGl();
  QApplication app(argc, argv);
  std::setlocale(LC_NUMERIC, "C");
  trimtab::workbench::nameApplication();
  QApplication::setQuitOnLastWindowClosed(false);
  return RUN_ALL_TESTS();
}
