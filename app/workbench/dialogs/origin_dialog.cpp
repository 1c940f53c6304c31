// SPDX-License-Identifier: GPL-3.0-or-later
#include "origin_dialog.h"

#include <QDialogButtonBox>
#include <QFileInfo>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSettings>
#include <QVariantMap>

#include "trimtab/scene/osg_database.h"

namespace trimtab::workbench {
namespace {

const QString kOriginsKey = QStringLiteral("scene_origins");

}  // namespace

OriginDialog::OriginDialog(const QString& file, QWidget* parent)
    : QDialog(parent), file_(file), latitude_(new QLineEdit(this)), longitude_(new QLineEdit(this)) {
  setWindowTitle(tr("Origin of a scene"));
  auto* const what = new QLabel(
      tr("The coordinates of %1 are flat: metres east, north and up of a place that the file does not "
         "name. Where on the earth is it?")
          .arg(QFileInfo(file).fileName()),
      this);
  what->setWordWrap(true);
  latitude_->setAccessibleName(tr("Latitude"));
  latitude_->setPlaceholderText(tr("degrees, -90 to 90, south negative"));
  longitude_->setAccessibleName(tr("Longitude"));
  longitude_->setPlaceholderText(tr("degrees, -180 to 180, west negative"));
  const QStringList before =
      QSettings().value(kOriginsKey).toMap().value(file).toString().split(QLatin1Char(','));
  if (before.size() == 2) {
    latitude_->setText(before[0]);
    longitude_->setText(before[1]);
  }
  auto* const form = new QFormLayout;
  form->addRow(tr("L&atitude"), latitude_);
  form->addRow(tr("L&ongitude"), longitude_);
  auto* const buttons = new QDialogButtonBox(QDialogButtonBox::Open | QDialogButtonBox::Cancel, this);
  open_ = buttons->button(QDialogButtonBox::Open);
  auto* const column = new QVBoxLayout(this);
  column->addWidget(what);
  column->addLayout(form);
  column->addWidget(buttons);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  for (QLineEdit* line : {latitude_, longitude_})
    connect(line, &QLineEdit::textChanged, this, &OriginDialog::check);
  connect(this, &QDialog::accepted, this, [this] {
    QVariantMap origins = QSettings().value(kOriginsKey).toMap();
    origins[file_] = text();
    QSettings().setValue(kOriginsKey, origins);
    emit given(text());
  });
  resize(420, sizeHint().height());
  check();
}

QString OriginDialog::text() const {
  return latitude_->text().trimmed() + QLatin1Char(',') + longitude_->text().trimmed();
}

void OriginDialog::check() {
  open_->setEnabled(bool(scene::originFrom(text().toStdString())));
}

}  // namespace trimtab::workbench
