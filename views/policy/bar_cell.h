// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QStyledItemDelegate>

namespace trimtab::views {

/// The role under which a cell has the length of its bar, 0..1; no value is no bar.
inline constexpr int kBarRole = Qt::UserRole + 1;
/// The role under which a cell has its bar's colour.
inline constexpr int kBarColourRole = Qt::UserRole + 2;

/// Draws cells that have a bar as the bar with the text on it.
class BarCell : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;
  void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override;
};

/// Returns a share in steps that a bar can show, so that a cell is repainted only if it looks different.
double shownShare(double share);

}  // namespace trimtab::views
