// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QColor>
#include <QString>
#include <QStringList>
#include <QVector>

class QPalette;

namespace trimtab::views {

/// What a benchmark measured, in the form that the plots of run time against error use.
struct ErrorRun {
  struct Error {
    QString key, label, unit;  ///< the unit is empty for a pure number
    bool largerIsWorse = true;
  };
  struct Mark {
    qsizetype frame = 0;  ///< index into the series
    QString why;
  };
  /// One preset in one culling case along one flight; all vectors have one entry per frame.
  struct Series {
    QString flight, preset, method;
    QVector<double> timeS, ms;
    QVector<QVector<double>> errors;  ///< by ErrorRun::errors, then by frame; NaN if not measured
    QVector<Mark> worst;
  };
  QVector<Error> errors;
  QVector<Series> series;
  int widthPx = 0, heightPx = 0;  ///< of the measured images; 0 if nothing was measured

  QStringList flights() const;
  /// Returns the presets in the order of their first series, which is the order of their colours.
  QStringList presets() const;
  QStringList methods() const;
};

/// Where equal images are drawn, whose PSNR is infinite.
inline constexpr double kEqualDb = 100;
/// Returns the place of an error on an axis: kEqualDb for an infinity of an error for which larger is better.
double placeOf(const ErrorRun::Error& error, double value);

/// Returns the label with the unit, for axes and choices.
QString titleOf(const ErrorRun::Error& error);
/// Returns the value with its unit to three digits; "∞ (equal images)" for an infinity, "–" for NaN.
QString textOf(const ErrorRun::Error& error, double value);
QString msText(double ms);
/// Returns the colour of the preset with this place in ErrorRun::presets(), which is never that of the live
/// point.
QColor presetColour(int preset, const QPalette& palette);
/// Returns a culling case as people read it: "view frustum" for "view_frustum".
QString methodText(const QString& method);

}  // namespace trimtab::views
