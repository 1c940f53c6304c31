// SPDX-License-Identifier: GPL-3.0-or-later
#include "value_text.h"

#include <QCoreApplication>
#include <QRegularExpression>
#include <QStringList>

#include "trimtab/preset/preset.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

QString tr(const char* text) {
  return QCoreApplication::translate("trimtab::views::ValueText", text);
}

bool isList(const ParameterRow& row) {
  return row.kind == Kind::curve || row.kind == Kind::bands || row.kind == Kind::lines;
}

/// Returns the entries of a list, each as files spell it.
QStringList entriesOf(const ParameterRow& row, const ParameterValue& value) {
  QStringList entries;
  if (const TextLines* lines = std::get_if<TextLines>(&value)) {
    for (const std::string& line : lines->line) entries << QString::fromStdString(line);
    return entries;
  }
  return QString::fromStdString(toText(row, value)).split(QLatin1Char(' '), Qt::SkipEmptyParts);
}

/// Returns the entries that are in `these` but not in `those`. An entry that occurs three times in the first
/// list and once in the second is returned twice.
QString onlyIn(const QStringList& these, QStringList those) {
  QStringList only;
  for (const QString& entry : these)
    if (!those.removeOne(entry)) only << entry;
  return only.isEmpty() ? QStringLiteral("–") : only.join(QStringLiteral("  "));
}

}  // namespace

QString shortText(const ParameterRow& row, const ParameterValue& value) {
  switch (row.kind) {
    case Kind::flag:
      return std::get<bool>(value) ? tr("on") : tr("off");
    case Kind::choice:
      return fromView(row.choices[std::get<ChoiceIndex>(value).index].label);
    case Kind::curve:
      return tr("%1 points").arg(std::get<CurvePoints>(value).size);
    case Kind::bands:
      return tr("%1 bands").arg(std::get<BandList>(value).size);
    case Kind::lines:
      return tr("%1 lines").arg(std::get<TextLines>(value).line.size());
    case Kind::scalar:
      break;
  }
  return exactText(std::get<double>(value)) + unitAfter(row);
}

QString documentsHtml(std::string_view source) {
  static const QRegularExpression letter(QStringLiteral("(?:^|[,;] )([A-E])(?=[,:;]|$)"));
  QString html;
  for (auto all = letter.globalMatch(fromView(source)); all.hasNext();) {
    const QString cited = all.next().captured(1);
    html +=
        QStringLiteral("<br>%1: %2").arg(cited, fromView(documentOf(cited[0].toLatin1())).toHtmlEscaped());
  }
  return html.isEmpty() ? html : QStringLiteral("<small>%1</small>").arg(html);
}

QString unitAfter(const ParameterRow& row) {
  return row.unit.empty() || row.unit == "°" ? fromView(row.unit) : QLatin1Char(' ') + fromView(row.unit);
}

BeforeAfter changeText(const Change& change) {
  const ParameterRow& row = *change.row;
  if (!isList(row)) return {shortText(row, change.before), shortText(row, change.after)};
  const QStringList before = entriesOf(row, change.before), after = entriesOf(row, change.after);
  const BeforeAfter said{onlyIn(before, after), onlyIn(after, before)};
  // Both have the same entries in another order, so all are shown.
  if (said.before == said.after) return {before.join(QStringLiteral("  ")), after.join(QStringLiteral("  "))};
  return said;
}

QString stepText(const Step& step) {
  QStringList lines;
  for (const Change& change : step.changes) {
    const BeforeAfter text = changeText(change);
    lines << tr("%1: %2 → %3").arg(fromView(change.row->label), text.before, text.after);
  }
  return lines.join(QLatin1Char('\n'));
}

}  // namespace trimtab::views
