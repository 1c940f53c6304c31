#include "trimtab/policy/condition_terms.h"

#include "condition.h"

namespace trimtab {

std::vector<TermUse> termsIn(std::string_view condition) {
  std::vector<TermUse> uses;
  if (const auto steps = readCondition(condition, "", ""))
    for (const ConditionStep& step : *steps)
      if (step.kind == ConditionStep::Kind::proposition && step.term != "any")
        uses.push_back({step.signal, step.term});
  return uses;
}

std::string withTermRenamed(std::string_view condition, Signal signal, std::string_view from,
                            std::string_view to) {
  std::string text;
  const char* copied = condition.data();
  for (const TermUse& use : termsIn(condition)) {
    if (use.signal != signal || use.term != from) continue;
    text.append(copied, use.term.data());
    text += to;
    copied = use.term.data() + use.term.size();
  }
  return text.append(copied, condition.data() + condition.size());
}

}  // namespace trimtab
