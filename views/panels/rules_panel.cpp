// SPDX-License-Identifier: GPL-3.0-or-later
#include "rules_panel.h"

#include <QBoxLayout>
#include <QFileDialog>
#include <QSplitter>

#include "trimtab/fuzzy/rule_file.h"
#include "trimtab/preset/file_io.h"
#include "views/controls/tell_findings.h"
#include "views/editors/rule_viewer.h"
#include "views/editors/rules_editor.h"

namespace trimtab::views {

namespace {

QString filters() {
  return QObject::tr("Fuzzy rules (*.fll *.fis);;FuzzyLite Language (*.fll);;MATLAB fuzzy system (*.fis)");
}

}  // namespace

RulesPanel::RulesPanel(Draft& draft, QWidget* parent)
    : QWidget(parent), draft_(draft), editor_(new RulesEditor(draft)), viewer_(new RuleViewer(draft)) {
  auto* viewing = new QWidget;
  auto* viewingLayout = new QVBoxLayout(viewing);
  viewingLayout->setContentsMargins(6, 2, 6, 4);
  viewingLayout->addWidget(viewer_);
  viewingLayout->addStretch(1);
  auto* split = new QSplitter(Qt::Vertical);
  split->addWidget(editor_);
  split->addWidget(viewing);
  split->setChildrenCollapsible(false);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(split);
  connect(editor_, &RulesEditor::importAsked, this, &RulesPanel::askAndImport);
  connect(editor_, &RulesEditor::exportAsked, this, &RulesPanel::askAndExport);
}

void RulesPanel::showFrame(const LiveFrame& frame) {
  viewer_->showFrame(frame);
}

Findings RulesPanel::importFile(const QString& file) {
  const auto format = ruleFormatOf(file.toStdString());
  if (!format) return {unknownRuleEnding(file)};
  const Result<std::string> text = readWhole(file.toStdString());
  if (!text) return text.findings();
  const Result<TuningParameters> read = readRuleFile(*text, file.toStdString(), *format, draft_.parameters());
  if (!read) return read.findings();
  draft_.takeParameters(*read, tr("Import Rules"));
  return read.findings();
}

Findings RulesPanel::exportFile(const QString& file) const {
  const auto format = ruleFormatOf(file.toStdString());
  if (!format) return {unknownRuleEnding(file)};
  const Result<std::string> text = ruleFileText(*draft_.active(), draft_.preset().name, *format);
  if (!text) return text.findings();
  const auto written = writeAtomically(file.toStdString(), *text);
  Findings findings = written.findings();
  if (written) findings.insert(findings.end(), text.findings().begin(), text.findings().end());
  return findings;
}

void RulesPanel::askAndImport() {
  const QString file = QFileDialog::getOpenFileName(this, tr("Import Rules"), {}, filters());
  if (file.isEmpty()) return;
  tellFindings(this, tr("The rules were not imported"), tr("The rules were imported"), importFile(file));
}

void RulesPanel::askAndExport() {
  QFileDialog dialog(this, tr("Export Rules"), {}, filters());
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QStringLiteral("fll"));
  dialog.selectFile(QStringLiteral("rules.fll"));
  if (dialog.exec() != QDialog::Accepted) return;
  tellFindings(this, tr("The rules were not exported"), tr("The rules were exported"),
               exportFile(dialog.selectedFiles().constFirst()));
}

}  // namespace trimtab::views
