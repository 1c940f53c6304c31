// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameter_of.h"

#include <QVariant>
#include <QWidget>

#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr auto kProperty = "trimtab_parameter";

}  // namespace

void markParameter(QWidget& control, std::string_view key) {
  control.setProperty(kProperty, fromView(key));
}

QString parameterOf(const QWidget* control) {
  for (; control != nullptr; control = control->parentWidget())
    if (const QVariant key = control->property(kProperty); key.isValid()) return key.toString();
  return {};
}

}  // namespace trimtab::views
