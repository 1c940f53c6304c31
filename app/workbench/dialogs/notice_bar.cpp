// SPDX-License-Identifier: GPL-3.0-or-later
#include "notice_bar.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <algorithm>

namespace trimtab::workbench {

NoticeBar::NoticeBar(QWidget* parent) : QFrame(parent), label_(new QLabel(this)), buttons_(new QHBoxLayout) {
  setAttribute(Qt::WA_DontCreateNativeAncestors);
  setAttribute(Qt::WA_NativeWindow);  // the viewport would cover any other (GlWidget)
  setFrameShape(QFrame::StyledPanel);
  setAutoFillBackground(true);
  setBackgroundRole(QPalette::ToolTipBase);
  setForegroundRole(QPalette::ToolTipText);
  label_->setWordWrap(true);
  label_->setForegroundRole(QPalette::ToolTipText);
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(8, 4, 8, 4);
  layout->addWidget(label_, 1);
  layout->addLayout(buttons_);
  hide();
  parent->installEventFilter(this);
}

bool NoticeBar::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize) place();
  return QFrame::eventFilter(watched, event);
}

void NoticeBar::place() {
  const int widthPx = parentWidget()->width();
  setGeometry(0, 0, widthPx, std::max(heightForWidth(widthPx), minimumSizeHint().height()));
}

void NoticeBar::ask(const QString& id, const QString& text, std::vector<Answer> answers) {
  std::erase_if(questions_, [&](const Question& question) { return question.id == id; });
  questions_.push_back({id, text, std::move(answers)});
  showFirst();
}

void NoticeBar::withdraw(const QString& id) {
  std::erase_if(questions_, [&](const Question& question) { return question.id == id; });
  showFirst();
}

void NoticeBar::showFirst() {
  while (QLayoutItem* item = buttons_->takeAt(0)) {
    item->widget()->hide();
    item->widget()->deleteLater();
    delete item;
  }
  setVisible(!questions_.empty());
  if (questions_.empty()) return;
  label_->setText(questions_.front().text);
  for (const Answer& answer : questions_.front().answers) {
    auto* button = new QPushButton(answer.text, this);
    buttons_->addWidget(button);
    connect(button, &QPushButton::clicked, this, [this, id = questions_.front().id, act = answer.act] {
      withdraw(id);
      if (act) act();
    });
  }
  layout()->activate();
  place();
  raise();
}

}  // namespace trimtab::workbench
