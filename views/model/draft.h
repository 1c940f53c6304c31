// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDateTime>
#include <QObject>
#include <QString>
#include <QUndoStack>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "trimtab/preset/preset.h"
#include "trimtab/preset/table.h"

namespace trimtab {
struct IgProfile;
}

namespace trimtab::views {

/// Groups edits that are one step for the person: all edits of one drag have the same token and are undone
/// together. Edits with 0 are never merged.
using MergeToken = int;

/// What the values of a draft are compared with and go back to.
enum class Reference {
  file,      ///< as the preset was opened, or saved last
  base,      ///< the preset that the file names as its base; the defaults if it names none that can be read
  defaults,  ///< the program's own
  pinned     ///< a snapshot that a person pinned; there may be none
};

/// One parameter before and after a step.
struct Change {
  const ParameterRow* row;
  ParameterValue before, after;
};
/// One step of the undo stack. `when` is the time of its last edit.
struct Step {
  QString text;
  QDateTime when;
  std::vector<Change> changes;
};

/// The preset that is being edited. Every edit goes through its undo stack and one validator. `active()`, the
/// last draft that passed, is what runs. Use it on the main thread only.
class Draft : public QObject {
  Q_OBJECT
 public:
  explicit Draft(QObject* parent = nullptr);

  const Preset& preset() const { return preset_; }
  const TuningParameters& parameters() const { return preset_.parameters; }
  /// Returns the values of a reference; null only for a pinned snapshot, while none is pinned.
  const TuningParameters* reference(Reference which) const;
  /// Returns how people call it: "the file", "the base", "the defaults", or the name of what is pinned.
  QString referenceName(Reference which) const;
  /// Reports whether the preset has a base whose values differ from the defaults.
  bool hasOwnBase() const { return ownBase_; }
  const ValidatedParameters& active() const { return active_; }
  /// Reports whether the draft breaks a rule, so that `active()` is an earlier one.
  bool isBroken() const { return broken_; }
  const Findings& findings() const { return findings_; }
  /// Returns the findings of one key, errors first.
  Findings findingsOf(std::string_view key) const;
  QUndoStack& undoStack() { return stack_; }
  bool isDirty() const { return !stack_.isClean(); }
  /// Returns a step of the undo stack, done or undone; `index` counts from 0, the oldest.
  Step step(int index) const;

  ParameterValue value(std::string_view key) const;
  /// Reports whether a value differs from its reference. Nothing differs from a snapshot that is not there.
  bool isChanged(std::string_view key, Reference from = Reference::file) const;

  /// Sets a value as one undo step ("Change Hysteresis"), or as part of the step with the same token and key.
  /// Returning to the value at which a token began removes the whole step. A number that is not finite or
  /// outside its row's hard range is refused with the reason; a broken rule is accepted and is among
  /// `findings()`.
  Findings setValue(std::string_view key, const ParameterValue& value, MergeToken token = 0);
  struct KeyValue {
    std::string_view key;
    ParameterValue value;
  };
  /// Sets several parameters as one undo step with a text of its own. With a token, later calls for the same
  /// keys in the same order are part of it. If one value is refused, nothing is changed.
  Findings setValues(std::span<const KeyValue> values, const QString& undoText, MergeToken token = 0);
  /// Does what setValue does, with typed text.
  Findings setText(std::string_view key, std::string_view text, MergeToken token = 0);
  void reset(std::string_view key, Reference to = Reference::file);
  void resetAll(Reference to = Reference::file);
  /// Takes over another preset's values as one undo step; name, base and file stay.
  void takeParameters(const TuningParameters& parameters, const QString& undoText);
  /// Starts over with another preset and an empty, clean undo stack.
  void load(const Preset& preset);
  /// Call this when the preset was written to its file: the values are the file's from now on.
  void markSaved();
  /// Makes values a reference that plots show behind what is edited. It stays when another preset is loaded.
  void pin(const QString& name, const TuningParameters& values);
  void unpin();
  /// Sets name and description, which are no parameters: this is no undo step and marks nothing as changed.
  void describe(const std::string& name, const std::string& description);

  MergeToken newToken() { return ++lastToken_; }

  /// Returns the image generator for which the preset is tuned; null if it is this program's own, which has
  /// every lever. It stays when another preset is loaded, and is no part of any step.
  const IgProfile* imageGenerator() const { return ig_.get(); }
  /// Returns the file of its profile.
  const QString& imageGeneratorFile() const { return igFile_; }
  void setImageGenerator(std::shared_ptr<const IgProfile> profile, const QString& file);

 signals:
  void valueChanged(
      const QString& key);  ///< one a key, also on load, undo and redo; active() is up to date by then
  void activeChanged();     ///< another set of parameters runs from the next frame on
  void findingsChanged();
  void loaded();
  void dirtyChanged(bool dirty);
  void referencesChanged();  ///< the file's values or those of the pinned snapshot are others
  void imageGeneratorChanged();

 private:
  class Edit;
  using Changes = std::vector<Change>;

  void apply(const Changes& changes, bool forward);
  void takeAll(const TuningParameters& to, const QString& text);
  void check();
  void announce(std::span<const ParameterRow* const> rows);

  Preset preset_;
  TuningParameters file_, base_;
  struct Pinned {
    QString name;
    TuningParameters values;
  };
  std::optional<Pinned> pinned_;
  ValidatedParameters active_;
  Findings findings_;
  bool broken_ = false, ownBase_ = false;
  bool activeMoved_ = false;
  QUndoStack stack_;
  MergeToken lastToken_ = 0;
  std::shared_ptr<const IgProfile> ig_;
  QString igFile_;
};

}  // namespace trimtab::views
