// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_timeline.h"

#include <algorithm>
#include <cmath>

#include "trimtab/units/not_finite.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr double kTimelineHeadRoom = 1.15;
constexpr double kWorstPx = 9;
constexpr std::array kPens{Qt::SolidLine, Qt::DashLine, Qt::DashDotLine, Qt::DotLine};

QString timeText(double seconds) {
  return QStringLiteral("%1 s").arg(numberText(seconds, 2));
}

}  // namespace

ErrorTimeline::ErrorTimeline(QWidget* parent)
    : Plot(tr("Frame time and error along the flight"), Keyboard::used, parent), cursor_(kNan) {
  plotLayout()->clear();
  plotLayout()->setRowSpacing(0);
  addLegendAbove();
  addOverlays({"cursor", "numbers"});
  auto* margins = new QCPMarginGroup(this);
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    QCPAxisRect* rect = lanes_[i] = new QCPAxisRect(this, true);
    plotLayout()->addElement(int(i) + 1, 0, rect);
    rect->setMarginGroup(QCP::msLeft | QCP::msRight, margins);
    rect->setMinimumMargins(QMargins(4, 4, 8, 2));
    for (QCPAxis* axis : {time(int(i)), value(int(i))}) {
      axis->setSubTicks(false);
      axis->setNumberFormat(QStringLiteral("g"));
    }
    time(int(i))->ticker()->setTickCount(6);
    value(int(i))->ticker()->setTickCount(3);
    value(int(i))->setNumberPrecision(4);
    time(int(i))->setNumberPrecision(7);
  }
  time(0)->setTickLabels(false);
  time(1)->setLabel(tr("Time of the flight (s)"));
  value(0)->setLabel(tr("Frame (ms)"));

  budgetLine_ = addLine("main", lanes_[0]);
  const QMargins padding(6, 3, 6, 3);
  line_.attach(*this, "cursor", {lanes_.begin(), lanes_.end()});
  numbers_ = addReadout("numbers", padding);
  hint_ = addReadout("main", padding);
  hint_->position->setType(QCPItemPosition::ptAxisRectRatio);
  hint_->position->setAxisRect(lanes_[0]);
  hint_->position->setCoords(0.5, 0.5);
  redraw();
}

bool ErrorTimeline::isShown(const ErrorRun::Series& s) const {
  return s.flight == flight_ && s.method == method_;
}

const ErrorRun::Error* ErrorTimeline::error() const {
  return error_ >= 0 && error_ < run_.errors.size() ? &run_.errors[error_] : nullptr;
}

void ErrorTimeline::show(const ErrorRun& run) {
  run_ = run;
  if (!run_.flights().contains(flight_)) flight_ = run_.flights().value(0);
  if (!run_.methods().contains(method_)) method_ = run_.methods().value(run_.methods().size() - 1);
  whole_ = {};
  redraw();
}

void ErrorTimeline::showFlight(const QString& flight) {
  flight_ = run_.flights().contains(flight) ? flight : run_.flights().value(0);
  whole_ = {};
  redraw();
}

void ErrorTimeline::showError(int error) {
  error_ = error;
  redraw();
}

void ErrorTimeline::showMethod(const QString& method) {
  method_ = run_.methods().contains(method) ? method : run_.methods().value(run_.methods().size() - 1);
  redraw();
}

void ErrorTimeline::setBudget(double ms) {
  budget_ = std::isfinite(ms) ? ms : 0;
  redraw();
}

void ErrorTimeline::drawLines() {
  const QStringList presets = run_.presets();
  std::array<double, 2> low{0, 0}, high{0, 0};
  times_.clear();
  const ErrorRun::Error* shown = error();
  bool first = true;
  for (const ErrorRun::Series& s : run_.series) {
    if (!isShown(s)) continue;
    times_.insert(times_.end(), s.timeS.begin(), s.timeS.end());
    const int preset = int(presets.indexOf(s.preset));
    for (int lane = 0; lane < 2; ++lane) {
      if (lane == 1 && (shown == nullptr || error_ >= s.errors.size())) continue;
      QVector<double> y = lane == 0 ? s.ms : s.errors[error_];
      for (double& v : y) {
        if (lane == 1) v = placeOf(*shown, v);
        if (!std::isfinite(v)) {
          v = kNan;
          continue;
        }
        if (lane == 1 && !shown->largerIsWorse) low[1] = first ? v : std::min(low[1], v);
        high[std::size_t(lane)] = lane == 1 && first ? v : std::max(high[std::size_t(lane)], v);
        if (lane == 1) first = false;
      }
      QCPGraph* graph = addGraph(time(lane), value(lane));
      graph->setData(s.timeS, y);
      graph->setPen(QPen(presetColour(preset, palette()), 1.5, kPens[std::size_t(preset) % kPens.size()]));
      graph->setName(s.preset);
      if (lane == 0) graph->addToLegend();
    }
  }
  std::sort(times_.begin(), times_.end());
  times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
  if (budget_ > 0) high[0] = std::max(high[0], budget_);
  value(0)->setRange(0, high[0] > 0 ? high[0] * kTimelineHeadRoom : 1);
  const double room =
      high[1] > low[1] ? (high[1] - low[1]) * (kTimelineHeadRoom - 1) : std::max(high[1], 1.0) * 0.1;
  value(1)->setRange(low[1] > 0 ? low[1] - room : 0, high[1] + room);
  value(1)->setLabel(shown != nullptr ? titleOf(*shown) : tr("Error"));
  if (whole_.size() == 0 && !times_.empty()) {
    const double margin = std::max(0.02 * (times_.back() - times_.front()), 0.5);
    whole_ = QCPRange(times_.front() - margin, times_.back() + margin);
    for (int lane = 0; lane < 2; ++lane) time(lane)->setRange(whole_);
  }
}

