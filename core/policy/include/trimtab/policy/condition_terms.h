#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "trimtab/policy/signals.h"

/// The terms that the conditions of rules ask for.
namespace trimtab {

struct TermUse {
  Signal signal = Signal::altitude;
  std::string_view term;  ///< a part of the condition that was given; "any" is no term and is left out
};

/// Returns every term that a condition asks for, in the order of the text, as often as it stands there;
/// nothing for a condition that cannot be read.
std::vector<TermUse> termsIn(std::string_view condition);

/// Returns the condition with another name for one term; everything else stays as it was typed.
std::string withTermRenamed(std::string_view condition, Signal signal, std::string_view from,
                            std::string_view to);

}  // namespace trimtab
