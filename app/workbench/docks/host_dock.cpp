// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_dock.h"

#include <QComboBox>
#include <QFontDatabase>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QHostInfo>
#include <QLabel>
#include <QLineEdit>
#include <QNetworkInterface>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QSettings>
#include <QSpinBox>
#include <QVBoxLayout>
#include <cmath>
#include <initializer_list>

#include "app/link/link.h"
#include "trimtab/host/protocol_names.h"
#include "views/controls/scrollable.h"
#include "views/model/draft.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

constexpr int kHostRefreshMs = 250;
const QString kEvery = QStringLiteral("0.0.0.0"), kEvery6 = QStringLiteral("::"),
              kOwn = QString::fromLatin1(link::kOwnMachine);
constexpr int kDefaultPort = 8004;
constexpr auto kProtocolKey = "host.protocol";
const QString kNone = QStringLiteral("–");

QString protocolText(WireProtocol protocol) {
  const ProtocolName* const name = nameOf(protocol);
  return name ? QString::fromLatin1(name->label) : kNone;
}

QString milliseconds(double ms) {
  return std::isfinite(ms) ? QStringLiteral("%L1 ms").arg(ms, 0, 'f', 2) : kNone;
}

QString p99Of(const SampleWindow& samples) {
  if (samples.size() == 0) return kNone;
  return HostDock::tr("%1  (median %2, largest %3)")
      .arg(milliseconds(samples.quantile(0.99)), milliseconds(samples.median()),
           milliseconds(samples.largest()));
}

/// Says the latency of the packets that images show, in that run's own frames, and of all packets.
QString latencyText(const Latency& latency) {
  if (latency.shown.size() == 0) return kNone;
  const double shown = latency.shown.quantile(0.99), frame = latency.frame.median();
  return HostDock::tr("%1, %2 frames of %3  (overtaken packets too: %4)")
      .arg(milliseconds(shown))
      .arg(std::isfinite(shown) ? QString::number(shown / frame, 'f', 2) : kNone)
      .arg(milliseconds(frame), milliseconds(latency.every.quantile(0.99)));
}

/// Says in one line why what came led to no state. The line is empty if nothing came, or if all of it did.
QString unusedText(const HostStatistics& host, const link::Senders& senders) {
  const auto newest = [](const std::optional<Finding>& finding) {
    return QString::fromStdString(toString(finding.value_or(Finding{})));
  };
  if (host.bad > 0)
    return HostDock::tr("%L1 of %L2 datagrams refused; the newest from %3")
        .arg(host.bad)
        .arg(host.received)
        .arg(newest(host.newestBad));
  if (host.notForUs > 0)
    return HostDock::tr("%L1 of %L2 datagrams are for someone else; the newest from %3")
        .arg(host.notForUs)
        .arg(host.received)
        .arg(newest(host.newestNotForUs));
  if (host.newestUnused && host.states == 0)
    return HostDock::tr("%L1 datagrams and no state; the newest from %2")
        .arg(host.received)
        .arg(newest(host.newestUnused));
  if (host.received == 0 && senders.refused > 0)
    return HostDock::tr("%L1 datagrams thrown away, the last from %2: allowed is %3")
        .arg(senders.refused)
        .arg(QString::fromStdString(senders.lastRefused), QString::fromStdString(senders.allowed));
  return {};
}

/// Returns the bytes in lines of sixteen, each with its offset.
QString hexDump(const std::string& hex) {
  QString digits = QString::fromStdString(hex).remove(' ');
  QString dump;
  for (qsizetype at = 0; at < digits.size(); at += 32) {
    dump += QStringLiteral("%1 ").arg(at / 2, 4, 16, QLatin1Char('0'));
    for (qsizetype i = at; i < std::min(at + 32, digits.size()); i += 2)
      dump += QLatin1Char(' ') + digits.mid(i, 2);
    dump += QLatin1Char('\n');
  }
  return dump.trimmed();
}

}  // namespace

