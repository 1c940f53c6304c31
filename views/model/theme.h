// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QColor>
#include <QPalette>
#include <QString>
#include <optional>

class QCustomPlot;
class QWidget;

/// Colours and number texts that all docks share. Colours follow the palette, so dark mode works, and are
/// told apart by the colour blind (Okabe and Ito's set); plots add shapes and dashes.
namespace trimtab::views {

bool isDark(const QPalette& palette);
/// 0..6: blue, orange, green, purple, sky, vermilion, yellow.
QColor seriesColour(int index, const QPalette& palette);
QColor liveColour(const QPalette& palette);
QColor errorColour(const QPalette& palette);
QColor warningColour(const QPalette& palette);
/// Text that matters less; still readable.
QColor quietColour(const QPalette& palette);
/// `amount` of `over` on `under`, 0..1.
QColor blend(const QColor& under, const QColor& over, double amount);

/// What a focused widget that paints itself draws last.
void paintFocusFrame(QWidget& widget);

/// By palette, which is cheaper than a style sheet.
void setTextColour(QWidget& widget, const QColor& colour);

/// Palette colours and font on every axis, label, grid and legend of a plot.
void applyTheme(QCustomPlot& plot);

/// Shortest text of a number to at most `decimals`, in the person's locale: 4,000 or 0.35.
QString numberText(double value, int decimals);
/// The shortest that reads back the same value; plain digits unless that would be long.
QString exactText(double value);
/// The number in a text of the person's locale or of C, with or without `unit` after it. None: not a finite
/// number.
std::optional<double> parseNumber(const QString& text, const QString& unit);

/// The round number (1, 2 or 5 times a power of ten) nearest below `value`.
double roundStep(double value);

}  // namespace trimtab::views
