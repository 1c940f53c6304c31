// SPDX-License-Identifier: GPL-3.0-or-later
#include "reason_list.h"

#include <QScrollBar>

namespace trimtab::views {
namespace {

constexpr int kMostReasons = 500, kLeastLines = 4;

}  // namespace

ReasonList::ReasonList(QWidget* parent) : QListWidget(parent) {
  setWordWrap(true);
  setResizeMode(Adjust);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setSelectionMode(ExtendedSelection);
  setMinimumHeight(fontMetrics().height() * kLeastLines);
}

void ReasonList::add(double timeS, const std::string& reason) {
  const QScrollBar* bar = verticalScrollBar();
  const bool follow = bar->value() == bar->maximum();
  addItem(tr("%1 s  %2").arg(timeS, 0, 'f', 3).arg(QString::fromStdString(reason)));
  while (count() > kMostReasons) delete takeItem(0);
  if (follow) scrollToBottom();
}

}  // namespace trimtab::views
