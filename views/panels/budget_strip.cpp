// SPDX-License-Identifier: GPL-3.0-or-later
#include "budget_strip.h"

#include <QPainter>
#include <cmath>

#include "views/model/error_run.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr int kPeriodMs = 1000, kMarginPx = 6;
/// A preset fits if no more than this share of its images is over the budget.
constexpr double kFits = 0.05;

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
  load_ = {double(frame.drawn().visible.triangles), imageMpx, imageMpx, frame.decision.weather.density,
           frame.decision.motion.blur.strength > 0};
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
  if (const auto help = minute_.help(budgetMs, costs_ ? costs_(load_) : CostCoefficients{}))
    parts << (std::isnan(help->ms) ? tr("most help: %1").arg(help->lever)
                                   : tr("most help: %1, −%2").arg(help->lever, msText(help->ms)));
  text_ = parts.join(QStringLiteral("  ·  "));
  setAccessibleDescription(text_);
  setToolTip(
      tr("%1\n\nOf %L2 images. The lever is the one that saves most if it halves what it scales: the "
         "triangles, the pixels, or the particles. Its time is known once the budget has been held on this "
         "machine for a while; trimtab-cli leverage measures what each lever costs in the image.")
          .arg(text_)
          .arg(minute_.images()));
  update();
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
