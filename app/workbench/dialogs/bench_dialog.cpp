// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench_dialog.h"

#include <QCheckBox>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QRegularExpressionValidator>
#include <QSettings>
#include <QSpinBox>
#include <QVBoxLayout>
#include <utility>

#include "sweep_choice.h"
#include "trimtab/preset/preset.h"
#include "views/model/error_run.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

constexpr const char* kCases[] = {"none", "view_frustum", "proposed"};

}  // namespace

const QString BenchChoice::kDraft = QStringLiteral("draft");

namespace {

const QString kPresets = QStringLiteral("bench/presets"), kCaseNames = QStringLiteral("bench/cases"),
              kSize = QStringLiteral("bench/size"), kFrames = QStringLiteral("bench/frames"),
              kRepeats = QStringLiteral("bench/repeats"), kWhole = QStringLiteral("bench/whole");

BenchChoice lastChoice() {
  const QSettings settings;
  BenchChoice last;
  last.presets = settings.value(kPresets, last.presets).toStringList();
  last.cases = settings.value(kCaseNames, last.cases).toStringList();
  last.size = settings.value(kSize, last.size).toString();
  last.frames = settings.value(kFrames, last.frames).toInt();
  last.repeats = settings.value(kRepeats, last.repeats).toInt();
  last.whole = settings.value(kWhole, last.whole).toBool();
  return last;
}

}  // namespace

QStringList BenchChoice::arguments(const QString& terrain, const QString& flight,
                                   const QString& draft) const {
  QStringList arguments{QStringLiteral("bench"), QStringLiteral("--terrain"), terrain,
                        QStringLiteral("--flight"), flight};
  arguments << QStringLiteral("--preset");
  for (const QString& preset : presets) arguments << (preset == BenchChoice::kDraft ? draft : preset);
  for (const QString& sweep : sweeps) arguments << QStringLiteral("--sweep") << sweep;
  arguments << QStringLiteral("--cases") << cases.join(QLatin1Char(','))  //
            << QStringLiteral("--size") << size                           //
            << QStringLiteral("--frames") << QString::number(frames)      //
            << QStringLiteral("--repeats") << QString::number(repeats)    //
            << QStringLiteral("-o") << folder;
  if (whole) arguments << QStringLiteral("--whole");
  return arguments;
}

