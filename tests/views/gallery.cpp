// SPDX-License-Identifier: GPL-3.0-or-later
#include <QApplication>
#include <QDir>
#include <QElapsedTimer>
#include <QFontDatabase>
#include <QStyleFactory>
#include <clocale>
#include <cstdio>

#include "live_flight.h"
#include "trimtab/views/band_scale.h"
#include "trimtab/views/bands_editor.h"
#include "trimtab/views/curve_plot.h"
#include "trimtab/views/decision_panel.h"
#include "trimtab/views/membership_editor.h"
#include "trimtab/views/parameter_table.h"
#include "trimtab/views/plots_panel.h"
#include "trimtab/views/time_plot.h"

// Draws every dock with live data into PNG files, for a person to look at: views_gallery DIR [dark].
namespace {

using namespace trimtab;
using namespace trimtab::views;

QPalette darkPalette() {
  QPalette p;
  p.setColor(QPalette::Window, QColor(45, 45, 48));
  p.setColor(QPalette::WindowText, QColor(230, 230, 230));
  p.setColor(QPalette::Base, QColor(30, 30, 32));
  p.setColor(QPalette::AlternateBase, QColor(38, 38, 41));
  p.setColor(QPalette::Text, QColor(230, 230, 230));
  p.setColor(QPalette::Button, QColor(55, 55, 58));
  p.setColor(QPalette::ButtonText, QColor(230, 230, 230));
  p.setColor(QPalette::ToolTipBase, QColor(55, 55, 58));
  p.setColor(QPalette::ToolTipText, QColor(230, 230, 230));
  p.setColor(QPalette::Highlight, QColor(42, 110, 180));
  p.setColor(QPalette::PlaceholderText, QColor(150, 150, 150));
  for (const auto role : {QPalette::Text, QPalette::WindowText, QPalette::ButtonText})
    p.setColor(QPalette::Disabled, role, QColor(128, 128, 128));
  return p;
}

void settle(int ms = 120) {
  QElapsedTimer timer;
  timer.start();
  while (timer.elapsed() < ms) QCoreApplication::processEvents(QEventLoop::AllEvents, 10);
}

void shoot(QWidget& widget, const QSize& size, const QString& file) {
  widget.resize(size);
  widget.show();
  settle();
  widget.grab().save(file);
  std::printf("%s\n", qPrintable(file));
}

}  // namespace

int main(int argc, char** argv) {
  QApplication app(argc, argv);
  std::setlocale(LC_NUMERIC, "C");
  if (argc < 2) return 2;
  app.setStyle(QStyleFactory::create(QStringLiteral("Fusion")));
  if (argc > 2) app.setPalette(darkPalette());
  const QDir dir(QString::fromLocal8Bit(argv[1]));
  dir.mkpath(QStringLiteral("."));

  Draft draft;
  test::LiveFlight flight(14);
  MembershipEditor memberships(draft);
  for (int i = 0; i < 60; ++i) memberships.showFrame(flight.next(draft.active()));
  memberships.altitude().plot().select(1);
  shoot(memberships, {480, 560}, dir.filePath(QStringLiteral("memberships.png")));
  draft.setValue("fuzzy.altitude.reading", ChoiceIndex{2});
  draft.setValue("fuzzy.pitch.reading", ChoiceIndex{1});
  shoot(memberships, {640, 560}, dir.filePath(QStringLiteral("memberships_as_printed.png")));

  BandsEditor bands(draft);
  for (int i = 0; i < 60; ++i) bands.showFrame(flight.next(draft.active()));
  bands.scale().select(1);
  shoot(bands, {480, 560}, dir.filePath(QStringLiteral("bands.png")));
  QImage map(400, 300, QImage::Format_Grayscale8);
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 400; ++x)
      map.scanLine(y)[x] =
          static_cast<uchar>(y < 120 + 30 * std::sin(x * 0.03) ? 255 : 255 * (300 - y) / 300);
  bands.showDepthMap(map, QStringLiteral("400 × 300 px, near 1 m, far 38,200 m"));
  draft.setValue("fuzzy.hysteresis", 0.3);
  shoot(bands, {480, 560}, dir.filePath(QStringLiteral("bands_broken.png")));
  draft.resetAll();

  ParameterTable parameters(draft);
  draft.setValue("fuzzy.hysteresis", 0.3);
  draft.setValue("lod.scale", 30.0);
  shoot(parameters, {520, 760}, dir.filePath(QStringLiteral("parameters.png")));
  draft.resetAll();

  DecisionPanel decision(draft);
  for (int i = 0; i < 6000; ++i) decision.showFrame(flight.next(draft.active()));
  shoot(decision, {520, 520}, dir.filePath(QStringLiteral("decision.png")));

  PlotsPanel plots(draft);
  for (int i = 0; i < 60 * 90; ++i) plots.showFrame(flight.next(draft.active()));
  shoot(plots, {680, 520}, dir.filePath(QStringLiteral("plots.png")));
  plots.setCursors(true);
  shoot(plots, {680, 700}, dir.filePath(QStringLiteral("plots_cursors.png")));
  plots.setCursors(false);
  for (int i = 0; i < 60 * 3500; ++i) plots.showFrame(flight.next(draft.active()));
  for (const double span : {60.0, 600.0, 3600.0}) {
    plots.plot().setSpan(span);
    settle();
    QElapsedTimer timer;
    timer.start();
    for (int i = 0; i < 20; ++i) {
      plots.showFrame(flight.next(draft.active()));
      plots.plot().refresh(true);
      plots.plot().replot();
    }
    std::printf("%g s shown: %.2f ms a refresh\n", span, static_cast<double>(timer.nsecsElapsed()) / 20e6);
  }
  shoot(plots, {680, 520}, dir.filePath(QStringLiteral("plots_hour.png")));
  return 0;
}
