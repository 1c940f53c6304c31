// SPDX-License-Identifier: GPL-3.0-or-later
#include "fuzzy_match.h"

#include <algorithm>
#include <vector>

namespace trimtab::workbench {
namespace {

constexpr int kNone = -1000000;
constexpr int kLetter = 4, kWordStart = 12, kFollows = 12;

bool beginsWord(QStringView text, qsizetype at) {
  return text[at].isLetterOrNumber() && (at == 0 || !text[at - 1].isLetterOrNumber());
}

}  // namespace

std::optional<int> fuzzyScore(QStringView typed, QStringView text) {
  // best[i]: of the letters so far, the last of which is text[i].
  std::vector<int> best(std::size_t(text.size()), 0);
  bool first = true;
  for (const QChar letter : typed) {
    if (letter.isSpace()) continue;
    std::vector<int> next(best.size(), kNone);
    int before = kNone;  // the best that ends before text[i - 1]
    for (qsizetype i = 0; i < text.size(); ++i) {
      const std::size_t at = std::size_t(i);
      if (i >= 2) before = std::max(before, best[at - 2]);
      if (text[i].toCaseFolded() != letter.toCaseFolded()) continue;
      const int own = kLetter + (beginsWord(text, i) ? kWordStart : 0);
      const int follows = i > 0 ? best[at - 1] + kFollows : kNone;
      const int from = first ? 0 : std::max(before, follows);
      if (from > kNone / 2) next[at] = from + own;
    }
    best = std::move(next);
    first = false;
  }
  if (first) return 0;
  const auto top = std::max_element(best.begin(), best.end());
  if (top == best.end() || *top < 0) return std::nullopt;
  return *top * 8 - static_cast<int>(std::min<qsizetype>(text.size(), 200));
}

}  // namespace trimtab::workbench
