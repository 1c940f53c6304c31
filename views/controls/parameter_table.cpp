// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameter_table.h"

#include <QBoxLayout>
#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QToolButton>
#include <algorithm>

#include "parameter_line.h"
#include "views/model/theme.h"

namespace trimtab::views {

namespace {

QString groupOf(std::string_view key) {
  const std::string_view first = key.substr(0, key.find('.'));
  QString name = fromView(first);
  if (name == QStringLiteral("fuzzy")) return QObject::tr("Fuzzy decision");
  if (name == QStringLiteral("lod")) return QObject::tr("Level of detail");
  if (!name.isEmpty()) name[0] = name[0].toUpper();
  return name;
}

}  // namespace

ParameterTable::ParameterTable(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      search_(new QLineEdit),
      tier_(new QComboBox),
      changedOnly_(new QCheckBox(tr("Changed"))),
      resetAll_(new QPushButton(tr("Reset all"))),
      summary_(new QLabel),
      nothing_(new QLabel(tr("No parameter matches."))) {
  makeBar();
  QWidget* content = new QWidget;
  QGridLayout* grid = new QGridLayout(content);
  grid->setHorizontalSpacing(8);
  grid->setVerticalSpacing(3);
  grid->setContentsMargins(4, 4, 4, 4);
  grid->setColumnStretch(1, 1);
  makeLines(*grid);
  QScrollArea* area = new QScrollArea;
  area->setWidget(content);
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAsNeeded);
  area->setFocusPolicy(Qt::NoFocus);

  QHBoxLayout* bar = new QHBoxLayout;
  bar->addWidget(search_, 1);
  bar->addWidget(tier_);
  bar->addWidget(changedOnly_);
  bar->addWidget(resetAll_);
  QVBoxLayout* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addLayout(bar);
  layout->addWidget(summary_);
  layout->addWidget(area, 1);

  connect(&draft_, &Draft::valueChanged, this, &ParameterTable::changed);
  connect(&draft_, &Draft::findingsChanged, this, [this] {
    for (const Group& group : groups_)
      for (ParameterLine* line : group.lines) line->refresh();
    summarise();
  });
  filter();
  summarise();
}

void ParameterTable::makeBar() {
  search_->setPlaceholderText(tr("Search parameters"));
  search_->setAccessibleName(tr("Search parameters"));
  search_->setClearButtonEnabled(true);
  tier_->addItems({tr("Basic"), tr("All")});
  tier_->setAccessibleName(tr("Which parameters are shown"));
  tier_->setToolTip(tr("Basic parameters, or the advanced ones too. A search looks through all."));
  changedOnly_->setToolTip(tr("Only parameters that differ from their default"));
  resetAll_->setToolTip(tr("Every parameter back to its default, as one step that can be undone"));
  resetAll_->setAutoDefault(false);
  summary_->setWordWrap(true);
  connect(search_, &QLineEdit::textChanged, this, &ParameterTable::filter);
  connect(tier_, &QComboBox::currentIndexChanged, this, &ParameterTable::filter);
  connect(changedOnly_, &QCheckBox::toggled, this, &ParameterTable::filter);
  connect(resetAll_, &QPushButton::clicked, &draft_, &Draft::resetAll);
}

void ParameterTable::makeLines(QGridLayout& grid) {
  int gridRow = 0;
  for (const ParameterRow& row : parameterRows()) {
    const QString name = groupOf(row.key);
    if (groups_.empty() || groups_.back().name != name) {
      QToolButton* header = new QToolButton;
      header->setText(name);
      header->setCheckable(true);
      header->setChecked(true);
      header->setArrowType(Qt::DownArrow);
      header->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
      header->setAutoRaise(true);
      header->setFocusPolicy(Qt::StrongFocus);
      header->setAccessibleName(tr("Group %1").arg(name));
      QFont bold = font();
      bold.setBold(true);
      header->setFont(bold);
      connect(header, &QToolButton::toggled, this, [this, header](bool open) {
        header->setArrowType(open ? Qt::DownArrow : Qt::RightArrow);
        filter();
      });
      grid.addWidget(header, gridRow++, 0, 1, 4, Qt::AlignLeft);
      groups_.push_back({name, header, {}});
    }
    auto* const line = new ParameterLine(draft_, row, grid, gridRow);
    connect(line, &ParameterLine::editorAsked, this, &ParameterTable::editorAsked);
    groups_.back().lines.push_back(line);
    gridRow += 2;
  }
  nothing_->setAlignment(Qt::AlignCenter);
  grid.addWidget(nothing_, gridRow++, 0, 1, 4);
  grid.addItem(new QSpacerItem(0, 0, QSizePolicy::Minimum, QSizePolicy::Expanding), gridRow, 0);
}

ParameterLine* ParameterTable::line(std::string_view key) const {
  for (const Group& group : groups_)
    for (ParameterLine* line : group.lines)
      if (line->row().key == key) return line;
  return nullptr;
}

std::vector<std::string_view> ParameterTable::visibleKeys() const {
  std::vector<std::string_view> keys;
  for (const Group& group : groups_)
    for (const ParameterLine* line : group.lines)
      if (line->isVisible()) keys.push_back(line->row().key);
  return keys;
}

void ParameterTable::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  const bool compact = width() < fontMetrics().horizontalAdvance(QLatin1Char('0')) * 56;
  if (compact == compact_) return;
  compact_ = compact;
  for (const Group& group : groups_)
    for (ParameterLine* line : group.lines) line->setCompact(compact);
}

void ParameterTable::filter() {
  const QString search = search_->text().trimmed();
  bool any = false;
  for (const Group& group : groups_) {
    bool inGroup = false;
    for (ParameterLine* line : group.lines) {
      // What is broken or changed is never hidden by its tier.
      const bool tier = tier_->currentIndex() == 1 || line->row().tier == Tier::basic || !search.isEmpty() ||
                        draft_.isChanged(line->row().key) || !line->problem().isEmpty();
      const bool wanted = tier && (search.isEmpty() || line->matches(search)) &&
                          (!changedOnly_->isChecked() || draft_.isChanged(line->row().key));
      inGroup = inGroup || wanted;
      line->setVisible(wanted && (group.header->isChecked() || !search.isEmpty()));
    }
    group.header->setVisible(inGroup);
    any = any || inGroup;
  }
  nothing_->setVisible(!any);
}

void ParameterTable::changed(const QString& key) {
  if (ParameterLine* changedLine = line(key.toStdString())) changedLine->clearRefusal();
  if (changedOnly_->isChecked()) filter();
}

void ParameterTable::summarise() {
  const auto rows = parameterRows();
  const auto changedCount =
      std::ranges::count_if(rows, [this](const ParameterRow& row) { return draft_.isChanged(row.key); });
  const auto errors = std::ranges::count_if(draft_.findings(),
                                            [](const Finding& f) { return f.severity == Severity::error; });
  QString text = tr("Nothing differs from the defaults.");
  if (changedCount == 1) text = tr("1 parameter differs from its default.");
  if (changedCount > 1) text = tr("%1 parameters differ from their defaults.").arg(changedCount);
  if (errors > 0)
    text += QStringLiteral(" <span style='color:%1'>%2</span>")
                .arg(errorColour(palette()).name(),
                     tr("A rule is broken: the last valid parameters keep running.").toHtmlEscaped());
  summary_->setText(text);
  resetAll_->setEnabled(changedCount > 0);
}

}  // namespace trimtab::views
