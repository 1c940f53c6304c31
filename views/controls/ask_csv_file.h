// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

class QWidget;

namespace trimtab::views {

/// Where to write; a name without an ending gets .csv, and a file that exists is asked about under that name.
/// Empty when the question was cancelled.
QString askCsvFile(QWidget* parent, const QString& title, const QString& proposal);

}  // namespace trimtab::views
