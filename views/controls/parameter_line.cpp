// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameter_line.h"

#include <QBoxLayout>
#include <QCheckBox>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QToolButton>

#include "choice_box.h"
#include "note_line.h"
#include "number_box.h"
#include "parameter_of.h"
#include "parameter_slider.h"
#include "views/model/keys.h"
#include "views/model/value_text.h"

namespace trimtab::views {

namespace {

/// Values with more digits are shortened in their column; the tool tip has them whole.
constexpr int kWidestValue = 14;
constexpr std::array kColumns{Reference::file, Reference::base, Reference::defaults};

/// The name of a parameter, which wraps only where it has less width than its line. A QLabel that may wrap
/// asks for a few words' width.
class NameLabel : public QLabel {
 public:
  explicit NameLabel(const QString& name) : name_(name) {
    setWordWrap(true);
    setMinimumWidth(fontMetrics().horizontalAdvance(QStringLiteral("membership offset")));
  }
  QSize sizeHint() const override {
    QFont bold = font();
    bold.setBold(true);
    const int width = QFontMetrics(bold).horizontalAdvance(QStringLiteral("● ") + name_) + 2;
    return {width, heightForWidth(width)};
  }

 private:
  QString name_;
};

}  // namespace

ParameterLine::ParameterLine(Draft& draft, const ParameterRow& row, QGridLayout& grid, int gridRow)
    : QObject(grid.parentWidget()),
      draft_(draft),
      row_(row),
      label_(new NameLabel(fromView(row.label))),
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
  for (QWidget* widget : {static_cast<QWidget*>(label_), field_}) widget->setToolTip(help);
  for (QWidget* widget : {static_cast<QWidget*>(label_), field_, editor_, static_cast<QWidget*>(reset_)})
    markParameter(*widget, row.key);
  makeValues();
  reset_->setText(QStringLiteral("↺"));
  reset_->setAutoRaise(true);
  reset_->setFocusPolicy(Qt::StrongFocus);
  connect(reset_, &QToolButton::clicked, this, [this] { draft_.reset(row_.key, reference_); });
  for (QWidget* widget : {static_cast<QWidget*>(label_), static_cast<QWidget*>(reset_)}) {
    widget->setContextMenuPolicy(Qt::CustomContextMenu);
    connect(widget, &QWidget::customContextMenuRequested, this,
            [this, widget](const QPoint& at) { showResets(widget->mapToGlobal(at)); });
  }

  grid.addWidget(label_, gridRow, 0, Qt::AlignVCenter);
  grid.addWidget(field_, gridRow, 1, Qt::AlignVCenter);
  grid.addWidget(reset_, gridRow, 2, Qt::AlignVCenter);
  for (std::size_t i = 0; i < kValues; ++i) grid.addWidget(values_[i], gridRow, 3 + int(i), Qt::AlignVCenter);
  problem_ = new NoteBubble(*field_);
  connect(&draft_, &Draft::valueChanged, this, [this](const QString& key) {
    if (key.toStdString() == row_.key) refusal_.clear();
  });
  connect(&draft_, &Draft::referencesChanged, this, [this] {
    readValues();
    refresh();
  });
  whenThemeChanges(*label_, [this] { refresh(); });
  readValues();
  refresh();
}

void ParameterLine::makeValues() {
  for (std::size_t i = 0; i < kValues; ++i) {
    auto* button = values_[i] = new QToolButton;
    button->setAutoRaise(true);
    button->setFocusPolicy(Qt::StrongFocus);
    connect(button, &QToolButton::clicked, this, [this, i] { draft_.reset(row_.key, kColumns[i]); });
  }
}

void ParameterLine::compareWith(Reference reference) {
  reference_ = reference;
  readValues();
  refresh();
}

