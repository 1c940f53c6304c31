// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QLineEdit>
#include <QStringList>
#include <algorithm>

namespace trimtab::views {

/// The line above a list in which a person types what to search it for.
class SearchField : public QLineEdit {
 public:
  explicit SearchField(const QString& purpose) {
    setPlaceholderText(purpose);
    setAccessibleName(purpose);
    setClearButtonEnabled(true);
  }
  bool isUsed() const { return !text().trimmed().isEmpty(); }
  /// Reports whether each typed word is in one of the texts of an entry; true while nothing is typed.
  bool finds(const QStringList& texts) const {
    const QStringList words = text().split(QLatin1Char(' '), Qt::SkipEmptyParts);
    return std::ranges::all_of(words, [&](const QString& word) {
      return std::ranges::any_of(
          texts, [&](const QString& each) { return each.contains(word, Qt::CaseInsensitive); });
    });
  }
};

}  // namespace trimtab::views
