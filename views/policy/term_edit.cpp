// SPDX-License-Identifier: GPL-3.0-or-later
#include "term_edit.h"

#include <QObject>
#include <QRegularExpression>
#include <algorithm>
#include <cmath>

#include "trimtab/units/not_finite.h"
#include "trimtab/units/number.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

/// The membership one deviation from the mean, half-way to the slope's handle of a bell, and at the slope's
/// handle of a sigmoid, which is two units of its exponent from the middle.
const double kAtDeviation = std::exp(-0.5);
constexpr double kBellAt = 0.5, kSigmoidAt = 2, kAtSigmoid = 0.880797;
const double kHalfOfGaussian = std::sqrt(2 * std::log(2));

bool takes(const PolicyTerm& term) {
  const std::size_t count = term.numbers.size();
  switch (term.shape) {
    case TermShape::points:
      return count >= 4 && count % 2 == 0;
    case TermShape::triangle:
    case TermShape::bell:
      return count == 3;
    case TermShape::trapezoid:
      return count == 4;
    case TermShape::ramp:
    case TermShape::gaussian:
    case TermShape::sigmoid:
      return count == 2;
  }
  return false;
}

/// An outline is any term as a rough trapezoid, from which other shapes are made.
struct Outline {
  double leftFoot, leftTop, rightTop, rightFoot;
  bool openLeft = false, openRight = false;
  double halfWidth() const { return ((rightTop - leftTop) + (rightFoot - leftFoot)) / 4; }
  double middle() const { return (leftTop + rightTop) / 2; }
};

Outline outlineOf(const PolicyTerm& term, Range view) {
  const std::vector<double>& n = term.numbers;
  const auto rising = [&](double foot, double top) {
    return foot < top ? Outline{foot, top, view.high, view.high, false, true}
                      : Outline{view.low, view.low, top, foot, true, false};
  };
  if (takes(term)) switch (term.shape) {
      case TermShape::points: {
        Outline o{n[0], n[0], n[n.size() - 2], n[n.size() - 2]};
        double most = -1;
        for (std::size_t i = 1; i < n.size(); i += 2) most = std::max(most, n[i]);
        std::size_t first = 0, last = 0;
        for (std::size_t i = 0; i < n.size(); i += 2) {
          if (n[i + 1] < most) continue;
          if (first == 0) first = i + 1;
          last = i + 1;
        }
        o.leftTop = n[first - 1];
        o.rightTop = n[last - 1];
        o.openLeft = first == 1;
        o.openRight = last == n.size() - 1;
        return o;
      }
      case TermShape::triangle:
        return {n[0], n[1], n[1], n[2]};
      case TermShape::trapezoid:
        return {std::isinf(n[0]) ? std::min(view.low, n[1]) : n[0],
                n[1],
                n[2],
                std::isinf(n[3]) ? std::max(view.high, n[2]) : n[3],
                std::isinf(n[0]),
                std::isinf(n[3])};
      case TermShape::ramp:
        return rising(n[0], n[1]);
      case TermShape::gaussian: {
        const double half = 2 * kHalfOfGaussian * n[1];
        return {n[0] - half, n[0], n[0], n[0] + half};
      }
      case TermShape::bell:
        return {n[0] - 2 * n[1], n[0], n[0], n[0] + 2 * n[1]};
      case TermShape::sigmoid:
        return rising(n[0] - kSigmoidAt / n[1], n[0] + kSigmoidAt / n[1]);
    }
  const double quarter = (view.high - view.low) / 4;
  return {view.low + quarter, view.low + 2 * quarter, view.low + 2 * quarter, view.high - quarter};
}

std::size_t strideOf(const PolicyTerm& term) {
  return term.shape == TermShape::points ? 2 : 1;
}

/// Returns the places of a polygon, of feet and of tops. Tops may meet; a foot keeps a flank, so that the
/// term has a width.
PointRow xOf(const PolicyTerm& term, double gap) {
  PointRow row{{}, {-kInfinity, kInfinity}, {}};
  for (std::size_t i = 0; i < term.numbers.size(); i += strideOf(term)) row.x.push_back(term.numbers[i]);
  row.gapAfter = [gap, points = term.shape == TermShape::points, last = row.x.size() - 2](std::size_t i) {
    return points || i == 0 || i == last ? gap : 0;
  };
  return row;
}

