#include "trimtab/units/finding_list.h"

#include "trimtab/units/labelled.h"

namespace trimtab {

Findings FindingList::all(const std::string& where) const {
  Findings all = findings_;
  for (const Severity severity : {Severity::error, Severity::warning, Severity::note}) {
    const std::size_t count = count_[static_cast<std::size_t>(severity)];
    if (count <= kMost) continue;
    std::string more = std::to_string(count - kMost);
    const bool one = more == "1";
    for (std::size_t at = more.size(); at > 3; at -= 3) more.insert(at - 3, ",");
    all.push_back(
        {severity, where, "", "", more + " more " + std::string(label(severity)) + (one ? "" : "s")});
  }
  return all;
}

Findings firstOf(const Findings& findings, const std::string& where) {
  FindingList list;
  list.add(findings);
  return list.all(where);
}

}  // namespace trimtab
