// SPDX-License-Identifier: GPL-3.0-or-later
#include "budget_minute.h"

#include <QCoreApplication>
#include <algorithm>
#include <array>
#include <cmath>

#include "trimtab/units/not_finite.h"

namespace trimtab::views {
namespace {

/// Less than this, in milliseconds, is no help.
constexpr double kLeastMs = 0.05;

QString tr(const char* text) {
  return QCoreApplication::translate("BudgetMinute", text);
}

double orZero(double ms) {
  return std::isnan(ms) ? 0 : ms;
}

/// Bounds a saving by what was measured, if that was measured.
double atMost(double measuredMs, double savesMs) {
  return std::isnan(measuredMs) ? savesMs : std::min(measuredMs, savesMs);
}

enum Part { decide, select, occlusion, cull, ground, page, blur, weather, symbology, kParts };
constexpr const char* kNames[kParts] = {
    QT_TRANSLATE_NOOP("BudgetMinute", "decision"),  QT_TRANSLATE_NOOP("BudgetMinute", "selection"),
    QT_TRANSLATE_NOOP("BudgetMinute", "occlusion"), QT_TRANSLATE_NOOP("BudgetMinute", "culling"),
    QT_TRANSLATE_NOOP("BudgetMinute", "drawing"),   QT_TRANSLATE_NOOP("BudgetMinute", "paging"),
    QT_TRANSLATE_NOOP("BudgetMinute", "blur"),      QT_TRANSLATE_NOOP("BudgetMinute", "weather"),
    QT_TRANSLATE_NOOP("BudgetMinute", "symbols")};

/// Returns the times of parts that do not overlap: what was measured by itself within the drawing is
/// subtracted from it.
std::array<double, kParts> partsOf(const FrameCost& cost) {
  const double drawn = std::isfinite(cost.gpu) ? std::max(cost.gpu, orZero(cost.draw)) : orZero(cost.draw);
  const double inside = orZero(cost.blur) + orZero(cost.weather) + orZero(cost.symbology);
  return {orZero(cost.decide), orZero(cost.select),           orZero(cost.occlusion),
          orZero(cost.cull),   std::max(drawn - inside, 0.0), orZero(cost.page),
          orZero(cost.blur),   orZero(cost.weather),          orZero(cost.symbology)};
}

}  // namespace

void BudgetMinute::add(double timeS, const FrameCost& cost, const FrameLoad& load) {
  images_.push_back({timeS, cost});
  load_ = load;
  while (images_.front().timeS < timeS - kSpanS) images_.pop_front();
}

double BudgetMinute::overShare(double budgetMs) const {
  const auto over = std::count_if(images_.begin(), images_.end(),
                                  [&](const Image& image) { return image.cost.total > budgetMs; });
  return images_.empty() ? kNan : double(over) / double(images_.size());
}

std::optional<BudgetMinute::Stage> BudgetMinute::worstStage(double budgetMs) const {
  const bool all = !(overShare(budgetMs) > 0);
  std::array<double, kParts> sum{};
  std::size_t count = 0;
  for (const Image& image : images_) {
    if (!all && !(image.cost.total > budgetMs)) continue;
    const std::array<double, kParts> parts = partsOf(image.cost);
    for (std::size_t i = 0; i < kParts; ++i) sum[i] += parts[i];
    ++count;
  }
  const auto worst = std::max_element(sum.begin(), sum.end());
  if (count == 0 || !(*worst > 0)) return std::nullopt;
  return Stage{tr(kNames[worst - sum.begin()]), *worst / double(count)};
}

std::optional<BudgetMinute::Help> BudgetMinute::help(double budgetMs, const CostCoefficients& cost,
                                                     Spent spent) const {
  const std::optional<Stage> worst = worstStage(budgetMs);
  if (!worst) return std::nullopt;
  const auto isSpent = [spent](Lever lever) { return (spent >> indexOf(lever) & 1) != 0; };
  if (cost.known) {
    const FrameCost& last = images_.back().cost;
    const StageTimes now = predict(cost, load_);
    const auto saves = [&](Lever lever, void (*change)(FrameLoad&)) {
      if (isSpent(lever)) return Help{lever, 0};
      FrameLoad less = load_;
      change(less);
      const StageTimes then = predict(cost, less);
      return Help{lever, atMost(stagesOf(last).ground, now.ground - then.ground) +
                             atMost(last.weather, now.weather - then.weather) +
                             atMost(last.blur, now.blur - then.blur) + now.other - then.other};
    };
    const std::array<Help, 4> helps{
        saves(Lever::screen_space_error, [](FrameLoad& l) { l.triangles /= 2; }),
        saves(Lever::render_scale, [](FrameLoad& l) { l.groundMpx /= 2, l.sceneMpx /= 2; }),
        saves(Lever::particle_density, [](FrameLoad& l) { l.particles /= 2; }),
        saves(Lever::blur_strength, [](FrameLoad& l) { l.blurs = false; })};
    const auto best = std::max_element(helps.begin(), helps.end(),
                                       [](const Help& a, const Help& b) { return a.ms < b.ms; });
    if (best->ms >= kLeastMs) return *best;
  }
  if (worst->name == tr(kNames[decide]) || worst->name == tr(kNames[symbology])) return std::nullopt;
  const Lever lever = worst->name == tr(kNames[weather])     ? Lever::particle_density
                      : worst->name == tr(kNames[blur])      ? Lever::blur_strength
                      : worst->name == tr(kNames[occlusion]) ? Lever::occlusion
                                                             : Lever::screen_space_error;
  if (isSpent(lever)) return std::nullopt;
  return Help{lever, kNan};
}

}  // namespace trimtab::views
