// SPDX-License-Identifier: GPL-3.0-or-later
#include "column_lines.h"

#include <QGridLayout>
#include <QLabel>
#include <algorithm>

#include "trimtab/units/text.h"
#include "views/controls/chooser.h"
#include "views/controls/conversion_edit.h"
#include "views/model/theme.h"

namespace trimtab::workbench {

using views::Chooser;
using views::ConversionEdit;

namespace {

/// The entry of the columns that leaves a quantity to the reader.
constexpr int kAsFound = 0;

/// Refusals name columns with the blanks around them, and a list of choices without.
QString columnOf(const ColumnSource& source) {
  return QString::fromStdString(std::string(trimmed(source.column)));
}

}  // namespace

ColumnLines::ColumnLines(LogKind kind, const LogBeginning& log, QWidget* parent)
    : QWidget(parent), header_(log.header) {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  const QStringList titles{tr("Quantity"), tr("Column"), tr("Unit"), tr("Scale and offset")};
  for (int i = 0; i < titles.size(); ++i) {
    auto* title = new QLabel(titles[i]);
    views::setInk(*title, views::Ink::quiet);
    grid->addWidget(title, 0, i);
  }
  for (const LogQuantity& quantity : logQuantities(kind)) {
    const Line line = makeLine(quantity, log.found);
    const int row = grid->rowCount();
    auto* label = new QLabel(QString::fromStdString(quantity.label));
    label->setBuddy(line.column);
    grid->addWidget(label, row, 0);
    grid->addWidget(line.column, row, 1);
    grid->addWidget(line.unit, row, 2);
    grid->addWidget(line.conversion, row, 3);
    lines_.push_back(line);
  }
  grid->setColumnStretch(1, 2);
  grid->setColumnStretch(3, 1);
  grid->setRowStretch(grid->rowCount(), 1);
  // Signals refer to lines, which stay where they are from now on.
  for (const Line& line : lines_) {
    leave(line);
    connect(line.column, &QComboBox::activated, this, [this, &line] { chose(line); });
    connect(line.unit, &QComboBox::activated, this, [this, &line] { touch(line); });
    connect(line.conversion, &ConversionEdit::edited, this, [this, &line] { touch(line); });
  }
}

ColumnLines::Line ColumnLines::makeLine(const LogQuantity& quantity, const ColumnMap& found) {
  const QString name = QString::fromStdString(quantity.label);
  Line line{&quantity,
            {},
            0,
            1,
            0,
            new Chooser(tr("Column of %1").arg(name)),
            new Chooser(tr("Unit of %1").arg(name)),
            new ConversionEdit(name)};
  for (std::size_t i = 0; i < quantity.keys.size(); ++i) {
    const LogKey& key = quantity.keys[i];
    line.unit->addItem(QString::fromStdString(key.unit));
    if (const auto at = found.find(key.key); at != found.end()) {
      line.found = columnOf(at->second);
      line.foundKey = i;
      line.foundScale = at->second.scale;
      line.foundOffset = at->second.offset;
    }
  }
  line.column->addItem(line.found.isEmpty() ? tr("none found") : tr("%1 (found)").arg(line.found));
  for (std::size_t place = 0; place < header_.size(); ++place)
    line.column->addItem(columnOf(trimtab::sourceOf(header_, place)));
  line.column->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  constexpr int kLetters = 18;
  line.column->setMinimumContentsLength(kLetters);
  return line;
}

std::pair<const ColumnLines::Line*, std::size_t> ColumnLines::lineOf(const std::string& key) const {
  for (const Line& line : lines_)
    for (std::size_t i = 0; i < line.quantity->keys.size(); ++i)
      if (!key.empty() && line.quantity->keys[i].key == key) return {&line, i};
  return {nullptr, 0};
}

/// Leaves a line to the reader.
void ColumnLines::leave(const Line& line) {
  line.column->setCurrentIndex(kAsFound);
  line.unit->setCurrentIndex(static_cast<int>(line.foundKey));
  line.conversion->set(line.foundScale, line.foundOffset);
  const bool found = !line.found.isEmpty();
  line.unit->setEnabled(found && line.quantity->keys.size() > 1);
  line.conversion->setEnabled(found);
}

/// A map may name what is no column of the header, as a part of a cell.
void ColumnLines::chooseColumn(const Line& line, const QString& column) {
  const auto place = [&] { return line.column->findText(column, Qt::MatchExactly | Qt::MatchCaseSensitive); };
  if (place() < 0) line.column->addItem(column);
  line.column->setCurrentIndex(place());
}

void ColumnLines::setLine(const Line& line, const QString& column, std::size_t key, double scale,
                          double offset) {
  chooseColumn(line, column);
  line.unit->setCurrentIndex(static_cast<int>(key));
  line.conversion->set(scale, offset);
  line.unit->setEnabled(line.quantity->keys.size() > 1);
  line.conversion->setEnabled(true);
}

/// The person has chosen a column: it begins in the unit that its name says.
void ColumnLines::chose(const Line& line) {
  const int index = line.column->currentIndex();
  if (index == kAsFound)
    leave(line);
  else
    setLine(line, line.column->currentText(),
            likelyKey(*line.quantity, static_cast<std::size_t>(index) <= header_.size()
                                          ? header_[static_cast<std::size_t>(index) - 1]
                                          : std::string()),
            1, 0);
  emit changed();
}

/// The person has changed the unit or the conversion: of the column that was found, if none was chosen.
void ColumnLines::touch(const Line& line) {
  if (line.column->currentIndex() == kAsFound) chooseColumn(line, line.found);
  emit changed();
}

ColumnSource ColumnLines::sourceOf(const QString& column, double scale, double offset) const {
  for (std::size_t place = 0; place < header_.size(); ++place)
    if (columnOf(trimtab::sourceOf(header_, place)) == column)
      return trimtab::sourceOf(header_, place, scale, offset);
  ColumnSource source{column.toStdString(), scale, offset, ""};
  source.written = columnMapText({{"", source}}).substr(1);
  return source;
}

void ColumnLines::setMap(const ColumnMap& map) {
  for (const Line& line : lines_) leave(line);
  others_.clear();
  take(map);
}

void ColumnLines::take(const ColumnMap& map) {
  for (const auto& [key, source] : map) {
    if (const auto [line, unit] = lineOf(key); line != nullptr)
      setLine(*line, columnOf(source), unit, source.scale, source.offset);
    else
      others_[key] = source;
  }
  emit changed();
}

Result<ColumnMap> ColumnLines::map() const {
  ColumnMap map = others_;
  Findings findings;
  for (const Line& line : lines_) {
    if (line.column->currentIndex() == kAsFound) continue;
    const LogKey& key = line.quantity->keys[static_cast<std::size_t>(line.unit->currentIndex())];
    const auto refuse = [&](const QString& expected, const QString& found) {
      findings.push_back(
          {Severity::error, "", line.quantity->label, expected.toStdString(), found.toStdString()});
    };
    const auto scale = line.conversion->scale(), offset = line.conversion->offset();
    if (!scale) refuse(tr("a scale that is a number and not 0"), tr("another text"));
    if (!offset) refuse(tr("an offset that is a number"), tr("another text"));
    if (key.key.empty()) refuse(tr("a unit"), tr("none chosen"));
    if (scale && offset && !key.key.empty())
      map[key.key] = sourceOf(line.column->currentText(), *scale, *offset);
  }
  if (!findings.empty()) return findings;
  // What the lines say is what the same words would say on a command line.
  return parseColumnMap(columnMapText(map));
}

bool ColumnLines::hold(const ColumnMap& map) const {
  return std::all_of(map.begin(), map.end(), [this](const auto& entry) {
    const auto [line, unit] = lineOf(entry.first);
    return line != nullptr && line->column->currentIndex() != kAsFound &&
           line->column->currentText() == columnOf(entry.second) &&
           line->unit->currentIndex() == static_cast<int>(unit) &&
           line->conversion->scale() == entry.second.scale &&
           line->conversion->offset() == entry.second.offset;
  });
}

bool ColumnLines::readFrom(const ColumnMap& map) const {
  return std::all_of(map.begin(), map.end(), [this](const auto& entry) {
    const auto [line, unit] = lineOf(entry.first);
    if (line == nullptr) return false;
    // A column without a unit is not found, and is still what the choice is about.
    if (line->column->currentIndex() == kAsFound)
      return line->found.isEmpty() || line->found == columnOf(entry.second);
    return line->column->currentText() == columnOf(entry.second);
  });
}

QString ColumnLines::textOf(const ColumnMap& map) const {
  QStringList parts;
  for (const auto& [key, source] : map) {
    const auto [line, unit] = lineOf(key);
    if (line == nullptr) continue;
    const std::string whole = columnMapText({{"", source}}).substr(1);
    parts << tr("%1 = %2 in %3")
                 .arg(QString::fromStdString(line->quantity->label), QString::fromStdString(whole),
                      QString::fromStdString(line->quantity->keys[unit].unit));
  }
  return parts.join(QStringLiteral(", "));
}

}  // namespace trimtab::workbench
