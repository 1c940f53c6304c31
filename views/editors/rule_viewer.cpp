// SPDX-License-Identifier: GPL-3.0-or-later
#include "rule_viewer.h"

#include <QPainter>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "rule_edit.h"
#include "trimtab/fuzzy/combination.h"
#include "views/model/theme.h"

namespace trimtab::views {

struct RuleViewer::Row {
  FuzzyRule rule;
  std::optional<double> altitude, pitch;  ///< none: no such condition
  double firing = 0, counts = 0;
};

struct RuleViewer::Picture {
  std::vector<Row> rows;
  TotalMembership total;
  double top = 1;  ///< of the bars of lambda mu: the largest weight
};

RuleViewer::RuleViewer(Draft& draft, QWidget* parent)
    : QWidget(parent), draft_(draft), throttle_(this, [this] {
        setAccessibleDescription(lines().join(QLatin1Char('\n')));
        update();
      }) {
  setAccessibleName(tr("Firing of the rules"));
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::MinimumExpanding);
  connect(&draft_, &Draft::activeChanged, this, [this] {
    updateGeometry();
    throttle_.request();
  });
}

void RuleViewer::showFrame(const LiveFrame& frame) {
  any_ = frame.decision.reason != SchemeReason::invalid_input &&
         frame.decision.reason != SchemeReason::altitude_unknown;
  decision_ = frame.decision;
  throttle_.request();
}

RuleViewer::Picture RuleViewer::picture() const {
  const RuleList& rules = draft_.active()->scheme.rules;
  const double altitude = any_ ? decision_.altitudeMembership : 0,
               pitch = any_ ? decision_.pitchMembership : 0;
  RuleFiring firing = ruleFiring(rules, altitude, pitch);
  if (!any_) std::fill_n(firing.mu.begin(), firing.count, 0.0);
  Picture p;
  p.total = weightedOutput(rules, firing);
  p.top = 0;
  for (std::size_t i = 0; i < rules.size; ++i) {
    const FuzzyRule& rule = rules.rule[i];
    Row row{rule, {}, {}, firing.mu[i], rule.weight * firing.mu[i]};
    if (any_ && rule.altitude != AltitudeCondition::any)
      row.altitude = rule.altitude == AltitudeCondition::low ? altitude : 1 - altitude;
    if (any_ && rule.pitch != PitchCondition::any)
      row.pitch = rule.pitch == PitchCondition::nose_down ? pitch : 1 - pitch;
    p.rows.push_back(row);
    p.top = std::max(p.top, rule.weight);
  }
  if (!(p.top > 0)) p.top = 1;
  return p;
}

QStringList RuleViewer::lines() const {
  if (!any_) return {tr("No frame has been decided yet")};
  const Picture p = picture();
  const auto text = [](double value) { return QString::number(value, 'f', 3); };
  const auto condition = [&](const std::optional<double>& mu) { return mu ? text(*mu) : tr("any"); };
  QStringList said;
  for (const Row& row : p.rows)
    said << tr("%1: %2, %3, fires %4, counts %5, output %6")
                .arg(ruleLabel(row.rule), condition(row.altitude), condition(row.pitch), text(row.firing),
                     text(row.counts), numberText(row.rule.output, 3));
  said << (p.total.anyFires ? tr("Total %1").arg(text(p.total.total)) : tr("No rule fires: total 0"));
  return said;
}

int RuleViewer::lineHeight() const {
  return fontMetrics().height() + 7;
}

QSize RuleViewer::sizeHint() const {
  const int lines = static_cast<int>(draft_.active()->scheme.rules.size) + 2;
  return {fontMetrics().horizontalAdvance(QLatin1Char('0')) * 60, lines * lineHeight() + 10};
}

QSize RuleViewer::minimumSizeHint() const {
  return {fontMetrics().horizontalAdvance(QLatin1Char('0')) * 40, sizeHint().height()};
}

