// SPDX-License-Identifier: GPL-3.0-or-later
#include "export_dialog.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QSettings>

namespace trimtab::workbench {
namespace {

const QString kAuthorKey = QStringLiteral("export/author");

}  // namespace

ExportDialog::ExportDialog(const std::optional<ExportTarget>& before, QWidget* parent)
    : QDialog(parent),
      format_(new QComboBox(this)),
      file_(new QLineEdit(this)),
      author_(new QLineEdit(this)),
      comment_(new QPlainTextEdit(this)) {
  setWindowTitle(tr("Export preset"));
  file_->setObjectName(QStringLiteral("file"));
  format_->addItem(tr("JSON"), int(ExportFormat::json));
  format_->addItem(tr("FlightGear property list (XML)"), int(ExportFormat::xml));
  format_->addItem(tr("Flat INI"), int(ExportFormat::ini));
  author_->setText(QSettings().value(kAuthorKey, qEnvironmentVariable("USER")).toString());
  if (before) {
    format_->setCurrentIndex(format_->findData(int(before->format)));
    comment_->setPlainText(before->comment);
  }
  // Another format is another file: its ending follows, unless the person gave it an ending of its own.
  connect(format_, &QComboBox::currentIndexChanged, this, [this] {
    const QFileInfo info(file_->text());
    if (QStringList{"json", "xml", "ini"}.contains(info.suffix()))
      file_->setText(info.path() + QLatin1Char('/') + info.completeBaseName() + QLatin1Char('.') + suffix());
  });
  comment_->setPlaceholderText(tr("What this preset is for"));
  comment_->setMinimumWidth(380);
  comment_->setTabChangesFocus(true);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  connect(buttons, &QDialogButtonBox::accepted, this, [this] {
    QSettings().setValue(kAuthorKey, author());
    accept();
  });
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* form = new QFormLayout(this);
  form->addRow(tr("&Format"), format_);
  form->addRow(tr("&Author"), author_);
  form->addRow(tr("Co&mment"), comment_);
  if (before)
    form->addRow(tr("Fi&le"), makeFile(before->file));
  else
    file_->hide();
  form->addRow(buttons);
}

QLayout* ExportDialog::makeFile(const QString& file) {
  file_->setText(file);
  file_->setAccessibleName(tr("File of the export"));
  file_->setToolTip(tr("The file of the last export, which is replaced; empty: you are asked for another"));
  auto* choose = new QPushButton(tr("C&hoose…"), this);
  choose->setAutoDefault(false);
  connect(choose, &QPushButton::clicked, this, &ExportDialog::askFile);
  auto* row = new QHBoxLayout;
  row->addWidget(file_, 1);
  row->addWidget(choose);
  return row;
}

void ExportDialog::askFile() {
  QFileDialog files(this, tr("Export preset"), {}, fileFilter());
  files.setAcceptMode(QFileDialog::AcceptSave);
  files.setDefaultSuffix(suffix());
  files.selectFile(file());
  if (files.exec() == QDialog::Accepted) file_->setText(files.selectedFiles().constFirst());
}

QString ExportDialog::file() const {
  return file_->text().trimmed();
}

ExportFormat ExportDialog::format() const {
  return static_cast<ExportFormat>(format_->currentData().toInt());
}
QString ExportDialog::author() const {
  return author_->text().trimmed();
}
QString ExportDialog::comment() const {
  return comment_->toPlainText().trimmed();
}

QString ExportDialog::suffix() const {
  switch (format()) {
    case ExportFormat::xml:
      return QStringLiteral("xml");
    case ExportFormat::ini:
      return QStringLiteral("ini");
    case ExportFormat::json:
      break;
  }
  return QStringLiteral("json");
}

QString ExportDialog::fileFilter() const {
  return QStringLiteral("%1 (*.%2)").arg(format_->currentText(), suffix());
}

ExportFormat exportFormatOf(const QString& file) {
  const QString ending = QFileInfo(file).suffix().toLower();
  return ending == QLatin1String("xml")   ? ExportFormat::xml
         : ending == QLatin1String("ini") ? ExportFormat::ini
                                          : ExportFormat::json;
}

}  // namespace trimtab::workbench
