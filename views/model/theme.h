// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QColor>
#include <QPalette>
#include <QString>
#include <functional>
#include <optional>
#include <string_view>

class QCustomPlot;
class QWidget;

/// Colours and number texts that all docks share. The colours follow the palette, so that dark mode works,
/// and colour-blind people can tell them apart (Okabe and Ito's set); plots add shapes and dashes.
namespace trimtab::views {

bool isDark(const QPalette& palette);
/// Returns the colour of series 0..6: blue, orange, green, purple, sky, vermilion, yellow.
QColor seriesColour(int index, const QPalette& palette);
QColor liveColour(const QPalette& palette);
QColor errorColour(const QPalette& palette);
QColor warningColour(const QPalette& palette);
/// Returns a colour for text that matters less and is still readable.
QColor quietColour(const QPalette& palette);
/// Returns `under` with a share `amount`, 0..1, of `over` on it.
QColor blend(const QColor& under, const QColor& over, double amount);

/// Draws the focus frame of a widget that paints itself; call it last.
void paintFocusFrame(QWidget& widget);

/// What the colour of a text says.
enum class Ink { plain, quiet, warning, error };
QColor colourOf(Ink ink, const QPalette& palette);
/// Gives the text of a widget the colour of `ink`, in every theme that is chosen while the widget lives. It
/// sets the palette, which is cheaper than a style sheet.
void setInk(QWidget& widget, Ink ink);
/// Calls `act` whenever the theme changes while the widget lives. It is for colours that something keeps,
/// such as the text of a label in HTML.
void whenThemeChanges(QWidget& widget, std::function<void()> act);

/// Gives every axis, label, grid and legend of a plot the colours of the palette and the font.
void applyTheme(QCustomPlot& plot);

/// Returns the shortest text of a number with at most `decimals` decimals, in the person's locale: 4,000 or
/// 0.35.
QString numberText(double value, int decimals);
/// Returns the shortest text that reads back to the same value, in plain digits unless that would be long.
QString exactText(double value);
/// Returns text of the library, which is UTF-8, as Qt has it.
inline QString fromView(std::string_view text) {
  return QString::fromUtf8(text.data(), qsizetype(text.size()));
}
/// Reads a number in the person's locale or in that of C, with or without `unit` after it. Returns nothing if
/// it is no finite number.
std::optional<double> parseNumber(const QString& text, const QString& unit);

/// Returns the largest round number (1, 2 or 5 times a power of ten) that is not above `value`.
double roundStep(double value);

}  // namespace trimtab::views
