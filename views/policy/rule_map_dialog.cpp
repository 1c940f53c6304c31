// SPDX-License-Identifier: GPL-3.0-or-later
#include "rule_map_dialog.h"

#include <QCheckBox>
#include <QDialogButtonBox>
#include <QGridLayout>
#include <QLabel>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>

#include "trimtab/policy/levers.h"
#include "trimtab/policy/signals.h"
#include "views/controls/chooser.h"
#include "views/controls/conversion_edit.h"
#include "views/controls/scrollable.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr int kDigits = 4, kFindingLines = 5;

QString withUnit(const QString& text, std::string_view unit) {
  return unit.empty() ? text : text + QLatin1Char(' ') + fromView(unit);
}

QString spanText(double low, double high, std::string_view unit) {
  const auto number = [](double value) { return QLocale().toString(value, 'g', kDigits); };
  return withUnit(RuleMapDialog::tr("%1 to %2").arg(number(low), number(high)), unit);
}

/// What a person is shown of a signal or of a lever.
struct KeyRow {
  std::string_view label, unit;
  Range range;
};
std::optional<KeyRow> rowOfKey(std::string_view key, bool input) {
  if (input) {
    const auto signal = signalNamed(key);
    if (!signal) return std::nullopt;
    const SignalRow& row = rowOf(*signal);
    return KeyRow{row.label, row.unit, row.range};
  }
  const auto lever = leverNamed(key);
  if (!lever) return std::nullopt;
  const LeverRow& row = rowOf(*lever);
  return KeyRow{row.label, row.unit, row.hard};
}

/// Lists signals or levers behind an entry that chooses none.
void fill(Chooser& chooser, bool input) {
  chooser.addItem(input ? RuleMapDialog::tr("choose a signal") : RuleMapDialog::tr("choose a lever"),
                  QString());
  const auto add = [&](const auto& rows) {
    for (const auto& row : rows) {
      const QString label = fromView(row.label);
      chooser.addItem(row.unit.empty() ? label : QStringLiteral("%1 (%2)").arg(label, fromView(row.unit)),
                      fromView(row.key));
    }
  };
  if (input)
    add(kSignalRows);
  else
    add(kLeverRows);
}

}  // namespace

RuleMapDialog::RuleMapDialog(RuleFile file, const QString& name, Import import, QWidget* parent)
    : QDialog(parent),
      file_(std::move(file)),
      import_(std::move(import)),
      differences_(new QLabel),
      result_(new QLabel),
      accept_(new QCheckBox(tr("&Accept a difference above 5 %, and keep the rules of the file"))),
      findings_(new QPlainTextEdit) {
  setObjectName(QStringLiteral("ruleMap"));
  setWindowTitle(tr("Signals and levers of %1").arg(name));
  auto* table = new QWidget;
  auto* grid = new QGridLayout(table);
  grid->setContentsMargins(0, 0, 0, 0);
  addLines(*grid, file_.inputs(), true);
  addLines(*grid, file_.outputs(), false);
  grid->setColumnStretch(2, 1);
  grid->setColumnStretch(4, 1);
  grid->setRowStretch(grid->rowCount(), 1);

  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel);
  ok_ = buttons->addButton(tr("&Import"), QDialogButtonBox::AcceptRole);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(buttons, &QDialogButtonBox::accepted, this, [this] {
    const auto policy = file_.policy(mapping(), accept_->isChecked());
    if (!policy) return;
    accept();
    import_(*policy, policy.findings());
  });
  for (QLabel* label : {differences_, result_}) {
    label->setWordWrap(true);
    label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  }
  differences_->setAccessibleName(tr("Difference of the surface"));
  result_->setAccessibleName(tr("What comes of the file"));
  findings_->setReadOnly(true);
  findings_->setTabChangesFocus(true);
  findings_->setAccessibleName(tr("What the reader says"));
  const int line = findings_->fontMetrics().lineSpacing();
  findings_->setFixedHeight(kFindingLines * line + 2 * findings_->frameWidth() + line / 2);
  accept_->setVisible(file_.acceptMatters());
  connect(accept_, &QCheckBox::toggled, this, &RuleMapDialog::refresh);

  auto* column = new QVBoxLayout(this);
  column->addWidget(scrollable(table, tr("Variables of the file")), 1);
  column->addWidget(differences_);
  column->addWidget(accept_, 0, Qt::AlignLeft);
  for (QWidget* each : std::initializer_list<QWidget*>{result_, findings_, buttons}) column->addWidget(each);
  for (const Line& each : lines_) {
    connect(each.key, &QComboBox::currentIndexChanged, this, &RuleMapDialog::refresh);
    connect(each.conversion, &ConversionEdit::edited, this, &RuleMapDialog::refresh);
  }
  refresh();
  constexpr int kWidth = 900, kLineHeight = 30, kAround = 330, kMostHeight = 640;
  resize(kWidth, std::min(kMostHeight, kAround + kLineHeight * static_cast<int>(lines_.size())));
}

