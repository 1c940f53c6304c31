// SPDX-License-Identifier: GPL-3.0-or-later
#include "terrain_panel.h"

#include <QAction>
#include <QBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QTableView>
#include <QToolButton>
#include <algorithm>
#include <cmath>

#include "views/controls/parameter_lines.h"
#include "views/model/terrain_levels_model.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr const char* kTerrainKeys[] = {"terrain.form",     "lod.screen_space_error_px", "lod.scale",
                                        "lod.level_spread", "lod.level_spread_from_m",   "lod.texture",
                                        "terrain.cache_mb"};

QString megabytes(std::uint64_t bytes) {
  return TerrainPanel::tr("%1 MB").arg(
      numberText(static_cast<double>(bytes) * 1e-6, bytes < 100'000'000 ? 1 : 0));
}

QString degrees(double value, const QString& positive, const QString& negative) {
  return QStringLiteral("%1° %2").arg(numberText(std::abs(value), 3), value < 0 ? negative : positive);
}

QString summaryOf(const TerrainSummary& t) {
  const auto number = [](double value) { return numberText(value, 0); };
  QString text = QStringLiteral("<b>%1</b> ").arg(t.name.toHtmlEscaped());
  if (t.osgScene)
    text += TerrainPanel::tr("A scene of OpenSceneGraph, drawn as it is: it has no posts<br>%1")
                .arg(t.source.toHtmlEscaped());
  else
    text += TerrainPanel::tr("%1 × %2 posts, %3 m apart; %4 to %5 m high")
                .arg(number(static_cast<double>(t.columns)), number(static_cast<double>(t.rows)),
                     numberText(t.postM, t.postM < 10 ? 2 : 1), number(t.lowestM), number(t.highestM));
  text += TerrainPanel::tr("<br>%1 to %2, %3 to %4")
              .arg(degrees(t.southDeg, TerrainPanel::tr("N"), TerrainPanel::tr("S")),
                   degrees(t.northDeg, TerrainPanel::tr("N"), TerrainPanel::tr("S")),
                   degrees(t.westDeg, TerrainPanel::tr("E"), TerrainPanel::tr("W")),
                   degrees(t.eastDeg, TerrainPanel::tr("E"), TerrainPanel::tr("W")));
  if (t.osgScene) return text;
  const double posts = static_cast<double>(t.columns) * static_cast<double>(t.rows);
  text += TerrainPanel::tr("<br>%1 on disk").arg(megabytes(t.bytes));
  if (posts > 0)
    text += TerrainPanel::tr(", %1 bytes a post").arg(numberText(static_cast<double>(t.bytes) / posts, 2));
  if (t.voidsFilled > 0)
    text += TerrainPanel::tr("; %1 voids filled (%2 %)")
                .arg(number(static_cast<double>(t.voidsFilled)),
                     numberText(100 * static_cast<double>(t.voidsFilled) / std::max(posts, 1.0), 2));
  return text;
}

}  // namespace

TerrainPanel::TerrainPanel(Draft& draft, QWidget* parent)
    : QWidget(parent),
      summary_(new QLabel),
      drawn_(new QLabel),
      paging_(new QLabel),
      job_(new QLabel),
      fileRow_(new QHBoxLayout),
      overlayRow_(new QHBoxLayout),
      jobLine_(new QWidget),
      bar_(new QProgressBar),
      cancel_(new QPushButton(tr("&Cancel"))),
      levels_(new TerrainLevelsModel(this)),
      table_(new QTableView),
      throttle_(this, [this] { refresh(); }) {
  for (QLabel* label : {summary_, drawn_, paging_, job_}) label->setWordWrap(true);
  summary_->setTextFormat(Qt::RichText);
  summary_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  paging_->setToolTip(
      tr("Patches are read from disk by a thread of their own, those first whose absence costs the image "
         "most. No image waits for them: land is drawn coarser until they are there."));
  bar_->setRange(0, 1000);
  bar_->setAccessibleName(tr("Progress of opening or baking"));
  cancel_->setToolTip(tr("Stops; a bake goes on from there when it is started again"));
  connect(cancel_, &QPushButton::clicked, this, &TerrainPanel::cancelAsked);

  table_->setModel(levels_);
  table_->setAccessibleName(tr("Levels of the terrain and their errors"));
  table_->setSelectionMode(QAbstractItemView::NoSelection);
  table_->setTabKeyNavigation(false);
  table_->setWordWrap(false);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(table_->fontMetrics().height() + 6);
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table_->horizontalHeader()->setStretchLastSection(true);
  // The table is as high as its rows: the dock scrolls, and no bar of its own covers the last column.
  table_->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);

  auto* progress = new QHBoxLayout;
  progress->setContentsMargins(0, 0, 0, 0);
  progress->addWidget(bar_, 1);
  progress->addWidget(cancel_);
  auto* job = new QVBoxLayout(jobLine_);
  job->setContentsMargins(0, 0, 0, 0);
  job->addWidget(job_);
  job->addLayout(progress);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  layout->addLayout(fileRow_);
  layout->addWidget(jobLine_);
  layout->addWidget(summary_);
  layout->addWidget(new ParameterLines(draft, kTerrainKeys));
  layout->addLayout(overlayRow_);
  layout->addWidget(drawn_);
  layout->addWidget(table_);
  layout->addWidget(paging_);
  layout->addStretch(1);
  endJob();
  setTerrain(std::nullopt);
}

