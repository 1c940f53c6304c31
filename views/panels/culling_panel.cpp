// SPDX-License-Identifier: GPL-3.0-or-later
#include "culling_panel.h"

#include <QAction>
#include <QBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>
#include <cmath>

#include "trimtab/frame/overlay_colours.h"
#include "views/controls/bar_list.h"
#include "views/controls/parameter_lines.h"
#include "views/insets/depth_map_inset.h"
#include "views/insets/horizon_inset.h"
#include "views/model/depth_map_reason.h"
#include "views/model/theme.h"
#include "views/plots/time_plot.h"

namespace trimtab::views {
namespace {

constexpr double kStagesShownS = 20;
constexpr const char* kCullingKeys[] = {"culling.case", "culling.occlusion", "culling.back_faces"};

QString count(std::uint64_t n) {
  return numberText(static_cast<double>(n), 0);
}

QString metres(double m) {
  return m < 10000 ? CullingPanel::tr("%1 m").arg(numberText(m, m < 10 ? 2 : 0))
                   : CullingPanel::tr("%1 km").arg(numberText(m / 1000, 1));
}

/// `size` is empty, or begins with a comma.
QString whatServes(OcclusionMethod method, const QString& size) {
  switch (method) {
    case OcclusionMethod::depth_map:
      return CullingPanel::tr("The <b>depth map</b> that GL draws serves%1.").arg(size);
    case OcclusionMethod::automatic:
      break;
    case OcclusionMethod::horizon:
      return CullingPanel::tr("The <b>horizon</b> serves: what the ground about the eye hides, all round.");
  }
  return {};
}

QString horizonLeftOut() {
  return CullingPanel::tr("The horizon is left out: near here it hid next to nothing.");
}

QString textOf(const PickedNode& node) {
  const auto row = [](const QString& name, const QString& value) {
    return QStringLiteral("<tr><td>%1&nbsp;&nbsp;</td><td>%2</td></tr>").arg(name, value);
  };
  QString text = QStringLiteral("<table>");
  if (!node.model.isEmpty()) text += row(CullingPanel::tr("Model"), node.model.toHtmlEscaped());
  text += row(
      node.model.isEmpty() ? CullingPanel::tr("Node") : CullingPanel::tr("Object"),
      CullingPanel::tr("%1 %2, level %3").arg(node.form, count(node.number), QString::number(node.level)));
  text += row(CullingPanel::tr("Reason"), node.reason);
  text += row(CullingPanel::tr("Triangles"), count(node.triangles));
  text += row(CullingPanel::tr("Distance"), metres(node.distanceM));
  text += row(CullingPanel::tr("In the image"),
              CullingPanel::tr("%1 × %2 px").arg(numberText(node.widthPx, 0), numberText(node.heightPx, 0)));
  text +=
      row(CullingPanel::tr("Stated error"),
          CullingPanel::tr("%1, %2 px seen from here").arg(metres(node.errorM), numberText(node.errorPx, 2)));
  return text + QStringLiteral("</table>");
}

}  // namespace

CullingPanel::CullingPanel(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      served_(new QLabel),
      work_(new QLabel),
      picked_(new QLabel),
      objects_(new QLabel),
      reasons_(new BarList),
      map_(new DepthMapInset),
      horizon_(new HorizonInset),
      overlayRow_(new QHBoxLayout),
      pick_(new QPushButton(tr("&Pick in the image"))),
      throttle_(this, [this] { refresh(); }) {
  for (QLabel* label : {served_, work_, picked_, objects_}) label->setWordWrap(true);
  picked_->setTextFormat(Qt::RichText);
  picked_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  reasons_->setAccessibleName(tr("Nodes of the cut, by why they are drawn or not"));
  pick_->setCheckable(true);
  pick_->setToolTip(tr("Click into the image, and read what is there"));
  work_->setToolTip(tr("Since the terrain was opened. Work whose result is known is left out."));
  connect(pick_, &QPushButton::toggled, this, &CullingPanel::pickingChanged);

  auto* layout = layout_ = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  layout->addWidget(new ParameterLines(draft, kCullingKeys));
  layout->addLayout(overlayRow_);
  auto* pickRow = new QHBoxLayout;
  pickRow->addWidget(pick_);
  pickRow->addStretch(1);
  layout->addLayout(pickRow);
  layout->addWidget(picked_);
  layout->addWidget(new QLabel(tr("<b>Nodes of the cut, by reason</b>")));
  layout->addWidget(reasons_);
  layout->addWidget(objects_);
  layout->addWidget(served_);
  layout->addWidget(horizon_, 2);
  layout->addWidget(map_, 3);
  layout->addWidget(work_);
  showPicked(std::nullopt);
  refresh();
}

void CullingPanel::showStages(const TraceBuffer& frames) {
  stages_ = new TimePlot(frames, nullptr, {{{}, true}});
  stages_->setAccessibleName(tr("Stages of a frame, stacked"));
  stages_->setToolTip(tr("What each stage of a frame takes; the Plots dock has the rest"));
  stages_->setSpan(kStagesShownS);
  const auto budget = [this] { stages_->setBudget(draft_.active()->measure.budget.value()); };
  connect(&draft_, &Draft::activeChanged, this, budget);
  budget();
  layout_->insertWidget(layout_->indexOf(work_), stages_, 2);
}

void CullingPanel::setActions(const QList<QAction*>& overlays) {
  for (QAction* action : overlays) {
    auto* button = new QToolButton(this);
    button->setDefaultAction(action);
    button->setToolButtonStyle(Qt::ToolButtonTextOnly);
    button->setFocusPolicy(Qt::StrongFocus);
    overlayRow_->addWidget(button);
  }
  overlayRow_->addStretch(1);
}

void CullingPanel::showFrame(const LiveFrame& frame) {
  frame_ = frame;
  throttle_.request();
}

void CullingPanel::showMap(const QImage& image, const QString& caption) {
  hasMap_ = !image.isNull();
  if (hasMap_) return map_->setImage(image, caption);
  map_->setReason(whyNoDepthMap(frame_, *draft_.active()));
}

void CullingPanel::showHorizon(std::vector<float> elevationDeg, double headingDeg, double fovDeg) {
  hasHorizon_ = !elevationDeg.empty();
  if (hasHorizon_)
    horizon_->setProfile(std::move(elevationDeg), headingDeg, fovDeg);
  else
    horizon_->setReason(whyNoHorizon());
}

QString CullingPanel::whyNoHorizon() const {
  if (!frame_.drawn().note.empty()) return QString::fromStdString(frame_.drawn().note);
  if (frame_.drawn().occlusion == OcclusionMethod::horizon) return horizonLeftOut();
  if (frame_.drawn().occlusion || frame_.drawn().depthMap) return tr("A depth map serves, not the horizon.");
  return tr("No horizon: nothing asks for one in this frame.");
}

void CullingPanel::showPicked(std::optional<PickedNode> node) {
  picked_->setText(node ? textOf(*node)
                        : tr("Nothing is picked. The sky is no node; the image must show terrain there."));
}

bool CullingPanel::picking() const {
  return pick_->isChecked();
}

void CullingPanel::endPicking() {
  pick_->setChecked(false);
}

QString CullingPanel::served() const {
  const QString note = QString::fromStdString(frame_.drawn().note).toHtmlEscaped();
  const QString size =
      frame_.drawn().depthMap
          ? tr(", %1 × %2 px").arg(frame_.drawn().depthMap->widthPx).arg(frame_.drawn().depthMap->heightPx)
          : QString();
  if (frame_.drawn().occlusion) {
    const OcclusionMethod method = *frame_.drawn().occlusion;
    QStringList sentences{whatServes(method, size)};
    if (!note.isEmpty()) sentences << note;
    if (!frame_.drawn().horizon && note.isEmpty() && method == OcclusionMethod::horizon)
      sentences << horizonLeftOut();
    return sentences.join(QLatin1Char(' '));
  }
  if (frame_.drawn().depthMap) return tr("A <b>depth map</b> of the static trees serves%1.").arg(size);
  if (!note.isEmpty()) return tr("Nothing is looked for behind the ground.") + QLatin1Char(' ') + note;
  if (!frame_.decision.occlusionResolution)
    return tr("The decision is plain view-frustum culling in this frame.");
  return tr("Nothing is looked for behind the ground in this case.");
}

void CullingPanel::refresh() {
  served_->setText(served());
  if (!hasHorizon_) horizon_->setReason(whyNoHorizon());
  hasMap_ = hasMap_ && (frame_.drawn().depthMap || frame_.drawn().horizon);
  if (!hasMap_) map_->setReason(whyNoDepthMap(frame_, *draft_.active()));
  if (stages_) stages_->refresh(true);
  const FrameResult& f = frame_.drawn();
  const FrameCounters& work = f.counters;
  const double all = std::max<double>(1, static_cast<double>(f.tilesInCut));
  const auto bar = [&](const QString& name, std::size_t nodes, const QString& more, CullReason reason) {
    const auto [red, green, blue] = reasonColour(reason);
    return BarList::Bar{.name = name,
                        .value = static_cast<double>(nodes),
                        .top = all,
                        .text = count(nodes) + more,
                        .quiet = f.tilesInCut == 0,
                        .given = QColor(red, green, blue)};
  };
  reasons_->setBars(
      {bar(tr("drawn"), f.visible.tiles.size(), tr(" (%1 triangles)").arg(count(f.visible.triangles)),
           CullReason::drawn),
       bar(tr("outside the frustum"), f.visible.outsideFrustum, {}, CullReason::outside_frustum),
       bar(tr("occluded"), f.visible.occluded, {}, CullReason::occluded),
       bar(tr("beyond visibility"), f.visible.beyondVisibility, {}, CullReason::beyond_visibility),
       bar(tr("facing away"), f.visible.backFacing, {}, CullReason::back_facing)});
  objects_->setVisible(f.objects.all() > 0);
  objects_->setText(tr("Objects: %1 drawn (%2 triangles) of %3; %4 outside the frustum, %5 occluded, %6 too "
                       "far, %7 too small.")
                        .arg(count(f.objects.drawn), count(f.objects.triangles), count(f.objects.all()),
                             count(f.objects.outsideFrustum), count(f.objects.occluded),
                             count(f.objects.tooFar), count(f.objects.tooSmall)));
  work_->setText(tr("Cuts chosen %1, views %2; horizons built %3, moved along %4, left out %5; depth maps "
                    "drawn %6; frames in which nothing was worth its cost %7.")
                     .arg(count(work.cutsSelected), count(work.visibleSelected), count(work.horizonsBuilt),
                          count(work.horizonsMoved), count(work.horizonsLeftOut), count(work.depthMapsDrawn),
                          count(work.occlusionsLeftOut)));
}

}  // namespace trimtab::views
