// SPDX-License-Identifier: GPL-3.0-or-later
#include "palette.h"

#include <QHeaderView>
#include <QKeyEvent>
#include <QLineEdit>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <algorithm>

#include "fuzzy_match.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

constexpr std::size_t kMostShown = 60;
constexpr QSize kSize{640, 420};
enum Column { kText, kKind, kHint, kColumns };

}  // namespace

Palette::Palette(Source source, QWidget* parent)
    : QDialog(parent), source_(std::move(source)), input_(new QLineEdit(this)), list_(new QTreeWidget(this)) {
  setWindowTitle(tr("Find anything"));
  input_->setPlaceholderText(tr("A command, dock, parameter, preset, terrain or flight"));
  input_->setAccessibleName(tr("What to find"));
  input_->installEventFilter(this);
  list_->setColumnCount(kColumns);
  list_->setHeaderHidden(true);
  list_->setRootIsDecorated(false);
  list_->setUniformRowHeights(true);
  list_->setFocusPolicy(Qt::NoFocus);
  list_->setAccessibleName(tr("What was found"));
  list_->header()->setStretchLastSection(false);
  list_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  list_->header()->setSectionResizeMode(kText, QHeaderView::Stretch);
  auto* column = new QVBoxLayout(this);
  column->addWidget(input_);
  column->addWidget(list_, 1);
  connect(input_, &QLineEdit::textChanged, this, &Palette::find);
  connect(list_, &QTreeWidget::itemClicked, this, &Palette::runCurrent);
}

void Palette::begin() {
  entries_ = source_();
  input_->clear();
  find();
  const QSize room = parentWidget()->size();
  resize(kSize.boundedTo(room));
  move(parentWidget()->mapToGlobal(QPoint((room.width() - width()) / 2, room.height() / 8)));
  show();
  raise();
  activateWindow();
  input_->setFocus();
}

void Palette::find() {
  struct Found {
    int score;
    std::size_t entry;
  };
  std::vector<Found> found;
  const QString typed = input_->text();
  for (std::size_t i = 0; i < entries_.size(); ++i)
    if (const auto score = fuzzyScore(typed, entries_[i].text)) found.push_back({*score, i});
  if (!typed.trimmed().isEmpty())
    std::stable_sort(found.begin(), found.end(),
                     [](const Found& a, const Found& b) { return a.score > b.score; });
  list_->clear();
  for (const Found& each : found) {
    if (std::size_t(list_->topLevelItemCount()) == kMostShown) break;
    const PaletteEntry& entry = entries_[each.entry];
    auto* row = new QTreeWidgetItem(list_, {entry.text, entry.kind, entry.hint});
    row->setData(kText, Qt::UserRole, QVariant::fromValue(qulonglong(each.entry)));
    row->setForeground(kKind, views::quietColour(palette()));
    row->setToolTip(kText, entry.text);
  }
  if (list_->topLevelItemCount() > 0) list_->setCurrentItem(list_->topLevelItem(0));
}

bool Palette::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() != QEvent::KeyPress) return QDialog::eventFilter(watched, event);
  switch (static_cast<QKeyEvent*>(event)->key()) {
    case Qt::Key_Up:
    case Qt::Key_Down:
    case Qt::Key_PageUp:
    case Qt::Key_PageDown:
      return QCoreApplication::sendEvent(list_, event);
    case Qt::Key_Return:
    case Qt::Key_Enter:
      runCurrent();
      return true;
    default:
      return QDialog::eventFilter(watched, event);
  }
}

/// The window has the focus again before the entry runs, because many go on from where the focus is.
void Palette::runCurrent() {
  const QTreeWidgetItem* const row = list_->currentItem();
  if (row == nullptr) return;
  const auto run = entries_[row->data(kText, Qt::UserRole).toULongLong()].run;
  hide();
  parentWidget()->activateWindow();
  if (run) run();
}

}  // namespace trimtab::workbench