void TerrainPanel::addRow(QHBoxLayout& row, const QList<QAction*>& actions) {
  for (QAction* action : actions) {
    auto* button = new QToolButton(this);
    button->setDefaultAction(action);
    button->setToolButtonStyle(Qt::ToolButtonTextOnly);
    button->setFocusPolicy(Qt::StrongFocus);
    row.addWidget(button);
  }
  row.addStretch(1);
}

void TerrainPanel::setActions(const QList<QAction*>& files, const QList<QAction*>& overlays) {
  addRow(*fileRow_, files);
  addRow(*overlayRow_, overlays);
}

void TerrainPanel::setTerrain(std::optional<TerrainSummary> terrain) {
  terrain_ = std::move(terrain);
  frame_ = {};
  shownPatches_.reset();
  summary_->setText(terrain_ ? summaryOf(*terrain_)
                             : tr("No terrain yet. Open a database, or bake one of elevation files, scenery "
                                  "and imagery."));
  summary_->setToolTip(terrain_ ? terrain_->source : QString());
  refresh();
}

void TerrainPanel::showJob(double fraction, const QString& what) {
  jobLine_->show();
  bar_->setValue(static_cast<int>(std::lround(1000 * std::clamp(fraction, 0.0, 1.0))));
  if (!what.isEmpty()) job_->setText(what);
}

void TerrainPanel::endJob() {
  jobLine_->hide();
}

void TerrainPanel::showFrame(const LiveFrame& frame) {
  frame_ = frame;
  throttle_.request();
}

void TerrainPanel::refresh() {
  table_->setVisible(terrain_ && !terrain_->osgScene);
  drawn_->setVisible(terrain_.has_value());
  if (!terrain_) return paging_->hide();
  if (terrain_->osgScene) {
    drawn_->setText(
        tr("OpenSceneGraph chooses its levels by LOD scale and allowed error; it has read %1 pages.")
            .arg(numberText(static_cast<double>(frame_.drawn().paging.pagesRead), 0)));
    return paging_->hide();
  }
  const bool patches = frame_.drawn().patches || terrain_->tiles.empty();
  const std::vector<TerrainLevel>& levels = patches ? terrain_->patches : terrain_->tiles;
  if (shownPatches_ != patches) {
    levels_->setLevels(levels, !patches);
    table_->setFixedHeight(static_cast<int>(levels.size() + 1) * (table_->fontMetrics().height() + 6) + 12);
    // These columns are known of patches only.
    for (const int column :
         {TerrainLevelsModel::kRmsError, TerrainLevelsModel::kSurfaceError, TerrainLevelsModel::kSize})
      table_->setColumnHidden(column, !patches);
    shownPatches_ = patches;
  }
  levels_->setDrawn(frame_.levels);
  drawn_->setText(frame_.drawn().staticLod.drawn ? tr("The static trees are drawn, not these levels.")
                  : patches
                      ? tr("<b>Patches</b> of triangles, the error bounded in every one; they fit at any "
                           "mixture of levels.")
                      : tr("<b>Tiles</b> of regular posts, 32 × 32 cells each."));
  paging_->setVisible(patches);
  const PagingFrame& p = frame_.drawn().paging;
  QString text =
      tr("In memory %1 of %2; read %3 pages, %4; longest read %5 ms.")
          .arg(megabytes(p.bytes), megabytes(p.budgetBytes), numberText(static_cast<double>(p.pagesRead), 0),
               megabytes(p.bytesRead), numberText(p.longestReadMs, 1));
  if (p.failed > 0)
    text += QLatin1Char(' ') +
            tr("%1 pages cannot be read: see Messages.").arg(numberText(static_cast<double>(p.failed), 0));
  if (p.heldBack > 0 && p.waiting == 0)
    text += QLatin1Char(' ') + tr("%1 pairs of patches are drawn coarser than asked for: the memory allowed "
                                  "holds no more.")
                                   .arg(numberText(static_cast<double>(p.heldBack), 0));
  else if (p.heldBack > 0)
    text += QLatin1Char(' ') + tr("%1 pairs of patches are drawn coarser than asked for until %2 more pages "
                                  "are there.")
                                   .arg(numberText(static_cast<double>(p.heldBack), 0),
                                        numberText(static_cast<double>(p.waiting), 0));
  paging_->setText(text);
}

}  // namespace trimtab::views
