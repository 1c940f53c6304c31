// SPDX-License-Identifier: GPL-3.0-or-later
#include "draft.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "views/model/theme.h"

namespace trimtab::views {

namespace {

std::string rangeText(const ParameterRow& row) {
  std::string said = "a number from ";
  said += toText(row, row.hard.low);
  said += " to ";
  said += toText(row, row.hard.high);
  if (!row.unit.empty()) said.append(" ").append(row.unit);
  return said;
}

/// Returns why a value is refused because no editor could show or store it. The validator judges everything
/// else.
Findings refusals(const ParameterRow& row, const ParameterValue& value) {
  const auto refuse = [&](std::string expected, std::string found) {
    return Findings{{Severity::error, "", std::string(row.key), std::move(expected), std::move(found)}};
  };
  if (const double* number = std::get_if<double>(&value)) {
    // Written so that NaN is refused too.
    if (!(*number >= row.hard.low && *number <= row.hard.high))
      return refuse(rangeText(row), toText(row, value));
    if (row.whole && *number != std::floor(*number)) return refuse("a whole number", toText(row, value));
  } else if (const ChoiceIndex* choice = std::get_if<ChoiceIndex>(&value)) {
    if (choice->index >= row.choices.size())
      return refuse("one of " + std::to_string(row.choices.size()) + " choices",
                    std::to_string(choice->index));
  } else if (const CurvePoints* curve = std::get_if<CurvePoints>(&value)) {
    for (const CurvePoint& p : curve->span())
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) return refuse("finite numbers", toText(row, value));
  } else if (const BandList* bands = std::get_if<BandList>(&value)) {
    for (const Band& b : bands->span())
      if (!std::isfinite(b.low)) return refuse("finite numbers", toText(row, value));
  }
  return {};
}

bool sameValues(const TuningParameters& a, const TuningParameters& b) {
  return std::ranges::all_of(parameterRows(),
                             [&](const ParameterRow& row) { return row.get(a) == row.get(b); });
}

}  // namespace

/// The one undo command of the program holds the values before and after.
class Draft::Edit : public QUndoCommand {
 public:
  Edit(Draft& draft, Changes changes, const QString& what, MergeToken token)
      : QUndoCommand(what), draft_(draft), changes_(std::move(changes)), token_(token) {}

  int id() const override { return token_ == 0 ? -1 : token_; }
  void redo() override { draft_.apply(changes_, true); }
  void undo() override { draft_.apply(changes_, false); }
  bool mergeWith(const QUndoCommand* other) override {
    const Changes& later = static_cast<const Edit*>(other)->changes_;
    if (!std::ranges::equal(changes_, later, {}, &Change::row, &Change::row)) return false;
    for (std::size_t i = 0; i < changes_.size(); ++i) changes_[i].after = later[i].after;
    when_ = QDateTime::currentDateTime();
    setObsolete(
        std::ranges::all_of(changes_, [](const Change& change) { return change.before == change.after; }));
    return true;
  }
  Step step() const { return {text(), when_, changes_}; }

 private:
  Draft& draft_;
  Changes changes_;
  MergeToken token_;
  QDateTime when_ = QDateTime::currentDateTime();
};

Draft::Draft(QObject* parent) : QObject(parent), active_(defaultParameters()) {
  connect(&stack_, &QUndoStack::cleanChanged, this, [this](bool clean) { emit dirtyChanged(!clean); });
  check();
}

