// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake_dialog.h"

#include <QCheckBox>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QSettings>
#include <QShortcut>
#include <QSpinBox>
#include <QVBoxLayout>

#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/cdb/catalogue.h"
#include "trimtab/terrain/elevation/height_unit.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::workbench {
namespace {

const QString kImages =
    BakeDialog::tr("Images (*.tif *.tiff *.jp2 *.jpg *.jpeg *.png *.vrt *.img);;All files (*)");
const QString kElevation = BakeDialog::tr(
    "Elevation and scenery (*.tif *.tiff *.hgt *.dt0 *.dt1 *.dt2 *.img *.asc *.vrt *.zip *.btg *.btg.gz "
    "*.stg);;All files (*)");

/// What of a source brings its own objects; read once, when it is added to the list.
constexpr int kIsCdb = Qt::UserRole, kIsScenery = Qt::UserRole + 1;

/// A line with buttons that fill it.
QWidget* withButtons(QLineEdit* line, std::initializer_list<QPushButton*> buttons) {
  auto* both = new QWidget;
  auto* row = new QHBoxLayout(both);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(line, 1);
  for (QPushButton* button : buttons) row->addWidget(button);
  return both;
}

}  // namespace

BakeDialog::BakeDialog(QWidget* parent)
    : QDialog(parent),
      sources_(new QListWidget(this)),
      imagery_(new QLineEdit(this)),
      heightUnit_(new QLineEdit(this)),
      sceneryModels_(new QLineEdit(this)),
      output_(new QLineEdit(this)),
      ignoreChecksums_(new QCheckBox(tr("Read DTED whose chec&ksums do not agree"), this)),
      ownObjects_(new QCheckBox(tr("&Place what stands on the ground"), this)),
      ownError_(new QCheckBox(tr("Error of the fi&nest patches"), this)),
      error_(new QDoubleSpinBox(this)),
      memory_(new QSpinBox(this)),
      note_(new QLabel(this)) {
  setWindowTitle(tr("Bake a terrain database"));
  sources_->setAccessibleName(tr("Elevation and scenery"));
  sources_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  sources_->setToolTip(
      tr("Files may overlap and may differ in projection, datum and resolution. Where several overlap, the "
         "finest one is used, and borders are blended. A folder adds all files in it; a CDB (a folder with "
         "Tiles) "
         "adds its elevation and features, and its imagery unless an image is named."));
  sources_->setMinimumHeight(110);
  auto* files = new QPushButton(tr("Add &files..."), this);
  auto* folder = new QPushButton(tr("Add fo&lder..."), this);
  auto* remove = new QPushButton(tr("&Remove"), this);
  connect(files, &QPushButton::clicked, this, &BakeDialog::addFiles);
  connect(folder, &QPushButton::clicked, this, &BakeDialog::addFolder);
  connect(remove, &QPushButton::clicked, this, &BakeDialog::removeChosen);
  auto* removeKey = new QShortcut(QKeySequence::Delete, sources_);
  removeKey->setContext(Qt::WidgetShortcut);
  connect(removeKey, &QShortcut::activated, this, &BakeDialog::removeChosen);
  auto* sourceButtons = new QHBoxLayout;
  sourceButtons->addWidget(files);
  sourceButtons->addWidget(folder);
  sourceButtons->addWidget(remove);
  sourceButtons->addStretch(1);
  auto* sourceColumn = new QVBoxLayout;
  sourceColumn->addWidget(sources_, 1);
  sourceColumn->addLayout(sourceButtons);

  makeReading();
  output_->setToolTip(tr("A new folder, or a database that is replaced once the new one is complete"));
  auto* browseOutput = new QPushButton(tr("Bro&wse..."), this);
  connect(browseOutput, &QPushButton::clicked, this, [this] {
    const QString chosen = QFileDialog::getSaveFileName(this, tr("Folder of the database"), output_->text(),
                                                        {}, nullptr, QFileDialog::DontConfirmOverwrite);
    if (!chosen.isEmpty()) output_->setText(chosen);
  });
  error_->setRange(0, 1000);
  error_->setDecimals(2);
  error_->setSingleStep(0.1);
  error_->setValue(1);
  error_->setSuffix(tr(" m"));
  error_->setToolTip(tr("Largest vertical distance from the posts; 0 keeps every post"));
  error_->setAccessibleName(tr("Error of the finest patches"));
  error_->setEnabled(false);
  ownError_->setToolTip(tr("If this is off, a tenth of the distance between posts is used"));
  connect(ownError_, &QCheckBox::toggled, error_, &QWidget::setEnabled);
  memory_->setRange(128, 1 << 20);
  memory_->setSingleStep(128);
  memory_->setValue(static_cast<int>(terrain::BakeOptions{}.memory.value()));
  memory_->setSuffix(tr(" MB"));
  memory_->setToolTip(tr("Baking uses no more memory than this, however large the data are"));

  auto* const form = form_ = new QFormLayout;
  form->addRow(tr("&Elevation,\nscenery"), sourceColumn);
  qobject_cast<QLabel*>(form->labelForField(sourceColumn))->setBuddy(sources_);
  form->addRow(tr("&Unit of heights"), heightUnit_);
  form->addRow(ignoreChecksums_);
  auto* imageRow = makeImagery();
  form->addRow(tr("&Image"), imageRow);
  qobject_cast<QLabel*>(form->labelForField(imageRow))->setBuddy(imagery_);
  form->addRow(ownObjects_);
  modelsRow_ = makeSceneryModels();
  form->addRow(tr("&Shared models"), modelsRow_);
  qobject_cast<QLabel*>(form->labelForField(modelsRow_))->setBuddy(sceneryModels_);
  form->addRow(ownError_, error_);
  form->addRow(tr("&Memory"), memory_);
  auto* outputRow = withButtons(output_, {browseOutput});
  form->addRow(tr("&Database"), outputRow);
  qobject_cast<QLabel*>(form->labelForField(outputRow))->setBuddy(output_);

  note_->setWordWrap(true);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel, this);
  bake_ = buttons->addButton(tr("&Bake"), QDialogButtonBox::AcceptRole);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* column = new QVBoxLayout(this);
  column->addLayout(form, 1);
  column->addWidget(note_);
  column->addWidget(buttons);
  for (QLineEdit* line : {imagery_, heightUnit_, sceneryModels_, output_})
    connect(line, &QLineEdit::textChanged, this, &BakeDialog::check);
  resize(640, sizeHint().height());
  check();
}

