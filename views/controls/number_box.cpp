// SPDX-License-Identifier: GPL-3.0-or-later
#include "number_box.h"

#include <QLineEdit>
#include <QLocale>
#include <QWheelEvent>
#include <cmath>

#include "choice_box.h"
#include "parameter_of.h"
#include "views/model/rounded.h"
#include "views/model/theme.h"
#include "views/model/value_text.h"

namespace trimtab::views {

namespace {

/// Returns text in the person's locale as text in the C locale, which the table of parameters reads.
std::string inC(const QString& typed) {
  QString text = typed.trimmed();
  text.replace(QChar(0x2212), QLatin1Char('-'));
  qsizetype end = text.size();
  while (end > 0 && !text[end - 1].isDigit()) --end;
  bool ok = false;
  const double value = QLocale().toDouble(text.left(end), &ok);
  // 17 digits read back the same double.
  return (ok ? QString::number(value, 'g', 17) + text.mid(end) : text).toStdString();
}

/// A spin box puts its suffix behind whatever is typed: "10 ft" arrives as "10 ft m".
Result<ParameterValue> parseTyped(const ParameterRow& row, const QString& text, const QString& suffix) {
  if (!suffix.isEmpty() && text.endsWith(suffix))
    if (Result<ParameterValue> bare = parseValue(row, inC(text.chopped(suffix.size())))) return bare;
  return parseValue(row, inC(text));
}

}  // namespace

NumberBox::NumberBox(Draft& draft, std::string_view key, QWidget* parent)
    : QDoubleSpinBox(parent), draft_(draft), row_(findRow(key)) {
  Q_ASSERT(row_ && row_->kind == Kind::scalar);
  // The box keeps as many decimals as a double may need; textFromValue() shows only those that are there.
  setDecimals(20);
  setRange(row_->hard.low, row_->hard.high);
  setSingleStep(row_->step);
  setKeyboardTracking(false);
  setFocusPolicy(Qt::StrongFocus);
  setAccessibleName(fromView(row_->label));
  markParameter(*this, row_->key);
  setToolTip(helpText(*row_));
  setSuffix(unitAfter(*row_));
  setMinimumWidth(fontMetrics().horizontalAdvance(QStringLiteral("0.0000 ms")) + 32);
  read();
  connect(&draft_, &Draft::valueChanged, this, [this](const QString& changed) {
    if (changed.toStdString() == row_->key) read();
  });
  connect(this, &QDoubleSpinBox::valueChanged, this, &NumberBox::write);
  connect(lineEdit(), &QLineEdit::textChanged, this, [this](QString text) {
    int position = 0;
    const bool good = validate(text, position) == QValidator::Acceptable;
    setInk(*lineEdit(), good ? Ink::plain : Ink::error);
  });
}

void NumberBox::read() {
  const QSignalBlocker quiet(this);
  setValue(std::get<double>(draft_.value(row_->key)));
}

void NumberBox::write() {
  if (value() != std::get<double>(draft_.value(row_->key))) draft_.setValue(row_->key, value(), stepToken_);
}

void NumberBox::stepBy(int steps) {
  if (stepToken_ == 0) stepToken_ = draft_.newToken();
  if (!row_->logarithmic) {
    // To the step's own grid, so that 0.1 + 0.1 + 0.1 is 0.3.
    const double grid = std::round(value() / row_->step) + steps;
    setValue(withoutDust(grid * row_->step));
  } else {
    const double now = std::abs(value());
    setValue(withoutDust(value() + steps * (now > 0 ? roundStep(now / 5) : row_->step)));
  }
}

void NumberBox::keyReleaseEvent(QKeyEvent* event) {
  if (!event->isAutoRepeat()) stepToken_ = 0;
  QDoubleSpinBox::keyReleaseEvent(event);
}

QString NumberBox::textFromValue(double value) const {
  return exactText(value);
}

void NumberBox::mouseReleaseEvent(QMouseEvent* event) {
  QDoubleSpinBox::mouseReleaseEvent(event);
  stepToken_ = 0;
}

void NumberBox::focusOutEvent(QFocusEvent* event) {
  QDoubleSpinBox::focusOutEvent(event);
  stepToken_ = 0;
}

double NumberBox::valueFromText(const QString& text) const {
  const Result<ParameterValue> parsed = parseTyped(*row_, text, suffix());
  return parsed ? std::get<double>(*parsed) : value();
}

QValidator::State NumberBox::validate(QString& text, int&) const {
  const Result<ParameterValue> parsed = parseTyped(*row_, text, suffix());
  if (!parsed) return QValidator::Intermediate;
  const double number = std::get<double>(*parsed);
  if (!(number >= row_->hard.low && number <= row_->hard.high)) return QValidator::Intermediate;
  if (row_->whole && number != std::floor(number)) return QValidator::Intermediate;
  return QValidator::Acceptable;
}

void NumberBox::fixup(QString& text) const {
  emit refused(tr("“%1” was refused: expected a%2 number from %3 to %4%5.")
                   .arg(text, row_->whole ? tr(" whole") : QString(), numberText(row_->hard.low, 9),
                        numberText(row_->hard.high, 9), unitAfter(*row_)));
  text = textFromValue(value()) + suffix();
}

void NumberBox::wheelEvent(QWheelEvent* event) {
  if (hasFocus())
    QDoubleSpinBox::wheelEvent(event);
  else
    event->ignore();
}

}  // namespace trimtab::views
