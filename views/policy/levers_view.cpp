// SPDX-License-Identifier: GPL-3.0-or-later
#include "levers_view.h"

#include <QHelpEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>
#include <cmath>

#include "trimtab/units/not_finite.h"
#include "views/model/ig_words.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr std::size_t kMostRules = 4;

/// Where a value lies on the bar, 0..1.
double placeOf(const LeverRow& row, double value) {
  const double place = row.logarithmic
                           ? std::log(value / row.hard.low) / std::log(row.hard.high / row.hard.low)
                           : (value - row.hard.low) / (row.hard.high - row.hard.low);
  return std::clamp(place, 0.0, 1.0);
}

double shownPlace(const LeverRow& row, double value) {
  return std::isnan(value) ? kNan : std::round(placeOf(row, value) * 400) / 400;
}

}  // namespace

QString whyText(const PolicyLive& live, Lever lever) {
  if (const QString lacks = lacksText(live.ig, rowOf(lever).key); !lacks.isEmpty()) return lacks;
  if (!live.decided) return QObject::tr("no policy is switched on");
  if (!live.compiled->moves(lever)) return QObject::tr("no rule sets it: as the preset says");
  std::vector<std::pair<double, std::size_t>> shares;
  for (std::size_t r = 0; r < live.policy.rules.size(); ++r)
    if (const double share = live.share(r, lever); share >= 0.005) shares.push_back({-share, r});
  if (shares.empty()) return QObject::tr("no rule fires: neutral");
  std::sort(shares.begin(), shares.end());
  QStringList texts;
  for (std::size_t i = 0; i < std::min(kMostRules, shares.size()); ++i)
    texts << QObject::tr("rule %1 %2 %").arg(shares[i].second + 1).arg(-100 * shares[i].first, 0, 'f', 0);
  if (shares.size() > kMostRules) texts << QObject::tr("%1 more").arg(shares.size() - kMostRules);
  return texts.join(QStringLiteral(", "));
}

LeversView::LeversView(QWidget* parent) : QWidget(parent) {
  setAccessibleName(tr("Levers"));
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::MinimumExpanding);
  showLive({});
}

LeversView::Bar LeversView::barOf(const PolicyLive& live, const LeverRow& row) const {
  Bar bar;
  bar.moved = live.decided && live.compiled->moves(row.lever) && lacksText(live.ig, row.key).isEmpty();
  bar.why = whyText(live, row.lever);
  const double value = bar.moved ? live.outcome[row.lever] : kNan;
  bar.value = bar.moved ? shownPlace(row, value) : -1;
  bar.target = bar.moved ? shownPlace(row, live.decision.target[row.lever]) : kNan;
  bar.own = ownRangeText(live.ig, row.key);
  bar.text = bar.moved ? leverText(row.lever, value) : QStringLiteral("–");
  return bar;
}

void LeversView::showLive(const PolicyLive& live) {
  std::array<Bar, kLevers> bars;
  for (const LeverRow& row : kLeverRows) bars[indexOf(row.lever)] = barOf(live, row);
  if (bars == bars_) return;
  bars_ = std::move(bars);
  setAccessibleDescription(lines().join(QLatin1Char('\n')));
  update();
}

QStringList LeversView::lines() const {
  QStringList texts;
  for (const LeverRow& row : kLeverRows) {
    const Bar& bar = bars_[indexOf(row.lever)];
    texts << QStringLiteral("%1 %2: %3").arg(fromView(row.label), bar.text, bar.why);
  }
  return texts;
}

int LeversView::rowHeight() const {
  return 2 * fontMetrics().height() + 7;
}

QSize LeversView::sizeHint() const {
  return {fontMetrics().averageCharWidth() * 70, rowHeight() * static_cast<int>(kLevers) + 4};
}
QSize LeversView::minimumSizeHint() const {
  return {fontMetrics().averageCharWidth() * 40, sizeHint().height()};
}

void LeversView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  int top = 2;
  for (const LeverRow& row : kLeverRows) {
    paintLever(painter, row, bars_[indexOf(row.lever)], top);
    top += rowHeight();
  }
}

