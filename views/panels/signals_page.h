// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "views/model/trace_buffer.h"

class QListWidget;
class QListWidgetItem;

namespace trimtab::views {

class SearchField;

/// All signals that plots can show. A person searches them, and drags one into a plot or adds it.
class SignalsPage : public QWidget {
  Q_OBJECT
 public:
  explicit SignalsPage(QWidget* parent = nullptr);
  QListWidget& list() { return *list_; }

 signals:
  void added(trimtab::views::Trace trace);

 private:
  void search();
  void add(const QListWidgetItem* item);

  QListWidget* list_;
  SearchField* search_;
};

}  // namespace trimtab::views
