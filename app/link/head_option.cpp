#include "head_option.h"

namespace trimtab::link {

Result<HeadLog> openHeadOption(const std::string& head, bool skipBadRows) {
  if (skipBadRows) return openHead(head, BadRows::leave_out);
  Result<HeadLog> log = openHead(head);
  if (log) return log;
  const Result<HeadLog> rest = openHead(head, BadRows::leave_out);
  if (!rest) return log;
  Findings findings = log.findings();
  const std::string rows = std::to_string(rest->rowsLeftOut) + (rest->rowsLeftOut == 1 ? " row" : " rows");
  findings.push_back(
      {Severity::note, head, "--skip-bad-rows", "this option, to leave " + rows + " out", "none"});
  return findings;
}

}  // namespace trimtab::link
