#include "support.h"

namespace trimtab::test {

std::filesystem::path sourceDir() {
  return TRIMTAB_SOURCE_DIR;
}

std::filesystem::path programDir() {
  return TRIMTAB_BIN_DIR;
}

}  // namespace trimtab::test