Findings Draft::findingsOf(std::string_view key) const {
  Findings found;
  std::ranges::copy_if(findings_, std::back_inserter(found), [&](const Finding& f) { return f.key == key; });
  std::ranges::stable_sort(found, [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
  return found;
}

ParameterValue Draft::value(std::string_view key) const {
  const ParameterRow* row = findRow(key);
  Q_ASSERT(row);
  return row->get(preset_.parameters);
}

const TuningParameters* Draft::reference(Reference which) const {
  static const TuningParameters kDefaults;
  switch (which) {
    case Reference::file:
      return &file_;
    case Reference::base:
      return &base_;
    case Reference::pinned:
      return pinned_ ? &pinned_->values : nullptr;
    case Reference::defaults:
      break;
  }
  return &kDefaults;
}

QString Draft::referenceName(Reference which) const {
  switch (which) {
    case Reference::file:
      return tr("the file");
    case Reference::base:
      return tr("the base");
    case Reference::pinned:
      return pinned_ ? pinned_->name : tr("no snapshot");
    case Reference::defaults:
      break;
  }
  return tr("the defaults");
}

Step Draft::step(int index) const {
  return static_cast<const Edit*>(stack_.command(index))->step();
}

bool Draft::isChanged(std::string_view key, Reference from) const {
  const ParameterRow* row = findRow(key);
  const TuningParameters* values = reference(from);
  return row && values && row->get(preset_.parameters) != row->get(*values);
}

Findings Draft::setValue(std::string_view key, const ParameterValue& value, MergeToken token) {
  const ParameterRow* row = findRow(key);
  Q_ASSERT(row);
  const ParameterValue before = row->get(preset_.parameters);
  Q_ASSERT(before.index() == value.index());
  if (Findings refused = refusals(*row, value); !refused.empty()) return refused;
  if (before != value)
    stack_.push(new Edit(*this, {{row, before, value}}, tr("Change %1").arg(fromView(row->label)), token));
  return {};
}

Findings Draft::setValues(std::span<const KeyValue> values, const QString& undoText, MergeToken token) {
  Changes changes;
  bool any = false;
  for (const KeyValue& each : values) {
    const ParameterRow* row = findRow(each.key);
    Q_ASSERT(row);
    if (Findings refused = refusals(*row, each.value); !refused.empty()) return refused;
    changes.push_back({row, row->get(preset_.parameters), each.value});
    any = any || changes.back().before != each.value;
  }
  // What does not change now stays in the list: steps merge by their rows.
  if (any) stack_.push(new Edit(*this, std::move(changes), undoText, token));
  return {};
}

Findings Draft::setText(std::string_view key, std::string_view typed, MergeToken token) {
  const ParameterRow* row = findRow(key);
  Q_ASSERT(row);
  const Result<ParameterValue> parsed = parseValue(*row, typed);
  return parsed ? setValue(key, *parsed, token) : parsed.findings();
}

void Draft::reset(std::string_view key, Reference to) {
  const ParameterRow* row = findRow(key);
  const TuningParameters* values = reference(to);
  Q_ASSERT(row);
  if (!values) return;
  const ParameterValue before = row->get(preset_.parameters), after = row->get(*values);
  if (before != after)
    stack_.push(new Edit(*this, {{row, before, after}}, tr("Reset %1").arg(fromView(row->label)), 0));
}

void Draft::resetAll(Reference to) {
  if (const TuningParameters* values = reference(to))
    takeAll(*values, tr("Reset All to %1").arg(referenceName(to)));
}

void Draft::takeParameters(const TuningParameters& parameters, const QString& undoText) {
  takeAll(parameters, undoText);
}

void Draft::takeAll(const TuningParameters& to, const QString& what) {
  Changes changes;
  for (const ParameterRow& row : parameterRows()) {
    const ParameterValue before = row.get(preset_.parameters), after = row.get(to);
    if (before != after) changes.push_back({&row, before, after});
  }
  if (!changes.empty()) stack_.push(new Edit(*this, std::move(changes), what, 0));
}

void Draft::load(const Preset& preset) {
  preset_ = preset;
  const Result<TuningParameters> base = baseParameters(preset);
  base_ = base ? *base : *defaultParameters();
  ownBase_ = !sameValues(base_, *reference(Reference::defaults));
  file_ = preset.parameters;
  stack_.clear();
  check();
  emit loaded();
  emit referencesChanged();
  std::vector<const ParameterRow*> rows;
  for (const ParameterRow& row : parameterRows()) rows.push_back(&row);
  announce(rows);
}

void Draft::markSaved() {
  file_ = preset_.parameters;
  stack_.setClean();
  emit referencesChanged();
}

void Draft::pin(const QString& name, const TuningParameters& values) {
  pinned_ = {name, values};
  emit referencesChanged();
}

void Draft::unpin() {
  if (!std::exchange(pinned_, std::nullopt)) return;
  emit referencesChanged();
}

void Draft::describe(const std::string& name, const std::string& description) {
  preset_.name = name;
  preset_.description = description;
}

void Draft::apply(const Changes& changes, bool forward) {
  std::vector<const ParameterRow*> rows;
  for (const Change& change : changes) {
    change.row->set(preset_.parameters, forward ? change.after : change.before);
    rows.push_back(change.row);
  }
  check();
  announce(rows);
}

void Draft::setImageGenerator(std::shared_ptr<const IgProfile> profile, const QString& file) {
  // Who shows the earlier one may still refer to it while the change is announced.
  const std::shared_ptr<const IgProfile> before = std::exchange(ig_, std::move(profile));
  igFile_ = ig_ ? file : QString();
  emit imageGeneratorChanged();
}

void Draft::check() {
  Result<ValidatedParameters> result = validate(preset_.parameters);
  findings_ = result.findings();
  broken_ = !result;
  activeMoved_ = result && !sameValues(**result, *active_);
  if (activeMoved_) active_ = *result;
}

void Draft::announce(std::span<const ParameterRow* const> rows) {
  const bool moved = activeMoved_;
  for (const ParameterRow* row : rows) emit valueChanged(fromView(row->key));
  emit findingsChanged();
  if (moved) emit activeChanged();
}

}  // namespace trimtab::views