void LeversView::paintLever(QPainter& painter, const LeverRow& row, const Bar& bar, int top) const {
  const QColor base = palette().color(QPalette::Base), ink = palette().color(QPalette::WindowText),
               quiet = quietColour(palette());
  const int line = fontMetrics().height(), names = std::min(width() * 2 / 5, line * 13);
  const QString name = fromView(row.label);
  painter.setPen(bar.moved ? ink : quiet);
  painter.drawText(QRect(4, top, names - 8, line), Qt::AlignVCenter,
                   fontMetrics().elidedText(name, Qt::ElideRight, names - 8));
  QFont bold = font();
  bold.setBold(bar.moved);
  painter.setFont(bold);
  painter.drawText(QRect(4, top + line, names - 8, line), Qt::AlignVCenter,
                   painter.fontMetrics().elidedText(bar.text, Qt::ElideRight, names - 8));
  painter.setFont(font());

  const QRectF track(names, top + 3, std::max(20, width() - names - 8), line - 4);
  const auto x = [&](double place) { return track.left() + place * track.width(); };
  painter.fillRect(track, base);
  QRectF usual = track;
  usual.setLeft(x(placeOf(row, row.usual.low)));
  usual.setRight(x(placeOf(row, row.usual.high)));
  painter.fillRect(usual, blend(base, ink, 0.12));
  if (bar.moved) {
    QRectF filled = track.adjusted(0, 2, 0, -2);
    filled.setWidth(bar.value * track.width());
    painter.fillRect(filled, blend(base, seriesColour(0, palette()), 0.75));
  }
  painter.setPen(blend(base, ink, 0.4));
  painter.drawRect(track);
  if (std::isfinite(row.neutral)) {
    painter.setPen(QPen(ink, 1.4, Qt::DotLine));
    const double at = x(placeOf(row, row.neutral));
    painter.drawLine(QPointF(at, track.top() - 3), QPointF(at, track.bottom() + 3));
  }
  if (!std::isnan(bar.target)) {
    painter.setPen(QPen(liveColour(palette()), 2));
    painter.drawLine(QPointF(x(bar.target), track.top() - 1), QPointF(x(bar.target), track.bottom() + 1));
  }
  const QString low = numberText(row.hard.low, 2), high = numberText(row.hard.high, 2);
  const int numbers = fontMetrics().horizontalAdvance(high);
  painter.setPen(quiet);
  painter.drawText(QRectF(track.left(), top + line, track.width(), line), Qt::AlignVCenter | Qt::AlignLeft,
                   low);
  painter.drawText(QRectF(track.left(), top + line, track.width(), line), Qt::AlignVCenter | Qt::AlignRight,
                   high);
  const int ends = std::max(numbers, fontMetrics().horizontalAdvance(low)) + 8;
  painter.setPen(bar.moved ? ink : quiet);
  const int space = static_cast<int>(track.width()) - 2 * ends;
  painter.drawText(QRectF(track.left() + ends, top + line, space, line), Qt::AlignCenter,
                   fontMetrics().elidedText(bar.why, Qt::ElideRight, space));
}

bool LeversView::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  auto& help = *static_cast<QHelpEvent*>(event);
  const int at = (help.pos().y() - 2) / rowHeight();
  if (at < 0 || at >= static_cast<int>(kLevers)) {
    QToolTip::hideText();
    return true;
  }
  const LeverRow& row = kLeverRows[static_cast<std::size_t>(at)];
  const QString cost = row.larger == CostOf::rises   ? tr("A larger value costs time.")
                       : row.larger == CostOf::falls ? tr("A larger value saves time.")
                                                     : tr("A larger value may cost or save time.");
  QToolTip::showText(
      help.globalPos(),
      tr("<p><b>%1</b>: %2.</p><p>It is %3.</p><p>Hard limits %4 to %5, usually %6 to %7 (shaded). Neutral "
         "(dotted): %8. %9</p><p>%10</p>")
          .arg(fromView(row.label), fromView(row.means), bars_[static_cast<std::size_t>(at)].why,
               leverText(row.lever, row.hard.low), leverText(row.lever, row.hard.high),
               numberText(row.usual.low, 2), leverText(row.lever, row.usual.high),
               std::isfinite(row.neutral) ? leverText(row.lever, row.neutral) : tr("the preset's own"), cost,
               bars_[static_cast<std::size_t>(at)].own.toHtmlEscaped()),
      this);
  return true;
}

}  // namespace trimtab::views
