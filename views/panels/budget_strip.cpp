// SPDX-License-Identifier: GPL-3.0-or-later
#include "budget_strip.h"

#include <QMouseEvent>
#include <QPainter>
#include <cmath>

#include "views/model/error_run.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr int kPeriodMs = 1000, kMarginPx = 6;
/// A preset fits if no more than this share of its images is over the budget.
constexpr double kFits = 0.05;

/// Returns the parameter that a person turns for a lever; the budget's limit where a preset has no other.
const char* knobOf(Lever lever) {
  switch (lever) {
    case Lever::render_scale:
      return "hold.render_scale_minimum";
    case Lever::particle_density:
      return "hold.particles_minimum";
    case Lever::blur_strength:
      return "motion.blur_strength";
    case Lever::occlusion:
      return "culling.occlusion";
    default:
      return "lod.screen_space_error_px";
  }
}

/// Returns the levers that are as far as the budget may move them, or as rules usually do if none is held.
BudgetMinute::Spent spentOf(const FrameLevers& drawn, const HoldParameters& hold) {
  const auto leastOr = [&hold](Ratio held, Lever lever) {
    return hold.enabled ? held.value() : rowOf(lever).usual.low;
  };
  const double most = hold.enabled ? hold.errorMaximum.value() : rowOf(Lever::screen_space_error).usual.high;
  BudgetMinute::Spent spent = 0;
  const auto spend = [&spent](Lever lever, bool is) { spent |= std::uint32_t{is} << indexOf(lever); };
  // The budget moves the error by sixteenths of an octave.
  spend(Lever::screen_space_error, drawn.errorPx * std::exp2(1.0 / 16) > most);
  spend(Lever::render_scale,
        drawn.renderScale - 0.05 < leastOr(hold.renderScaleMinimum, Lever::render_scale) - 1e-9);
  spend(Lever::particle_density,
        drawn.particleShare <= leastOr(hold.particlesMinimum, Lever::particle_density) + 1e-9);
  spend(Lever::blur_strength, drawn.blurStrength <= 0);
  return spent;
}

}  // namespace

BudgetStrip::BudgetStrip(Draft& draft, QWidget* parent)
    : QFrame(parent),
      draft_(draft),
      text_(tr("No image yet")),
      throttle_(
          this, [this] { refresh(); }, kPeriodMs) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setAccessibleName(tr("Budget of the last minute"));
  connect(&draft_, &Draft::activeChanged, this, [this] { throttle_.request(); });
}

QSize BudgetStrip::sizeHint() const {
  return {400, fontMetrics().height() + kMarginPx};
}

QSize BudgetStrip::minimumSizeHint() const {
  return {100, sizeHint().height()};
}

void BudgetStrip::showFrame(const LiveFrame& frame, double imageMpx) {
  if (!frame.newImage || !frame.counts) return;
  if (frame.levers) drawn_ = frame.levers->drawn;
  const FrameLevers drawn = drawn_.value_or(FrameLevers{});
  const double sceneMpx = imageMpx * drawn.renderScale * drawn.renderScale;
  load_ = {double(frame.drawn().visible.triangles), sceneMpx, sceneMpx,
           frame.decision.weather.density * drawn.particleShare, drawn.blurStrength > 0};
  minute_.add(frame.time, frame.cost, load_);
  throttle_.request();
}

void BudgetStrip::refresh() {
  if (minute_.images() == 0) return;
  const double budgetMs = draft_.active()->measure.budget.value(), share = minute_.overShare(budgetMs);
  over_ = share > kFits;
  QStringList parts;
  parts << (share > 0 ? tr("Over %1: %2 % of the last minute")
                            .arg(msText(budgetMs), numberText(share * 100, share < 0.1 ? 1 : 0))
                      : tr("Within %1: all of the last minute").arg(msText(budgetMs)));
  if (const auto stage = minute_.worstStage(budgetMs))
    parts << tr("longest: %1, %2").arg(stage->name, msText(stage->ms));
  named_.reset();
  const BudgetMinute::Spent spent = drawn_ ? spentOf(*drawn_, draft_.active()->hold) : 0;
  if (const auto help = minute_.help(budgetMs, costs_ ? costs_(load_) : CostCoefficients{}, spent)) {
    named_ = help->lever;
    const QString lever = fromView(rowOf(*named_).label).toLower();
    parts << (std::isnan(help->ms) ? tr("most help: %1").arg(lever)
                                   : tr("most help: %1, −%2").arg(lever, msText(help->ms)));
  }
  setCursor(named_ ? Qt::PointingHandCursor : Qt::ArrowCursor);
  text_ = parts.join(QStringLiteral("  ·  "));
  setAccessibleDescription(text_);
  setToolTip(
      tr("%1\n\nOf %L2 images. The lever is the one that saves most if it halves what it scales: the "
         "triangles, the pixels, or the particles. Its time is known once the budget has been held on this "
         "machine for a while, and one that is as far as it may go is not named. A click opens its knob; "
         "trimtab-cli leverage measures what each lever costs in the image.")
          .arg(text_)
          .arg(minute_.images()));
  update();
}

void BudgetStrip::mouseReleaseEvent(QMouseEvent*) {
  if (named_) emit knobAsked(QLatin1String(knobOf(*named_)));
}

void BudgetStrip::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), palette().color(QPalette::Window));
  // A bar, so that the state is seen without reading; the text says it to who does not see the colour.
  painter.fillRect(QRect(0, 0, kMarginPx / 2, height()),
                   over_ ? warningColour(palette()) : seriesColour(2, palette()));
  painter.setPen(palette().color(QPalette::WindowText));
  const QRect area = rect().adjusted(2 * kMarginPx, 0, -kMarginPx, 0);
  painter.drawText(area, Qt::AlignVCenter | Qt::AlignLeft,
                   fontMetrics().elidedText(text_, Qt::ElideRight, area.width()));
}

}  // namespace trimtab::views
