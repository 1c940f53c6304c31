// SPDX-License-Identifier: GPL-3.0-or-later
#include "conversion_edit.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>

#include "views/model/theme.h"

namespace trimtab::views {

ConversionEdit::ConversionEdit(const QString& name, QWidget* parent)
    : QWidget(parent), scale_(new QLineEdit(this)), offset_(new QLineEdit(this)) {
  scale_->setAccessibleName(tr("Scale of %1").arg(name));
  scale_->setToolTip(tr("What a number of the file is multiplied by"));
  offset_->setAccessibleName(tr("Offset of %1").arg(name));
  offset_->setToolTip(tr("What is added after that"));
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  for (const auto& [sign, line] : {std::pair{QStringLiteral("×"), scale_}, {QStringLiteral("+"), offset_}}) {
    row->addWidget(new QLabel(sign));
    row->addWidget(line, 1);
    line->setMinimumWidth(line->fontMetrics().horizontalAdvance(QStringLiteral("-0.000000001")));
    connect(line, &QLineEdit::textEdited, this, [this] {
      show();
      emit edited();
    });
  }
  set(1, 0);
}

void ConversionEdit::set(double scale, double offset) {
  scale_->setText(exactText(scale));
  offset_->setText(exactText(offset));
  show();
}

std::optional<double> ConversionEdit::scale() const {
  const auto number = parseNumber(scale_->text(), {});
  return number == 0 ? std::nullopt : number;
}

std::optional<double> ConversionEdit::offset() const {
  return parseNumber(offset_->text(), {});
}

void ConversionEdit::show() {
  for (const auto& [line, good] : {std::pair{scale_, scale().has_value()}, {offset_, offset().has_value()}})
    setInk(*line, good ? Ink::plain : Ink::error);
}

}  // namespace trimtab::views
