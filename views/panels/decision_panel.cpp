// SPDX-License-Identifier: GPL-3.0-or-later
#include "decision_panel.h"

#include <QAction>
#include <QApplication>
#include <QBoxLayout>
#include <QClipboard>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QScrollBar>
#include <QTableView>
#include <QToolButton>
#include <algorithm>

#include "decision_log.h"
#include "trimtab/decision/decide.h"
#include "trimtab/hold/arbiter.h"
#include "trimtab/motion/head_motion.h"
#include "views/controls/ask_csv_file.h"
#include "views/controls/bar_list.h"
#include "views/controls/lever_chain_table.h"
#include "views/controls/tell_findings.h"
#include "views/model/depth_map_reason.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

/// Which levers the rules set, and which signals they miss.
QString policyReason(const PolicyOutcome& policy) {
  QStringList set, unknown;
  for (const LeverRow& row : kLeverRows)
    if (policy.moves(row.lever)) set << fromView(row.label);
  for (const SignalRow& row : kSignalRows)
    if (policy.unknownAsked >> indexOf(row.signal) & 1) unknown << fromView(row.label);
  QString text = set.isEmpty() ? DecisionPanel::tr("No rule sets a lever")
                               : DecisionPanel::tr("Rules set %1").arg(set.join(QStringLiteral(", ")));
  if (!unknown.isEmpty()) text += DecisionPanel::tr("; unknown: %1").arg(unknown.join(QStringLiteral(", ")));
  return text;
}

/// What a reason says after scheme and depth map.
QString withoutOutcome(const QString& reason) {
  return reason.mid(reason.indexOf(QStringLiteral(": ")) + 1).trimmed();
}

}  // namespace

