// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_choice.h"

#include <QComboBox>
#include <QCompleter>
#include <QGridLayout>
#include <QLineEdit>
#include <cmath>

#include "app/harness/sweep.h"
#include "trimtab/preset/table.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

constexpr int kProposed = 5;

/// A few values from end to end of the usual range, as a slider would reach them; all names of a choice.
QStringList proposed(const ParameterRow& row) {
  QStringList values;
  for (const ChoiceOption& choice : row.choices) values << views::fromView(choice.name);
  if (!values.isEmpty()) return values;
  const bool logarithmic = row.logarithmic && row.usual.low > 0;
  for (int i = 0; i < kProposed; ++i) {
    const double part = double(i) / (kProposed - 1);
    const double value = logarithmic ? row.usual.low * std::pow(row.usual.high / row.usual.low, part)
                                     : row.usual.low + (row.usual.high - row.usual.low) * part;
    const QString text =
        QString::number(std::stod(QString::number(value, 'f', row.whole ? 0 : row.decimals).toStdString()));
    if (!values.contains(text)) values << text;
  }
  return values;
}

bool isSwept(const ParameterRow& row) {
  return row.kind == Kind::scalar || row.kind == Kind::choice;
}

}  // namespace

SweepChoice::SweepChoice(QWidget* parent) : QWidget(parent) {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  int line = 0;
  for (Axis& axis : axes_) {
    axis = {new QComboBox(this), new QLineEdit(this)};
    axis.key->addItem(tr("no parameter"), QString());
    for (const ParameterRow& row : parameterRows())
      if (isSwept(row))
        axis.key->addItem(
            QStringLiteral("%1  (%2)").arg(views::fromView(row.label), views::fromView(row.key)),
            views::fromView(row.key));
    axis.key->setEditable(true);
    axis.key->setInsertPolicy(QComboBox::NoInsert);
    axis.key->completer()->setFilterMode(Qt::MatchContains);
    axis.key->completer()->setCompletionMode(QCompleter::PopupCompletion);
    axis.key->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    axis.key->setMinimumContentsLength(24);
    axis.key->setAccessibleName(line == 0 ? tr("First parameter to sweep") : tr("Second parameter to sweep"));
    axis.values->setPlaceholderText(tr("values with commas between"));
    axis.values->setAccessibleName(line == 0 ? tr("Values of the first parameter")
                                             : tr("Values of the second parameter"));
    grid->addWidget(axis.key, line, 0);
    grid->addWidget(axis.values, line++, 1);
    axis.values->setEnabled(false);
    connect(axis.key, &QComboBox::editTextChanged, this, [this, &axis] {
      readKey(axis);
      emit changed();
    });
    connect(axis.values, &QLineEdit::textChanged, this, &SweepChoice::changed);
  }
  grid->setColumnStretch(0, 3);
  grid->setColumnStretch(1, 2);
}

/// Returns the key of the parameter that the field names by its entry in the list or by its key; empty if it
/// names none on purpose, and nothing if no parameter is called so. The index does not say it: it stays where
/// it was while a person types.
std::optional<QString> SweepChoice::keyOf(const Axis& axis) {
  const QString text = axis.key->currentText().trimmed();
  if (text.isEmpty()) return QString();
  int index = axis.key->findText(text, Qt::MatchFixedString);
  if (index < 0) index = axis.key->findData(text, Qt::UserRole, Qt::MatchFixedString);
  if (index < 0) return std::nullopt;
  return axis.key->itemData(index).toString();
}

/// Marks a field that names no parameter; proposes values where it names another one than before.
void SweepChoice::readKey(Axis& axis) {
  const std::optional<QString> key = keyOf(axis);
  views::setInk(*axis.key->lineEdit(), key ? views::Ink::plain : views::Ink::error);
  axis.key->setToolTip(key ? QString() : tr("No parameter is called this: choose one of the list"));
  if (!key || *key == axis.proposedFor) return;
  axis.proposedFor = *key;
  propose(axis);
}

void SweepChoice::propose(const Axis& axis) {
  const ParameterRow* const row = findRow(axis.proposedFor.toStdString());
  axis.values->setEnabled(row != nullptr);
  axis.values->setText(row == nullptr ? QString() : proposed(*row).join(QStringLiteral(", ")));
}

void SweepChoice::choose(std::size_t axis, const QString& key, const QString& values) {
  axes_[axis].key->setCurrentIndex(axes_[axis].key->findData(key));
  if (!values.isEmpty()) axes_[axis].values->setText(values);
}

QStringList SweepChoice::valuesOf(const Axis& axis) const {
  QStringList values;
  for (const QString& value : axis.values->text().split(QLatin1Char(','))) values << value.trimmed();
  return values;
}

QStringList SweepChoice::sweeps() const {
  QStringList sweeps;
  for (const Axis& axis : axes_)
    if (const QString key = keyOf(axis).value_or(QString()); !key.isEmpty())
      sweeps << key + QLatin1Char('=') + valuesOf(axis).join(QLatin1Char(','));
  return sweeps;
}

int SweepChoice::presets() const {
  int count = 1;
  for (const Axis& axis : axes_)
    if (!keyOf(axis).value_or(QString()).isEmpty()) count *= int(valuesOf(axis).size());
  return count;
}

QString SweepChoice::fault() const {
  for (const Axis& axis : axes_)
    if (!keyOf(axis)) return tr("No parameter is called “%1”").arg(axis.key->currentText().trimmed());
  if (keyOf(axes_[0]) == keyOf(axes_[1]) && !keyOf(axes_[0])->isEmpty())
    return tr("Both parameters to sweep are the same");
  for (const QString& sweep : sweeps()) {
    const Result<harness::SweepAxis> axis = harness::parseAxis(sweep.toStdString());
    if (!axis)
      return tr("%1: %2 expected").arg(sweep, QString::fromStdString(axis.findings().front().expected));
    const ParameterRow& row = *findRow(axis->key);
    for (const std::string& text : axis->values) {
      const Result<ParameterValue> value = parseValue(row, text);
      const double* const number = value ? std::get_if<double>(&*value) : nullptr;
      if (!value || (number != nullptr && !(*number >= row.hard.low && *number <= row.hard.high)))
        return tr("%1 is no value of %2").arg(QString::fromStdString(text), views::fromView(row.label));
    }
  }
  return {};
}

}  // namespace trimtab::workbench
