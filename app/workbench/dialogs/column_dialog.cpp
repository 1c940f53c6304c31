// SPDX-License-Identifier: GPL-3.0-or-later
#include "column_dialog.h"

#include <QButtonGroup>
#include <QDialogButtonBox>
#include <QFileInfo>
#include <QGroupBox>
#include <QHeaderView>
#include <QLabel>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QRadioButton>
#include <QTableWidget>
#include <QVBoxLayout>
#include <algorithm>

#include "column_lines.h"
#include "column_memory.h"
#include "log_reading.h"
#include "views/controls/scrollable.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

/// An edit is read when the person pauses, since reading may take longer than a key.
constexpr int kPauseMs = 150;
constexpr int kRowsSeen = 5, kRowPaddingPx = 6, kLinesOfFindings = 4;

bool same(const std::vector<ColumnMap>& a, const std::vector<ColumnMap>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const ColumnMap& x, const ColumnMap& y) {
    return columnMapText(x) == columnMapText(y);
  });
}

}  // namespace

ColumnDialog::ColumnDialog(LogKind kind, const QString& file, LogBeginning log, const ColumnMap& map,
                           Open open, QWidget* parent)
    : QDialog(parent),
      kind_(kind),
      file_(file),
      log_(std::move(log)),
      open_(std::move(open)),
      lines_(new ColumnLines(kind, log_)),
      choicesColumn_(new QVBoxLayout),
      reading_(new QLabel),
      findings_(new QPlainTextEdit) {
  setObjectName(QStringLiteral("columns"));
  setWindowTitle(tr("Columns of %1").arg(QFileInfo(file).fileName()));
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel);
  ok_ = buttons->addButton(tr("&Open"), QDialogButtonBox::AcceptRole);
  auto* clear = buttons->addButton(tr("As &found"), QDialogButtonBox::ResetRole);
  clear->setToolTip(tr("Leaves every quantity to the reader, and forgets what was said of such files"));
  connect(buttons, &QDialogButtonBox::accepted, this, &ColumnDialog::openLog);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(clear, &QPushButton::clicked, this, [this] { lines_->setMap({}); });

  auto* column = new QVBoxLayout(this);
  column->addWidget(makeRows());
  column->addLayout(choicesColumn_);
  column->addWidget(views::scrollable(lines_, tr("Quantities")), 1);
  column->addWidget(makeReading());
  column->addWidget(buttons);

  soon_.setSingleShot(true);
  soon_.setInterval(kPauseMs);
  connect(&soon_, &QTimer::timeout, this, &ColumnDialog::readNow);
  connect(lines_, &ColumnLines::changed, &soon_, qOverload<>(&QTimer::start));
  // The choices are those of the file itself: a map that is shown at first has made some of them.
  addChoices(readingOf(kind_, log_.text, file_.toStdString(), {}).findings);
  lines_->setMap(map);
  readNow();
  resize(860, 640);
}

Findings ColumnDialog::ask(LogKind kind, const QString& file, const ColumnMap& map, Open open,
                           QWidget& parent) {
  Result<LogBeginning> log = beginningOfLog(file.toStdString(), kind);
  if (!log) return log.findings();
  // Another file takes the place of one that nobody has answered for yet.
  for (ColumnDialog* earlier : parent.findChildren<ColumnDialog*>()) earlier->close();
  auto* dialog = new ColumnDialog(kind, file, std::move(*log), map, std::move(open), &parent);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->QDialog::open();
  return {};
}

QTableWidget* ColumnDialog::makeRows() {
  auto* table = new QTableWidget(static_cast<int>(log_.rows.size()), static_cast<int>(log_.header.size()));
  table->setAccessibleName(tr("The first rows of the file"));
  table->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table->setSelectionMode(QAbstractItemView::NoSelection);
  table->setTabKeyNavigation(false);
  QStringList names;
  for (const std::string& name : log_.header) names << QString::fromStdString(name);
  table->setHorizontalHeaderLabels(names);
  for (int row = 0; row < table->rowCount(); ++row) {
    const auto& cells = log_.rows[static_cast<std::size_t>(row)];
    const int cellsShown = std::min(static_cast<int>(cells.size()), table->columnCount());
    for (int i = 0; i < cellsShown; ++i)
      table->setItem(row, i,
                     new QTableWidgetItem(QString::fromStdString(cells[static_cast<std::size_t>(i)])));
  }
  table->resizeColumnsToContents();
  table->verticalHeader()->hide();
  const int rowHeight = table->fontMetrics().height() + kRowPaddingPx;
  table->verticalHeader()->setDefaultSectionSize(rowHeight);
  table->setFixedHeight(table->horizontalHeader()->sizeHint().height() + kRowsSeen * rowHeight +
                        2 * table->frameWidth());
  return table;
}

