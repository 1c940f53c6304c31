// SPDX-License-Identifier: GPL-3.0-or-later
#include "split_view.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QTableWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "app/workbench/jobs/live_meter.h"
#include "split_work.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/measure/image_error.h"
#include "trimtab/measure/machine_watch.h"
#include "trimtab/measure/statistics.h"
#include "trimtab/terrain/format/database.h"
#include "views/controls/scrollable.h"
#include "views/model/error_run.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

constexpr int kSoonMs = 60, kPeriodMs = 300;
/// A view that has rested for so long is drawn once more at its full size, and timed.
constexpr int kRestMs = 400;
constexpr int kMostOfTime = 2;
constexpr double kQuickMs = 250;
constexpr int kSmallest = 4;
constexpr std::size_t kRemembered = 16;
/// While the view stands, the rules of a preset follow its own image so often: what they change may change
/// what they know.
constexpr int kFollowed = 2;

QImage imageOf(const std::vector<std::uint8_t>& rgba, int width, int height) {
  if (rgba.size() != std::size_t(width) * std::size_t(height) * 4) return {};
  // The format is opaque, whatever the drawing left in alpha.
  return QImage(rgba.data(), width, height, width * 4, QImage::Format_RGBX8888)
      .mirrored()
      .convertToFormat(QImage::Format_RGB32);
}

/// The preset without the budget, which would have to learn what each of its images costs.
ValidatedParameters asAsked(const ValidatedParameters& parameters) {
  TuningParameters asked = *parameters;
  asked.hold.enabled = false;
  return validate(asked).value();
}

}  // namespace

const QString SplitView::kDraft = QStringLiteral("draft"),
              SplitView::kReference = QStringLiteral("reference");

SplitView::SplitView(DrawThread& thread, views::Draft& draft, Source source, QWidget& viewport)
    : thread_(thread),
      draft_(draft),
      source_(std::move(source)),
      form_(new QComboBox(this)),
      symbolsOn_(new QCheckBox(tr("S&ymbols"), this)),
      overOn_(new QCheckBox(tr("In the viewport"), this)),
      inDock_(new QWidget(this)),
      pictures_(new SplitPicture(inDock_)),
      overlay_(new SplitPicture(&viewport)),
      heat_(new HeatMap(inDock_)),
      numbers_(new QTableWidget(this)),
      status_(new QLabel(this)) {
  setObjectName(QStringLiteral("split_view"));
  choices_ = {makeChoice(left, kDraft), makeChoice(right, kReference)};
  form_->addItems(
      {tr("divided"), tr("side by side"), tr("left alone"), tr("right alone"), tr("differences")});
  form_->setAccessibleName(tr("Arrangement of the images"));
  symbolsOn_->setToolTip(
      tr("Draws symbology too. It covers the terrain, and differs wherever presets place it "
         "differently"));
  overOn_->setToolTip(
      tr("Shows both presets over the viewport, at its full size, as soon as the view rests"));
  status_->setWordWrap(true);
  overlay_->setObjectName(QStringLiteral("split_overlay"));
  overlay_->layOverParent();
  overlay_->hide();
  makeNumbers();
  arrange();

  connect(form_, &QComboBox::currentIndexChanged, this,
          [this](int index) { setForm(SplitPicture::Form(index)); });
  connect(symbolsOn_, &QCheckBox::toggled, this, &SplitView::setSymbols);
  connect(overOn_, &QCheckBox::toggled, this, &SplitView::setOverViewport);
  connect(&draft_, &views::Draft::activeChanged, this, [this] {
    for (const Side side : {left, right})
      if (sides_[side].name == kDraft) choose(side, kDraft);
  });
  connect(&thread_, &DrawThread::failed, this, &SplitView::sayMissing);
  timer_.setSingleShot(true);
  connect(&timer_, &QTimer::timeout, this, &SplitView::compare);
  choose(left, kDraft);
  choose(right, kReference);
  status_->setText(tr("Open a terrain to compare presets over it."));
  if (!thread_.usable()) sayMissing(thread_.missing());
}

