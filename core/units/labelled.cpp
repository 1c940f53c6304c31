#include "trimtab/units/labelled.h"

namespace trimtab {

std::string_view label(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::warning:
      return "warning";
    case Severity::error:
      break;
  }
  return "error";
}

std::string labelled(const Findings& findings) {
  std::string lines;
  for (const Finding& finding : findings) {
    lines += label(finding.severity);
    lines += ": " + toString(finding) + '\n';
  }
  return lines;
}

}  // namespace trimtab