double significant(double value) {
  if (value == 0 || !std::isfinite(value)) return value;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 3);
  return std::stod(trimtab::numberText(std::round(value / unit) * unit, 4));
}

}  // namespace

std::vector<EditPoint> handlesOf(const PolicyTerm& term, Range view) {
  if (!takes(term)) return {};
  const auto tr = [](const char* text) { return QObject::tr(text); };
  const std::vector<double>& n = term.numbers;
  std::vector<EditPoint> handles;
  switch (term.shape) {
    case TermShape::points:
      for (std::size_t i = 0; i < n.size(); i += 2)
        handles.push_back({n[i], n[i + 1], true, true, false,
                           QObject::tr("point %1 of %2").arg(i / 2 + 1).arg(n.size() / 2)});
      break;
    case TermShape::triangle:
      handles = {{n[0], 0, true, false, false, tr("left foot")},
                 {n[1], 1, true, false, false, tr("top")},
                 {n[2], 0, true, false, false, tr("right foot")}};
      break;
    case TermShape::trapezoid: {
      const bool left = std::isinf(n[0]), right = std::isinf(n[3]);
      handles = {
          {left ? std::min(view.low, n[1]) : n[0], left ? 1.0 : 0.0, true, false, left, tr("left foot")},
          {n[1], 1, true, false, false, tr("left top")},
          {n[2], 1, true, false, false, tr("right top")},
          {right ? std::max(view.high, n[2]) : n[3], right ? 1.0 : 0.0, true, false, right,
           tr("right foot")}};
      break;
    }
    case TermShape::ramp:
      handles = {{n[0], 0, true, false, false, tr("foot")}, {n[1], 1, true, false, false, tr("top")}};
      break;
    case TermShape::gaussian:
      handles = {{n[0], 1, true, false, false, tr("mean")},
                 {n[0] + n[1], kAtDeviation, true, false, false, tr("deviation")}};
      break;
    case TermShape::bell:
      handles = {
          {n[0], 1, true, false, false, tr("centre")},
          {n[0] + n[1], 0.5, true, false, false, tr("width")},
          {n[0] + kBellAt * n[1], 1 / (1 + std::pow(kBellAt, 2 * n[2])), false, true, false, tr("slope")}};
      break;
    case TermShape::sigmoid:
      handles = {{n[0], 0.5, true, false, false, tr("middle")},
                 {n[0] + kSigmoidAt / n[1], kAtSigmoid, true, false, false, tr("slope")}};
      break;
  }
  return handles;
}

PolicyTerm withHandleAt(const PolicyTerm& term, std::size_t handle, double x, double y, double gap) {
  PolicyTerm moved = term;
  std::vector<double>& n = moved.numbers;
  switch (term.shape) {
    case TermShape::points:
    case TermShape::triangle:
    case TermShape::trapezoid: {
      const std::size_t at = strideOf(term) * handle;
      const Range free = xOf(term, gap).freeRange(handle);
      n[at] = std::min(std::max(x, free.low), std::max(free.low, free.high));
      if (term.shape == TermShape::points) n[at + 1] = std::clamp(y, 0.0, 1.0);
      break;
    }
    case TermShape::ramp: {
      const double other = n[1 - handle];
      n[handle] = n[handle] < other ? std::min(x, other - gap) : std::max(x, other + gap);
      break;
    }
    case TermShape::gaussian:
    case TermShape::bell:
      if (handle == 0) n[0] = x;
      if (handle == 1) n[1] = std::max(gap, std::abs(x - n[0]));
      if (handle == 2) {
        const double at = std::clamp(y, 0.55, 0.9999);
        n[2] = significant(std::log(1 / at - 1) / (2 * std::log(kBellAt)));
      }
      break;
    case TermShape::sigmoid:
      if (handle == 0) {
        n[0] = x;
      } else {
        const double away = x - n[0];
        n[1] = significant(kSigmoidAt / (std::abs(away) < gap ? std::copysign(gap, n[1]) : away));
      }
      break;
  }
  return moved;
}

