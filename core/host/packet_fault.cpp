#include "packet_fault.h"

#include <charconv>

namespace trimtab {
namespace {

std::string shortest(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

}  // namespace

std::string toString(const PacketFault& fault) {
  return "byte " + std::to_string(fault.offset) + ": " + fault.field + ": expected " + fault.expected +
         ", found " + fault.found;
}

Finding toFinding(const PacketFault& fault, const std::string& from) {
  return {Severity::warning, from, "byte " + std::to_string(fault.offset) + ": " + fault.field,
          fault.expected, fault.found + (fault.remedy.empty() ? "" : "; " + fault.remedy)};
}

void FieldReader::refuse(std::size_t offset, const char* field, double lowest, double highest,
                         const char* unit, double value) {
  const std::string suffix = std::string(" ") + unit;
  fault_ = PacketFault{offset, field, shortest(lowest) + ".." + shortest(highest) + suffix,
                       shortest(value) + suffix};
}

}  // namespace trimtab