SplitView::~SplitView() {
  delete overlay_.data();
}

void SplitView::arrange() {
  auto* inner = new QWidget;
  auto *top = new QHBoxLayout, *switches = new QHBoxLayout;
  const auto add = [&](const QString& text, QComboBox* box) {
    auto* label = new QLabel(text, inner);
    label->setBuddy(box);
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    box->setMinimumContentsLength(8);
    top->addWidget(label);
    top->addWidget(box, 1);
  };
  add(tr("Left"), choices_[left]);
  add(tr("&Right"), choices_[right]);
  add(tr("&Shown as"), form_);
  switches->addWidget(overOn_);
  switches->addWidget(symbolsOn_);
  switches->addStretch(1);
  auto* images = new QHBoxLayout(inDock_);
  images->setContentsMargins(0, 0, 0, 0);
  images->addWidget(pictures_, 3);
  images->addWidget(heat_, 2);
  auto* column = new QVBoxLayout(inner);
  column->addLayout(top);
  column->addLayout(switches);
  column->addWidget(inDock_, 1);
  column->addWidget(numbers_);
  column->addWidget(status_);
  column->addStretch();
  // At the foot of the window every dock would have to be as tall as this one.
  auto* area = views::scrollable(inner, tr("Compare"));
  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(area);
}

void SplitView::setForm(SplitPicture::Form form) {
  form_->setCurrentIndex(int(form));
  pictures_->setForm(form);
  overlay_->setForm(form);
}

void SplitView::flicker() {
  setForm(overlay_->form() == SplitPicture::Form::left ? SplitPicture::Form::right
                                                       : SplitPicture::Form::left);
}

void SplitView::toggleDifference() {
  setForm(overlay_->form() == SplitPicture::Form::difference ? SplitPicture::Form::divided
                                                             : SplitPicture::Form::difference);
}

void SplitView::setSymbols(bool on) {
  if (on == symbols_) return;
  symbols_ = on;
  symbolsOn_->setChecked(on);
  ++generation_;
  changed_ = true;
  wake();
}

void SplitView::setSeen(bool seen) {
  const bool before = active();
  seen_ = seen;
  activityChanged(before);
}

void SplitView::setOverViewport(bool over) {
  if (over == over_) return;
  const bool before = active();
  over_ = over;
  overOn_->setChecked(over);
  overlay_->setVisible(over);
  overlay_->raise();
  inDock_->setVisible(!over);
  activityChanged(before);
  emit overViewportChanged(over);
}

/// Whoever looks again sees presets without a past, so that equal ones have equal memories.
void SplitView::activityChanged(bool before) {
  if (!active()) return timer_.stop();
  if (before) return;
  restart(left);
  restart(right);
}

void SplitView::restart(Side side) {
  Chosen& chosen = sides_[side];
  chosen.session.reset();
  chosen.recent.clear();
  if (chosen.parameters) {
    chosen.session = std::make_unique<Session>(asAsked(*chosen.parameters));
    chosen.session->setGround(terrain_);
  }
  last_.reset();
  changed_ = true;
  wake();
}

void SplitView::setTerrain(std::shared_ptr<const terrain::Database> terrain) {
  terrain_ = std::move(terrain);
  ++generation_;
  shownShrink_ = 0;
  if (terrain_ && thread_.usable())
    status_->setText(tr("Both presets are drawn as soon as they are looked at."));
  restart(left);
  restart(right);
}

void SplitView::painted() {
  if (!active() || !follow()) return;
  // Only a view that rests is worth a large image.
  if (std::exchange(refining_, false) && !busy_) timer_.stop();
  changed_ = true;
  wake();
}

