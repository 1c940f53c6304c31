// SPDX-License-Identifier: GPL-3.0-or-later
#include "bands_editor.h"

#include <QBoxLayout>
#include <QLabel>
#include <QTableView>
#include <QToolButton>

#include "band_edit.h"
#include "band_scale.h"
#include "views/controls/choice_box.h"
#include "views/controls/list_table.h"
#include "views/controls/note_line.h"
#include "views/controls/number_box.h"
#include "views/model/keys.h"
#include "views/model/list_model.h"
#include "views/model/theme.h"

namespace trimtab::views {

BandsEditor::BandsEditor(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      scale_(new BandScale(draft)),
      model_(new ListModel(draft, bandsTable(), this)),
      table_(new QTableView),
      note_(new NoteLine) {
  QHBoxLayout* top = new QHBoxLayout;
  NumberBox* hysteresis = new NumberBox(draft, key::kHysteresis);
  QLabel* hysteresisLabel = new QLabel(tr("Hysteresi&s ±"));
  hysteresisLabel->setBuddy(hysteresis);
  ChoiceBox* combination = new ChoiceBox(draft, key::kCombination);
  QLabel* combinationLabel = new QLabel(tr("&Total is"));
  combinationLabel->setBuddy(combination);
  top->addWidget(combinationLabel);
  top->addWidget(combination);
  top->addSpacing(8);
  top->addWidget(hysteresisLabel);
  top->addWidget(hysteresis);
  top->addStretch(1);

  setUpListTable(*table_, model_, tr("Depth-map bands"), tr("Height (px)"));
  table_->setMinimumHeight(fontMetrics().height() * 7);

  ListButtons* buttons = new ListButtons;
  QToolButton* const add =
      buttons->add(tr("Split"), tr("Split the selected band (Insert, or double click in the scale)"));
  remove_ = buttons->add(tr("Remove"), tr("Remove the selected band (Delete)"));
  connect(add, &QToolButton::clicked, scale_, &BandScale::insertBesideSelected);
  connect(remove_, &QToolButton::clicked, scale_, &BandScale::removeSelected);

  QVBoxLayout* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addLayout(top);
  layout->addWidget(scale_);
  layout->addWidget(table_, 1);
  layout->addWidget(buttons);
  layout->addWidget(note_);

  throttle_ = new Throttle(this, [this] { model_->setLiveRow(decision_.band); });

  connect(scale_, &BandScale::selectedChanged, this, [this](int index) {
    // Without a current row, a click on the row that was selected last selects it again.
    if (index < 0)
      table_->selectionModel()->clear();
    else
      table_->setCurrentIndex(model_->index(index, std::max(0, table_->currentIndex().column())));
    showNote();
  });
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          [this](const QModelIndex& current) {
            // The row that follows the scale must not make one edge of several.
            if (current.isValid() && current.row() != scale_->selected()) scale_->select(current.row());
          });
  connect(scale_, &BandScale::typingAsked, this, [this] {
    table_->setFocus();
    table_->edit(model_->index(scale_->selected(), kBandFrom));
  });
  connect(scale_, &BandScale::refused, this, &BandsEditor::say);
  connect(model_, &ListModel::refused, this, &BandsEditor::say);
  connect(hysteresis, &NumberBox::refused, this, &BandsEditor::say);
  connect(model_, &ListModel::accepted, this, [this] { say({}); });
  connect(&draft, &Draft::findingsChanged, this, [this] { say({}); });
  showNote();
}

void BandsEditor::showFrame(const LiveFrame& frame) {
  decision_ = frame.decision;
  scale_->showFrame(frame);
  throttle_->request();
}

void BandsEditor::say(const QString& refusal) {
  refusal_ = refusal;
  showNote();
}

void BandsEditor::showNote() {
  QString text = refusal_;
  Ink ink = Ink::error;
  for (const std::string_view key : {key::kBands, key::kHysteresis}) {
    if (!text.isEmpty()) break;
    const Findings findings = draft_.findingsOf(key);
    if (findings.empty()) continue;
    text = tr("%1: expected %2; found %3.")
               .arg(QString::fromStdString(std::string(findRow(key)->label)),
                    QString::fromStdString(findings.front().expected),
                    QString::fromStdString(findings.front().found));
    if (findings.front().severity != Severity::error) ink = Ink::warning;
  }
  note_->say(text, ink);
  remove_->setEnabled(scale_->selected() >= 0);
}

}  // namespace trimtab::views
