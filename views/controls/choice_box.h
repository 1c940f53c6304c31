// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QComboBox>

#include "views/model/draft.h"

namespace trimtab::views {

/// A combo box of a choice parameter. The wheel does not change it unless it has the focus.
class ChoiceBox : public QComboBox {
  Q_OBJECT
 public:
  ChoiceBox(Draft& draft, std::string_view key, QWidget* parent = nullptr);

 protected:
  void wheelEvent(QWheelEvent* event) override;
};

/// Tool tip of a row: help, source and range, as rich text.
QString helpText(const ParameterRow& row);

}  // namespace trimtab::views