QWidget* BakeDialog::makeImagery() {
  imagery_->setAccessibleName(tr("Image to drape"));
  imagery_->setPlaceholderText(tr("none: land is coloured by height and slope"));
  auto* image = new QPushButton(tr("Br&owse..."), this);
  connect(image, &QPushButton::clicked, this, [this] {
    const QString file = QFileDialog::getOpenFileName(this, tr("Image to drape"), {}, kImages);
    if (!file.isEmpty()) imagery_->setText(file);
  });
  auto* folder = new QPushButton(tr("Fold&er..."), this);
  connect(folder, &QPushButton::clicked, this, [this] {
    const QString chosen = QFileDialog::getExistingDirectory(this, tr("Folder of images to drape"));
    if (!chosen.isEmpty()) imagery_->setText(chosen);
  });
  return withButtons(imagery_, {image, folder});
}

QWidget* BakeDialog::makeSceneryModels() {
  ownObjects_->setChecked(true);
  ownObjects_->setToolTip(tr("The objects that scenery's lists place, and the features of a CDB"));
  connect(ownObjects_, &QCheckBox::toggled, this, &BakeDialog::check);
  sceneryModels_->setAccessibleName(tr("Shared models"));
  sceneryModels_->setPlaceholderText(tr("FG_ROOT, or /usr/share/games/flightgear"));
  sceneryModels_->setToolTip(
      tr("FlightGear's base package: the folder with Models, which scenery shares. An object whose model is "
         "not there is left out."));
  auto* folder = new QPushButton(tr("Folder..."), this);
  connect(folder, &QPushButton::clicked, this, [this] {
    const QString chosen = QFileDialog::getExistingDirectory(this, tr("FlightGear's base package"));
    if (!chosen.isEmpty()) sceneryModels_->setText(chosen);
  });
  return withButtons(sceneryModels_, {folder});
}

/// What the person knows of the files and the files do not say.
void BakeDialog::makeReading() {
  const QString units = QString::fromStdString(terrain::unitsOfHeight());
  heightUnit_->setPlaceholderText(tr("as the files say"));
  heightUnit_->setAccessibleName(tr("Unit of heights"));
  heightUnit_->setToolTip(tr("Of files that name none, or none that is known: %1").arg(units));
  ignoreChecksums_->setToolTip(tr("Also DTED without checksums; without this, such a file is refused"));
}