PolicyTerm withHandlesMoved(const PolicyTerm& term, const std::vector<std::size_t>& handles, double dx,
                            double dy, double gap, Range view) {
  PolicyTerm moved = term;
  std::vector<double>& n = moved.numbers;
  const auto isMiddle =
      term.shape == TermShape::gaussian || term.shape == TermShape::bell || term.shape == TermShape::sigmoid;
  const bool withMiddle = isMiddle && std::ranges::find(handles, 0u) != handles.end();
  if (handles.size() == 1 || (isMiddle && !withMiddle)) {
    const std::vector<EditPoint> from = handlesOf(term, view);
    for (const std::size_t i : handles) {
      if (from[i].open && dx == 0) continue;
      moved = withHandleAt(moved, i, withoutDust(from[i].x + dx), withoutDust(from[i].y + dy), gap);
    }
    return moved;
  }
  if (withMiddle) {
    n[0] = withoutDust(n[0] + dx);
    return moved;
  }
  const std::size_t stride = strideOf(term);
  dx = xOf(term, gap).step(handles, dx);
  if (stride == 2) {
    std::vector<double> y;
    for (const std::size_t i : handles) y.push_back(n[2 * i + 1]);
    dy = membershipStep(y, dy);
  }
  for (const std::size_t i : handles) {
    n[stride * i] = withoutDust(n[stride * i] + dx);
    if (stride == 2) n[2 * i + 1] = std::clamp(withoutDust(n[2 * i + 1] + dy), 0.0, 1.0);
  }
  return moved;
}

PolicyTerm withShape(const PolicyTerm& term, TermShape shape, Range view) {
  if (shape == term.shape) return term;
  const double unit = std::max(roundStep((view.high - view.low) / 1000), 1e-9);
  Outline o = outlineOf(term, view);
  for (double* x : {&o.leftFoot, &o.leftTop, &o.rightTop, &o.rightFoot}) *x = roundedTo(*x, unit);
  if (!(o.rightFoot - o.leftFoot >= 4 * unit)) {
    o.leftFoot -= 2 * unit;
    o.rightFoot += 2 * unit;
  }
  const double half = std::max(o.halfWidth(), unit);
  PolicyTerm changed = term;
  changed.shape = shape;
  std::vector<double>& n = changed.numbers;
  n.clear();
  switch (shape) {
    case TermShape::points: {
      const auto add = [&](double x, double y) {
        if (n.size() >= 2 && n[n.size() - 2] == x && n.back() == y) return;
        n.insert(n.end(), {x, y});
      };
      if (!o.openLeft) add(o.leftFoot, 0);
      add(o.leftTop, 1);
      add(o.rightTop, 1);
      if (!o.openRight) add(o.rightFoot, 0);
      if (n.size() < 4) add(n[0] + unit, n[1]);
      break;
    }
    case TermShape::triangle:
      n = {o.leftFoot,
           o.openLeft    ? o.leftFoot
           : o.openRight ? o.rightFoot
                         : roundedTo(o.middle(), unit),
           o.rightFoot};
      break;
    case TermShape::trapezoid:
      n = {o.openLeft ? -kInfinity : o.leftFoot, o.leftTop, o.rightTop,
           o.openRight ? kInfinity : o.rightFoot};
      break;
    case TermShape::ramp:
      n = o.openLeft ? std::vector{o.rightFoot, o.rightTop} : std::vector{o.leftFoot, o.leftTop};
      if (n[0] == n[1]) n[1] += o.openLeft ? -unit : unit;
      break;
    case TermShape::gaussian:
      n = {roundedTo(o.middle(), unit), std::max(roundedTo(half / kHalfOfGaussian, unit), unit)};
      break;
    case TermShape::bell:
      n = {roundedTo(o.middle(), unit), std::max(roundedTo(half, unit), unit), 2};
      break;
    case TermShape::sigmoid: {
      const double foot = o.openLeft ? o.rightFoot : o.leftFoot, top = o.openLeft ? o.rightTop : o.leftTop;
      const double flank =
          std::abs(top - foot) < unit ? std::copysign(unit, o.openLeft ? -1.0 : 1.0) : top - foot;
      n = {(foot + top) / 2, significant(2 * kSigmoidAt / flank)};
      break;
    }
  }
  return changed;
}

