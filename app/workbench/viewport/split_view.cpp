// SPDX-License-Identifier: GPL-3.0-or-later
#include "split_view.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QSplitter>
#include <QTableWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <span>

#include "app/workbench/jobs/live_meter.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/measure/image_error.h"
#include "trimtab/terrain/format/database.h"
#include "views/model/error_run.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

constexpr int kSoonMs = 60, kPeriodMs = 300;
constexpr int kMostOfTime = 2;
constexpr double kLongestMs = 1500, kQuickMs = 250;
constexpr int kSmallest = 4;
constexpr std::size_t kRemembered = 16;

enum Column {
  flipColumn,
  ssimColumn,
  psnrColumn,
  maxPxColumn,
  meanPxColumn,
  trianglesColumn,
  msColumn,
  kColumns
};

QImage imageOf(const std::vector<std::uint8_t>& rgba, int width, int height) {
  if (rgba.size() != std::size_t(width) * std::size_t(height) * 4) return {};
  // Opaque whatever the drawing left in alpha.
  return QImage(rgba.data(), width, height, width * 4, QImage::Format_RGBX8888)
      .mirrored()
      .convertToFormat(QImage::Format_RGB32);
}

}  // namespace

const QString SplitView::kDraft = QStringLiteral("draft"),
              SplitView::kReference = QStringLiteral("reference");

/// Both sides' pictures, made on the measuring thread.
struct SplitView::Work {
  struct One {
    std::vector<FrameRequest> requests;  ///< the last one is measured
    QString label;
    bool reference = false;
    FrameError error;
    scene::ErrorPictures pictures;
    void measure(scene::ErrorMeter& meter) {
      error = meter.measure(requests.back(), std::span(requests).first(requests.size() - 1), &pictures);
    }
    const std::vector<std::uint8_t>& shown() const { return reference ? pictures.reference : pictures.ours; }
  };
  std::array<One, 2> sides;
  std::uint64_t generation = 0;
  int widthPx = 0, heightPx = 0;
  std::vector<float> map;
  double flip = 0, largest = 0, ssim = 0, psnr = 0, tookMs = 0;
};

SplitView::SplitView(DrawThread& thread, views::Draft& draft, Source source, QWidget* parent)
    : QWidget(parent, Qt::Window),
      thread_(thread),
      draft_(draft),
      source_(std::move(source)),
      form_(new QComboBox(this)),
      pictures_(new SplitPicture(this)),
      heat_(new HeatMap(this)),
      numbers_(new QTableWidget(3, kColumns, this)),
      status_(new QLabel(this)) {
  setWindowTitle(tr("Compare two presets – Trimtab"));
  setObjectName(QStringLiteral("split_view"));
  choices_ = {makeChoice(left, kDraft), makeChoice(right, kReference)};
  form_->addItems({tr("one image, divided"), tr("side by side")});
  form_->setAccessibleName(tr("Arrangement of the images"));

  auto* top = new QHBoxLayout;
  const auto add = [&](const QString& text, QComboBox* box) {
    auto* label = new QLabel(text, this);
    label->setBuddy(box);
    top->addWidget(label);
    top->addWidget(box, 1);
  };
  add(tr("&Left"), choices_[left]);
  add(tr("&Right"), choices_[right]);
  add(tr("&Shown as"), form_);

  numbers_->setHorizontalHeaderLabels({tr("FLIP"), tr("SSIM"), tr("PSNR (dB)"),
                                       tr("Geometric,\nlargest (px)"), tr("Geometric,\nmean (px)"),
                                       tr("Triangles"), tr("Frame (ms)")});
  numbers_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  numbers_->setAccessibleName(tr("Errors and cost of both"));
  numbers_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  numbers_->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  numbers_->setSelectionMode(QAbstractItemView::NoSelection);
  numbers_->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  numbers_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  numbers_->setToolTip(
      tr("The first two rows compare with the reference; the third row compares the right image "
         "with the left one"));
  status_->setWordWrap(true);

  auto* middle = new QSplitter(Qt::Horizontal, this);
  middle->addWidget(pictures_);
  middle->addWidget(heat_);
  middle->setStretchFactor(0, 3);
  middle->setStretchFactor(1, 2);
  auto* column = new QVBoxLayout(this);
  column->addLayout(top);
  column->addWidget(middle, 1);
  column->addWidget(numbers_);
  column->addWidget(status_);
  resize(1240, 640);

  connect(form_, &QComboBox::currentIndexChanged, this,
          [this](int index) { pictures_->setBeside(index == 1); });
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

void SplitView::restart(Side side) {
  Chosen& chosen = sides_[side];
  chosen.session.reset();
  chosen.recent.clear();
  if (chosen.parameters) {
    chosen.session = std::make_unique<Session>(*chosen.parameters);
    chosen.session->setGround(terrain_);
  }
  last_.reset();
  changed_ = true;
  wake();
}

void SplitView::setTerrain(std::shared_ptr<const terrain::Database> terrain) {
  terrain_ = std::move(terrain);
  ++generation_;
  restart(left);
  restart(right);
}

void SplitView::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  restart(left);
  restart(right);
}

void SplitView::hideEvent(QHideEvent* event) {
  timer_.stop();
  QWidget::hideEvent(event);
}