void BakeDialog::addSources(const QStringList& paths) {
  for (const QString& path : paths) {
    const QString absolute = QFileInfo(path).absoluteFilePath();
    if (!sources_->findItems(absolute, Qt::MatchExactly).isEmpty()) continue;
    auto* item = new QListWidgetItem(absolute, sources_);
    const std::filesystem::path file = absolute.toStdString();
    const bool cdb = terrain::isCdb(file);
    item->setData(kIsCdb, cdb);
    item->setData(kIsScenery, !cdb && terrain::isScenery(file));
  }
  if (output_->text().isEmpty() && sources_->count() > 0) {
    const QFileInfo first(sources_->item(0)->text());
    output_->setText(first.absolutePath() + QLatin1Char('/') + first.completeBaseName() +
                     QStringLiteral("-terrain"));
  }
  check();
}

void BakeDialog::addFiles() {
  addSources(QFileDialog::getOpenFileNames(this, tr("Elevation and scenery"), {}, kElevation));
}

void BakeDialog::addFolder() {
  const QString folder =
      QFileDialog::getExistingDirectory(this, tr("Folder of elevation files, scenery or a CDB"));
  if (!folder.isEmpty()) addSources({folder});
}

void BakeDialog::removeChosen() {
  qDeleteAll(sources_->selectedItems());
  check();
}

void BakeDialog::showObjects() {
  bool cdb = false, scenery = false;
  for (int i = 0; i < sources_->count(); ++i) {
    cdb = cdb || sources_->item(i)->data(kIsCdb).toBool();
    scenery = scenery || sources_->item(i)->data(kIsScenery).toBool();
  }
  form_->setRowVisible(ownObjects_, cdb || scenery);
  form_->setRowVisible(modelsRow_, scenery);
  modelsRow_->setEnabled(ownObjects_->isChecked());
}

void BakeDialog::check() {
  showObjects();
  const QString output = output_->text().trimmed(), image = imagery_->text().trimmed(),
                unit = heightUnit_->text().trimmed(),
                models = modelsRow_->isEnabled() && !modelsRow_->isHidden() ? sceneryModels_->text().trimmed()
                                                                            : QString();
  const QFileInfo folder(output);
  QString problem;
  if (sources_->count() == 0)
    problem = tr("Add at least one elevation file or folder of scenery.");
  else if (!image.isEmpty() && !QFileInfo::exists(image))
    problem = tr("There is no image or folder %1.").arg(image);
  else if (!unit.isEmpty() && !terrain::metresPerUnit(unit.toStdString()))
    problem = tr("%1 is no unit of heights; they are %2.")
                  .arg(unit, QString::fromStdString(terrain::unitsOfHeight()));
  else if (!models.isEmpty() && !QFileInfo::exists(models + QStringLiteral("/Models")) &&
           !QFileInfo::exists(models + QStringLiteral("/Scenery/Models")))
    problem = tr("%1 is no base package of FlightGear: there is no folder Models in it.").arg(models);
  else if (output.isEmpty())
    problem = tr("Name a folder for the database.");
  else if (folder.exists() && !folder.isDir())
    problem = tr("%1 is a file; a database is a folder.").arg(output);
  else if (!terrain::mayReplace(output.toStdString()))
    problem = tr("%1 holds other files, which are left alone: name a new folder.").arg(output);
  bake_->setEnabled(problem.isEmpty());
  if (!problem.isEmpty())
    note_->setText(problem);
  else if (terrain::isDatabase(output.toStdString()))
    note_->setText(tr("The database there is replaced once the new one is complete."));
  else
    note_->setText(tr("To resume a bake that was stopped, name its folder again."));
}

terrain::BakeOptions BakeDialog::options() const {
  terrain::BakeOptions options;
  for (int i = 0; i < sources_->count(); ++i)
    options.sources.emplace_back(sources_->item(i)->text().toStdString());
  if (const QString image = imagery_->text().trimmed(); !image.isEmpty())
    options.imagery = image.toStdString();
  if (const QString unit = heightUnit_->text().trimmed(); !unit.isEmpty())
    options.reading.heightUnit = terrain::metresPerUnit(unit.toStdString());
  options.reading.ignoreChecksums = ignoreChecksums_->isChecked();
  options.ownObjects = ownObjects_->isChecked();
  if (const QString models = sceneryModels_->text().trimmed(); !models.isEmpty())
    options.sceneryModels = models.toStdString();
  if (ownError_->isChecked()) options.maxError = Metres{error_->value()};
  options.memory = Megabytes{double(memory_->value())};
  options.output = output_->text().trimmed().toStdString();
  return options;
}

}  // namespace trimtab::workbench