std::optional<InsertedPoint> withPoint(const PolicyTerm& term, double x, double y) {
  if (term.shape != TermShape::points || term.numbers.size() + 2 > kMostTermNumbers) return std::nullopt;
  InsertedPoint inserted{term, 0};
  std::vector<double>& n = inserted.term.numbers;
  std::size_t at = 0;
  while (at < n.size() && n[at] < x) at += 2;
  if (at < n.size() && n[at] == x) return std::nullopt;
  n.insert(n.begin() + static_cast<std::ptrdiff_t>(at), {x, std::clamp(y, 0.0, 1.0)});
  inserted.handle = at / 2;
  return inserted;
}

std::optional<PolicyTerm> withoutPoint(const PolicyTerm& term, std::size_t handle) {
  if (term.shape != TermShape::points || term.numbers.size() <= 4) return std::nullopt;
  PolicyTerm changed = term;
  const auto at = changed.numbers.begin() + static_cast<std::ptrdiff_t>(2 * handle);
  changed.numbers.erase(at, at + 2);
  return changed;
}

PolicyTerm newTerm(Signal signal, const std::string& name, Range view) {
  const double unit = std::max(roundStep((view.high - view.low) / 40), 1e-9);
  const double middle = roundedTo((view.low + view.high) / 2, unit),
               width = roundedTo((view.high - view.low) / 4, unit);
  return {signal, name, TermShape::triangle, {middle - width, middle, middle + width}};
}

Range viewOf(Signal signal, const std::vector<PolicyTerm>& terms) {
  const Range whole = rowOf(signal).range;
  double low = kInfinity, high = -kInfinity;
  for (const PolicyTerm& term : terms) {
    if (term.signal != signal) continue;
    const Outline o = outlineOf(term, {kInfinity, -kInfinity});
    for (const double x : {o.leftFoot, o.leftTop, o.rightTop, o.rightFoot})
      if (std::isfinite(x)) low = std::min(low, x), high = std::max(high, x);
  }
  if (!(low < high)) return whole;
  const double margin = 0.3 * (high - low);
  // Beyond the range of a signal nothing happens.
  return {std::max(low - margin, std::min(low, whole.low)),
          std::min(high + margin, std::max(high, whole.high))};
}

double nudgeStep(Range view) {
  return roundStep((view.high - view.low) / 100);
}

QString numbersText(const PolicyTerm& term) {
  QStringList texts;
  for (const double number : term.numbers) texts << QString::fromStdString(trimtab::numberText(number));
  return texts.join(QLatin1Char(' '));
}

std::optional<std::vector<double>> readNumbers(const QString& text) {
  std::vector<double> numbers;
  static const QRegularExpression kBetween(QStringLiteral("[\\s;]+"));
  for (QString word : text.split(kBetween, Qt::SkipEmptyParts)) {
    word.replace(QChar(0x2212), QLatin1Char('-'));
    const auto number = readNumber(word.toStdString());
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

QString numbersHelp(TermShape shape) {
  switch (shape) {
    case TermShape::points:
      return QObject::tr("x and membership of each point, from left to right");
    case TermShape::triangle:
      return QObject::tr("left foot, top, right foot");
    case TermShape::trapezoid:
      return QObject::tr("left foot (or -inf), left top, right top, right foot (or inf)");
    case TermShape::ramp:
      return QObject::tr("where it is 0, where it is 1");
    case TermShape::gaussian:
      return QObject::tr("mean, deviation");
    case TermShape::bell:
      return QObject::tr("centre, width, slope");
    case TermShape::sigmoid:
      return QObject::tr("middle, slope (below 0 falls)");
  }
  return {};
}

}  // namespace trimtab::views
