#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "trimtab/preset/parameters.h"
#include "trimtab/units/result.h"

/// The parameter table: one row for each field of TuningParameters, checked by the compiler. Panels, files,
/// the command line, undo text, validation and the reference page all derive from it.
namespace trimtab {

struct Range {
  double low = 0, high = 0;
};

enum class Kind { scalar, flag, choice, curve, bands, rules };
enum class Tier { basic, advanced };
/// What has to be done again when the parameter changes.
enum class Effect { next_frame, resize, host };

/// A row's value whatever its kind: scalar, flag, index into the row's choices, curve, bands, rules.
struct ChoiceIndex {
  std::size_t index = 0;
  friend constexpr bool operator==(ChoiceIndex, ChoiceIndex) = default;
};
using ParameterValue = std::variant<double, bool, ChoiceIndex, CurvePoints, BandList, RuleList>;

struct ChoiceOption {
  std::string_view name;   ///< as files spell it
  std::string_view label;  ///< as people read it
};

struct ParameterRow {
  std::string_view key;     ///< "fuzzy.hysteresis"; ends in the unit's suffix
  std::string_view label;   ///< a few words, no unit
  std::string_view help;    ///< what it does and what to watch; never the default or the range
  std::string_view source;  ///< document and equation or table; empty where it is ours
  Range hard;               ///< refused outside (a curve's x; a band's width and height; a rule's weight)
  Range usual;              ///< a slider's travel; a warning outside
  double step = 1;
  int decimals = 0;
  Tier tier = Tier::basic;
  Effect effect = Effect::next_frame;
  bool logarithmic = false;  ///< a slider should be exponential
  bool whole = false;        ///< only whole numbers
  Kind kind = Kind::scalar;
  std::string_view unit;  ///< symbol; of x for a curve
  std::span<const ChoiceOption> choices;
  ParameterValue (*get)(const TuningParameters&) = nullptr;
  void (*set)(TuningParameters&, const ParameterValue&) = nullptr;  ///< the value must have the row's kind
};

/// All rows, in the order people should read them (grouped by the first part of the key).
std::span<const ParameterRow> parameterRows();
/// Null where there is no such key (old names of renamed keys are found by migration, not here).
const ParameterRow* findRow(std::string_view key);

/// A value as text: C locale, shortest form that reads back bit for bit; a choice by its name; a curve as
/// "4000:1 5000:0.6"; bands as "0.1:320x240 0.5:400x300"; rules as "low&down*1=2 high*0.5=0".
std::string toText(const ParameterRow& row, const ParameterValue& value);
/// The inverse; findings say what was expected. A scalar may carry a unit ("4000 ft"), which is converted to
/// the row's when both measure the same thing. Refuses what is no finite number; ranges and rules are
/// validate()'s.
Result<ParameterValue> parseValue(const ParameterRow& row, std::string_view text);

/// Parameters that passed every rule. There is no other way to get one, so unchecked numbers do not reach
/// decide().
class ValidatedParameters {
 public:
  const TuningParameters& operator*() const { return parameters_; }
  const TuningParameters* operator->() const { return &parameters_; }

 private:
  friend Result<ValidatedParameters> validate(const TuningParameters&);
  explicit ValidatedParameters(const TuningParameters& p) : parameters_(p) {}
  TuningParameters parameters_;
};

/// Every broken range and rule as an error, every value outside its usual range as a warning (with the
/// value). Rules are asked once every range holds. Does not allocate while nothing is wrong.
Result<ValidatedParameters> validate(const TuningParameters& parameters);
/// The defaults, validated.
ValidatedParameters defaultParameters();

}  // namespace trimtab
