#include "head_option.h"

namespace trimtab::link {

Result<HeadLog> openHeadOption(const std::string& head, bool skipBadRows) {
  if (skipBadRows) return openHead(head, BadRows::leave_out);
  Result<HeadLog> log = openHead(head);
  if (log) return log;
  const Result<HeadLog> rest = openHead(head, BadRows::leave_out);
  if (!rest) return log;
  Findings findings = log.findings();
  findings.push_back({Severity::note, head, "--skip-bad-rows", "the option, to use the other rows",
                      "not given: it leaves " + std::to_string(rest->rowsLeftOut) + " rows out"});
  return findings;
}

}  // namespace trimtab::link
