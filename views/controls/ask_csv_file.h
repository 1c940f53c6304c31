// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

class QWidget;

namespace trimtab::views {

/// Asks for a file to write. A name without an ending gets .csv before it is checked whether the file exists.
/// Returns an empty text if the person cancels.
QString askCsvFile(QWidget* parent, const QString& title, const QString& proposal);

}  // namespace trimtab::views
