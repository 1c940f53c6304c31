// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <optional>

#include "app/link/link.h"

class QLabel;
class QLineEdit;
class QPushButton;
class QTreeWidget;

namespace trimtab::views {
class Draft;
}

namespace trimtab::workbench {

/// Shows what is heard at the host's port beside what is drawn, so that somebody can choose: the entities and
/// views of the host, every sender, and the packets that nobody reads.
class HostChoicePanel : public QWidget {
  Q_OBJECT

 public:
  explicit HostChoicePanel(views::Draft& draft, QWidget* parent = nullptr);

  /// Returns the name by which the own aircraft was asked for, as `--entity` has it; empty: as the preset
  /// says.
  QString entity() const;
  /// Shows what has come so far. `doubt` is where the host's height above ground contradicts the terrain.
  void showLink(const HostStatistics& host, const link::Senders& senders, const link::Questions& questions,
                const std::optional<Finding>& doubt);

 signals:
  /// One sender alone is to be heard: "10.0.0.5:5500".
  void senderChosen(const QString& sender);
  /// The own entity was named, or that or the view of the preset changed.
  void choiceChanged();

 private:
  void choose();
  void showSenders(const HostStatistics& host, const link::Senders& senders);

  QLineEdit* entity_;
  QString askedFor_;  ///< the entity when somebody was told last
  QTreeWidget* senders_;
  QPushButton* alone_;
  QLabel *seen_, *unused_;
};

}  // namespace trimtab::workbench
