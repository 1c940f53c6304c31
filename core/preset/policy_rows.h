#pragma once

#include "rows.h"

/// Rows of the policy.
namespace trimtab::table {

inline constexpr std::array kPolicyRows{
    row<&TuningParameters::policy, &PolicyParameters::enabled>(
        {.key = "policy.enabled",
         .label = "Policy",
         .help =
             "Lets the rules of the policy set the levers that they name, in place of the fixed numbers of "
             "the preset. What no rule names stays as it is."}),
    row<&TuningParameters::policy, &PolicyParameters::norm>(
        {.key = "policy.norm",
         .label = "And, or",
         .help =
             "How memberships combine: the smaller and the larger, or the product and the algebraic sum. The "
             "product counts every condition, the minimum only the weakest."}),
    row<&TuningParameters::policy, &PolicyParameters::terms>(
        {.key = "policy.terms",
         .label = "Terms",
         .help =
             "What the rules call low, fast or steep: a signal, a name and a shape with its numbers in the "
             "signal's unit, one term a line, such as `above_ground low = ramp 2000 1000`. Shapes are "
             "points, "
             "triangle, trapezoid, ramp, gaussian, bell and sigmoid."}),
    row<&TuningParameters::policy, &PolicyParameters::rules>(
        {.key = "policy.rules",
         .label = "Rules",
         .help =
             "One rule a line, such as `if above_ground is low and speed is fast then screen_space_error = 4 "
             "with 0.5 # why`. Each lever becomes the mean of what the rules that fire give it, weighted by "
             "firing times weight, and moves there without jumps. `off ` before a rule switches it off.",
         .source = "A, B: Eq. 2"})};

}  // namespace trimtab::table