void RuleMapDialog::addLines(QGridLayout& grid, const std::vector<RuleFile::Variable>& variables,
                             bool input) {
  const QStringList titles{input ? tr("Input") : tr("Output"), tr("Its range"),
                           input ? tr("is the signal") : tr("is the lever"),
                           input ? tr("number of the file = signal × scale + offset")
                                 : tr("number of the file = lever × scale + offset"),
                           input ? tr("so the signal goes over") : tr("so the lever goes over")};
  const int top = grid.rowCount();
  for (int i = 0; i < titles.size(); ++i) {
    auto* title = new QLabel(titles[i]);
    setInk(*title, Ink::quiet);
    grid.addWidget(title, top, i);
  }
  for (const RuleFile::Variable& variable : variables) {
    const QString name = QString::fromStdString(variable.name), key = QString::fromStdString(variable.key);
    Line line{variable, input,
              new Chooser(input ? tr("Signal of %1").arg(name) : tr("Lever of %1").arg(name)),
              new ConversionEdit(name), new QLabel};
    fill(*line.key, input);
    // The output of the former rule base is no lever by its own name.
    if (line.key->findData(key) < 0) line.key->addItem(key, key);
    line.key->setCurrentIndex(line.key->findData(key));
    auto* label = new QLabel(name);
    label->setBuddy(line.key);
    const int row = grid.rowCount();
    grid.addWidget(label, row, 0);
    grid.addWidget(new QLabel(spanText(variable.range.low, variable.range.high, {})), row, 1);
    grid.addWidget(line.key, row, 2);
    grid.addWidget(line.conversion, row, 3);
    grid.addWidget(line.range, row, 4);
    lines_.push_back(line);
  }
}

std::vector<RuleVariable> RuleMapDialog::mapping() const {
  std::vector<RuleVariable> mapping;
  for (const Line& line : lines_) {
    const std::string key = line.key->currentData().toString().toStdString();
    const double scale = line.conversion->scale().value_or(1), offset = line.conversion->offset().value_or(0);
    const bool byName = key == line.variable.key && scale == 1 && offset == 0;
    if (!key.empty() && !byName) mapping.push_back({line.variable.name, key, scale, offset});
  }
  return mapping;
}

/// Says where the file's range lies in the unit of the signal or lever, beside what that can be.
void RuleMapDialog::showRange(const Line& line) const {
  const auto row = rowOfKey(line.key->currentData().toString().toStdString(), line.input);
  const auto scale = line.conversion->scale(), offset = line.conversion->offset();
  if (!row || !scale || !offset) return line.range->clear();
  const double ends[] = {(line.variable.range.low - *offset) / *scale,
                         (line.variable.range.high - *offset) / *scale};
  line.range->setText(tr("%1, of %2")
                          .arg(spanText(std::min(ends[0], ends[1]), std::max(ends[0], ends[1]), row->unit),
                               spanText(row->range.low, row->range.high, {})));
}

void RuleMapDialog::refresh() {
  QStringList open;
  bool numbers = true;
  for (const Line& line : lines_) {
    showRange(line);
    if (line.key->currentData().toString().isEmpty()) open << QString::fromStdString(line.variable.name);
    numbers = numbers && line.conversion->scale() && line.conversion->offset();
  }
  QStringList differences;
  for (const Finding& finding : file_.differences(accept_->isChecked()))
    if (finding.key.starts_with("difference of "))
      differences << QString::fromStdString(finding.key + ": " + finding.found);
  differences_->setText(differences.join(QLatin1Char('\n')));
  differences_->setVisible(!differences.isEmpty());

  const auto say = [this](bool good, const QString& result, const Findings& findings) {
    ok_->setEnabled(good);
    setInk(*result_, good ? Ink::plain : Ink::error);
    result_->setText(result);
    findings_->setPlainText(QString::fromStdString(toString(findings)));
  };
  if (!open.isEmpty())
    return say(false, tr("Still to be chosen: %1").arg(open.join(QStringLiteral(", "))),
               file_.differences(accept_->isChecked()));
  if (!numbers) return say(false, tr("A scale is a number that is not 0, and an offset a number."), {});
  const auto policy = file_.policy(mapping(), accept_->isChecked());
  say(policy.ok(),
      policy ? tr("The policy has %1 terms and %2 rules.").arg(policy->terms.size()).arg(policy->rules.size())
             : tr("The file cannot be imported so."),
      policy.findings());
}

}  // namespace trimtab::views
