// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/policy/policy.h"
#include "views/model/draft.h"

namespace trimtab::views {

/// The policy of a draft, line by line, so that a line which cannot be read is shown and can be mended or
/// removed. It keeps terms and rules as such: text is read only when a line comes from elsewhere, such as a
/// file, an undo or a person who types. Every change goes through the draft as one undo step, or as a part of
/// the step with its token; it writes its own line and leaves all others as they are, letter by letter.
class PolicyDraft : public QObject {
  Q_OBJECT
 public:
  struct TermLine {
    std::string text;
    std::optional<PolicyTerm> term;  ///< none if the line cannot be read
    bool sound = false;              ///< whether there is a term whose membership can be computed
  };
  struct RuleLine {
    std::string text;
    std::optional<PolicyRule> rule;  ///< none if the line cannot be read
  };

  explicit PolicyDraft(Draft& draft, QObject* parent = nullptr);

  Draft& draft() const { return draft_; }
  const std::vector<TermLine>& terms() const { return terms_; }
  const std::vector<RuleLine>& rules() const { return rules_; }
  bool empty() const { return terms_.empty() && rules_.empty(); }
  /// Returns the policy that the readable lines make.
  Policy policy() const;
  /// Returns the policy that runs; an empty one if it cannot be read.
  Policy active() const;
  /// Returns the lines of a signal's terms.
  std::vector<std::size_t> termsOf(Signal signal) const;
  /// Reports whether a rule that is switched on asks for the signal.
  bool uses(Signal signal) const;
  /// Returns a name that no term of the signal has: `wanted`, or `wanted` with a number.
  std::string freeName(Signal signal, const std::string& wanted) const;

  /// Returns what would be wrong with a term in this line, or with a new one, by itself.
  Findings check(const PolicyTerm& term, std::optional<std::size_t> line) const;
  /// Returns what would be wrong with a rule among the terms of the draft.
  Findings check(const PolicyRule& rule) const;

  void putTerm(std::size_t line, const PolicyTerm& term, const QString& undoText, MergeToken token = 0);
  void insertTerm(std::size_t line, const PolicyTerm& term, const QString& undoText);
  void removeTerm(std::size_t line);
  /// Gives a term another name, in the rules too.
  void renameTerm(std::size_t line, const std::string& name);
  void putRule(std::size_t line, const PolicyRule& rule, const QString& undoText);
  void insertRule(std::size_t line, const PolicyRule& rule, const QString& undoText);
  void removeRule(std::size_t line);
  void moveRule(std::size_t from, std::size_t to);
  /// Takes over another policy and switches it on.
  void replace(const Policy& policy, const QString& undoText);

 signals:
  void termsChanged();
  void rulesChanged();

 private:
  void readTerms();
  void readRules();
  Policy policy(PolicyNorm norm) const;
  /// Changes the lines of one key as a step.
  template <class Change>
  void change(std::string_view key, Change change, const QString& undoText, MergeToken token = 0);
  std::string written(const PolicyTerm& term);
  std::string written(const PolicyRule& rule);
  TextLines lines(std::string_view key) const;

  Draft& draft_;
  std::vector<TermLine> terms_;
  std::vector<RuleLine> rules_;
  /// The lines that are being written, which need not be read again.
  std::optional<TermLine> writtenTerm_;
  std::optional<RuleLine> writtenRule_;
};

/// Reports whether a term by itself compiles, so that its membership can be computed.
bool isSound(const PolicyTerm& term);
/// Returns findings of compile() or of policy files as sentences: the first ones, and how many more there
/// are.
QString sentences(const Findings& findings);

}  // namespace trimtab::views
