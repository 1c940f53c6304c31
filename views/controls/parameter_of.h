// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <string_view>

class QWidget;

namespace trimtab::views {

/// Notes which parameter a control sets, so that help finds it.
void markParameter(QWidget& control, std::string_view key);
/// Returns the key of the parameter that this control, or the nearest one around it, sets; empty if none
/// does.
QString parameterOf(const QWidget* control);

}  // namespace trimtab::views