void SplitView::painted() {
  if (!isVisible()) return;
  follow();
  changed_ = true;
  wake();
}

/// Decides what was shown: memory, and with it hysteresis and head motion, go along.
void SplitView::follow() {
  std::optional<Frame> frame = source_();
  if (!frame) return;
  const bool back = last_ && frame->state.time < last_->state.time;
  const bool same = last_ && frame->state == last_->state;
  last_ = std::move(frame);
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
}

void SplitView::wake() {
  if (!isVisible() || !terrain_ || !changed_ || busy_ || timer_.isActive()) return;
  const qint64 due = sinceLast_.isValid() ? gapMs_ - sinceLast_.elapsed() : 0;
  timer_.start(int(std::max<qint64>(due, kSoonMs)));
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
  if (!isVisible() || busy_ || !terrain_ || !thread_.usable()) return;
  if (!last_) follow();
  if (!last_) return;
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
      one.requests = {pilotsPicture(last_->shown, shrink_)};
    else
      for (const FrameRequest& request : decides.recent)
        one.requests.push_back(pilotsPicture(request, shrink_));
  }
  busy_ = true;
  sinceLast_.start();
  thread_.run(
      [work](scene::ErrorMeter& meter) {
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
      },
      this,
      [this, work] {
        busy_ = false;
        if (work->tookMs > kLongestMs) shrink_ = std::min(shrink_ * 2, kSmallest);
        if (work->tookMs < kQuickMs) shrink_ = std::max(shrink_ / 2, 1);
        if (work->generation == generation_) {
          ++comparisons_;
          showWork(*work);
          emit compared();
        }
        gapMs_ = std::max(kPeriodMs, int(work->tookMs) * kMostOfTime);
        wake();
      });
}

/// What was asked of the thread never comes back.
void SplitView::sayMissing(const Findings& missing) {
  busy_ = changed_ = false;
  status_->setText(
      tr("Presets cannot be compared on this machine: %1").arg(QString::fromStdString(toString(missing))));
}

void SplitView::showWork(const Work& work) {
  const auto image = [&](Side side) {
    return imageOf(work.sides[side].shown(), work.widthPx, work.heightPx);
  };
  pictures_->setNames(work.sides[left].label, work.sides[right].label);
  pictures_->show(image(left), image(right));
  heat_->show(heatImage(work.map, work.widthPx, work.heightPx), work.flip, work.largest);
  fill(work);
  status_->setText(tr("Measured in %1 at %L2 × %L3 px; errors of left and right against the reference.")
                       .arg(views::msText(work.tookMs))
                       .arg(work.widthPx)
                       .arg(work.heightPx));
}

void SplitView::fill(const Work& work) {
  const auto put = [this](int row, Column column, const QString& text) {
    auto* item = new QTableWidgetItem(text);
    item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
    numbers_->setItem(row, column, item);
  };
  const auto errors = [&](int row, double flipError, double ssim, double psnr) {
    put(row, flipColumn, views::numberText(flipError, 4));
    put(row, ssimColumn, views::numberText(ssim, 5));
    put(row, psnrColumn, std::isinf(psnr) ? tr("∞ (equal)") : views::numberText(psnr, 2));
  };
  QStringList names;
  for (const Side side : {left, right}) {
    const Work::One& one = work.sides[side];
    names << (side == left ? tr("Left: %1") : tr("Right: %1")).arg(one.label);
    const FrameError equal{0, 0, 0, INFINITY, 1, 0, 0, 0};
    const FrameError& error = one.reference ? equal : one.error;
    errors(side, error.flip, error.ssim, error.psnrDb);
    put(side, maxPxColumn, views::numberText(error.geometricMaxPx, 2));
    put(side, meanPxColumn, views::numberText(error.geometricMeanPx, 3));
    const FrameResult& drawn = one.reference ? one.pictures.drawnReference : one.pictures.drawn;
    put(side, trianglesColumn, QLocale().toString(qulonglong(drawn.visible.triangles)));
    put(side, msColumn, views::numberText(drawn.cost.total, 1));
  }
  names << tr("Right compared with left");
  errors(2, work.flip, work.ssim, work.psnr);
  const auto ratio = [&](double a, double b) {
    return a > 0 && b > 0 ? QStringLiteral("× %1").arg(views::numberText(b / a, 2)) : QStringLiteral("–");
  };
  const auto drawnOf = [&](Side side) -> const FrameResult& {
    const Work::One& one = work.sides[side];
    return one.reference ? one.pictures.drawnReference : one.pictures.drawn;
  };
  put(2, maxPxColumn, QStringLiteral("–"));
  put(2, meanPxColumn, QStringLiteral("–"));
  put(2, trianglesColumn,
      ratio(double(drawnOf(left).visible.triangles), double(drawnOf(right).visible.triangles)));
  put(2, msColumn, ratio(drawnOf(left).cost.total, drawnOf(right).cost.total));
  numbers_->setVerticalHeaderLabels(names);
  int height = numbers_->horizontalHeader()->height() + 2 * numbers_->frameWidth();
  for (int row = 0; row < numbers_->rowCount(); ++row) height += numbers_->rowHeight(row);
  numbers_->setFixedHeight(height);
}

}  // namespace trimtab::workbench
