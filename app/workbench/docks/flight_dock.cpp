// SPDX-License-Identifier: GPL-3.0-or-later
#include "flight_dock.h"
#include "app/link/link.h"
#include "trimtab/host/flight.h"
#include "views/controls/seek_slider.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QSlider>
#include <QStyle>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

namespace trimtab::workbench {
namespace {

constexpr int kRefreshMs = 100, kSymbolPx = 16;
constexpr int kScrubSteps = 10000;

QString clock(double seconds) {
  const int s = static_cast<int>(seconds);
  return QStringLiteral("%1:%2.%3")
      .arg(s / 60)
      .arg(s % 60, 2, 10, QLatin1Char('0'))
      .arg(static_cast<int>(seconds * 10) % 10);
}

}  // namespace

FlightDock::FlightDock(Feed& feed, QWidget* parent)
    : QWidget(parent),
      feed_(feed),
      name_(new QLabel(tr("no flight"), this)),
      time_(new QLabel(this)),
      where_(new QLabel(this)),
      play_(new QPushButton(this)),
      stop_(new QPushButton(this)),
      close_(new QPushButton(tr("Close"), this)),
      scrub_(new views::SeekSlider(this)),
      speed_(new QDoubleSpinBox(this)),
      loop_(new QCheckBox(tr("Loop"), this)),
      via_(new QComboBox(this)) {
  auto* open = new QPushButton(tr("Open..."), this);
  connect(open, &QPushButton::clicked, this, &FlightDock::openRequested);
  auto* columns = new QPushButton(tr("Columns..."), this);
  columns->setToolTip(tr("Says which column of a table is which quantity, and in what unit"));
  connect(columns, &QPushButton::clicked, this, &FlightDock::columnsRequested);
  close_->setToolTip(tr("Closes the flight: the free camera starts where the aircraft was"));
  connect(close_, &QPushButton::clicked, this, &FlightDock::close);
  auto* top = new QHBoxLayout;
  name_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  top->addWidget(name_, 1);
  top->addWidget(open);
  top->addWidget(columns);
  top->addWidget(close_);

  stop_->setIcon(symbol(QStyle::SP_MediaStop));
  stop_->setToolTip(tr("Back to the start"));
  stop_->setAccessibleName(tr("Stop"));
  scrub_->setRange(0, kScrubSteps);
  scrub_->setAccessibleName(tr("Place in the flight"));
  auto* row = new QHBoxLayout;
  row->addWidget(play_);
  row->addWidget(stop_);
  row->addWidget(scrub_, 1);
  row->addWidget(time_);

  speed_->setRange(0.1, 20);
  speed_->setSingleStep(0.5);
  speed_->setDecimals(1);
  speed_->setValue(1);
  speed_->setPrefix(QStringLiteral("× "));
  speed_->setAccessibleName(tr("Speed"));
  via_->addItems({tr("here, without a network"), tr("over UDP, CIGI 3.3"), tr("over UDP, native-fdm"),
                  tr("over UDP, CIGI 4.0")});
  via_->setToolTip(tr(
      "Over UDP the flight is sent like a real host's packets, to the port that the Host dock listens on"));
  auto* form = new QFormLayout;
  auto* speedRow = new QHBoxLayout;
  speedRow->addWidget(speed_, 1);
  speedRow->addWidget(loop_);
  form->addRow(tr("Spee&d"), speedRow);
  qobject_cast<QLabel*>(form->labelForField(speedRow))->setBuddy(speed_);
  form->addRow(tr("&Way"), via_);
  form->addRow(tr("Aircraft"), where_);
  where_->setWordWrap(true);

  auto* layout = new QVBoxLayout(this);
  layout->addLayout(top);
  layout->addLayout(row);
  layout->addLayout(form);
  layout->addStretch(1);

  refresh_.setInterval(kRefreshMs);
  connect(&refresh_, &QTimer::timeout, this, &FlightDock::showPosition);
  connect(play_, &QPushButton::clicked, this, [this] { playing() ? pause() : play(); });
  connect(stop_, &QPushButton::clicked, this, &FlightDock::stop);
  connect(scrub_, &QSlider::actionTriggered, this,
          [this] { seek(feed_.playback().duration() * scrub_->sliderPosition() / kScrubSteps); });
  connect(speed_, &QDoubleSpinBox::valueChanged, this, [this](double speed) {
    feed_.playback().setSpeed(speed);
    if (feed_.udpPlayer() != nullptr) feed_.udpPlayer()->setSpeed(speed);
  });
  connect(loop_, &QCheckBox::toggled, this, [this](bool loop) {
    feed_.playback().setLoop(loop);
    if (feed_.udpPlayer() != nullptr) feed_.udpPlayer()->setLoop(loop);
  });
  connect(via_, &QComboBox::activated, this, [this] {
    const bool was = playing();
    feed_.stopUdp();
    feed_.pauseHere();
    if (was) play();
  });
  connect(&feed_, &Feed::flightChanged, this, &FlightDock::showState);
  showState();
}

bool FlightDock::overUdp() const {
  return via_->currentIndex() != here;
}

QString FlightDock::file() const {
  if (file_.isEmpty() || QFileInfo(file_).lastModified() != fileOf_) return {};
  return file_;
}

Findings FlightDock::open(const QString& file, const ColumnMap& columns) {
  const QDateTime written = QFileInfo(file).lastModified();
  Result<Flight> flight = readFlight(file.toStdString(), 0.1, columns);
  if (!flight) return flight.findings();
  Findings notes = flight.findings();
  if (flight->states.size() < 2) {
    notes.push_back({Severity::error, file.toStdString(), "", "a flight of two rows or more",
                     std::to_string(flight->states.size()) + " usable"});
    return notes;
  }
  Flight& loaded = flight.value();
  if (loaded.name.empty()) loaded.name = QFileInfo(file).fileName().toStdString();
  feed_.loadFlight(std::move(loaded));
  file_ = file;
  columns_ = columns;
  fileOf_ = written;
  name_->setToolTip(file);
  return notes;
}

/// Styles draw these symbols in black, which nobody sees on a dark button.
QIcon FlightDock::symbol(QStyle::StandardPixmap which) const {
  QPixmap drawn =
      style()->standardIcon(which, nullptr, this).pixmap(QSize(kSymbolPx, kSymbolPx), devicePixelRatio());
  QPainter painter(&drawn);
  painter.setCompositionMode(QPainter::CompositionMode_SourceIn);
  painter.fillRect(drawn.rect(), palette().color(QPalette::ButtonText));
  return drawn;
}

void FlightDock::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() != QEvent::PaletteChange && event->type() != QEvent::StyleChange) return;
  stop_->setIcon(symbol(QStyle::SP_MediaStop));
  showState();
}

