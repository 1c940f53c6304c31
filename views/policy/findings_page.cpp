// SPDX-License-Identifier: GPL-3.0-or-later
#include "findings_page.h"

#include <QBoxLayout>
#include <algorithm>

#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/policy_review.h"
#include "views/model/keys.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

/// What a finding is about, for people.
QString subject(const Finding& finding) {
  const QString key = QString::fromStdString(finding.key);
  if (key.startsWith(QStringLiteral("rules."))) return QObject::tr("Rule %1").arg(key.mid(6));
  if (key.startsWith(QStringLiteral("terms."))) {
    const QString name = key.mid(6);
    return QObject::tr("Term %1").arg(QString(name).replace(QLatin1Char('.'), QStringLiteral(" is ")));
  }
  return key == QStringLiteral("levers") ? QObject::tr("Levers") : QObject::tr("Rules");
}

}  // namespace

FindingsPage::FindingsPage(PolicyDraft& policy, QWidget* parent)
    : QWidget(parent), policy_(policy), list_(new QListWidget) {
  list_->setAccessibleName(tr("Findings about the policy"));
  list_->setWordWrap(true);
  list_->setUniformItemSizes(false);
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list_->setMinimumHeight(fontMetrics().height() * 4);
  list_->setToolTip(tr("Click a line, or press Enter, to go to its rule or term"));
  setFocusProxy(list_);
  whenThemeChanges(*this, [this] { colourLines(); });
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addWidget(list_);
  connect(list_, &QListWidget::itemClicked, this, [this] { follow(list_->currentRow()); });
  connect(list_, &QListWidget::itemActivated, this, [this] { follow(list_->currentRow()); });
}

void FindingsPage::refresh() {
  Findings unreadable;
  for (const std::string_view key : {key::kPolicyTerms, key::kPolicyRules})
    for (const Finding& finding : policy_.draft().findingsOf(key)) unreadable.push_back(finding);
  const Policy policy = policy_.policy();
  const auto readable = [](const auto& lines, auto member) {
    return std::ranges::all_of(lines, [member](const auto& line) { return (line.*member).has_value(); });
  };
  const bool whole = readable(policy_.terms(), &PolicyDraft::TermLine::term) &&
                     readable(policy_.rules(), &PolicyDraft::RuleLine::rule);
  // Findings of the compiler name rules and terms, those of lines that cannot be read do not.
  if (!whole && !unreadable.empty()) {
    reviewed_.reset();
    return showFindings(unreadable);
  }
  if (reviewed_ && *reviewed_ == policy) return;
  reviewed_ = policy;
  showFindings(reviewPolicy(policy));
}

void FindingsPage::showFindings(const Findings& findings) {
  if (findings == findings_ && told_ >= 0) return;
  findings_ = findings;
  std::ranges::stable_sort(findings_,
                           [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
  const int line = list_->currentRow();
  list_->clear();
  for (const Finding& finding : findings_) {
    const QString text = tr("%1: expected %2; found %3.")
                             .arg(subject(finding), QString::fromStdString(finding.expected),
                                  QString::fromStdString(finding.found));
    list_->addItem(text);
  }
  if (findings_.empty() && !policy_.empty()) list_->addItem(tr("Nothing to remark."));
  colourLines();
  // A review follows each edit; who reads the list keeps the place.
  list_->setCurrentRow(std::min(line, list_->count() - 1));
  const auto count = static_cast<int>(
      std::ranges::count_if(findings_, [](const Finding& f) { return f.severity != Severity::note; }));
  told_ = count;
  emit countChanged(count);
}

void FindingsPage::colourLines() {
  for (int row = 0; row < list_->count(); ++row) {
    const auto at = static_cast<std::size_t>(row);
    const Severity severity = at < findings_.size() ? findings_[at].severity : Severity::note;
    const Ink ink = at >= findings_.size()          ? Ink::quiet
                    : severity == Severity::error   ? Ink::error
                    : severity == Severity::warning ? Ink::warning
                                                    : Ink::plain;
    list_->item(row)->setForeground(colourOf(ink, palette()));
  }
}

void FindingsPage::follow(int row) {
  if (row < 0 || row >= static_cast<int>(findings_.size())) return;
  const std::string& key = findings_[static_cast<std::size_t>(row)].key;
  if (key.starts_with("rules.")) return emit ruleAsked(std::stoi(key.substr(6)) - 1);
  if (key.starts_with("rules") || key == key::kPolicyRules) return emit ruleAsked(-1);
  for (std::size_t i = 0; i < policy_.terms().size(); ++i) {
    const auto& term = policy_.terms()[i].term;
    if (term && key == "terms." + std::string(rowOf(term->signal).key) + "." + term->name)
      return emit termAsked(static_cast<int>(i));
  }
}

}  // namespace trimtab::views
