// SPDX-License-Identifier: GPL-3.0-or-later
#include "choice_box.h"

#include <QWheelEvent>

#include "parameter_of.h"
#include "views/model/theme.h"
#include "views/model/value_text.h"

namespace trimtab::views {

ChoiceBox::ChoiceBox(Draft& draft, std::string_view key, QWidget* parent) : QComboBox(parent) {
  const ParameterRow* row = findRow(key);
  Q_ASSERT(row && row->kind == Kind::choice);
  for (const ChoiceOption& option : row->choices) addItem(fromView(option.label));
  setFocusPolicy(Qt::StrongFocus);
  setAccessibleName(fromView(row->label));
  markParameter(*this, key);
  setToolTip(helpText(*row));
  setSizeAdjustPolicy(QComboBox::AdjustToContents);
  setMinimumContentsLength(8);
  const auto read = [this, &draft, row] {
    const QSignalBlocker quiet(this);
    setCurrentIndex(static_cast<int>(std::get<ChoiceIndex>(draft.value(row->key)).index));
  };
  read();
  connect(&draft, &Draft::valueChanged, this, [row, read](const QString& changed) {
    if (changed.toStdString() == row->key) read();
  });
  connect(this, &QComboBox::currentIndexChanged, this, [&draft, row](int index) {
    if (index >= 0) draft.setValue(row->key, ChoiceIndex{static_cast<std::size_t>(index)});
  });
}

void ChoiceBox::wheelEvent(QWheelEvent* event) {
  if (hasFocus())
    QComboBox::wheelEvent(event);
  else
    event->ignore();
}

QString helpText(const ParameterRow& row) {
  QString html = QStringLiteral("<p><b>%1</b></p><p>%2</p>")
                     .arg(fromView(row.label).toHtmlEscaped(), fromView(row.help).toHtmlEscaped());
  if (!row.source.empty())
    html += QObject::tr("<p>Source: %1%2</p>")
                .arg(fromView(row.source).toHtmlEscaped(), documentsHtml(row.source));
  const auto range = [&](const Range& r) {
    return QObject::tr("%1 to %2%3").arg(numberText(r.low, 9), numberText(r.high, 9), unitAfter(row));
  };
  if (row.kind == Kind::scalar) {
    html += QObject::tr("<p>Range: %1").arg(range(row.hard));
    if (row.usual.low != row.hard.low || row.usual.high != row.hard.high)
      html += QObject::tr("; usual: %1").arg(range(row.usual));
    html += QStringLiteral("</p>");
  }
  html += QStringLiteral("<p><code>%1</code></p>").arg(fromView(row.key));
  return html;
}

}  // namespace trimtab::views