QWidget* ColumnDialog::makeReading() {
  reading_->setWordWrap(true);
  reading_->setAccessibleName(tr("What is read"));
  reading_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  findings_->setReadOnly(true);
  findings_->setTabChangesFocus(true);
  findings_->setAccessibleName(tr("What the reader says"));
  const int line = findings_->fontMetrics().lineSpacing();
  findings_->setFixedHeight(kLinesOfFindings * line + 2 * findings_->frameWidth() + line / 2);
  auto* both = new QWidget;
  auto* column = new QVBoxLayout(both);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(reading_);
  column->addWidget(findings_);
  return both;
}

/// Adds the choices that a refusal leaves and that are not shown yet.
void ColumnDialog::addChoices(const Findings& findings) {
  for (std::vector<ColumnMap>& maps : readingsThatFit(findings)) {
    const bool known = std::any_of(choices_.begin(), choices_.end(),
                                   [&](const Choice& choice) { return same(choice.maps, maps); });
    if (known) continue;
    Choice choice{std::move(maps), new QGroupBox(tr("More than one reading fits. Choose the right one:")),
                  new QButtonGroup(this)};
    auto* rows = new QVBoxLayout(choice.box);
    for (std::size_t i = 0; i < choice.maps.size(); ++i) {
      auto* button = new QRadioButton(lines_->textOf(choice.maps[i]));
      choice.buttons->addButton(button, static_cast<int>(i));
      rows->addWidget(button, 0, Qt::AlignLeft);
      connect(button, &QRadioButton::clicked, this, [this, map = choice.maps[i]] { lines_->take(map); });
    }
    choicesColumn_->addWidget(choice.box);
    choices_.push_back(std::move(choice));
  }
}

/// Checks the readings that the lines say; hides a choice between columns that are not read any more.
void ColumnDialog::showChoices() {
  for (const Choice& choice : choices_) {
    choice.box->setVisible(std::any_of(choice.maps.begin(), choice.maps.end(),
                                       [this](const ColumnMap& map) { return lines_->readFrom(map); }));
    choice.buttons->setExclusive(false);
    for (QAbstractButton* button : choice.buttons->buttons())
      button->setChecked(lines_->hold(choice.maps[static_cast<std::size_t>(choice.buttons->id(button))]));
    choice.buttons->setExclusive(true);
  }
}

void ColumnDialog::readNow() {
  soon_.stop();
  const Result<ColumnMap> map = lines_->map();
  if (!map) return say({}, map.findings());
  const LogReading reading = readingOf(kind_, log_.text, file_.toStdString(), *map);
  addChoices(reading.findings);
  showChoices();
  say(reading.text, reading.findings);
}

void ColumnDialog::say(const QString& reading, const Findings& findings) {
  const bool good = !reading.isEmpty();
  ok_->setEnabled(good);
  views::setInk(*reading_, good ? views::Ink::plain : views::Ink::error);
  if (!good)
    reading_->setText(tr("The file cannot be read so."));
  else
    reading_->setText(log_.whole ? reading : tr("The first part of the file: %1").arg(reading));
  findings_->setPlainText(QString::fromStdString(toString(findings)));
}

void ColumnDialog::openLog() {
  if (soon_.isActive()) readNow();
  const Result<ColumnMap> map = lines_->map();
  if (!map || !ok_->isEnabled()) return;
  if (const Findings findings = open_(*map); hasError(findings)) return say({}, findings);
  rememberColumns(kind_, log_, *map);
  accept();
}

}  // namespace trimtab::workbench
