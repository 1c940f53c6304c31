#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

Progress stageOf(const Progress& progress, double from, double to) {
  return [&progress, from, to](double fraction, const std::string& what) {
    return !progress || progress(from + (to - from) * fraction, what);
  };
}

Finding cancelled(const std::string& what) {
  return {Severity::note, what, "", "to be completed", "cancelled"};
}

Finding unreadable(const std::string& what) {
  return {Severity::error, what, "", "rows that can be read", "others"};
}

}  // namespace trimtab::terrain
