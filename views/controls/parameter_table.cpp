// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameter_table.h"

#include <QBoxLayout>
#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>
#include <algorithm>

#include "parameter_line.h"
#include "views/controls/scrollable.h"
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
      search_(new SearchField(tr("Search parameters"))),
      tier_(new QComboBox),
      comparedWith_(new QComboBox),
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
  QScrollArea* area = scrollable(content, tr("Parameters"));
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
  QHBoxLayout* compared = new QHBoxLayout;
  compared->addWidget(comparedWith_);
  compared->addWidget(summary_, 1);
  layout->addLayout(compared);
  layout->addWidget(area, 1);

  connect(&draft_, &Draft::findingsChanged, this, [this] {
    for (const Group& group : groups_)
      for (ParameterLine* line : group.lines) line->refresh();
    if (changedOnly_->isChecked()) filter();
    summarise();
  });
  connect(&draft_, &Draft::referencesChanged, this, &ParameterTable::fillReferences);
  fillReferences();
}

void ParameterTable::makeBar() {
  tier_->addItems({tr("Basic"), tr("All")});
  tier_->setAccessibleName(tr("Which parameters are shown"));
  tier_->setToolTip(tr("Basic parameters, or the advanced ones too. A search looks through all."));
  changedOnly_->setToolTip(tr("Only parameters that differ from what they are compared with"));
  comparedWith_->setAccessibleName(tr("What the parameters are compared with"));
  comparedWith_->setToolTip(tr(
      "What the marks, “Changed” and “Reset all” compare with: the preset as it was opened or saved last,\n"
      "the base that it names, the program's defaults, or a pinned snapshot"));
  resetAll_->setAutoDefault(false);
  summary_->setWordWrap(true);
  whenThemeChanges(*summary_, [this] { summarise(); });
  connect(search_, &QLineEdit::textChanged, this, &ParameterTable::filter);
  connect(tier_, &QComboBox::currentIndexChanged, this, &ParameterTable::filter);
  connect(changedOnly_, &QCheckBox::toggled, this, &ParameterTable::filter);
  connect(resetAll_, &QPushButton::clicked, this, [this] { draft_.resetAll(reference()); });
  connect(comparedWith_, &QComboBox::activated, this, [this] {
    for (const Group& group : groups_)
      for (ParameterLine* line : group.lines) line->compareWith(reference());
    filter();
    summarise();
  });
}

Reference ParameterTable::reference() const {
  return static_cast<Reference>(comparedWith_->currentData().toInt());
}

/// A base that has the defaults' values is left out, as is a snapshot while none is pinned.
void ParameterTable::fillReferences() {
  const QVariant before = comparedWith_->currentData();
  comparedWith_->clear();
  const auto offer = [this](Reference which) {
    comparedWith_->addItem(tr("Against %1").arg(draft_.referenceName(which)), int(which));
  };
  offer(Reference::file);
  if (draft_.hasOwnBase()) offer(Reference::base);
  offer(Reference::defaults);
  if (draft_.reference(Reference::pinned)) offer(Reference::pinned);
  comparedWith_->setCurrentIndex(std::max(0, comparedWith_->findData(before)));
  if (before.isValid() && before != comparedWith_->currentData())
    for (const Group& group : groups_)
      for (ParameterLine* line : group.lines) line->compareWith(reference());
  fitColumns();
  filter();
  summarise();
}

void ParameterTable::makeHeader(QGridLayout& grid, int gridRow, const QString& name) {
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
  grid.addWidget(header, gridRow, 0, 1, 3, Qt::AlignLeft);
  Group group{name, header, {}, {}};
  const QString titles[] = {tr("File"), tr("Base"), tr("Default")};
  for (std::size_t i = 0; i < group.columns.size(); ++i) {
    group.columns[i] = new QLabel(titles[i]);
    setInk(*group.columns[i], Ink::quiet);
    grid.addWidget(group.columns[i], gridRow, 3 + int(i), Qt::AlignCenter);
  }
  groups_.push_back(std::move(group));
}

void ParameterTable::showColumns() {
  for (const Group& group : groups_)
    for (std::size_t i = 0; i < group.columns.size(); ++i)
      group.columns[i]->setVisible(!compact_ && !group.header->isHidden() && group.header->isChecked() &&
                                   (i != 1 || draft_.hasOwnBase()));
}

QString ParameterTable::summary() const {
  return summary_->text();
}

void ParameterTable::makeLines(QGridLayout& grid) {
  int gridRow = 0;
  for (const ParameterRow& row : parameterRows()) {
    const QString name = groupOf(row.key);
    if (groups_.empty() || groups_.back().name != name) makeHeader(grid, gridRow++, name);
    auto* const line = new ParameterLine(draft_, row, grid, gridRow);
    connect(line, &ParameterLine::editorAsked, this, &ParameterTable::editorAsked);
    groups_.back().lines.push_back(line);
    ++gridRow;
  }
  nothing_->setAlignment(Qt::AlignCenter);
  grid.addWidget(nothing_, gridRow++, 0, 1, 6);
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
  fitColumns();
}

/// Hides the columns of values where they leave the editors no room.
void ParameterTable::fitColumns() {
  const int digits = draft_.hasOwnBase() ? 72 : 60;
  const bool compact = width() < fontMetrics().horizontalAdvance(QLatin1Char('0')) * digits;
  if (compact == compact_) return;
  compact_ = compact;
  for (const Group& group : groups_)
    for (ParameterLine* line : group.lines) line->setCompact(compact);
  showColumns();
}

void ParameterTable::filter() {
  const auto isChanged = [this](const ParameterRow& row) { return draft_.isChanged(row.key, reference()); };
  const auto isFound = [this](const ParameterRow& row) {
    return search_->finds({fromView(row.label), fromView(row.key), fromView(row.help), fromView(row.source)});
  };
  bool any = false;
  for (const Group& group : groups_) {
    bool inGroup = false;
    for (ParameterLine* line : group.lines) {
      // What is broken or changed is never hidden by its tier.
      const bool tier = tier_->currentIndex() == 1 || line->row().tier == Tier::basic || search_->isUsed() ||
                        isChanged(line->row()) || !line->problem().isEmpty();
      const bool wanted =
          tier && isFound(line->row()) && (!changedOnly_->isChecked() || isChanged(line->row()));
      inGroup = inGroup || wanted;
      line->setVisible(wanted && (group.header->isChecked() || search_->isUsed()));
    }
    group.header->setVisible(inGroup);
    any = any || inGroup;
  }
  nothing_->setVisible(!any);
  showColumns();
}

void ParameterTable::summarise() {
  const Reference against = reference();
  const auto changedCount = std::ranges::count_if(
      parameterRows(), [&](const ParameterRow& row) { return draft_.isChanged(row.key, against); });
  const auto errors = std::ranges::count_if(draft_.findings(),
                                            [](const Finding& f) { return f.severity == Severity::error; });
  QString text = changedCount == 0   ? tr("nothing differs.")
                 : changedCount == 1 ? tr("1 parameter differs.")
                                     : tr("%1 parameters differ.").arg(changedCount);
  if (errors > 0)
    text += QStringLiteral(" <span style='color:%1'>%2</span>")
                .arg(errorColour(palette()).name(),
                     tr("A rule is broken: the last valid parameters keep running.").toHtmlEscaped());
  summary_->setText(text);
  resetAll_->setEnabled(changedCount > 0);
  resetAll_->setToolTip(tr("Every parameter back to its value in %1, as one step that can be undone")
                            .arg(draft_.referenceName(against)));
}

}  // namespace trimtab::views
