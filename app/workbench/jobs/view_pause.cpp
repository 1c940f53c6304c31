// SPDX-License-Identifier: GPL-3.0-or-later
#include "view_pause.h"

#include <algorithm>

namespace trimtab::workbench {

void ViewPause::begin(const QObject& who, const QString& what) {
  measuring_[&who] = what;
  connect(&who, &QObject::destroyed, this, &ViewPause::forget, Qt::UniqueConnection);
  emit changed();
}

void ViewPause::forget(const QObject* who) {
  if (measuring_.erase(who) > 0) emit changed();
}

bool ViewPause::onBut(const QObject& who) const {
  return std::ranges::any_of(measuring_, [&](const auto& each) { return each.first != &who; });
}

QString ViewPause::text() const {
  for (const auto& [who, what] : measuring_)
    if (!what.isEmpty())
      return tr("PAUSED: %1, and drawing would disturb the times. The view goes on when that ends.")
          .arg(what);
  return {};
}

}  // namespace trimtab::workbench
