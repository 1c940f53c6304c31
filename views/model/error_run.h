// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QColor>
#include <QString>
#include <QStringList>
#include <QVector>

class QCustomPlot;
class QPalette;

namespace trimtab::views {

/// What a benchmark measured, as the plots of run time against error see it.
struct ErrorRun {
  struct Error {
    QString key, label, unit;  ///< unit empty: a pure number
    bool largerIsWorse = true;
  };
  struct Mark {
    qsizetype frame = 0;  ///< index into the series
    QString why;
  };
  /// One preset in one culling case along one flight; all vectors have one entry a frame.
  struct Series {
    QString flight, preset, method;
    QVector<double> timeS, ms;
    QVector<QVector<double>> errors;  ///< by ErrorRun::errors, then by frame; NaN: not measured
    QVector<Mark> worst;
  };
  QVector<Error> errors;
  QVector<Series> series;

  QStringList flights() const;
  /// In the order of their first series, which is the order of their colours.
  QStringList presets() const;
  QStringList methods() const;
};

/// Pictures that are equal have a PSNR that no axis holds: they are drawn here.
inline constexpr double kEqualDb = 100;
/// The place of an error on an axis: infinity where larger is better is kEqualDb.
double placeOf(const ErrorRun::Error& error, double value);

/// Label with unit, for axes and choices.
QString titleOf(const ErrorRun::Error& error);
/// Value with unit to three digits; "equal" for what has no difference to measure, "–" for NaN.
QString textOf(const ErrorRun::Error& error, double value);
QString msText(double ms);
/// Of the preset with this place in ErrorRun::presets(); never the live point's colour.
QColor presetColour(int preset, const QPalette& palette);
/// A culling case as choices spell it: "view_frustum" is "view frustum".
QString methodText(const QString& method);

}  // namespace trimtab::views
