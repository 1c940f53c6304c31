// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <span>
#include <vector>

#include "views/model/draft.h"

namespace trimtab::views {

class ParameterLine;

/// Compact lines for some parameters in a dock, which follow the draft.
class ParameterLines : public QWidget {
  Q_OBJECT
 public:
  ParameterLines(Draft& draft, std::span<const char* const> keys);
  /// Adds all parameters whose key begins so.
  ParameterLines(Draft& draft, std::string_view prefix);

 private:
  ParameterLines(Draft& draft, const std::vector<const ParameterRow*>& rows);

  std::vector<ParameterLine*> lines_;
};

}  // namespace trimtab::views