/// Offers the values that the columns of a wide line show in a menu.
void ParameterLine::showResets(const QPoint& at) {
  QMenu menu(label_);
  const auto add = [&](Reference to) {
    const TuningParameters* values = draft_.reference(to);
    if (!values) return;
    const QString text =
        tr("Back to %1: %2").arg(draft_.referenceName(to), shortText(row_, row_.get(*values)));
    menu.addAction(text, this, [this, to] { draft_.reset(row_.key, to); })
        ->setEnabled(draft_.isChanged(row_.key, to));
  };
  for (const Reference to : kColumns)
    if (to != Reference::base || draft_.hasOwnBase()) add(to);
  add(Reference::pinned);
  menu.exec(at);
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

void ParameterLine::setVisible(bool visible) {
  visible_ = visible;
  label_->setVisible(visible);
  field_->setVisible(visible);
  reset_->setVisible(visible);
  showValues();
}

void ParameterLine::setCompact(bool compact) {
  compact_ = compact;
  showValues();
}

/// A base that has the defaults' values would repeat their column.
void ParameterLine::showValues() {
  for (std::size_t i = 0; i < kValues; ++i)
    values_[i]->setVisible(visible_ && !compact_ && (kColumns[i] != Reference::base || draft_.hasOwnBase()));
}

/// Reads the values of the references, which no edit changes.
void ParameterLine::readValues() {
  const QString name = fromView(row_.label);
  const int widest = label_->fontMetrics().horizontalAdvance(QLatin1Char('0')) * kWidestValue;
  QStringList said;
  for (std::size_t i = 0; i < kValues; ++i) {
    const ParameterValue value = row_.get(*draft_.reference(kColumns[i]));
    const QString of = draft_.referenceName(kColumns[i]), text = shortText(row_, value);
    values_[i]->setText(label_->fontMetrics().elidedText(text, Qt::ElideRight, widest));
    values_[i]->setAccessibleName(tr("%1 back to %2: %3").arg(name, of, text));
    values_[i]->setToolTip(tr("A click goes back to %1: %2").arg(of, text));
    if (kColumns[i] != Reference::base || draft_.hasOwnBase())
      said << tr("%1: %2").arg(of, QString::fromStdString(toText(row_, value)));
  }
  reset_->setToolTip(tr("Reset %1 to %2. A right click offers each of these:\n%3")
                         .arg(name, draft_.referenceName(reference_), said.join(QLatin1Char('\n'))));
  reset_->setAccessibleName(tr("Reset %1").arg(name));
  showValues();
}

/// Two lists of five points may differ: what differs is shown, not how many there are.
void ParameterLine::showLists(const std::array<bool, kValues>& differs) {
  const int widest = label_->fontMetrics().horizontalAdvance(QLatin1Char('0')) * kWidestValue;
  for (std::size_t i = 0; i < kValues; ++i) {
    const ParameterValue value = row_.get(*draft_.reference(kColumns[i]));
    const QString text =
        differs[i] ? changeText({&row_, value, draft_.value(row_.key)}).before : shortText(row_, value);
    values_[i]->setText(label_->fontMetrics().elidedText(text, Qt::ElideRight, widest));
  }
}

void ParameterLine::refresh() {
  State now;
  now.changed = draft_.isChanged(row_.key, reference_);
  for (std::size_t i = 0; i < kValues; ++i) now.differs[i] = draft_.isChanged(row_.key, kColumns[i]);
  now.problem = refusal_;
  now.mark = seriesColour(1, label_->palette());
  if (const Findings findings = draft_.findingsOf(row_.key); now.problem.isEmpty() && !findings.empty()) {
    QStringList said;
    for (const Finding& f : findings)
      said << tr("Expected %1; found %2.")
                  .arg(QString::fromStdString(f.expected), QString::fromStdString(f.found));
    now.problem = said.join(QLatin1Char(' '));
    if (findings.front().severity != Severity::error) now.ink = Ink::warning;
  }
  if (row_.kind != Kind::scalar && row_.kind != Kind::flag && row_.kind != Kind::choice)
    showLists(now.differs);
  // Every edit asks every line: nothing is laid out again that stayed as it was.
  if (now == shown_) return;
  shown_ = now;
  const QString name = fromView(row_.label).toHtmlEscaped();
  const QString mark = QStringLiteral("<span style='color:%1'>●</span> ").arg(now.mark.name());
  label_->setText(now.changed ? mark + QStringLiteral("<b>%1</b>").arg(name) : name);
  label_->setAccessibleName(now.changed ? tr("%1, changed").arg(fromView(row_.label)) : fromView(row_.label));
  for (std::size_t i = 0; i < kValues; ++i) values_[i]->setEnabled(now.differs[i]);
  reset_->setEnabled(now.changed);
  problem_->say(now.problem, now.ink);
}

}  // namespace trimtab::views
