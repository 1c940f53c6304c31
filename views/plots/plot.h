// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <qcustomplot.h>

#include <initializer_list>

namespace trimtab::views {

class TimeCursor;

/// What all plots of the workbench share: their name for assistive technology, the colours and fonts of the
/// theme, the focus frame, zooming by wheel and keys, overlays that move without a replot of the rest, and
/// the items from which budgets, cursors and readouts are made. Lives in the GUI thread.
class Plot : public QCustomPlot {
  Q_OBJECT
  friend class TimeCursor;

 public:
  enum class Keyboard { ignored, used };

 protected:
  /// With Keyboard::used, Tab reaches the plot, and the plot shows when it has the focus.
  Plot(const QString& accessibleName, Keyboard keyboard, QWidget* parent);

  /// Applies all colours and fonts and draws again. Called when the palette or font changes.
  virtual void restyle() = 0;
  /// Draws what depends on the size. Called after each change of size; the axes are drawn in any case.
  virtual void resized() {}
  /// Scales the visible range; a factor below 1 shows less. Called for the keys plus and minus. Returns false
  /// if keys do not zoom this plot.
  virtual bool zoomByKey(double /*factor*/) { return false; }

  /// Zooms where the pointer is. Called for the wheel with Ctrl; without Ctrl the wheel is left to whatever
  /// scrolls around the plot, which it would otherwise stop at every plot.
  virtual void zoomByWheel(QWheelEvent* event) { QCustomPlot::wheelEvent(event); }
  void wheelEvent(QWheelEvent* event) final;
  /// Calls zoomByKey() for plus and minus, and leaves any other key to QCustomPlot.
  void keyPressEvent(QKeyEvent* event) override;
  /// Keeps Home for itself if it uses the keyboard, since Home is a command of the window too.
  bool event(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

  /// How much the wheel scales a range per notch.
  static constexpr double kWheelZoom = 0.85;
  /// An axis ends at this many times what all but a few values keep to, so that those few do not flatten the
  /// rest.
  static constexpr double kMostOverUsual = 3;
  static double wheelFactor(const QWheelEvent& event);

  /// Adds layers above all others, lowest first, each of which can be replotted on its own.
  void addOverlays(std::initializer_list<const char*> names);
  /// Returns a legend without a frame whose entries fill rows, to be put into a layout. Only entries that are
  /// added by hand appear in it.
  static QCPLegend* makeLegend();
  /// Shows a legend if it has entries, in as many rows as this width asks for, but with at least `least`
  /// entries in a row.
  void wrapLegend(QCPLegend& entries, int widthPx, int least = 1) const;
  /// Replaces the legend by one above the plot, whose entries fill rows. Only entries that are added by hand
  /// appear in it.
  void addLegendAbove();
  /// Shows the legend above the plot if it has entries, wrapped to the width of the plot, and draws again.
  void arrangeLegendAbove();
  /// Applies the colours of the theme to all axes and removes the frame of the legend above the plot.
  void applyThemeWithLegendAbove();

  /// Adds a colour scale to the right of the axes and as high as they are. The mouse does not change its
  /// range.
  QCPColorScale* addColourScale(const QCPColorGradient& gradient);
  /// Gives a colour scale, which applyTheme() does not reach, the colours of the theme and the font.
  void applyThemeTo(QCPColorScale& scale) const;

  /// Returns a hidden text whose position is in pixels of this widget and which no axis rect clips.
  QCPItemText* addReadout(const char* layerName, const QMargins& padding);
  /// Shows a text of several lines beside a point in pixels, moved so that it stays inside the widget.
  void placeReadout(QCPItemText& readout, const QString& text, QPointF beside) const;
  /// Returns a straight line that this axis rect clips and whose coordinates are those of its axes.
  QCPItemStraightLine* addLine(const char* layerName, QCPAxisRect* rect);
  static void putVertical(QCPItemStraightLine& line, double key);
  static void putHorizontal(QCPItemStraightLine& line, double value);
};

}  // namespace trimtab::views