void FlightDock::fly(const std::vector<AircraftState>& states) {
  feed_.stopUdp();
  feed_.loadFlight({tr("recorded run").toStdString(), states});
  file_.clear();
  name_->setToolTip({});
  via_->setCurrentIndex(here);
  feed_.useHead(Feed::Head::host);
  play();
}

void FlightDock::close() {
  file_.clear();
  name_->setToolTip({});
  feed_.loadFlight({});
}

void FlightDock::play() {
  if (!feed_.playback().loaded()) return emit openRequested();
  if (!overUdp()) return feed_.playHere();
  udpPaused_ = false;
  if (feed_.udpPlayer() != nullptr && !feed_.udpPlayer()->finished()) {
    feed_.udpPlayer()->pause(false);
    return showState();
  }
  double start = position();
  if (start >= feed_.playback().duration()) start = 0;
  const WireProtocol protocol = via_->currentIndex() == udpCigi    ? WireProtocol::cigi3
                                : via_->currentIndex() == udpCigi4 ? WireProtocol::cigi4
                                                                   : WireProtocol::native_fdm;
  if (const Findings findings = feed_.playOverUdp(protocol, speed_->value(), loop_->isChecked(), start);
      !findings.empty())
    emit refused(tr("The flight cannot be sent"), findings);
}

void FlightDock::pause() {
  udpPaused_ = true;
  if (feed_.udpPlayer() != nullptr) feed_.udpPlayer()->pause(true);
  feed_.pauseHere();
  showState();
}

void FlightDock::stop() {
  feed_.stopUdp();
  feed_.pauseHere();
  if (feed_.source() == Feed::Source::flight)
    feed_.seekHere(0);
  else
    feed_.playback().seek(0);
  showState();
}

bool FlightDock::playing() const {
  if (const link::FeedPlayer* udp = feed_.udpPlayer()) return !udpPaused_ && !udp->finished();
  return feed_.playback().playing();
}

void FlightDock::seek(double position) {
  feed_.seekHere(position);
  showPosition();
}

double FlightDock::position() const {
  return feed_.udpPlayer() != nullptr ? feed_.udpPlayer()->position() : feed_.playback().position();
}

void FlightDock::showState() {
  const bool loaded = feed_.playback().loaded();
  const Flight& flight = feed_.playback().flight();
  name_->setText(loaded
                     ? tr("%1 (%L2 rows)").arg(QString::fromStdString(flight.name)).arg(flight.states.size())
                     : tr("no flight"));
  stop_->setEnabled(loaded);
  scrub_->setEnabled(loaded);
  close_->setEnabled(loaded);
  const bool on = playing();
  play_->setText(on ? tr("Pause") : tr("Play"));
  play_->setIcon(symbol(on ? QStyle::SP_MediaPause : QStyle::SP_MediaPlay));
  if (on && isVisible())
    refresh_.start();
  else
    refresh_.stop();
  showPosition();
}

void FlightDock::showPosition() {
  if (refresh_.isActive() && !playing()) return showState();
  const FlightPlayback& playback = feed_.playback();
  if (!playback.loaded()) {
    time_->setText(clock(0));
    where_->setText(QStringLiteral("–"));
    return;
  }
  const double at = position(), whole = playback.duration();
  time_->setText(QStringLiteral("%1 / %2").arg(clock(at), clock(whole)));
  if (!scrub_->isSliderDown())
    scrub_->setValue(whole > 0 ? static_cast<int>(std::lround(at / whole * kScrubSteps)) : 0);
  const AircraftState state = stateAt(playback.flight(), playback.flight().states.front().time + at);
  where_->setText(tr("%L1 ft, heading %2°, pitch %3°, roll %4°")
                      .arg(state.position.height.in<Feet>(), 0, 'f', 0)
                      .arg(state.attitude.heading.value(), 0, 'f', 0)
                      .arg(state.attitude.pitch.value(), 0, 'f', 1)
                      .arg(state.attitude.roll.value(), 0, 'f', 1));
}

void FlightDock::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  showState();
}

void FlightDock::hideEvent(QHideEvent* event) {
  refresh_.stop();
  QWidget::hideEvent(event);
}

}  // namespace trimtab::workbench
