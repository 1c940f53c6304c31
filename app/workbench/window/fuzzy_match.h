// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <optional>

namespace trimtab::workbench {

/// How well what a person typed fits a text; nothing if its letters do not all occur in the text, in their
/// order. Case and spaces do not count. Letters that begin words or follow each other weigh more, and of two
/// texts that fit alike the shorter one wins. Costs the product of the two lengths.
std::optional<int> fuzzyScore(QStringView typed, QStringView text);

}  // namespace trimtab::workbench