/// Decides what was shown: memory, and with it hysteresis and head motion, go along. Returns whether the
/// image differs from the one before, apart from what moves by itself, such as rain.
bool SplitView::follow() {
  std::optional<Frame> frame = source_();
  if (!frame) return false;
  const bool back = last_ && frame->state.time < last_->state.time;
  const bool hadFrame = last_.has_value(), same = last_ && frame->state == last_->state;
  const bool blurs = frame->shown.levers.drawn.blurStrength > 0;
  const bool rests = same && !blurs && sameImage(frame->shown, last_->shown);
  last_ = std::move(frame);
  moves_ = hadFrame && !same;
  if (!same) followed_ = 0;
  for (Chosen& side : sides_) {
    if (!side.session) continue;
    if (back) {
      side.session->restart();
      side.recent.clear();
    }
    if (!same) side.session->fly(last_->state);
    if (!side.recent.empty() && side.recent.back().view != last_->shown.view) side.recent.clear();
    side.recent.push_back(requestOf(*side.session));
    if (side.recent.size() > kRemembered) side.recent.pop_front();
  }
  return !rests;
}

void SplitView::wake() {
  showAge();
  if (!active() || !terrain_ || busy_ || timer_.isActive()) return;
  refining_ = !changed_ && shownShrink_ > 0 && !(shownShrink_ == 1 && timed_);
  if (!changed_ && !refining_) return;
  const qint64 due = sinceLast_.isValid() ? gapMs_ - sinceLast_.elapsed() : 0;
  timer_.start(refining_ ? kRestMs : int(std::max<qint64>(due, kSoonMs)));
}

/// Over the viewport old images are not shown: the live one is there.
void SplitView::showAge() {
  overlay_->setOld(changed_ || shownShrink_ == 0,
                   !terrain_ ? tr("Open a terrain to compare presets over it")
                   : moves_  ? tr("The view moves: %1 and %2 are compared here as soon as it rests")
                                  .arg(sides_[left].label, sides_[right].label)
                            : tr("comparing %1 with %2 …").arg(sides_[left].label, sides_[right].label));
}

/// What this preset would show of the last frame: one camera and one size, whatever view it asks for.
FrameRequest SplitView::requestOf(Session& side) const {
  const FrameRequest& shown = last_->shown;
  FrameRequest request = *side.request(last_->state.time, shown.view.widthPx, shown.view.heightPx);
  request.time = shown.time;
  request.eye = shown.eye;
  request.velocity = shown.velocity;
  request.attitude = shown.attitude;
  request.view = shown.view;
  return request;
}

void SplitView::compare() {
  if (!active() || busy_ || !terrain_ || !thread_.usable()) return;
  if (!last_) follow();
  if (!last_) return;
  const bool rests = std::exchange(refining_, false);
  const int shrink = rests ? 1 : shrink_;
  changed_ = false;
  const auto work = std::make_shared<Work>();
  work->generation = generation_;
  for (const Side side : {left, right}) {
    Work::One& one = work->sides[side];
    const Chosen& chosen = sides_[side];
    one.label = chosen.label;
    one.reference = !chosen.parameters;
    // A reference has the air of the preset it is held against.
    const Chosen& decides = one.reference ? sides_[side == left ? right : left] : chosen;
    if (decides.recent.empty())
      one.requests = {pilotsImage(last_->shown, shrink)};
    else
      for (const FrameRequest& request : decides.recent) one.requests.push_back(pilotsImage(request, shrink));
    if (!symbols_)
      for (FrameRequest& request : one.requests) request.symbology.reset();
  }
  setBusy(true);
  sinceLast_.start();
  thread_.run(
      [work, rests, longestMs = longestMs_](scene::ErrorMeter& meter) {
        const MachineWatch watch;
        QElapsedTimer timer;
        timer.start();
        auto& [a, b] = work->sides;
        a.measure(meter);
        if (a.reference != b.reference) {
          b.error = a.error;
          b.pictures = a.pictures;
        } else {
          b.measure(meter);
        }
        // Sizes are one: both requests have the shown view.
        const int width = work->widthPx = a.pictures.widthPx, height = work->heightPx = a.pictures.heightPx;
        work->map.resize(std::size_t(width) * std::size_t(height));
        work->flip = flip(a.shown(), b.shown(), width, height, work->map);
        work->ssim = ssimOfLuma(a.shown(), b.shown(), width, height);
        work->psnr = psnrDb(a.shown(), b.shown(), width, height);
        work->largest = work->map.empty() ? 0 : *std::max_element(work->map.begin(), work->map.end());
        work->tookMs = double(timer.nsecsElapsed()) * 1e-6;
        if (rests) work->time(meter, longestMs);
        work->othersShare = watch.othersShare();
      },
      this,
      [this, work, shrink] {
        setBusy(false);
        if (shrink == shrink_ && work->tookMs > longestMs_) shrink_ = std::min(shrink_ * 2, kSmallest);
        if (work->tookMs < kQuickMs) shrink_ = std::max(shrink_ / 2, 1);
        if (work->generation == generation_) {
          ++comparisons_;
          shownShrink_ = shrink;
          timed_ = work->timed;
          showWork(*work);
          if (shrink == 1) giveBack(*work);
          emit compared();
        }
        gapMs_ = std::max(kPeriodMs, int(work->tookMs) * kMostOfTime);
        wake();
      });
}

