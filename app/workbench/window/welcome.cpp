// SPDX-License-Identifier: GPL-3.0-or-later
#include "welcome.h"

#include <QCheckBox>
#include <QCommandLinkButton>
#include <QDialogButtonBox>
#include <QGridLayout>
#include <QGroupBox>
#include <QLabel>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>

namespace trimtab::workbench {
namespace {

const QString kShownKey = QStringLiteral("welcome/at_start");
constexpr int kColumns = 2, kButtonWidth = 400;

QCommandLinkButton* button(const Welcome::Way& way, QDialog& page) {
  auto* const made = new QCommandLinkButton(way.text);
  const QFontMetrics metrics(made->font());
  made->setDescription(metrics.elidedText(way.detail, Qt::ElideMiddle, kButtonWidth - 60));
  made->setToolTip(way.detail);
  made->setMinimumWidth(kButtonWidth);
  QObject::connect(made, &QCommandLinkButton::clicked, &page, [&page, take = way.take] {
    page.accept();
    take();
  });
  return made;
}

}  // namespace

Welcome::Welcome(const std::vector<Group>& groups, QWidget* parent) : QDialog(parent) {
  setAttribute(Qt::WA_DeleteOnClose);
  setWindowTitle(tr("Welcome to Trimtab"));
  auto* grid = new QGridLayout;
  int cell = 0;
  for (const Group& group : groups) {
    if (group.ways.empty()) continue;
    auto* box = new QGroupBox(group.title);
    auto* column = new QVBoxLayout(box);
    for (const Way& way : group.ways) column->addWidget(button(way, *this));
    column->addStretch(1);
    grid->addWidget(box, cell / kColumns, cell % kColumns);
    ++cell;
  }
  auto* atStart = new QCheckBox(tr("&Show this page when the program starts with nothing to open"));
  atStart->setChecked(shownAtStart());
  connect(atStart, &QCheckBox::toggled, this, [](bool on) { QSettings().setValue(kShownKey, on); });
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* layout = new QVBoxLayout(this);
  layout->addLayout(grid);
  layout->addWidget(atStart);
  layout->addWidget(buttons);
}

bool Welcome::shownAtStart() {
  return QSettings().value(kShownKey, true).toBool();
}

}  // namespace trimtab::workbench
