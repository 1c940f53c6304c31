// SPDX-License-Identifier: GPL-3.0-or-later
#include "theme.h"

#include <qcustomplot.h>

#include <QApplication>
#include <QEvent>
#include <QLocale>
#include <QPainter>
#include <array>
#include <cmath>

namespace trimtab::views {
namespace {

constexpr const char* kInk = "trimtab_ink";

/// Calls a function when the palette of its widget has changed.
class ThemeWatch : public QObject {
 public:
  ThemeWatch(QWidget& widget, std::function<void()> act) : QObject(&widget), act_(std::move(act)) {}
  bool eventFilter(QObject*, QEvent* event) override {
    if (event->type() == QEvent::PaletteChange) act_();
    return false;
  }

 private:
  std::function<void()> act_;
};

/// The colour comes from the palette of the program: that of the widget has the ink of before in it.
void showInk(QWidget& widget) {
  const auto ink = static_cast<Ink>(widget.property(kInk).toInt());
  QPalette own;  // sets no colour yet: the widget looks as its parent does
  if (ink != Ink::plain) own.setColor(widget.foregroundRole(), colourOf(ink, QApplication::palette(&widget)));
  widget.setPalette(own);
}

}  // namespace

bool isDark(const QPalette& palette) {
  return palette.color(QPalette::Base).lightness() < palette.color(QPalette::Text).lightness();
}

QColor seriesColour(int index, const QPalette& palette) {
  // Blue, green, purple and yellow are shifted a little against their background for contrast.
  static constexpr std::array<QRgb, 7> kOnLight{0xff0072b2, 0xffd55e00, 0xff008a63, 0xffb2558c,
                                                0xff2a93cc, 0xff8c3d00, 0xff9a8a00};
  static constexpr std::array<QRgb, 7> kOnDark{0xff4aa3df, 0xffff8c3a, 0xff2fc494, 0xffe39ac4,
                                               0xff8fd3ff, 0xffffb27a, 0xfff0e442};
  const auto& set = isDark(palette) ? kOnDark : kOnLight;
  return QColor::fromRgb(set[static_cast<std::size_t>(index) % set.size()]);
}

QColor liveColour(const QPalette& palette) {
  return seriesColour(1, palette);
}
QColor errorColour(const QPalette& palette) {
  return isDark(palette) ? QColor(0xff, 0x7b, 0x72) : QColor(0xb3, 0x1d, 0x28);
}
QColor warningColour(const QPalette& palette) {
  return isDark(palette) ? QColor(0xf2, 0xb4, 0x4b) : QColor(0x8a, 0x55, 0x00);
}
QColor quietColour(const QPalette& palette) {
  return blend(palette.color(QPalette::Base), palette.color(QPalette::Text), 0.66);
}

QColor blend(const QColor& under, const QColor& over, double amount) {
  const auto mix = [&](int a, int b) { return static_cast<int>(std::lround(a + (b - a) * amount)); };
  return {mix(under.red(), over.red()), mix(under.green(), over.green()), mix(under.blue(), over.blue())};
}

void paintFocusFrame(QWidget& widget) {
  if (!widget.hasFocus()) return;
  QPainter painter(&widget);
  painter.setPen(QPen(widget.palette().color(QPalette::Highlight), 2));
  painter.drawRect(widget.rect().adjusted(1, 1, -1, -1));
}

QColor colourOf(Ink ink, const QPalette& palette) {
  switch (ink) {
    case Ink::quiet:
      return quietColour(palette);
    case Ink::warning:
      return warningColour(palette);
    case Ink::error:
      return errorColour(palette);
    case Ink::plain:
      break;
  }
  return palette.color(QPalette::WindowText);
}

void setInk(QWidget& widget, Ink ink) {
  const QVariant before = widget.property(kInk);
  if (before == static_cast<int>(ink)) return;
  widget.setProperty(kInk, static_cast<int>(ink));
  showInk(widget);
  if (!before.isValid()) whenThemeChanges(widget, [&widget] { showInk(widget); });
}

void whenThemeChanges(QWidget& widget, std::function<void()> act) {
  widget.installEventFilter(new ThemeWatch(widget, std::move(act)));
}

void applyTheme(QCustomPlot& plot) {
  const QPalette palette = plot.palette();
  const QColor base = palette.color(QPalette::Base), ink = palette.color(QPalette::Text);
  const QPen axis(blend(base, ink, 0.55)), grid(blend(base, ink, 0.13));
  plot.setBackground(QBrush(base));
  for (QCPAxisRect* rect : plot.axisRects())
    for (QCPAxis* a : rect->axes()) {
      a->setBasePen(axis);
      a->setTickPen(axis);
      a->setSubTickPen(axis);
      a->setTickLabelColor(ink);
      a->setLabelColor(ink);
      a->setTickLabelFont(plot.font());
      a->setLabelFont(plot.font());
      a->grid()->setPen(grid);
      a->grid()->setZeroLinePen(grid);
      a->setSelectedBasePen(axis);
    }
  if (plot.legend) {
    QColor back = base;
    back.setAlpha(210);
    plot.legend->setBrush(back);
    plot.legend->setBorderPen(grid);
    plot.legend->setTextColor(ink);
    plot.legend->setFont(plot.font());
  }
}

QString numberText(double value, int decimals) {
  if (std::isnan(value)) return QStringLiteral("–");
  const QLocale locale;
  QString text = locale.toString(value, 'f', decimals);
  const QString point = locale.decimalPoint();
  if (text.contains(point)) {
    while (text.endsWith(QLatin1Char('0'))) text.chop(1);
    if (text.endsWith(point)) text.chop(point.size());
  }
  return text == locale.negativeSign() + QLatin1Char('0') ? QStringLiteral("0") : text;
}

QString exactText(double value) {
  const QString text = QLocale().toString(value, 'f', QLocale::FloatingPointShortest);
  return text.size() > 12 ? QLocale().toString(value, 'g', QLocale::FloatingPointShortest) : text;
}

std::optional<double> parseNumber(const QString& text, const QString& unit) {
  QString bare = text.trimmed();
  if (!unit.isEmpty() && bare.endsWith(unit, Qt::CaseInsensitive)) bare.chop(unit.size());
  bare = bare.trimmed();
  bare.replace(QChar(0x2212), QLatin1Char('-'));
  bool ok = false;
  double value = QLocale().toDouble(bare, &ok);
  if (!ok) value = QLocale::c().toDouble(bare, &ok);
  if (!ok || !std::isfinite(value)) return std::nullopt;
  return value;
}

double roundStep(double value) {
  if (!(value > 0) || !std::isfinite(value)) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  const double lead = value / power;
  return (lead >= 5 ? 5 : lead >= 2 ? 2 : 1) * power;
}

}  // namespace trimtab::views
