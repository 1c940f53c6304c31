// SPDX-License-Identifier: GPL-3.0-or-later
#include "choice_box.h"

#include <QRegularExpression>
#include <QWheelEvent>

#include "parameter_of.h"
#include "trimtab/preset/preset.h"
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

namespace {

/// Authors and titles of the documents whose letters a source cites, such as "A, B: Table 2".
QString documentsOf(std::string_view source) {
  static const QRegularExpression letter(QStringLiteral("(?:^|[,;] )([A-E])(?=[,:;]|$)"));
  QString html;
  for (auto all = letter.globalMatch(fromView(source)); all.hasNext();) {
    const QString cited = all.next().captured(1);
    html +=
        QStringLiteral("<br>%1: %2").arg(cited, fromView(documentOf(cited[0].toLatin1())).toHtmlEscaped());
  }
  return html.isEmpty() ? html : QStringLiteral("<small>%1</small>").arg(html);
}

}  // namespace

QString helpText(const ParameterRow& row) {
  QString html = QStringLiteral("<p><b>%1</b></p><p>%2</p>")
                     .arg(fromView(row.label).toHtmlEscaped(), fromView(row.help).toHtmlEscaped());
  if (!row.source.empty())
    html +=
        QObject::tr("<p>Source: %1%2</p>").arg(fromView(row.source).toHtmlEscaped(), documentsOf(row.source));
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
