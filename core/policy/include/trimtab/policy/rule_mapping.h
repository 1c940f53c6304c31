#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab {

/// Says which signal an input of a rule file is, or which lever an output: variable = key * scale + offset.
/// The file's numbers are converted, so "Speed = speed * 0.514" is right for a file in m/s, as speed is in
/// kt.
struct RuleVariable {
  std::string variable;  ///< as the file names it
  std::string key;       ///< of a signal or a lever
  double scale = 1, offset = 0;
};

/// Reads "Speed=speed*0.514, Bank angle=roll, Out=lod_scale*10-1": scale and offset may be left out. Whether
/// the keys exist is seen where the file is read.
Result<std::vector<RuleVariable>> readRuleMapping(std::string_view text, const std::string& where);

}  // namespace trimtab
