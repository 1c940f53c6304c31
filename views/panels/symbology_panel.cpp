// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbology_panel.h"

#include <QCheckBox>
#include <QEvent>
#include <QFormLayout>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <string>

#include "views/controls/choice_box.h"
#include "views/controls/number_box.h"
#include "views/controls/parameter_of.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

const ParameterRow& rowOf(std::string_view key) {
  const ParameterRow* row = findRow(key);
  Q_ASSERT(row);
  return *row;
}

/// Returns the key of a parameter, which lives as long as the table of parameters.
std::string_view keyOf(std::string_view prefix, const char* field) {
  return rowOf(std::string(prefix) + field).key;
}

QCheckBox* flagBox(Draft& draft, std::string_view key) {
  const ParameterRow& row = rowOf(key);
  auto* box = new QCheckBox(fromView(row.label));
  box->setToolTip(helpText(row));
  markParameter(*box, row.key);
  QObject::connect(box, &QCheckBox::toggled, box, [&draft, &row](bool on) { draft.setValue(row.key, on); });
  return box;
}

}  // namespace

const std::array<std::string_view, SymbologyPanel::kSymbols> SymbologyPanel::kPrefixes{
    "symbology.pitch_ladder", "symbology.aircraft_reference",
    "symbology.flight_path",  "symbology.line_of_sight",
    "symbology.heading_tape", "symbology.airspeed",
    "symbology.altitude",     "symbology.host"};

SymbologyPanel::SymbologyPanel(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      enabled_(flagBox(draft, "symbology.enabled")),
      recolour_(flagBox(draft, "symbology.host.recolour")),
      place_(new QPushButton(tr("&Place in view"))),
      counts_(new QLabel),
      table_(new QWidget),
      throttle_(this, [this] {
        counts_->setText(tr("Drawn in %L1 images, made anew %L2 times")
                             .arg(frame_.drawn().counters.symbologyDraws)
                             .arg(frame_.drawn().counters.symbologyRedraws));
      }) {
  place_->setCheckable(true);
  place_->setToolTip(
      tr("Drag symbols in the image, or their corners to resize them; arrow keys move the chosen one "
         "by a pixel, with Shift by ten. Esc ends it."));
  connect(place_, &QPushButton::toggled, this, &SymbologyPanel::placingChanged);
  counts_->setToolTip(
      tr("Symbols are made anew only when an angle of a tenth of a pixel or a digit has changed"));

  auto* column = new QVBoxLayout(this);
  auto* top = new QHBoxLayout;
  top->addWidget(enabled_, 1);
  top->addWidget(place_);
  column->addLayout(top);
  auto* form = new QFormLayout;
  const auto add = [&](std::string_view key, QWidget* editor) {
    form->addRow(fromView(rowOf(key).label), editor);
  };
  add("symbology.frame", new ChoiceBox(draft, "symbology.frame"));
  add("symbology.line_width_px", new NumberBox(draft, "symbology.line_width_px"));
  add("symbology.outline_px", new NumberBox(draft, "symbology.outline_px"));
  form->addRow(recolour_);
  column->addLayout(form);

  auto* grid = new QGridLayout(table_);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setHorizontalSpacing(4);
  grid->setColumnStretch(0, 1);
  const QString heads[] = {tr("Symbol"), tr("Colour"), tr("x"), tr("y"), tr("Size")};
  for (int i = 0; i < 5; ++i) grid->addWidget(new QLabel(heads[i]), 0, i);
  for (int i = 0; i < kSymbols; ++i) {
    const std::string_view prefix = kPrefixes[static_cast<std::size_t>(i)];
    QCheckBox* show = flagBox(draft, keyOf(prefix, ".show"));
    show_[static_cast<std::size_t>(i)] = show;
    QWidget* editors[] = {
        show, new ChoiceBox(draft, keyOf(prefix, ".colour")), new NumberBox(draft, keyOf(prefix, ".x")),
        new NumberBox(draft, keyOf(prefix, ".y")), new NumberBox(draft, keyOf(prefix, ".size"))};
    for (int c = 0; c < 5; ++c) {
      // The row has to fit a dock, so a field is as wide as three decimals and its arrows.
      if (c >= 2) editors[c]->setFixedWidth(fontMetrics().horizontalAdvance(QStringLiteral("-0.0000")) + 28);
      grid->addWidget(editors[c], i + 1, c);
      editors[c]->setProperty("symbol", i);
      editors[c]->installEventFilter(this);
    }
  }
  column->addWidget(table_);
  column->addWidget(counts_);
  column->addStretch(1);
  readFlags();
  connect(&draft_, &Draft::valueChanged, this, [this](const QString& key) {
    if (key.startsWith(QLatin1String("symbology."))) readFlags();
  });
}

void SymbologyPanel::readFlags() {
  const auto set = [this](QCheckBox* box, std::string_view key) {
    const QSignalBlocker quiet(box);
    box->setChecked(std::get<bool>(draft_.value(key)));
  };
  set(enabled_, "symbology.enabled");
  set(recolour_, "symbology.host.recolour");
  for (std::size_t i = 0; i < kPrefixes.size(); ++i) set(show_[i], keyOf(kPrefixes[i], ".show"));
  const bool on = enabled_->isChecked();
  table_->setEnabled(on);
  place_->setEnabled(on);
  if (!on) place_->setChecked(false);
}

bool SymbologyPanel::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::FocusIn) emit selected(watched->property("symbol").toInt());
  return QWidget::eventFilter(watched, event);
}

void SymbologyPanel::setSelected(int symbol) {
  for (int i = 0; i < kSymbols; ++i) {
    QCheckBox* box = show_[static_cast<std::size_t>(i)];
    QFont font = box->font();
    font.setBold(i == symbol);
    box->setFont(font);
  }
}

void SymbologyPanel::showFrame(const LiveFrame& frame) {
  frame_ = frame;
  throttle_.request();
}

}  // namespace trimtab::views