/// Gives each preset what its image drew, and what it took if it was timed. The rules follow at the next
/// state, and while none comes at once.
void SplitView::giveBack(const Work& work) {
  const bool follow = followed_ < kFollowed;
  for (const Side side : {left, right}) {
    Chosen& chosen = sides_[side];
    if (!chosen.session || chosen.recent.empty()) continue;
    FrameResult result = work.sides[side].drawn();
    result.cost = {};
    result.cost.total = quantileOf(work.sides[side].ms, 0.5);
    chosen.session->finished(result, last_->state.time);
    if (!follow) continue;
    // The state again, at its own time, so that signals know the image; and an edit, so that levers jump.
    chosen.session->fly(last_->state);
    chosen.session->setParameters(chosen.session->parameters());
    FrameRequest follows = requestOf(*chosen.session);
    if (sameImage(follows, chosen.recent.back())) continue;
    chosen.recent.back() = std::move(follows);
    changed_ = true;
  }
  followed_ += changed_;
}

void SplitView::setBusy(bool busy) {
  busy_ = busy;
  emit busyChanged(busy);
}

/// What was asked of the thread never comes back.
void SplitView::sayMissing(const Findings& missing) {
  changed_ = false;
  setBusy(false);
  status_->setText(
      tr("Presets cannot be compared on this machine: %1").arg(QString::fromStdString(toString(missing))));
}

void SplitView::showWork(const Work& work) {
  const auto image = [&](Side side) {
    return imageOf(work.sides[side].shown(), work.widthPx, work.heightPx);
  };
  const ComparedImages compared{
      {image(left), image(right)}, heatImage(work.map, work.widthPx, work.heightPx), work.map};
  for (SplitPicture* shown : {pictures_, overlay_.data()}) {
    shown->setNames(work.sides[left].label, work.sides[right].label);
    shown->show(compared);
  }
  heat_->show(compared.map, work.flip, work.largest);
  fill(work);
  QString text = tr("Measured in %1 at %L2 × %L3 px%4; errors of left and right against the reference. The "
                    "live view waits while both are drawn.")
                     .arg(views::msText(work.tookMs))
                     .arg(work.widthPx)
                     .arg(work.heightPx)
                     .arg(shownShrink_ > 1 ? tr(", smaller while the view moves") : QString());
  const auto holds = [](const Chosen& side) { return side.parameters && (*side.parameters)->hold.enabled; };
  if (holds(sides_[left]) || holds(sides_[right]))
    text += tr(" The budget is off here: presets are drawn as they ask.");
  if (const std::string busy = busyText(work.othersShare); !busy.empty())
    text += QLatin1Char(' ') + QString::fromStdString(busy);
  status_->setText(text);
}

}  // namespace trimtab::workbench
