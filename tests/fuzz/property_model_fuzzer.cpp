#include <cstdlib>
#include <string>

#include "app/models/read_model.h"
#include "tests/support.h"

/// A FlightGear model list becomes a model with a level, or is refused with reasons.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  static const test::ScratchDir dir;
  static const bool made = [] {
    test::writeFile(dir / "part.obj", "o arm\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    return true;
  }();
  if (!made) return 0;
  test::writeFile(dir / "model.xml", std::string(reinterpret_cast<const char*>(data), size));
  const auto model = models::readModel(dir / "model.xml");
  if (model ? model->levels.empty() : model.findings().empty()) std::abort();
  return 0;
}
