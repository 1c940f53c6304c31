// SPDX-License-Identifier: GPL-3.0-or-later
#include "membership_editor.h"

#include <QBoxLayout>
#include <QLabel>
#include <QSplitter>
#include <QTableView>
#include <QToolButton>

#include "curve_plot.h"
#include "views/controls/choice_box.h"
#include "views/controls/list_table.h"
#include "views/controls/note_line.h"
#include "views/model/keys.h"
#include "views/model/list_model.h"
#include "views/model/theme.h"

namespace trimtab::views {

CurveEditor::CurveEditor(Draft& draft, const CurveSpec& spec, const QList<QWidget*>& extra, QWidget* parent)
    : QWidget(parent), draft_(draft), spec_(spec), plot_(new CurvePlot(draft, spec)), table_(new QTableView) {
  QLabel* title = new QLabel(QStringLiteral("<b>%1</b>").arg(spec.quantity));
  ChoiceBox* reading = new ChoiceBox(draft, spec.readingKey);
  QHBoxLayout* top = new QHBoxLayout;
  top->addWidget(title);
  top->addWidget(reading);
  for (QWidget* widget : extra) top->addWidget(widget);
  top->addStretch(0);

  ListModel* model = new ListModel(draft, pointsTable(spec), this);
  setUpListTable(*table_, model, tr("%1 breakpoints").arg(spec.quantity), tr("Membership "));

  ListButtons* buttons = new ListButtons;
  add_ = buttons->add(tr("Add"),
                      tr("Add a breakpoint after the selected one (Insert, or double click in the plot)"));
  remove_ = buttons->add(tr("Remove"), tr("Remove the selected breakpoint (Delete)"));
  connect(add_, &QToolButton::clicked, plot_, &CurvePlot::insertBesideSelected);
  connect(remove_, &QToolButton::clicked, plot_, &CurvePlot::removeSelected);
  QWidget* side = new QWidget;
  QVBoxLayout* sideLayout = new QVBoxLayout(side);
  sideLayout->setContentsMargins(0, 0, 0, 0);
  sideLayout->addWidget(table_, 1);
  sideLayout->addWidget(buttons);

  QSplitter* split = new QSplitter(Qt::Horizontal);
  split->addWidget(plot_);
  split->addWidget(side);
  split->setStretchFactor(0, 1);
  split->setStretchFactor(1, 0);
  split->setSizes({10000, side->minimumSizeHint().width()});
  split->setChildrenCollapsible(false);
  note_ = new NoteLine;

  QVBoxLayout* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addLayout(top);
  layout->addWidget(split, 1);
  layout->addWidget(note_);

  connect(plot_, &CurvePlot::selectedChanged, this, [this](int index) {
    // Without a current row, a click on the row that was selected last selects it again.
    if (index < 0)
      table_->selectionModel()->clear();
    else
      table_->setCurrentIndex(table_->model()->index(index, std::max(0, table_->currentIndex().column())));
    showNote();
  });
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          [this](const QModelIndex& current) {
            // The row that follows the plot's selection must not make one point of several.
            if (current.isValid() && current.row() != plot_->selected()) plot_->select(current.row());
          });
  connect(plot_, &CurvePlot::typingAsked, this, [this] {
    table_->setFocus();
    table_->edit(table_->model()->index(plot_->selected(), 0));
  });
  connect(plot_, &CurvePlot::refused, this, &CurveEditor::say);
  connect(model, &ListModel::refused, this, &CurveEditor::say);
  connect(model, &ListModel::accepted, this, [this] { say({}); });
  connect(&draft, &Draft::findingsChanged, this, [this] { say({}); });
  showNote();
}

void CurveEditor::showFrame(const LiveFrame& frame) {
  plot_->showFrame(frame);
}

void CurveEditor::say(const QString& refusal) {
  refusal_ = refusal;
  showNote();
}

void CurveEditor::showNote() {
  QString text;
  Ink ink = Ink::error;
  if (!refusal_.isEmpty()) {
    text = refusal_;
  } else if (const Findings findings = draft_.findingsOf(spec_.key); !findings.empty()) {
    text = tr("Expected %1; found %2.")
               .arg(QString::fromStdString(findings.front().expected),
                    QString::fromStdString(findings.front().found));
    if (findings.front().severity != Severity::error) ink = Ink::warning;
  } else if (!spec_.usesPoints(draft_.parameters())) {
    text = tr("This reading does not use the breakpoints. Choose another reading to edit them.");
    ink = Ink::quiet;
  }
  note_->say(text, ink);
  const bool editable = spec_.usesPoints(draft_.parameters());
  add_->setEnabled(editable);
  remove_->setEnabled(editable && plot_->selected() >= 0);
}

MembershipEditor::MembershipEditor(Draft& draft, QWidget* parent)
    : QWidget(parent),
      altitude_(new CurveEditor(draft, altitudeSpec(), {new ChoiceBox(draft, key::kAltitudeReference)})),
      pitch_(new CurveEditor(draft, pitchSpec(), {})) {
  QSplitter* split = new QSplitter(Qt::Vertical);
  split->addWidget(altitude_);
  split->addWidget(pitch_);
  split->setChildrenCollapsible(false);
  QVBoxLayout* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(split);
}

void MembershipEditor::showFrame(const LiveFrame& frame) {
  altitude_->showFrame(frame);
  pitch_->showFrame(frame);
}

}  // namespace trimtab::views
