// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "error_plot.h"
#include "views/model/theme.h"

// The numbers of ErrorPlot's selected point.
namespace trimtab::views {

QString ErrorPlot::selectedText() const {
  const ErrorRun::Error* shown = error();
  if (selected_ < 0 || shown == nullptr) return {};
  if (selected_ == int(points_.size())) {
    if (tail_.empty()) return {};
    return tr("%1\n%2: %3\nframe time: %4 (median of a second)")
        .arg(liveName(), shown->label, textOf(*shown, tail_.back().errors.value(error_)),
             msText(tail_.back().ms));
  }
  const Point& p = points_[std::size_t(selected_)];
  const ErrorRun::Series& s = run_.series[p.series];
  const auto back = [&](double place) {
    return !shown->largerIsWorse && place >= kEqualDb ? std::numeric_limits<double>::infinity() : place;
  };
  return tr("%1, %2, %L3 frames\n%4: %5 (5 to 95 %: %6 to %7)\nframe time: %8 (%9 to %10)%11")
      .arg(s.preset, methodText(s.method))
      .arg(s.ms.size())
      .arg(shown->label, textOf(*shown, back(p.error)), textOf(*shown, back(p.errorLow)),
           textOf(*shown, back(p.errorHigh)))
      .arg(msText(p.ms), msText(p.msLow), msText(p.msHigh), p.onFront ? tr("\non the front") : QString());
}

void ErrorPlot::placeText() {
  const QString text = selectedText();
  numbers_->setVisible(!text.isEmpty());
  setAccessibleDescription((text.isEmpty() ? QString() : QString(text).replace('\n', ", ") + ". ") +
                           tr("Left and right choose a point, L switches the scale of the frame time, F "
                              "fits the view, plus and minus zoom."));
  if (text.isEmpty()) return;
  const bool live = selected_ == int(points_.size());
  placeReadout(*numbers_, text, live ? livePixel() : pixelOf(points_[std::size_t(selected_)]));
  if (live) numbers_->setPen(QPen(liveColour(palette())));
}

void ErrorPlot::select(int point) {
  const int last = int(points_.size()) - (tail_.empty() ? 1 : 0);
  point = std::clamp(point, -1, last);
  if (point == selected_) return;
  selected_ = point;
  placeText();
  replot(QCustomPlot::rpQueuedReplot);
}

}  // namespace trimtab::views
