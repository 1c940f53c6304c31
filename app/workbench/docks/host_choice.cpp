// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_choice.h"

#include <QFormLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "views/controls/parameter_lines.h"
#include "views/model/draft.h"

namespace trimtab::workbench {
namespace {

constexpr std::array<const char*, 2> kKeys{"host.entity", "host.view"};

QString listed(const std::vector<std::uint16_t>& numbers) {
  QStringList texts;
  for (const std::uint16_t number : numbers) texts << QString::number(number);
  return texts.join(QStringLiteral(", "));
}

/// Says what of the host is passed over, one thing a line; empty if nothing is.
QString unusedText(const HostStatistics& host, const link::Questions& questions,
                   const std::optional<Finding>& doubt) {
  QStringList lines;
  if (!host.ignored.empty()) {
    QStringList types;
    for (const IgnoredPackets& each : host.ignored)
      types << QStringLiteral("%1 %L2").arg(QString::fromStdString(cigiPacketName(each.id))).arg(each.count);
    lines << HostChoicePanel::tr("Packets that are not read: %1").arg(types.join(QStringLiteral(", ")));
  }
  if (host.newestRefused)
    lines << HostChoicePanel::tr("%L1 packets left out, the newest from %2")
                 .arg(host.refusedPackets)
                 .arg(QString::fromStdString(toString(*host.newestRefused)));
  if (host.uncounted > 0)
    lines << HostChoicePanel::tr("The frame number stands still: nobody can tell what is lost");
  if (questions.asked > 0)
    lines << (questions.nowhereToAnswer
                  ? HostChoicePanel::tr("%L1 requests of heights or lines of sight without an answer: "
                                        "\"Reply to\" says where the host waits for it")
                        .arg(questions.asked)
                  : HostChoicePanel::tr("%L1 of %L2 requests of heights and lines of sight answered")
                        .arg(questions.answered)
                        .arg(questions.asked));
  if (doubt) lines << QString::fromStdString(toString(*doubt));
  return lines.join(QLatin1Char('\n'));
}

}  // namespace

HostChoicePanel::HostChoicePanel(views::Draft& draft, QWidget* parent)
    : QWidget(parent),
      entity_(new QLineEdit(this)),
      senders_(new QTreeWidget(this)),
      alone_(new QPushButton(tr("&Hear this one alone"), this)),
      seen_(new QLabel(this)),
      unused_(new QLabel(this)) {
  entity_->setPlaceholderText(tr("SITE:APPLICATION:ENTITY or marking; empty: as the preset says"));
  entity_->setAccessibleName(tr("Own aircraft by name"));
  entity_->setToolTip(QString::fromLatin1(link::kEntityHelp));
  connect(entity_, &QLineEdit::editingFinished, this, [this] {
    if (std::exchange(askedFor_, entity()) != entity()) emit choiceChanged();
  });
  auto* name = new QFormLayout;
  name->addRow(tr("Own aircraft by na&me"), entity_);
  senders_->setHeaderLabels({tr("Sender"), tr("States"), tr("Datagrams"), tr("Newest that led to none")});
  senders_->setRootIsDecorated(false);
  senders_->setAccessibleName(tr("Senders"));
  senders_->setToolTip(tr("Everyone who sends to this port. The first one is followed"));
  senders_->header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
  constexpr int kRows = 90;  // px
  senders_->setMaximumHeight(kRows);
  alone_->setToolTip(tr("Throws away the packets of all other senders"));
  for (QLabel* label : {seen_, unused_}) {
    label->setWordWrap(true);
    label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  }
  seen_->setAccessibleName(tr("Entities and views seen"));
  unused_->setAccessibleName(tr("Not used"));
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(new views::ParameterLines(draft, kKeys));
  column->addLayout(name);
  column->addWidget(seen_);
  column->addWidget(senders_);
  column->addWidget(alone_);
  column->addWidget(unused_);
  const auto enable = [this] { alone_->setEnabled(senders_->currentItem() != nullptr); };
  connect(senders_, &QTreeWidget::currentItemChanged, this, enable);
  enable();
  connect(alone_, &QPushButton::clicked, this, &HostChoicePanel::choose);
  connect(senders_, &QTreeWidget::itemActivated, this, &HostChoicePanel::choose);
  connect(&draft, &views::Draft::valueChanged, this, [this](const QString& key) {
    for (const char* own : kKeys)
      if (key == QLatin1String(own)) emit choiceChanged();
  });
  showLink({}, {}, {}, {});
}

QString HostChoicePanel::entity() const {
  return entity_->text().trimmed();
}

void HostChoicePanel::choose() {
  if (const QTreeWidgetItem* item = senders_->currentItem()) emit senderChosen(item->text(0));
}

/// Keeps the rows, so that the one that somebody is about to choose stays chosen.
void HostChoicePanel::showSenders(const HostStatistics& host, const link::Senders& senders) {
  std::vector<HostStatistics> all;
  if (!host.from.empty()) all.push_back(host);
  all.insert(all.end(), senders.others.begin(), senders.others.end());
  std::sort(all.begin() + (host.from.empty() ? 0 : 1), all.end(),
            [](const HostStatistics& a, const HostStatistics& b) { return a.from < b.from; });
  const auto rows = static_cast<int>(all.size());
  while (senders_->topLevelItemCount() > rows) delete senders_->takeTopLevelItem(rows);
  while (senders_->topLevelItemCount() < rows) senders_->addTopLevelItem(new QTreeWidgetItem);
  for (int i = 0; i < rows; ++i) {
    const HostStatistics& each = all[static_cast<std::size_t>(i)];
    const std::optional<Finding>& why = each.newestBad        ? each.newestBad
                                        : each.newestNotForUs ? each.newestNotForUs
                                                              : each.newestUnused;
    const QStringList cells{QString::fromStdString(each.from), QStringLiteral("%L1").arg(each.states),
                            QStringLiteral("%L1").arg(each.received),
                            why ? QString::fromStdString(toString(*why)) : QString()};
    QTreeWidgetItem* item = senders_->topLevelItem(i);
    for (int column = 0; column < cells.size(); ++column)
      if (item->text(column) != cells[column]) item->setText(column, cells[column]);
    item->setToolTip(3, cells[3]);
  }
}

void HostChoicePanel::showLink(const HostStatistics& host, const link::Senders& senders,
                               const link::Questions& questions, const std::optional<Finding>& doubt) {
  showSenders(host, senders);
  QStringList seen;
  if (!host.otherEntities.empty()) seen << tr("Other entities: %1").arg(listed(host.otherEntities));
  if (host.views.size() > 1 && host.view)
    seen << tr("Views: %1; %2 is drawn").arg(listed(host.views)).arg(*host.view);
  seen_->setText(seen.join(QLatin1Char('\n')));
  seen_->setVisible(!seen.isEmpty());
  const QString unused = unusedText(host, questions, doubt);
  unused_->setText(unused);
  unused_->setVisible(!unused.isEmpty());
}

}  // namespace trimtab::workbench
