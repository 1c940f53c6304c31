// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameter_line.h"

#include <QBoxLayout>
#include <QCheckBox>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QToolButton>

#include "choice_box.h"
#include "number_box.h"
#include "parameter_slider.h"
#include "views/model/keys.h"
#include "views/model/theme.h"

namespace trimtab::views {

namespace {

QString valueText(const ParameterRow& row, const ParameterValue& value) {
  switch (row.kind) {
    case Kind::flag:
      return std::get<bool>(value) ? QObject::tr("on") : QObject::tr("off");
    case Kind::choice:
      return fromView(row.choices[std::get<ChoiceIndex>(value).index].label);
    case Kind::curve:
      return QObject::tr("%1 points").arg(std::get<CurvePoints>(value).size);
    case Kind::bands:
      return QObject::tr("%1 bands").arg(std::get<BandList>(value).size);
    case Kind::rules:
      return QObject::tr("%1 rules").arg(std::get<RuleList>(value).size);
    case Kind::lines:
      return QObject::tr("%1 lines").arg(std::get<TextLines>(value).line.size());
    case Kind::scalar:
      break;
  }
  const QString unit =
      row.unit.empty() ? QString() : (row.unit == "°" ? QString() : QStringLiteral(" ")) + fromView(row.unit);
  return exactText(std::get<double>(value)) + unit;
}

}  // namespace

ParameterLine::ParameterLine(Draft& draft, const ParameterRow& row, QGridLayout& grid, int gridRow)
    : QObject(grid.parentWidget()),
      draft_(draft),
      row_(row),
      label_(new QLabel),
      default_(new QLabel),
      problem_(new QLabel),
      editor_(makeEditor()),
      field_(editor_),
      reset_(new QToolButton) {
  if (row.kind == Kind::scalar && row.usual.high > row.usual.low) {
    field_ = new QWidget;
    QHBoxLayout* both = new QHBoxLayout(field_);
    both->setContentsMargins(0, 0, 0, 0);
    both->addWidget(editor_);
    both->addWidget(new ParameterSlider(draft, row.key), 1);
  }
  if (key::hasEditor(row.key)) {
    field_ = new QWidget;
    QHBoxLayout* both = new QHBoxLayout(field_);
    both->setContentsMargins(0, 0, 0, 0);
    both->addWidget(editor_, 1);
    QToolButton* edit = new QToolButton;
    edit->setText(tr("Edit…"));
    edit->setAccessibleName(tr("Edit %1").arg(fromView(row.label)));
    edit->setToolTip(tr("Show the editor of %1").arg(fromView(row.label)));
    edit->setFocusPolicy(Qt::StrongFocus);
    connect(edit, &QToolButton::clicked, this, [this] { emit editorAsked(fromView(row_.key)); });
    both->addWidget(edit);
  }
  const QString help = helpText(row);
  label_->setBuddy(editor_);
  label_->setWordWrap(true);
  label_->setMinimumWidth(label_->fontMetrics().horizontalAdvance(QStringLiteral("membership offset")));

  default_->setMinimumWidth(default_->fontMetrics().horizontalAdvance(QStringLiteral("0.00001")));
  for (QWidget* widget : {static_cast<QWidget*>(label_), static_cast<QWidget*>(default_), field_})
    widget->setToolTip(help);
  reset_->setText(QStringLiteral("↺"));
  reset_->setAutoRaise(true);
  reset_->setFocusPolicy(Qt::StrongFocus);
  connect(reset_, &QToolButton::clicked, this, [this] { draft_.reset(row_.key); });
  problem_->setWordWrap(true);
  problem_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  problem_->hide();

  grid.addWidget(label_, gridRow, 0, Qt::AlignVCenter);
  grid.addWidget(field_, gridRow, 1, Qt::AlignVCenter);
  grid.addWidget(default_, gridRow, 2, Qt::AlignVCenter);
  grid.addWidget(reset_, gridRow, 3, Qt::AlignVCenter);
  grid.addWidget(problem_, gridRow + 1, 0, 1, 4);
  refresh();
}

QWidget* ParameterLine::makeEditor() {
  switch (row_.kind) {
    case Kind::scalar: {
      NumberBox* box = new NumberBox(draft_, row_.key);
      connect(box, &NumberBox::refused, this, &ParameterLine::refuse);
      return box;
    }
    case Kind::choice:
      return new ChoiceBox(draft_, row_.key);
    case Kind::flag: {
      QCheckBox* box = new QCheckBox;
      box->setAccessibleName(fromView(row_.label));
      const auto read = [this, box] {
        const QSignalBlocker quiet(box);
        box->setChecked(std::get<bool>(draft_.value(row_.key)));
      };
      read();
      connect(&draft_, &Draft::valueChanged, box, [this, read](const QString& key) {
        if (key.toStdString() == row_.key) read();
      });
      connect(box, &QCheckBox::toggled, this, [this](bool on) { draft_.setValue(row_.key, on); });
      return box;
    }
    case Kind::curve:
    case Kind::bands:
    case Kind::rules:
    case Kind::lines:
      break;
  }
  QLineEdit* line = new QLineEdit;
  line->setAccessibleName(fromView(row_.label));
  const auto read = [this, line] {
    line->setText(QString::fromStdString(toText(row_, draft_.value(row_.key))));
    line->setCursorPosition(0);
  };
  read();
  connect(&draft_, &Draft::valueChanged, line, [this, read](const QString& key) {
    if (key.toStdString() == row_.key) read();
  });
  connect(line, &QLineEdit::editingFinished, this, [this, line, read] {
    if (!line->isModified()) return;
    const QString typed = line->text();
    line->setModified(false);
    if (const Findings findings = draft_.setText(row_.key, typed.toStdString()); !findings.empty()) {
      refuse(tr("“%1” was refused: expected %2, found %3.")
                 .arg(typed, QString::fromStdString(findings.front().expected),
                      QString::fromStdString(findings.front().found)));
      read();
    }
  });
  return line;
}

void ParameterLine::refuse(const QString& why) {
  refusal_ = why;
  refresh();
}

QString ParameterLine::problem() const {
  return problem_->text();
}

bool ParameterLine::matches(const QString& search) const {
  for (const QString& word : search.split(QLatin1Char(' '), Qt::SkipEmptyParts)) {
    bool found = false;
    for (const std::string_view text : {row_.label, row_.key, row_.help, row_.source})
      found = found || fromView(text).contains(word, Qt::CaseInsensitive);
    if (!found) return false;
  }
  return true;
}

void ParameterLine::setVisible(bool visible) {
  visible_ = visible;
  label_->setVisible(visible);
  field_->setVisible(visible);
  default_->setVisible(visible && !compact_);
  reset_->setVisible(visible);
  problem_->setVisible(visible && !problem_->text().isEmpty());
}

void ParameterLine::setCompact(bool compact) {
  compact_ = compact;
  default_->setVisible(visible_ && !compact_);
}

void ParameterLine::refresh() {
  State now{draft_.isChanged(row_.key), valueText(row_, row_.get(draft_.baseline())), refusal_,
            errorColour(label_->palette())};
  if (const Findings findings = draft_.findingsOf(row_.key); now.problem.isEmpty() && !findings.empty()) {
    QStringList said;
    for (const Finding& f : findings)
      said << tr("Expected %1; found %2.")
                  .arg(QString::fromStdString(f.expected), QString::fromStdString(f.found));
    now.problem = said.join(QLatin1Char(' '));
    if (findings.front().severity != Severity::error) now.colour = warningColour(label_->palette());
  }
  // Every edit asks every line: nothing is laid out again that stayed as it was.
  if (now == shown_) return;
  shown_ = now;
  const QString name = fromView(row_.label).toHtmlEscaped();
  const QString mark =
      QStringLiteral("<span style='color:%1'>●</span> ").arg(seriesColour(1, label_->palette()).name());
  label_->setText(now.changed ? mark + QStringLiteral("<b>%1</b>").arg(name) : name);
  label_->setAccessibleName(now.changed ? tr("%1, changed").arg(fromView(row_.label)) : fromView(row_.label));
  default_->setText(now.baseline);
  default_->setToolTip(
      tr("Default: %1").arg(QString::fromStdString(toText(row_, row_.get(draft_.baseline())))));
  setTextColour(*default_, quietColour(default_->palette()));
  reset_->setEnabled(now.changed);
  reset_->setToolTip(tr("Reset %1 to %2").arg(fromView(row_.label), now.baseline));
  reset_->setAccessibleName(tr("Reset %1").arg(fromView(row_.label)));
  problem_->setText(now.problem);
  setTextColour(*problem_, now.colour);
  problem_->setVisible(visible_ && !now.problem.isEmpty());
}

}  // namespace trimtab::views
