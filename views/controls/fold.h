// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QToolButton>
#include <QVBoxLayout>

namespace trimtab::views {

/// A title that shows and hides what belongs to it.
class Fold : public QWidget {
 public:
  Fold(const QString& title, QWidget* content, bool open = false) : title_(new QToolButton) {
    title_->setText(title);
    title_->setCheckable(true);
    title_->setAutoRaise(true);
    title_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(title_);
    layout->addWidget(content);
    const auto show = [this, content](bool on) {
      title_->setArrowType(on ? Qt::DownArrow : Qt::RightArrow);
      content->setVisible(on);
    };
    connect(title_, &QToolButton::toggled, this, show);
    title_->setChecked(open);
    show(open);
  }
  QToolButton& title() { return *title_; }

 private:
  QToolButton* title_;
};

}  // namespace trimtab::views