HostDock::HostDock(Feed& feed, views::Draft& draft, QWidget* parent)
    : QWidget(parent),
      feed_(feed),
      draft_(draft),
      port_(new QSpinBox(this)),
      interface_(new QComboBox(this)),
      sender_(new QComboBox(this)),
      protocol_(new QComboBox(this)),
      group_(new QLineEdit(this)),
      reply_(new QLineEdit(this)),
      found_(new QLabel(this)),
      connect_(new QPushButton(this)),
      choice_(new HostChoicePanel(draft, this)),
      firstBad_(new QPlainTextEdit(this)) {
  auto* form = new QFormLayout;
  form->setVerticalSpacing(3);
  form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
  port_->setRange(1, 65535);
  port_->setValue(QSettings().value(QStringLiteral("host/port"), kDefaultPort).toInt());
  port_->setAccessibleName(tr("Port"));
  port_->setToolTip(tr("UDP port this program listens on"));
  interface_->setAccessibleName(tr("Interface"));
  interface_->setToolTip(tr(
      "The network interface that this program listens on, and joins a group on. Others can send only if it "
      "is another one than this machine's own"));
  showInterfaces();
  makeSender();
  group_->setPlaceholderText(tr("224.0.0.0 to 239.255.255.255 or ff00::/8; empty: none"));
  group_->setText(QSettings().value(QStringLiteral("host/group")).toString());
  group_->setToolTip(tr("A multicast group that the host sends to. Several programs may listen to one"));
  group_->setAccessibleName(tr("Multicast group"));
  if (const ParameterRow* row = findRow(kProtocolKey)) {
    for (const ChoiceOption& choice : row->choices) protocol_->addItem(views::fromView(choice.label));
    protocol_->setToolTip(views::fromView(row->help));
  }
  protocol_->setAccessibleName(tr("Protocol"));
  reply_->setPlaceholderText(tr("host:port; empty: nothing is sent"));
  reply_->setText(QSettings().value(QStringLiteral("host/reply")).toString());
  reply_->setToolTip(tr("Start of Frame is sent there, for a host that waits for its image generator"));
  reply_->setAccessibleName(tr("Reply address"));
  auto* portRow = new QHBoxLayout;
  portRow->addWidget(port_, 1);
  portRow->addWidget(connect_);
  form->addRow(tr("&Port"), portRow);
  qobject_cast<QLabel*>(form->labelForField(portRow))->setBuddy(port_);
  form->addRow(tr("&Interface"), interface_);
  form->addRow(tr("&Sender"), sender_);
  form->addRow(tr("&Group"), group_);
  form->addRow(tr("P&rotocol"), protocol_);
  form->addRow(tr("Repl&y to"), reply_);
  form->addRow(QString(), found_);
  found_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  found_->setAccessibleName(tr("Address of the reply's host"));
  connect(reply_, &QLineEdit::editingFinished, this, &HostDock::lookUp);
  lookUp();

  state_ = addRow(*form, tr("Link"), {});
  detected_ = addRow(*form, tr("Speaks"), tr("Protocol found in the packets, and who sends them"));
  rate_ = addRow(*form, tr("Rate"), tr("States per second, over the last second"));
  jitter_ = addRow(*form, tr("Jitter"), tr("Smoothed deviation of the gaps between packets"));
  loss_ =
      addRow(*form, tr("Lost"),
             tr("Packets that are missing in the host's frame numbers, without those that only came late"));
  age_ = addRow(*form, tr("Last packet"), tr("Age of the newest packet"));
  decoded_ = addRow(*form, tr("To decoded, p99"), tr("From the kernel's time stamp to the decoded state"));
  image_ = addRow(*form, tr("To image, p99"),
                  tr("From the kernel's time stamp to the finished image that shows the packet"));
  counts_ = addRow(*form, tr("Packets"), {});
  jumps_ = addRow(*form, tr("Jumps"), tr("Position changes too large for any aircraft"));
  weather_ =
      addRow(*form, tr("Weather ignored"),
             tr("Weather Control packets that are not drawn: for regions, for entities, and for layers other "
                "than rain and snow"));
  refused_ = addRow(*form, tr("Other senders"), tr("Packets that came from somebody who may not send"));
  bad_ = addRow(*form, tr("Bad packets"), tr("Packets that were refused; the first one is shown below"));
  for (QLabel* wide : {state_, image_, counts_, refused_, bad_}) wide->setWordWrap(true);
  firstBad_->setReadOnly(true);
  firstBad_->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  firstBad_->setLineWrapMode(QPlainTextEdit::NoWrap);
  firstBad_->setMinimumHeight(90);
  firstBad_->setAccessibleName(tr("First bad packet in hexadecimal"));

  auto* content = new QWidget;
  auto* column = new QVBoxLayout(content);
  column->addLayout(form);
  column->addWidget(choice_);
  column->addWidget(firstBad_);
  column->addStretch(1);
  auto* scroll = views::scrollable(content, tr("Host"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(scroll);

  refresh_.setInterval(kHostRefreshMs);
  connect(&refresh_, &QTimer::timeout, this, &HostDock::refresh);
  connect(connect_, &QPushButton::clicked, this, &HostDock::toggle);
  connect(&feed_, &Feed::linkChanged, this, &HostDock::showLink);
  connect(protocol_, &QComboBox::activated, this,
          [this](int index) { draft_.setValue(kProtocolKey, ChoiceIndex{static_cast<std::size_t>(index)}); });
  const auto connectAgain = [this] {
    if (feed_.receiver() != nullptr) connectHost();
  };
  connect(choice_, &HostChoicePanel::choiceChanged, this, connectAgain);
  connect(choice_, &HostChoicePanel::senderChosen, this, [this](const QString& sender) {
    setSender(sender);
    connectHost();
  });
  const auto showProtocol = [this] {
    const ParameterValue value = draft_.value(kProtocolKey);
    if (const auto* choice = std::get_if<ChoiceIndex>(&value))
      protocol_->setCurrentIndex(static_cast<int>(choice->index));
  };
  connect(&draft_, &views::Draft::valueChanged, this, [showProtocol, connectAgain](const QString& key) {
    if (key != QLatin1String(kProtocolKey)) return;
    showProtocol();
    connectAgain();
  });
  showProtocol();
  showLink();
}

QLabel* HostDock::addRow(QFormLayout& form, const QString& label, const QString& toolTip) {
  auto* value = new QLabel(kNone, this);
  value->setTextInteractionFlags(Qt::TextSelectableByMouse);
  value->setToolTip(toolTip);
  value->setAccessibleName(label);
  value->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  form.addRow(label, value);
  return value;
}

void HostDock::setPort(std::uint16_t port) {
  port_->setValue(port);
}

void HostDock::setInterface(const QString& address) {
  if (interface_->findData(address) < 0) interface_->addItem(address, address);
  interface_->setCurrentIndex(interface_->findData(address));
}

void HostDock::setSender(const QString& sender) {
  if (const int at = sender_->findData(sender); at >= 0)
    sender_->setCurrentIndex(at);
  else
    sender_->setEditText(sender);
}

void HostDock::makeSender() {
  sender_->setEditable(true);
  sender_->setInsertPolicy(QComboBox::NoInsert);
  sender_->addItem(tr("anyone"), QString::fromLatin1(link::kAnyone));
  sender_->addItem(tr("the first one, from then on"), QString::fromLatin1(link::kFirst));
  sender_->setAccessibleName(tr("Sender"));
  sender_->setToolTip(tr("Who may send: one of these, or an address. The packets of others are thrown away"));
  setSender(QSettings().value(QStringLiteral("host/sender"), QString::fromLatin1(link::kAnyone)).toString());
}

/// What was chosen, or typed.
std::string HostDock::senderAsked() const {
  const QString typed = sender_->currentText().trimmed();
  const int at = sender_->findText(typed);
  if (typed.isEmpty()) return link::kAnyone;
  return (at >= 0 ? sender_->itemData(at).toString() : typed).toStdString();
}

/// Every address of this machine, with its interface's name; the one chosen last stays chosen.
void HostDock::showInterfaces() {
  const QString chosen = interface_->count() > 0
                             ? interface_->currentData().toString()
                             : QSettings().value(QStringLiteral("host/listen-on"), kOwn).toString();
  interface_->clear();
  interface_->addItem(tr("every one (%1)").arg(kEvery), kEvery);
  interface_->addItem(tr("every one, also of IPv6 (%1)").arg(kEvery6), kEvery6);
  for (const QNetworkInterface& each : QNetworkInterface::allInterfaces()) {
    if (!each.flags().testFlag(QNetworkInterface::IsUp)) continue;
    for (const QNetworkAddressEntry& entry : each.addressEntries())
      if (!entry.ip().isNull())
        interface_->addItem(QStringLiteral("%1 (%2)").arg(each.humanReadableName(), entry.ip().toString()),
                            entry.ip().toString());
  }
  if (interface_->findData(kOwn) < 0) interface_->addItem(tr("this machine (%1)").arg(kOwn), kOwn);
  // An address that is gone must not open every door.
  const int at = interface_->findData(chosen);
  interface_->setCurrentIndex(at >= 0 ? at : interface_->findData(kOwn));
}

void HostDock::lookUp() {
  const auto endpoint = link::parseEndpoint(reply_->text().trimmed().toStdString());
  const QString name = endpoint ? QString::fromStdString(endpoint->address) : QString();
  if (name == foundName_) return;
  foundName_ = name;
  foundHost_ = QHostAddress(name);
  found_->setVisible(!name.isEmpty() && foundHost_.isNull());
  if (!found_->isVisibleTo(this)) return;
  found_->setText(tr("Looking up %1 …").arg(name));
  QHostInfo::lookupHost(name, this, [this, name](const QHostInfo& host) {
    if (name != foundName_) return;
    // IPv4 comes first, as in link::resolve.
    for (const auto protocol : {QAbstractSocket::IPv4Protocol, QAbstractSocket::IPv6Protocol})
      for (const QHostAddress& address : host.addresses())
        if (foundHost_.isNull() && address.protocol() == protocol) foundHost_ = address;
    found_->setText(foundHost_.isNull() ? tr("%1: %2").arg(name, host.errorString())
                                        : tr("%1 is %2").arg(name, foundHost_.toString()));
  });
}

Findings HostDock::connectHost() {
  Feed::HostSettings settings;
  settings.port = static_cast<std::uint16_t>(port_->value());
  settings.bindAddress = interface_->currentData().toString().toStdString();
  settings.sender = senderAsked();
  settings.group = group_->text().trimmed().toStdString();
  settings.choice = HostChoice(draft_.active()->host);
  settings.choice.chooseEntity(choice_->entity().toStdString());
  if (const QString reply = reply_->text().trimmed(); !reply.isEmpty()) {
    const Result<link::Endpoint> endpoint = link::parseEndpoint(reply.toStdString());
    if (!endpoint) {
      emit refused(tr("The reply address cannot be used"), endpoint.findings());
      return endpoint.findings();
    }
    settings.reply = *endpoint;
    lookUp();
    if (!foundHost_.isNull()) settings.reply->address = foundHost_.toString().toStdString();
  }
  Findings findings = feed_.openHost(settings);
  if (!findings.empty()) {
    emit refused(tr("Cannot listen on port %1").arg(port_->value()), findings);
    return findings;
  }
  QSettings().setValue(QStringLiteral("host/port"), port_->value());
  QSettings().setValue(QStringLiteral("host/reply"), reply_->text().trimmed());
  QSettings().setValue(QStringLiteral("host/group"), group_->text().trimmed());
  QSettings().setValue(QStringLiteral("host/listen-on"), interface_->currentData());
  QSettings().setValue(QStringLiteral("host/sender"), QString::fromStdString(settings.sender));
  emit connected(feed_.receiver()->port());
  return {};
}

void HostDock::toggle() {
  if (feed_.receiver() != nullptr)
    feed_.closeHost();
  else
    connectHost();
}

void HostDock::showLink() {
  const bool open = feed_.receiver() != nullptr;
  connect_->setText(open ? tr("Dis&connect") : tr("&Connect"));
  port_->setEnabled(!open);
  for (QWidget* field : std::initializer_list<QWidget*>{interface_, sender_, group_, reply_})
    field->setEnabled(!open);
  if (open && isVisible())
    refresh_.start();
  else
    refresh_.stop();
  refresh();
}

void HostDock::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  if (feed_.receiver() == nullptr) showInterfaces();
  showLink();
}

void HostDock::hideEvent(QHideEvent* event) {
  refresh_.stop();
  QWidget::hideEvent(event);
}

QString HostDock::stateText(double now, const QString& unused) const {
  if (feed_.receiver() == nullptr) return tr("not connected");
  switch (feed_.session().linkState(now)) {
    case LinkState::never:
      return tr("listening on port %1 of %2, %3")
          .arg(feed_.receiver()->port())
          .arg(interface_->currentData().toString(), unused.isEmpty() ? tr("nothing yet") : unused);
    case LinkState::live:
      return tr("live");
    case LinkState::silent:
      return tr("SILENT for %L1 s").arg(feed_.session().packetAge(now), 0, 'f', 1);
    case LinkState::jumped:
      return tr("live, JUMPED just now");
  }
  return {};
}

void HostDock::refresh() {
  if (!isVisible()) return;
  const double now = link::now();
  const Session& session = feed_.session();
  const bool any = feed_.receiver() != nullptr;
  const HostStatistics host = any ? feed_.receiver()->statistics() : HostStatistics{};
  const link::Senders senders = any ? feed_.receiver()->senders() : link::Senders{};
  const QString unused = unusedText(host, senders);
  state_->setText(stateText(now, unused));
  const auto number = [](std::uint64_t n) { return QStringLiteral("%L1").arg(n); };
  detected_->setText(
      host.lastFrom.empty()
          ? protocolText(host.protocol)
          : tr("%1 from %2").arg(protocolText(host.protocol), QString::fromStdString(host.lastFrom)));
  const double age = session.packetAge(now);
  const bool live = std::isfinite(age) && age < 1;
  rate_->setText(any && live              ? tr("%L1 Hz").arg(host.rateHz, 0, 'f', 1)
                 : any && host.states > 0 ? tr("0 Hz")
                                          : kNone);
  jitter_->setText(host.states > 1 ? milliseconds(host.jitterMs) : kNone);
  const bool numbered = host.protocol == WireProtocol::none || isCigi(host.protocol);
  if (!numbered)
    loss_->setText(tr("not carried by %1").arg(QString::fromLatin1(nameOf(host.protocol)->option)));
  else
    loss_->setText(host.lost ? number(*host.lost) : kNone);
  age_->setText(any && std::isfinite(age) ? tr("%1 ago").arg(milliseconds(age * 1e3)) : kNone);
  decoded_->setText(any ? p99Of(session.latency().decoded) : kNone);
  image_->setText(any ? latencyText(session.latency()) : kNone);
  counts_->setText(any ? tr("%1 received, %2 states, %3 repeated, %4 late, %5 implausible, %6 dropped here")
                             .arg(number(host.received), number(host.states), number(host.repeated),
                                  number(host.reordered), number(host.implausible),
                                  number(feed_.receiver()->dropped()))
                       : kNone);
  refused_->setText(!any ? kNone
                    : senders.refused == 0
                        ? tr("0; allowed: %1").arg(QString::fromStdString(senders.allowed))
                        : tr("%1, the last from %2; allowed: %3")
                              .arg(number(senders.refused), QString::fromStdString(senders.lastRefused),
                                   QString::fromStdString(senders.allowed)));
  jumps_->setText(any ? number(std::max(session.jumps(), host.jumps)) : kNone);
  weather_->setText(any ? tr("%1 for regions or entities, %2 for other layers")
                              .arg(number(host.regionalWeather), number(host.otherLayers))
                        : kNone);
  const QString packets =
      host.refusedPackets > 0 ? tr(", %1 packets of messages").arg(number(host.refusedPackets)) : QString();
  bad_->setText(!any ? kNone : (host.bad > 0 ? unused : number(0)) + packets);
  const auto& doubt = session.groundDoubt();
  choice_->showLink(host, senders, any ? feed_.receiver()->questions() : link::Questions{},
                    any && doubt ? std::optional(toFinding(*doubt)) : std::nullopt);
  const QString dump = host.bad == 0
                           ? QString::fromStdString(host.firstRefusedReason)
                           : QString::fromStdString(host.firstBadReason) + '\n' + hexDump(host.firstBadHex);
  firstBad_->setVisible(!dump.isEmpty());
  if (firstBad_->toPlainText() != dump) firstBad_->setPlainText(dump);
}

}  // namespace trimtab::workbench