void ErrorTimeline::drawWorst() {
  const QStringList presets = run_.presets();
  const ErrorRun::Error* shown = error();
  worst_.clear();
  bool named = false;
  for (int i = 0; i < run_.series.size(); ++i) {
    const ErrorRun::Series& s = run_.series[i];
    if (!isShown(s)) continue;
    for (int lane = 0; lane < 2; ++lane) {
      if (lane == 1 && (shown == nullptr || error_ >= s.errors.size())) continue;
      QVector<double> x, y;
      for (const ErrorRun::Mark& mark : s.worst) {
        if (mark.frame < 0 || mark.frame >= s.timeS.size()) continue;
        const double v = lane == 0 ? s.ms[mark.frame] : placeOf(*shown, s.errors[error_][mark.frame]);
        if (lane == 0) worst_.push_back({i, mark.frame});
        if (!std::isfinite(v)) continue;
        x << s.timeS[mark.frame];
        y << v;
      }
      QCPGraph* marks = addGraph(time(lane), value(lane));
      marks->setLineStyle(QCPGraph::lsNone);
      marks->setData(x, y);
      const QColor colour = presetColour(int(presets.indexOf(s.preset)), palette());
      marks->setScatterStyle(
          {QCPScatterStyle::ssTriangleInverted, QPen(errorColour(palette()), 1.4), QBrush(colour), kWorstPx});
      if (lane == 0 && !x.isEmpty() && !named) {
        marks->setName(tr("worst"));
        marks->addToLegend();
        named = true;
      }
    }
  }
  std::sort(worst_.begin(), worst_.end(), [this](const Worst& a, const Worst& b) {
    return run_.series[a.series].timeS[a.frame] < run_.series[b.series].timeS[b.frame];
  });
}

void ErrorTimeline::redraw() {
  clearPlottables();
  drawLines();
  drawWorst();
  arrangeLegendAbove();
  applyThemeWithLegendAbove();
  budgetLine_->setVisible(budget_ > 0);
  putHorizontal(*budgetLine_, budget_);
  budgetLine_->setPen(QPen(errorColour(palette()), 1.4, Qt::DashLine));
  line_.setLook(QPen(liveColour(palette()), 2), palette().color(QPalette::Base), font());
  hint_->setFont(font());
  hint_->setVisible(times_.empty());
  hint_->setText(tr("Frames of a measured flight are shown here."));
  hint_->setColor(quietColour(palette()));
  hint_->setPositionAlignment(Qt::AlignCenter);
  const int labelWidth = QFontMetrics(font()).horizontalAdvance(QStringLiteral("00000  "));
  for (int lane = 0; lane < 2; ++lane)
    time(lane)->ticker()->setTickCount(std::clamp(width() / labelWidth / 2, 2, 8));
  placeCursor();
  replot(QCustomPlot::rpQueuedReplot);
}

void ErrorTimeline::placeCursor() {
  const bool shown = std::isfinite(cursor_) && !times_.empty();
  line_.setFlag(timeText(cursor_));
  line_.place(shown ? std::optional(cursor_) : std::nullopt);
  setAccessibleDescription((shown ? textAt(cursor_).replace('\n', ", ") + ". " : QString()) +
                           tr("Left and right go to the frame before and after, with Shift ten frames, Home "
                              "and End to the ends, W to the next worst frame, plus and minus zoom."));
}

void ErrorTimeline::follow(double at) {
  if (dragging_ || at == cursor_ || (std::isnan(at) && std::isnan(cursor_))) return;
  cursor_ = at;
  placeCursor();
  layer(QStringLiteral("cursor"))->replot();
}

void ErrorTimeline::seek(double at) {
  if (!std::isfinite(at) || times_.empty()) return;
  cursor_ = std::clamp(at, times_.front(), times_.back());
  const QCPRange range = time()->range();
  if (!range.contains(cursor_))
    for (int lane = 0; lane < 2; ++lane) time(lane)->setRange(cursor_, range.size(), Qt::AlignCenter);
  placeCursor();
  replot(QCustomPlot::rpQueuedReplot);
  emit sought(cursor_);
}

QString ErrorTimeline::textAt(double at) const {
  const ErrorRun::Error* shown = error();
  if (times_.empty() || shown == nullptr) return {};
  auto nearest = std::lower_bound(times_.begin(), times_.end(), at);
  if (nearest == times_.end() || (nearest != times_.begin() && at - *(nearest - 1) <= *nearest - at))
    --nearest;
  QStringList lines{timeText(*nearest)};
  for (const ErrorRun::Series& s : run_.series) {
    if (!isShown(s)) continue;
    const qsizetype frame = s.timeS.indexOf(*nearest);
    if (frame < 0 || error_ >= s.errors.size()) continue;
    QString line =
        tr("%1: %2, %3 %4")
            .arg(s.preset, msText(s.ms[frame]), shown->label, textOf(*shown, s.errors[error_][frame]));
    for (const ErrorRun::Mark& mark : s.worst)
      if (mark.frame == frame && !mark.why.isEmpty()) line += tr(" (%1)").arg(mark.why);
    lines << line;
  }
  return lines.join('\n');
}

void ErrorTimeline::showNumbers(double at, QPointF pixel) {
  const QString text = times_.empty() ? QString() : textAt(at);
  numbers_->setVisible(!text.isEmpty());
  if (!text.isEmpty()) placeReadout(*numbers_, text, pixel);
  layer(QStringLiteral("numbers"))->replot();
}

QPointF ErrorTimeline::pixelOf(double at) const {
  return {time()->coordToPixel(at), double(lanes_[0]->center().y())};
}

}  // namespace trimtab::views