DecisionPanel::DecisionPanel(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      scheme_(new QLabel(tr("No frame has been decided yet"))),
      reason_(new QLabel),
      lead_(new QPushButton(tr("Go to Culling"))),
      count_(new QLabel),
      levers_(new LeverChainTable),
      memberships_(new BarList),
      log_(new DecisionLog(this)),
      view_(new QTableView),
      throttle_(this, [this] { refresh(); }) {
  QFont large = font();
  large.setPointSizeF(large.pointSizeF() * 1.25);
  large.setBold(true);
  scheme_->setFont(large);
  scheme_->setWordWrap(true);
  reason_->setWordWrap(true);
  reason_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  reason_->setMinimumHeight(3 * fontMetrics().lineSpacing());
  reason_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  lead_->hide();
  connect(lead_, &QPushButton::clicked, this, &DecisionPanel::cullingAsked);
  memberships_->setAccessibleName(tr("Memberships"));

  view_->setModel(log_);
  view_->setAccessibleName(tr("Log of decision changes"));
  view_->setSelectionBehavior(QAbstractItemView::SelectRows);
  view_->setTabKeyNavigation(false);
  view_->setWordWrap(false);
  view_->setShowGrid(false);
  view_->setAlternatingRowColors(true);
  view_->verticalHeader()->hide();
  view_->verticalHeader()->setDefaultSectionSize(fontMetrics().height() + 4);
  // A reason that is longer than its place ends in an ellipsis; its tool tip and the copy have all of it.
  view_->horizontalHeader()->setSectionResizeMode(DecisionLog::kReason, QHeaderView::Stretch);
  view_->horizontalHeader()->setHighlightSections(false);
  const auto width = [this](const char* sample) {
    return fontMetrics().horizontalAdvance(QLatin1String(sample)) + 14;
  };
  view_->setColumnWidth(DecisionLog::kTime, width("0000.000"));
  view_->setColumnWidth(DecisionLog::kPacket, width("Packet"));
  view_->setColumnWidth(DecisionLog::kScheme, width("dynamic"));
  view_->setColumnWidth(DecisionLog::kDepthMap, width("Depth map"));
  view_->setMinimumHeight(fontMetrics().height() * 6);

  QAction* copy = new QAction(tr("Copy"), view_);
  copy->setShortcut(QKeySequence::Copy);
  copy->setShortcutContext(Qt::WidgetShortcut);
  copy->setToolTip(tr("Copy the selected lines, or all of them (Ctrl+C)"));
  connect(copy, &QAction::triggered, this, &DecisionPanel::copyLog);
  QAction* all = new QAction(tr("Select all"), view_);
  all->setShortcut(QKeySequence::SelectAll);
  all->setShortcutContext(Qt::WidgetShortcut);
  connect(all, &QAction::triggered, view_, &QTableView::selectAll);
  QAction* save = new QAction(tr("Save…"), view_);
  save->setToolTip(tr("Save the whole log as CSV"));
  connect(save, &QAction::triggered, this, &DecisionPanel::askAndSave);
  QAction* clear = new QAction(tr("Clear"), view_);
  clear->setToolTip(tr("Empty the log"));
  connect(clear, &QAction::triggered, this, &DecisionPanel::clearLog);
  view_->addActions({copy, all, save, clear});
  view_->setContextMenuPolicy(Qt::ActionsContextMenu);

  QHBoxLayout* logBar = new QHBoxLayout;
  logBar->addWidget(new QLabel(tr("<b>Changes</b>")));
  logBar->addWidget(count_, 1);
  for (QAction* action : {copy, save, clear}) {
    QToolButton* button = new QToolButton;
    button->setDefaultAction(action);
    button->setFocusPolicy(Qt::StrongFocus);
    logBar->addWidget(button);
  }
  QVBoxLayout* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  layout->addWidget(scheme_);
  layout->addWidget(reason_);
  layout->addWidget(lead_, 0, Qt::AlignLeft);
  layout->addWidget(levers_);
  layout->addWidget(memberships_);
  layout->addLayout(logBar);
  layout->addWidget(view_, 1);

  // The newest line stays in sight unless the person has scrolled up.
  connect(log_, &QAbstractItemModel::rowsAboutToBeInserted, this, [this] {
    const QScrollBar* bar = view_->verticalScrollBar();
    if (bar->value() == bar->maximum())
      QMetaObject::invokeMethod(view_, &QTableView::scrollToBottom, Qt::QueuedConnection);
  });
  connect(&draft_, &Draft::activeChanged, this, [this] {
    if (any_) throttle_.request();
  });
  connect(&draft_, &Draft::imageGeneratorChanged, this, &DecisionPanel::refresh);
  refresh();
}

void DecisionPanel::showFrame(const LiveFrame& frame) {
  frame_ = frame;
  any_ = true;
  if (log_->isChange(frame.decision)) {
    // Scheme and depth map have columns of their own.
    const QString reason = QString::fromStdString(explain(frame.decision, draft_.active()));
    log_->append(frame.time, frame.input.state.packet, frame.decision, withoutOutcome(reason));
  }
  throttle_.request();
}

void DecisionPanel::refresh() {
  const FrameDecision& d = frame_.decision;
  const TuningParameters& p = *draft_.active();
  if (any_) {
    const QString reason = QString::fromStdString(explain(d, draft_.active()));
    const QString why = d.occlusionResolution && frame_.result ? whyNoDepthMap(frame_, p) : QString();
    // A size would say that a map of it was drawn.
    scheme_->setText(d.scheme == Scheme::frustum ? tr("Frustum: view-frustum culling alone")
                     : !why.isEmpty()            ? tr("Dynamic: no depth map was needed")
                     : d.occlusionResolution     ? tr("Dynamic: depth map %1 × %2 px")
                                                   .arg(d.occlusionResolution->widthPx)
                                                   .arg(d.occlusionResolution->heightPx)
                                             : tr("Dynamic"));
    reason_->setText(why.isEmpty() ? reason : withoutOutcome(reason) + QStringLiteral(". ") + why);
    lead_->setVisible(!why.isEmpty());
  }
  if (frame_.levers)
    levers_->showChain(*frame_.levers,
                       {tr("What the preset asks for"), fromView(trimtab::toText(d.motion.reason)),
                        fromView(trimtab::toText(d.weather.farReason)), policyReason(d.policy),
                        QString::fromStdString(explain(frame_.hold))},
                       draft_.imageGenerator());
  std::vector<double> edges;
  for (const Band& band : p.scheme.bands.span()) edges.push_back(band.low);
  const auto text = [](double value) { return QString::number(value, 'f', 3); };
  memberships_->setBars(
      {{tr("Altitude"), d.altitudeMembership, 1, text(d.altitudeMembership), {}, 0},
       {tr("Pitch"), d.pitchMembership, 1, text(d.pitchMembership), {}, 2},
       {tr("Total"), d.totalMembership, BandList::kTop, text(d.totalMembership), edges, 1}});
  const int rows = log_->rowCount();
  count_->setText(log_->forgotten() > 0 ? tr("%1 shown, %2 older forgotten").arg(rows).arg(log_->forgotten())
                                        : QString::number(rows));
}

void DecisionPanel::copyLog() {
  QList<int> rows;
  for (const QModelIndex& index : view_->selectionModel()->selectedRows()) rows.append(index.row());
  if (rows.isEmpty())
    for (int i = 0; i < log_->rowCount(); ++i) rows.append(i);
  std::sort(rows.begin(), rows.end());
  QApplication::clipboard()->setText(log_->toText(rows));
}

void DecisionPanel::clearLog() {
  log_->clear();
  refresh();
}

Findings DecisionPanel::saveLog(const QString& file) const {
  return writeAtomically(file.toStdString(), log_->toCsv().toStdString()).findings();
}

void DecisionPanel::askAndSave() {
  const QString file = askCsvFile(this, tr("Save Decision Log"), QStringLiteral("decisions.csv"));
  if (file.isEmpty()) return;
  tellFindings(this, tr("The log was not saved"), tr("The log was saved"), saveLog(file));
}

}  // namespace trimtab::views
