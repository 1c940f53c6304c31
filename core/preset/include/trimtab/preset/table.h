#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "trimtab/preset/parameters.h"
#include "trimtab/units/range.h"
#include "trimtab/units/result.h"

/// The parameter table: one row for each field of TuningParameters, checked by the compiler. Panels, files,
/// the command line, undo text, validation and the reference page all derive from it.
namespace trimtab {

class CompiledPolicy;

enum class Kind { scalar, flag, choice, curve, bands, lines };
enum class Tier { basic, advanced };
/// Says from when on a changed parameter counts.
enum class Effect { next_frame, resize, host };

/// A value of any row: scalar, flag, index into the row's choices, curve, bands or lines of text.
struct ChoiceIndex {
  std::size_t index = 0;
  friend constexpr bool operator==(ChoiceIndex, ChoiceIndex) = default;
};
using ParameterValue = std::variant<double, bool, ChoiceIndex, CurvePoints, BandList, TextLines>;

struct ChoiceOption {
  std::string_view name;   ///< as files spell it
  std::string_view label;  ///< as people read it
};

struct ParameterRow {
  std::string_view key;     ///< "fuzzy.hysteresis"; ends in the unit's suffix
  std::string_view label;   ///< a few words, no unit
  std::string_view help;    ///< what it does and what to watch; never the default or the range
  std::string_view source;  ///< document and equation or table; empty if it is ours
  Range hard;   ///< values outside are refused (a curve's x; a band's width and height; a rule's weight)
  Range usual;  ///< a slider's travel; values outside give a warning
  double step = 1;
  int decimals = 0;
  Tier tier = Tier::basic;
  Effect effect = Effect::next_frame;
  bool logarithmic = false;  ///< a slider should be exponential
  bool whole = false;        ///< only whole numbers
  Kind kind = Kind::scalar;
  std::string_view unit;  ///< its symbol; that of x for a curve
  std::span<const ChoiceOption> choices;
  ParameterValue (*get)(const TuningParameters&) = nullptr;
  void (*set)(TuningParameters&, const ParameterValue&) = nullptr;  ///< the value must have the row's kind
};

/// Returns all rows in reading order, grouped by the first part of the key.
std::span<const ParameterRow> parameterRows();
/// Returns the row with a key; null if there is none. Migration, not this function, finds old names of
/// renamed keys.
const ParameterRow* findRow(std::string_view key);

/// Returns a value as text in the C locale: a number in the shortest form that reads back bit for bit, a
/// choice by its name, a curve as "4000:1 5000:0.6", bands as "0.1:320x240 0.5:400x300", lines
/// with " | " between.
std::string toText(const ParameterRow& row, const ParameterValue& value);
/// Is the inverse; findings say what was expected. A scalar may have a unit ("4000 ft"), which is converted
/// to the row's if both have the same dimension. It refuses numbers that are not finite; validate() checks
/// ranges and rules.
Result<ParameterValue> parseValue(const ParameterRow& row, std::string_view text);

/// Parameters that passed every rule. Only validate() makes them, so unchecked numbers do not reach decide().
class ValidatedParameters {
 public:
  const TuningParameters& operator*() const { return parameters_; }
  const TuningParameters* operator->() const { return &parameters_; }
  /// Returns the policy that the parameters hold, compiled; null if it is switched off.
  const CompiledPolicy* policy() const { return policy_.get(); }

 private:
  friend Result<ValidatedParameters> validate(const TuningParameters&);
  ValidatedParameters(const TuningParameters& p, std::shared_ptr<const CompiledPolicy> policy)
      : parameters_(p), policy_(std::move(policy)) {}
  TuningParameters parameters_;
  std::shared_ptr<const CompiledPolicy> policy_;  ///< shared by copies: it never changes
};

/// Validates parameters. Every broken range and rule is an error, every value outside its usual range a
/// warning. Rules are checked only if every range holds. It allocates nothing if nothing is wrong, except for
/// a policy, which it compiles if it is switched on.
Result<ValidatedParameters> validate(const TuningParameters& parameters);
/// Returns the defaults, validated.
ValidatedParameters defaultParameters();

}  // namespace trimtab
