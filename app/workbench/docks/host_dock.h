// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QHostAddress>
#include <QTimer>
#include <QWidget>

#include "app/workbench/docks/host_choice.h"
#include "app/workbench/jobs/feed.h"

class QComboBox;
class QFormLayout;
class QLabel;
class QLineEdit;
class QPlainTextEdit;
class QPushButton;
class QSpinBox;

namespace trimtab::views {
class Draft;
}

namespace trimtab::workbench {

/// Opens and closes the link to the host, and shows how healthy it is.
class HostDock : public QWidget {
  Q_OBJECT

 public:
  HostDock(Feed& feed, views::Draft& draft, QWidget* parent = nullptr);

  void setPort(std::uint16_t port);
  /// Chooses the interface by its address, and who may send (see link::ReceiverOptions::sender).
  void setInterface(const QString& address);
  void setSender(const QString& sender);
  /// Does what the Connect button does. Returns what went wrong, and emits it as `refused` too.
  Findings connectHost();

 signals:
  void refused(const QString& what, const trimtab::Findings& findings);
  void connected(std::uint16_t port);

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  QLabel* addRow(QFormLayout& form, const QString& label, const QString& toolTip);
  void makeSender();
  void showInterfaces();
  std::string senderAsked() const;
  /// Asks for the address of the host to reply to, so that connecting does not wait for a name server.
  void lookUp();
  void toggle();
  void showLink();
  void refresh();
  QString stateText(double now, const QString& unused) const;

  Feed& feed_;
  views::Draft& draft_;
  QSpinBox* port_;
  QComboBox *interface_, *sender_, *protocol_;
  QLineEdit *group_, *reply_;
  QLabel* found_;           ///< what the look-up of the reply's host found
  QString foundName_;       ///< the name that was looked up
  QHostAddress foundHost_;  ///< its address; null if there is none
  QPushButton* connect_;
  HostChoicePanel* choice_;
  QLabel *state_, *detected_, *rate_, *jitter_, *loss_, *age_, *decoded_, *image_, *counts_, *jumps_, *bad_,
      *weather_, *refused_;
  QPlainTextEdit* firstBad_;
  QTimer refresh_;  ///< runs only while a link is open and the dock is visible
};

}  // namespace trimtab::workbench
