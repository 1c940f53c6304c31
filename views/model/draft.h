// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>
#include <QUndoStack>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "trimtab/preset/preset.h"
#include "trimtab/preset/table.h"

namespace trimtab::views {

/// Groups edits that are one step to the person who makes them: all edits of one drag carry the same token
/// and undo together. 0 never merges.
using MergeToken = int;

/// The preset being edited. Every edit goes through its undo stack and one validator; what runs is
/// `active()`, the last draft that passed. Main thread only.
class Draft : public QObject {
  Q_OBJECT
 public:
  explicit Draft(QObject* parent = nullptr);

  const Preset& preset() const { return preset_; }
  const TuningParameters& parameters() const { return preset_.parameters; }
  /// What a reset goes back to: the base preset's values, or the defaults where it names none that can be
  /// read.
  const TuningParameters& baseline() const { return baseline_; }
  const ValidatedParameters& active() const { return active_; }
  /// True while the draft breaks a rule, so that `active()` lags behind it.
  bool isBroken() const { return broken_; }
  const Findings& findings() const { return findings_; }
  /// Of one key, errors first.
  Findings findingsOf(std::string_view key) const;
  QUndoStack& undoStack() { return stack_; }
  bool isDirty() const { return !stack_.isClean(); }

  ParameterValue value(std::string_view key) const;
  bool isChanged(std::string_view key) const;

  /// One undo step ("Change Hysteresis"), or part of the step that has the same token and key. Returning to
  /// the value a token started from takes the whole step away. A number that is not finite or outside its
  /// row's hard range is refused, with the reason; broken rules are accepted and found in `findings()`.
  Findings setValue(std::string_view key, const ParameterValue& value, MergeToken token = 0);
  struct KeyValue {
    std::string_view key;
    ParameterValue value;
  };
  /// Several parameters as one undo step with a text of its own; with a token, later calls for the same keys
  /// in the same order are part of it. Nothing is changed when one of them is refused.
  Findings setValues(std::span<const KeyValue> values, const QString& undoText, MergeToken token = 0);
  /// As setValue, from typed text.
  Findings setText(std::string_view key, std::string_view text, MergeToken token = 0);
  void reset(std::string_view key);
  void resetAll();
  /// Another preset's values as one undo step; name, base and file stay.
  void takeParameters(const TuningParameters& parameters, const QString& undoText);
  /// Starts over with `preset`: the undo stack is emptied and clean.
  void load(const Preset& preset);
  /// Name and description are not parameters: no undo step, no dirty mark.
  void describe(const std::string& name, const std::string& description);

  MergeToken newToken() { return ++lastToken_; }

 signals:
  void valueChanged(
      const QString& key);  ///< one a key, also on load, undo and redo; active() is up to date by then
  void activeChanged();     ///< another set of parameters runs from the next frame on
  void findingsChanged();
  void loaded();
  void dirtyChanged(bool dirty);

 private:
  class Edit;
  struct Change {
    const ParameterRow* row;
    ParameterValue before, after;
  };
  using Changes = std::vector<Change>;

  void apply(const Changes& changes, bool forward);
  void takeAll(const TuningParameters& to, const QString& text);
  void check();
  void announce(std::span<const ParameterRow* const> rows);

  Preset preset_;
  TuningParameters baseline_;
  ValidatedParameters active_;
  Findings findings_;
  bool broken_ = false;
  bool activeMoved_ = false;
  QUndoStack stack_;
  MergeToken lastToken_ = 0;
};

}  // namespace trimtab::views