void RuleViewer::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const Picture p = picture();
  const QColor base = palette().color(QPalette::Base), ink = palette().color(QPalette::WindowText);
  const QColor quiet = quietColour(palette());
  const bool used = draft_.active()->scheme.combination == Combination::rules;
  const int line = lineHeight(), gap = 8;
  int names = fontMetrics().horizontalAdvance(tr("Total"));
  for (const Row& row : p.rows) names = std::max(names, fontMetrics().horizontalAdvance(ruleLabel(row.rule)));
  names = std::min(names, width() / 3) + gap;
  const int outputs = fontMetrics().horizontalAdvance(tr("Output u"));
  const double column = std::max(20.0, (width() - names - outputs) / 4.0);

  const auto bar = [&](int index, int y, double value, double top, int series, const QString& text) {
    const QRectF track(names + index * column, y + 3, column - gap, line - 6);
    painter.fillRect(track, base);
    painter.fillRect(
        QRectF(track.left(), track.top(), track.width() * std::clamp(value / top, 0.0, 1.0), track.height()),
        blend(base, seriesColour(series, palette()), used || index < 2 ? 0.75 : 0.35));
    painter.setPen(blend(base, ink, 0.4));
    painter.drawRect(track);
    painter.setPen(ink);
    painter.drawText(track.adjusted(4, 0, -2, 0), Qt::AlignVCenter | Qt::AlignLeft, text);
  };
  const auto number = [](double value) { return QString::number(value, 'f', 3); };

  painter.setPen(quiet);
  const QString heads[] = {tr("Altitude"), tr("Pitch"), tr("Fires μ"), tr("Counts λμ")};
  for (int i = 0; i < 4; ++i)
    painter.drawText(QRectF(names + i * column, 0, column - gap, line), Qt::AlignVCenter,
                     fontMetrics().elidedText(heads[i], Qt::ElideRight, static_cast<int>(column - gap)));
  painter.drawText(QRectF(width() - outputs, 0, outputs, line), Qt::AlignVCenter | Qt::AlignRight,
                   tr("Output u"));
  int y = line;
  for (const Row& row : p.rows) {
    painter.setPen(row.counts > 0 ? ink : quiet);
    painter.drawText(QRectF(0, y, names - gap, line), Qt::AlignVCenter,
                     fontMetrics().elidedText(ruleLabel(row.rule), Qt::ElideRight, names - gap));
    if (row.altitude) bar(0, y, *row.altitude, 1, 0, number(*row.altitude));
    if (row.pitch) bar(1, y, *row.pitch, 1, 2, number(*row.pitch));
    bar(2, y, row.firing, 1, 3, number(row.firing));
    bar(3, y, row.counts, p.top, 5, number(row.counts));
    painter.setPen(row.counts > 0 ? ink : quiet);
    painter.drawText(QRectF(width() - outputs, y, outputs, line), Qt::AlignVCenter | Qt::AlignRight,
                     numberText(row.rule.output, 3));
    y += line;
  }
  y += 4;
  painter.setPen(blend(base, ink, 0.3));
  painter.drawLine(0, y - 2, width(), y - 2);
  painter.setPen(ink);
  QFont bold = font();
  bold.setBold(true);
  painter.setFont(bold);
  painter.drawText(QRectF(0, y, names - gap, line), Qt::AlignVCenter, tr("Total"));
  painter.drawText(QRectF(width() - outputs, y, outputs, line), Qt::AlignVCenter | Qt::AlignRight,
                   any_ ? number(p.total.total) : QString());
  painter.setFont(font());
  const QRectF track(names, y + 3, 4 * column - gap, line - 6);
  painter.fillRect(track, base);
  painter.fillRect(
      QRectF(track.left(), track.top(), track.width() * p.total.total / BandList::kTop, track.height()),
      blend(base, seriesColour(1, palette()), used ? 0.75 : 0.35));
  painter.setPen(ink);
  for (const Band& band : draft_.active()->scheme.bands.span()) {
    const double x = track.left() + track.width() * band.low / BandList::kTop;
    painter.drawLine(QPointF(x, track.top() - 2), QPointF(x, track.bottom() + 2));
  }
  painter.setPen(blend(base, ink, 0.4));
  painter.drawRect(track);
  if (any_ && !p.total.anyFires) {
    painter.setPen(ink);
    painter.drawText(track.adjusted(6, 0, 0, 0), Qt::AlignVCenter, tr("No rule fires"));
  }
}

}  // namespace trimtab::views
