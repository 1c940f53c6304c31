// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_run.h"

#include <QCoreApplication>
#include <algorithm>
#include <cmath>

#include "theme.h"

namespace trimtab::views {
namespace {

constexpr int kDigits = 3, kMostDecimals = 6;

QStringList distinct(const QVector<ErrorRun::Series>& series, QString ErrorRun::Series::*name) {
  QStringList names;
  for (const ErrorRun::Series& s : series)
    if (!names.contains(s.*name)) names << s.*name;
  return names;
}

QString digits(double value) {
  if (value == 0 || !std::isfinite(value)) return numberText(value, 0);
  const int lead = static_cast<int>(std::floor(std::log10(std::abs(value))));
  return numberText(value, std::clamp(kDigits - 1 - lead, 0, kMostDecimals));
}

}  // namespace

QStringList ErrorRun::flights() const {
  return distinct(series, &Series::flight);
}
QStringList ErrorRun::presets() const {
  return distinct(series, &Series::preset);
}
QStringList ErrorRun::methods() const {
  return distinct(series, &Series::method);
}

double placeOf(const ErrorRun::Error& error, double value) {
  return std::isinf(value) && !error.largerIsWorse ? kEqualDb : value;
}

QString titleOf(const ErrorRun::Error& error) {
  return error.unit.isEmpty() ? error.label : QStringLiteral("%1 (%2)").arg(error.label, error.unit);
}

QString textOf(const ErrorRun::Error& error, double value) {
  if (std::isinf(value)) return QCoreApplication::translate("ErrorRun", "∞ (equal images)");
  const QString number = digits(value);
  return error.unit.isEmpty() || std::isnan(value) ? number : number + QLatin1Char(' ') + error.unit;
}

QString msText(double ms) {
  return std::isfinite(ms) ? digits(ms) + QStringLiteral(" ms") : QStringLiteral("–");
}

QColor presetColour(int preset, const QPalette& palette) {
  return seriesColour(preset > 0 ? preset + 1 : 0, palette);
}

QString methodText(const QString& method) {
  return QString(method).replace(QLatin1Char('_'), QLatin1Char(' '));
}

}  // namespace trimtab::views
