// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference.h"

#include <QApplication>
#include <QDockWidget>
#include <QKeyEvent>
#include <QLineEdit>
#include <QTextBrowser>
#include <QVBoxLayout>
#include <QWhatsThis>
#include <algorithm>

#include "app/workbench/docks/dock_of.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/table.h"
#include "views/controls/choice_box.h"
#include "views/controls/parameter_of.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

bool holds(const ParameterRow& row, const QStringList& words) {
  return std::all_of(words.begin(), words.end(), [&](const QString& word) {
    for (const std::string_view text : {row.label, row.key, row.help, row.source})
      if (views::fromView(text).contains(word, Qt::CaseInsensitive)) return true;
    return false;
  });
}

QString nameOf(const QWidget& control) {
  if (!control.accessibleName().isEmpty()) return control.accessibleName();
  const QString text = control.property("text").toString();
  return QString(text).remove('&');
}

/// Returns the name of a control, what its tool tip or its description says, and its dock; empty if neither
/// is known. What has no text of its own has that of what it is in.
QString explanationOf(const QWidget& control) {
  QString text;
  for (const QWidget* at = &control; at != nullptr && text.isEmpty() && !at->isWindow();
       at = at->parentWidget())
    text = at->toolTip().isEmpty() ? at->accessibleDescription() : at->toolTip();
  const QString name = nameOf(control);
  if (text.isEmpty() && name.isEmpty()) return {};
  if (!Qt::mightBeRichText(text))
    text = text.toHtmlEscaped().replace(QLatin1Char('\n'), QStringLiteral("<br>"));
  QString html = QStringLiteral("<h3>%1</h3>").arg(name.toHtmlEscaped());
  if (!text.isEmpty()) html += QStringLiteral("<p>%1</p>").arg(text);
  if (const QDockWidget* dock = dockOf(control))
    html += Reference::tr("<p>In the dock <b>%1</b>.</p>").arg(dock->windowTitle().toHtmlEscaped());
  return html;
}

}  // namespace

Reference::Reference(QWidget* parent)
    : QDialog(parent), search_(new QLineEdit(this)), text_(new QTextBrowser(this)) {
  setWindowTitle(tr("Parameter reference"));
  resize(860, 640);
  search_->setPlaceholderText(tr("Words of a name, key, explanation or source"));
  search_->setAccessibleName(tr("Search the reference"));
  search_->setClearButtonEnabled(true);
  text_->setAccessibleName(tr("Reference"));
  text_->setOpenExternalLinks(true);
  auto* column = new QVBoxLayout(this);
  column->addWidget(search_);
  column->addWidget(text_, 1);
  qApp->installEventFilter(this);
  connect(search_, &QLineEdit::textChanged, this, [this](const QString& words) {
    if (!explaining_) find(words);
  });
}

void Reference::look(const QString& words) {
  if (search_->text() == words)
    find(words);
  else
    search_->setText(words);
  begin();
  search_->setFocus();
  search_->selectAll();
}

void Reference::find(const QString& words) {
  const QStringList list = words.split(QLatin1Char(' '), Qt::SkipEmptyParts);
  if (list.isEmpty()) return text_->setMarkdown(QString::fromStdString(parameterReference()));
  QString html;
  for (const ParameterRow& row : parameterRows())
    if (holds(row, list)) html += views::helpText(row) + QStringLiteral("<hr>");
  text_->setHtml(html.isEmpty() ? tr("<p>No parameter holds these words.</p>") : html);
}

bool Reference::explain(const QWidget* control) {
  if (control == nullptr) return false;
  if (const QString key = views::parameterOf(control); !key.isEmpty()) {
    look(key);
    return true;
  }
  const QString html = explanationOf(*control);
  if (html.isEmpty()) return false;
  // An empty search would show the whole reference first. The box's own signals stay on: its clear button
  // follows them.
  explaining_ = true;
  search_->clear();
  explaining_ = false;
  text_->setHtml(html);
  begin();
  return true;
}

bool Reference::eventFilter(QObject* watched, QEvent* event) {
  const auto* const control = qobject_cast<QWidget*>(watched);
  if (event->type() == QEvent::KeyPress && static_cast<QKeyEvent*>(event)->key() == Qt::Key_F1 &&
      control != nullptr && QApplication::activeModalWidget() != nullptr) {
    if (const QString html = explanationOf(*control); !html.isEmpty())
      QWhatsThis::showText(control->mapToGlobal(QPoint(0, control->height())), html);
    return true;
  }
  return QDialog::eventFilter(watched, event);
}

void Reference::begin() {
  show();
  raise();
  activateWindow();
}

}  // namespace trimtab::workbench
