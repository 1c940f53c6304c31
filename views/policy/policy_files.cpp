// SPDX-License-Identifier: GPL-3.0-or-later
#include "policy_files.h"

#include <QFileInfo>
#include <QObject>
#include <QStringList>

#include "trimtab/policy/policy_file.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "views/controls/tell_findings.h"

namespace trimtab::views {
namespace {

/// A language of fuzzy-logic tools. Another one is another row.
struct Language {
  const char* ending;
  const char* name;
  Result<std::string> (*write)(const Policy&, const std::string& name);
  Result<Policy> (*read)(std::string_view text, const std::string& where);
};
constexpr Language kLanguages[] = {
    {"fll", QT_TRANSLATE_NOOP("QObject", "FuzzyLite Language"), &toFuzzyLite, &readFuzzyLite},
    {"fis", QT_TRANSLATE_NOOP("QObject", "MATLAB fuzzy inference system"), &toMatlab,
     [](std::string_view text, const std::string& where) { return readMatlab(text, where); }},
};

const Language* languageOf(const QString& file) {
  const QString ending = QFileInfo(file).suffix().toLower();
  for (const Language& language : kLanguages)
    if (ending == QLatin1String(language.ending)) return &language;
  return nullptr;
}

}  // namespace

QString policyFileFilters() {
  QStringList all, each;
  for (const Language& language : kLanguages) {
    const QString pattern = QStringLiteral("*.%1").arg(QLatin1String(language.ending));
    all << pattern;
    each << QStringLiteral("%1 (%2)").arg(QObject::tr(language.name), pattern);
  }
  if (each.size() > 1) each.prepend(QObject::tr("Policies (%1)").arg(all.join(QLatin1Char(' '))));
  return each.join(QStringLiteral(";;"));
}

Result<Policy> readPolicyFile(const QString& file) {
  const Language* language = languageOf(file);
  if (language == nullptr) return unknownRuleEnding(file);
  const Result<std::string> text = readWhole(file.toStdString());
  if (!text) return text.findings();
  return language->read(*text, file.toStdString());
}

Findings writePolicyFile(const QString& file, const Policy& policy, const std::string& name) {
  const Language* language = languageOf(file);
  if (language == nullptr) return {unknownRuleEnding(file)};
  const Result<std::string> text = language->write(policy, name);
  if (!text) return text.findings();
  const auto written = writeAtomically(file.toStdString(), *text);
  Findings findings = written.findings();
  if (written) findings.insert(findings.end(), text.findings().begin(), text.findings().end());
  return findings;
}

}  // namespace trimtab::views
