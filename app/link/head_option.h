#pragma once

#include <string>

#include "trimtab/host/head_log.h"
#include "trimtab/units/result.h"

namespace trimtab::link {

/// Opens what `--head` names, a log or a sweep, for a program that has the option `--skip-bad-rows`. If the
/// log is refused only because of rows that cannot be used, the last finding says that the option leaves them
/// out.
Result<HeadLog> openHeadOption(const std::string& head, bool skipBadRows);

}  // namespace trimtab::link
