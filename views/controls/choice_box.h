// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QComboBox>

#include "views/model/draft.h"

namespace trimtab::views {

/// A combo box for a choice parameter. The wheel changes it only while it has the focus.
class ChoiceBox : public QComboBox {
  Q_OBJECT
 public:
  ChoiceBox(Draft& draft, std::string_view key, QWidget* parent = nullptr);

 protected:
  void wheelEvent(QWheelEvent* event) override;
};

/// Returns the tool tip of a row as rich text: help, source and range.
QString helpText(const ParameterRow& row);

}  // namespace trimtab::views