BenchDialog::BenchDialog(const QString& folder, QWidget* parent)
    : QDialog(parent),
      presets_(new QListWidget(this)),
      size_(new QLineEdit(this)),
      folder_(new QLineEdit(folder, this)),
      frames_(new QSpinBox(this)),
      repeats_(new QSpinBox(this)),
      whole_(new QCheckBox(tr("Draw &every image of the flight"), this)),
      sweep_(new SweepChoice(this)),
      amount_(new QLabel(this)) {
  setWindowTitle(tr("Measure presets along the flight"));
  const BenchChoice last = lastChoice();
  const auto add = [this](const QString& label, const QString& name, bool chosen) {
    auto* item = new QListWidgetItem(label, presets_);
    item->setData(Qt::UserRole, name);
    item->setFlags(item->flags() | Qt::ItemIsUserCheckable);
    item->setCheckState(chosen ? Qt::Checked : Qt::Unchecked);
  };
  QStringList files = last.presets;
  for (const std::string_view shipped : shippedPresets()) {
    const QString name = views::fromView(shipped);
    add(name, name, files.removeAll(name) > 0);
  }
  add(tr("the draft, as it is now"), BenchChoice::kDraft, files.removeAll(BenchChoice::kDraft) > 0);
  for (const QString& path : files)
    if (QFileInfo::exists(path)) add(QFileInfo(path).completeBaseName(), path, true);
  presets_->setAccessibleName(tr("Presets"));
  presets_->setMaximumHeight(130);
  auto* file = new QPushButton(tr("&Add a preset..."), this);
  connect(file, &QPushButton::clicked, this, [this, add] {
    for (const QString& name :
         QFileDialog::getOpenFileNames(this, tr("Add presets"), {}, tr("Presets (*.json)")))
      add(QFileInfo(name).completeBaseName(), name, true);
  });
  auto* presetRow = new QHBoxLayout;
  presetRow->addWidget(file);
  for (const auto& [text, state] : {std::pair{tr("A&ll"), Qt::Checked}, {tr("&None"), Qt::Unchecked}}) {
    auto* all = new QPushButton(text, this);
    connect(all, &QPushButton::clicked, this, [this, state = state] {
      for (int i = 0; i < presets_->count(); ++i) presets_->item(i)->setCheckState(state);
    });
    presetRow->addWidget(all);
  }
  presetRow->addStretch(1);

  auto* caseRow = new QHBoxLayout;
  for (std::size_t i = 0; i < cases_.size(); ++i) {
    cases_[i] = new QCheckBox(views::methodText(QLatin1String(kCases[i])), this);
    cases_[i]->setChecked(last.cases.contains(QLatin1String(kCases[i])));
    caseRow->addWidget(cases_[i]);
    connect(cases_[i], &QCheckBox::toggled, this, &BenchDialog::check);
  }
  size_->setText(last.size);
  size_->setValidator(new QRegularExpressionValidator(
      QRegularExpression(QStringLiteral("[1-9][0-9]{1,4}x[1-9][0-9]{1,4}")), size_));
  frames_->setRange(2, 100000);
  frames_->setValue(last.frames);
  frames_->setToolTip(tr("The frames are spread evenly over the flight"));
  repeats_->setRange(1, 1000);
  repeats_->setValue(last.repeats);
  repeats_->setToolTip(tr("How often each frame is drawn and timed; the median counts"));
  whole_->setChecked(last.whole);
  whole_->setToolTip(
      tr("A preset whose rules or budget depend on its own images draws those that may have an effect on a "
         "measured frame; with this it draws all of them, which takes longer"));
  folder_->setToolTip(tr("To resume a measurement that was stopped, name its folder again"));
  auto* browse = new QPushButton(tr("&Browse..."), this);
  connect(browse, &QPushButton::clicked, this, [this] {
    const QString chosen = QFileDialog::getExistingDirectory(this, tr("Folder for the results"));
    if (!chosen.isEmpty()) folder_->setText(chosen);
  });
  auto* folderRow = new QHBoxLayout;
  folderRow->addWidget(folder_, 1);
  folderRow->addWidget(browse);

  auto* form = new QFormLayout;
  form->addRow(tr("&Presets"), presets_);
  form->addRow({}, presetRow);
  form->addRow(tr("Culling cases"), caseRow);
  form->addRow(tr("S&weep"), sweep_);
  form->addRow(tr("&Size (px)"), size_);
  form->addRow(tr("&Frames"), frames_);
  form->addRow(tr("&Repeats"), repeats_);
  form->addRow({}, whole_);
  form->addRow(tr("Fol&der"), folderRow);
  qobject_cast<QLabel*>(form->labelForField(folderRow))->setBuddy(folder_);

  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel, this);
  measure_ = buttons->addButton(tr("&Measure"), QDialogButtonBox::AcceptRole);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* column = new QVBoxLayout(this);
  column->addLayout(form);
  column->addWidget(amount_);
  column->addWidget(buttons);
  connect(presets_, &QListWidget::itemChanged, this, &BenchDialog::check);
  for (QSpinBox* box : {frames_, repeats_}) connect(box, &QSpinBox::valueChanged, this, &BenchDialog::check);
  connect(sweep_, &SweepChoice::changed, this, &BenchDialog::check);
  for (QLineEdit* line : {size_, folder_}) connect(line, &QLineEdit::textChanged, this, &BenchDialog::check);
  resize(560, sizeHint().height());
  check();
}

void BenchDialog::check() {
  const BenchChoice chosen = choice();
  const auto units = chosen.presets.size() * chosen.cases.size() * sweep_->presets();
  const QString fault = sweep_->fault();
  amount_->setText(!fault.isEmpty() ? fault
                                    : tr("%L1 timed images of %L2 frames, and a reference image of each")
                                          .arg(units * chosen.frames * chosen.repeats)
                                          .arg(units * chosen.frames));
  measure_->setEnabled(units > 0 && fault.isEmpty() && size_->hasAcceptableInput() &&
                       !chosen.folder.isEmpty());
}

void BenchDialog::accept() {
  const BenchChoice chosen = choice();
  QSettings settings;
  settings.setValue(kPresets, chosen.presets);
  settings.setValue(kCaseNames, chosen.cases);
  settings.setValue(kSize, chosen.size);
  settings.setValue(kFrames, chosen.frames);
  settings.setValue(kRepeats, chosen.repeats);
  settings.setValue(kWhole, chosen.whole);
  QDialog::accept();
}

BenchChoice BenchDialog::choice() const {
  BenchChoice choice;
  choice.presets.clear();
  choice.cases.clear();
  for (int i = 0; i < presets_->count(); ++i)
    if (presets_->item(i)->checkState() == Qt::Checked)
      choice.presets << presets_->item(i)->data(Qt::UserRole).toString();
  for (std::size_t i = 0; i < cases_.size(); ++i)
    if (cases_[i]->isChecked()) choice.cases << QLatin1String(kCases[i]);
  choice.size = size_->text();
  choice.frames = frames_->value();
  choice.repeats = repeats_->value();
  choice.whole = whole_->isChecked();
  choice.sweeps = sweep_->sweeps();
  choice.folder = folder_->text().trimmed();
  return choice;
}

}  // namespace trimtab::workbench
