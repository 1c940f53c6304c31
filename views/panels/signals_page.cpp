// SPDX-License-Identifier: GPL-3.0-or-later
#include "signals_page.h"

#include <QBoxLayout>
#include <QListWidget>
#include <QMimeData>
#include <QPushButton>

#include "views/controls/search_field.h"
#include "views/model/plot_signals.h"
#include "views/model/theme.h"
#include "views/plots/time_plot.h"

namespace trimtab::views {
namespace {

constexpr int kTraceRole = Qt::UserRole;

/// A list whose rows can be dragged into a plot.
class SignalList : public QListWidget {
 protected:
  QStringList mimeTypes() const override { return {QString::fromLatin1(TimePlot::kSignalMime)}; }
  QMimeData* mimeData(const QList<QListWidgetItem*>& items) const override {
    auto* carried = new QMimeData;
    if (!items.isEmpty())
      carried->setData(QString::fromLatin1(TimePlot::kSignalMime),
                       items.front()->data(kTraceRole).toString().toUtf8());
    return carried;
  }
};

}  // namespace

SignalsPage::SignalsPage(QWidget* parent)
    : QWidget(parent), list_(new SignalList), search_(new SearchField(tr("Search signals"))) {
  list_->setAccessibleName(tr("Signals"));
  list_->setToolTip(
      tr("Drag a signal into a plot; Enter adds it to the plot that was clicked last. The "
         "menu of a plot adds, removes and makes plots."));
  list_->setDragEnabled(true);
  for (const PlotSignal& signal : plotSignals()) {
    auto* item = new QListWidgetItem(signal.fullName(), list_);
    item->setData(kTraceRole, fromView(traceName(signal.trace)));
  }
  auto* button = new QPushButton(tr("&Add signal"));
  button->setToolTip(tr("Add the selected signal to the plot that was clicked last"));
  button->setAutoDefault(false);
  button->setEnabled(false);
  search_->setToolTip(tr("Enter adds the first signal that is found"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  layout->addWidget(search_);
  layout->addWidget(list_, 1);
  layout->addWidget(button);
  connect(list_, &QListWidget::currentRowChanged, button,
          [button](int row) { button->setEnabled(row >= 0); });
  connect(list_, &QListWidget::itemActivated, this, &SignalsPage::add);
  connect(button, &QPushButton::clicked, this, [this] { add(list_->currentItem()); });
  connect(search_, &QLineEdit::returnPressed, this, [this] { add(list_->currentItem()); });
  connect(search_, &QLineEdit::textChanged, this, &SignalsPage::search);
}

void SignalsPage::search() {
  QListWidgetItem* first = nullptr;
  for (int row = 0; row < list_->count(); ++row) {
    QListWidgetItem* const item = list_->item(row);
    const bool found = search_->finds({item->text(), item->data(kTraceRole).toString()});
    item->setHidden(!found);
    if (found && first == nullptr) first = item;
  }
  list_->setCurrentItem(search_->isUsed() ? first : nullptr);
}

void SignalsPage::add(const QListWidgetItem* item) {
  if (item == nullptr) return;
  if (const auto trace = traceOf(item->data(kTraceRole).toString())) emit added(*trace);
}

}  // namespace trimtab::views
