// SPDX-License-Identifier: GPL-3.0-or-later
#include "policy_files.h"

#include <QObject>
#include <QStringList>

#include "trimtab/policy/policy_file.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "views/controls/tell_findings.h"

namespace trimtab::views {
namespace {

/// A language of fuzzy-logic tools is a row of the table below.
struct Language {
  const char* ending;
  const char* name;
};
constexpr Language kLanguages[] = {{"fll", QT_TRANSLATE_NOOP("QObject", "FuzzyLite Language")},
                                   {"fis", QT_TRANSLATE_NOOP("QObject", "MATLAB fuzzy inference system")}};

}  // namespace

QString policyFileFilters() {
  QStringList all, each;
  for (const Language& language : kLanguages) {
    const QString pattern = QStringLiteral("*.%1").arg(QLatin1String(language.ending));
    all << pattern;
    each << QStringLiteral("%1 (%2)").arg(QObject::tr(language.name), pattern);
  }
  each.prepend(QObject::tr("Policies (%1)").arg(all.join(QLatin1Char(' '))));
  return each.join(QStringLiteral(";;"));
}

Result<RuleFile> openRuleFile(const QString& file) {
  const auto format = ruleFormatOf(file.toStdString());
  if (!format) return unknownRuleEnding(file);
  const Result<std::string> text = readWhole(file.toStdString());
  if (!text) return text.findings();
  return RuleFile::open(*text, file.toStdString(), *format);
}

Findings writePolicyFile(const QString& file, const Policy& policy, const std::string& name) {
  const auto format = ruleFormatOf(file.toStdString());
  if (!format) return {unknownRuleEnding(file)};
  const Result<std::string> text = policyFileText(policy, name, *format);
  if (!text) return text.findings();
  const auto written = writeAtomically(file.toStdString(), *text);
  Findings findings = written.findings();
  if (written) findings.insert(findings.end(), text.findings().begin(), text.findings().end());
  return findings;
}

}  // namespace trimtab::views
