// SPDX-License-Identifier: GPL-3.0-or-later
#include "measured_run.h"

#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

template <class Use>
void eachError(const Use& use) {
  for (const harness::Quantity& quantity : harness::quantities())
    if (quantity.kind == harness::Quantity::Kind::error) use(quantity);
}

}  // namespace

QVector<views::ErrorRun::Error> measuredErrors() {
  QVector<views::ErrorRun::Error> list;
  eachError([&](const harness::Quantity& q) {
    list.append({views::fromView(q.key), views::fromView(q.label), views::fromView(q.unit), q.largerIsWorse});
  });
  return list;
}

QVector<double> errorsOf(const FrameError& error) {
  harness::MeasuredFrame frame;
  frame.error = error;
  QVector<double> values;
  eachError([&](const harness::Quantity& q) { values.append(q.of(frame)); });
  return values;
}

views::ErrorRun measuredRun(const harness::Results& results) {
  views::ErrorRun run{measuredErrors(), {}, results.widthPx, results.heightPx};
  for (const harness::Unit& unit : results.units) {
    views::ErrorRun::Series s{QString::fromStdString(unit.name.flight),
                              QString::fromStdString(unit.name.preset),
                              QString::fromStdString(unit.name.method),
                              {},
                              {},
                              QVector<QVector<double>>(run.errors.size()),
                              {}};
    for (const harness::MeasuredFrame& frame : unit.frames) {
      s.timeS.append(frame.timeS);
      s.ms.append(frame.cost.total);
      const QVector<double> errors = errorsOf(frame.error);
      for (qsizetype i = 0; i < errors.size(); ++i) s.errors[i].append(errors[i]);
    }
    for (const harness::WorstFrame& worst : unit.worst)
      s.worst.append({qsizetype(worst.frame), QString::fromStdString(worst.why)});
    run.series.append(std::move(s));
  }
  return run;
}

}  // namespace trimtab::workbench
