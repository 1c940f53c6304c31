// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather_panel.h"

#include <QBoxLayout>
#include <QGridLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QTableWidget>
#include <cmath>

#include "trimtab/preset/choices.h"
#include "trimtab/weather/weather.h"
#include "views/controls/parameter_line.h"
#include "views/model/theme.h"
#include "views/model/value_text.h"

namespace trimtab::views {
namespace {

constexpr double kNauticalMile = 1852;
constexpr int kSteps = 7;

/// The parameters that the dock edits beside those of the steps; isWanted() says which are shown.
constexpr std::string_view kWeatherKeys[] = {"weather.source",
                                             "weather.step",
                                             "weather.visibility_from",
                                             "weather.typed_visibility_m",
                                             "weather.clear_visibility_m",
                                             "weather.haze",
                                             "weather.air",
                                             "weather.layer_top_m",
                                             "weather.ratio_mode",
                                             "weather.fixed_ratio",
                                             "weather.severity_density",
                                             "weather.precipitation_form",
                                             "weather.wind_speed_mps",
                                             "weather.wind_from_deg"};

std::string_view stepName(WeatherStep step) {
  return table::ChoicesOf<WeatherStep>::options[static_cast<std::size_t>(step)].name;
}
QString stepLabel(WeatherStep step) {
  return fromView(table::ChoicesOf<WeatherStep>::options[static_cast<std::size_t>(step)].label);
}

/// Returns the prefix of the keys in a step's own group, such as "weather.rain_light.".
std::string groupPrefix(WeatherStep step) {
  return "weather." + std::string(stepName(step)) + ".";
}

bool isWanted(std::string_view key, const TuningParameters& p) {
  const WeatherParameters& w = p.weather;
  const bool typed = w.visibilityFrom == VisibilitySource::typed;
  if (key == "weather.typed_visibility_m") return typed;
  if (key == "weather.clear_visibility_m") return !typed;
  if (key == "weather.haze") return !typed && w.step == WeatherStep::clear;
  if (key == "weather.layer_top_m") return w.air == AirModel::layer;
  if (key == "weather.fixed_ratio") return w.ratioMode == RatioMode::fixed;
  if (key == "weather.severity_density") return w.source == WeatherSource::host;
  const Precipitation falls = precipitationOf(w.step);
  if (key == "weather.precipitation_form")
    return falls != Precipitation::none || w.source == WeatherSource::host;
  if (key.starts_with("weather.rain.")) return falls == Precipitation::rain;
  if (key.starts_with("weather.snow.")) return falls == Precipitation::snow;
  if (key.starts_with("weather.wind_from")) return w.windSpeed.value() > 0;
  for (const std::string_view always : kWeatherKeys)
    if (key == always) return true;
  if (!key.starts_with(groupPrefix(w.step))) return false;
  if (key.ends_with(".visibility_share")) return !typed;
  if (key.ends_with(".far_stretch")) return w.ratioMode == RatioMode::adaptive;
  return true;
}

QString fallsText(const WeatherDecision& d) {
  const QString fog =
      d.fogged ? (d.visibilityM < 1000 ? QObject::tr("fog") : QObject::tr("haze")) : QString();
  if (d.precipitation == Precipitation::none) return fog.isEmpty() ? QObject::tr("Clear") : fog;
  const QString kind = d.precipitation == Precipitation::rain ? QObject::tr("Rain") : QObject::tr("Snow");
  return fog.isEmpty() ? kind : QObject::tr("%1 and %2").arg(kind, fog);
}

QString ratioText(double ratio) {
  return numberText(ratio, 7);
}

QString hostText(const AircraftState& state) {
  QStringList said;
  if (state.weather) {
    const HostWeather& w = *state.weather;
    said << (w.precipitation == Precipitation::none
                 ? QObject::tr("nothing falls")
                 : QObject::tr("%1 of severity %2").arg(fromView(toText(w.precipitation))).arg(w.severity));
    if (w.visibility) said << QObject::tr("%1 in it").arg(distanceText(w.visibility->value()));
  }
  if (state.wind)
    said << QObject::tr("wind from %1 degrees at %2 m/s")
                .arg(numberText(state.wind->from.value(), 0), numberText(state.wind->speed.value(), 1));
  if (state.visibility) said << QObject::tr("visibility %1").arg(distanceText(state.visibility->value()));
  return said.isEmpty() ? QObject::tr("nothing of weather") : said.join(QStringLiteral(", "));
}

}  // namespace

QString distanceText(double metres) {
  if (std::isnan(metres)) return QObject::tr("unknown");
  if (std::isinf(metres)) return QObject::tr("unlimited");
  const double miles = metres / kNauticalMile;
  return QObject::tr("%1 m (%2 NM)").arg(numberText(metres, 0), numberText(miles, miles < 10 ? 2 : 1));
}

WeatherPanel::WeatherPanel(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      now_(new QLabel(tr("No frame has been decided yet"))),
      reason_(new QLabel),
      steps_(new QTableWidget(kSteps, 6)),
      calibrate_(new QPushButton(tr("&Calibrate…"))),
      throttle_(this, [this] { refresh(); }) {
  QFont large = font();
  large.setPointSizeF(large.pointSizeF() * 1.25);
  large.setBold(true);
  now_->setFont(large);
  reason_->setWordWrap(true);
  reason_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  reason_->setMinimumHeight(2 * fontMetrics().lineSpacing());
  reason_->setAlignment(Qt::AlignLeft | Qt::AlignTop);

  QGridLayout* values = new QGridLayout;
  values->setHorizontalSpacing(12);
  values->setVerticalSpacing(2);
  values->setColumnStretch(1, 1);
  visibility_ = addValue(*values, tr("Visibility"), tr("How far one sees from the eye"));
  density_ = addValue(*values, tr("Density"), tr("Intensity of the particles, 0 to 1"));
  ratio_ = addValue(*values, tr("Near-far ratio"),
                    tr("Default near over far plane, Eq. (1)%1").arg(documentsHtml("D: Eq. (1)")));
  far_ = addValue(*values, tr("Far plane"), tr("Nothing farther from the eye is drawn"));
  cut_ =
      addValue(*values, tr("Cut away"), tr("Tiles that lie wholly beyond the far plane and are not drawn"));
  host_ = addValue(*values, tr("Host says"),
                   tr("Weather Control of rain and snow, and the visibility of the atmosphere"));

  QWidget* content = new QWidget;
  QGridLayout* grid = new QGridLayout(content);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setHorizontalSpacing(8);
  grid->setVerticalSpacing(3);
  grid->setColumnStretch(1, 1);
  makeLines(*grid);

  steps_->setHorizontalHeaderLabels(
      {tr("Weather"), tr("Visibility (m)"), tr("(NM)"), tr("Density"), tr("Far plane (m)"), tr("Ratio")});
  steps_->setAccessibleName(tr("What each weather step means"));
  steps_->setToolTip(tr("What each step means with the parameters as they are; a double click chooses it"));
  steps_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  steps_->setSelectionBehavior(QAbstractItemView::SelectRows);
  steps_->setSelectionMode(QAbstractItemView::SingleSelection);
  steps_->setAlternatingRowColors(true);
  steps_->setTabKeyNavigation(false);
  steps_->verticalHeader()->hide();
  steps_->verticalHeader()->setDefaultSectionSize(fontMetrics().height() + 4);
  steps_->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  steps_->horizontalHeader()->setStretchLastSection(true);
  steps_->setMinimumHeight((kSteps + 1) * (fontMetrics().height() + 5) + 6);
  for (int r = 0; r < kSteps; ++r)
    for (int c = 0; c < steps_->columnCount(); ++c) {
      auto* item = new QTableWidgetItem;
      if (c > 0) item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
      steps_->setItem(r, c, item);
    }
  connect(steps_, &QTableWidget::cellActivated, this, [this](int row, int) {
    draft_.setValue("weather.step", ChoiceIndex{static_cast<std::size_t>(row)});
  });

  calibrate_->setToolTip(
      tr("Measure what each weather step costs on this machine, and set far planes that win as much"));
  calibrate_->setAutoDefault(false);
  connect(calibrate_, &QPushButton::clicked, this, &WeatherPanel::calibrationAsked);

  QVBoxLayout* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  QHBoxLayout* head = new QHBoxLayout;
  head->addWidget(now_, 1);
  head->addWidget(calibrate_);
  layout->addLayout(head);
  layout->addWidget(reason_);
  layout->addLayout(values);
  layout->addWidget(content);
  layout->addWidget(steps_, 1);

  connect(&draft_, &Draft::valueChanged, this, [this](const QString& key) {
    if (!key.startsWith(QStringLiteral("weather."))) return;
    showLines();
    showSteps();
  });
  connect(&draft_, &Draft::findingsChanged, this, [this] {
    for (ParameterLine* each : lines_) each->refresh();
  });
  showLines();
  showSteps();
  refresh();
}

QLabel* WeatherPanel::addValue(QGridLayout& grid, const QString& name, const QString& toolTip) {
  QLabel* value = new QLabel;
  value->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  value->setWordWrap(true);
  value->setAccessibleName(name);
  QLabel* title = new QLabel(name);
  for (QLabel* each : {title, value}) each->setToolTip(toolTip);
  const int row = grid.rowCount();
  grid.addWidget(title, row, 0, Qt::AlignTop);
  grid.addWidget(value, row, 1);
  return value;
}

void WeatherPanel::makeLines(QGridLayout& grid) {
  int gridRow = 0;
  const auto add = [&](std::string_view key) {
    lines_.push_back(new ParameterLine(draft_, *findRow(key), grid, gridRow));
    lines_.back()->setCompact(true);
    ++gridRow;
  };
  for (const std::string_view key : kWeatherKeys) add(key);
  for (const ParameterRow& row : parameterRows())
    if (row.key.starts_with("weather.") && row.key.find('.', 8) != std::string_view::npos) add(row.key);
}

ParameterLine* WeatherPanel::line(std::string_view key) const {
  for (ParameterLine* each : lines_)
    if (each->row().key == key && each->isVisible()) return each;
  return nullptr;
}

QString WeatherPanel::reason() const {
  return reason_->text();
}

void WeatherPanel::showLines() {
  for (ParameterLine* each : lines_) {
    const bool wanted = isWanted(each->row().key, draft_.parameters());
    if (wanted != each->isVisible()) each->setVisible(wanted);
  }
}

void WeatherPanel::showSteps() {
  TuningParameters p = draft_.parameters();
  p.weather.source = WeatherSource::preset;
  const WeatherStep chosen = p.weather.step;
  for (int r = 0; r < kSteps; ++r) {
    p.weather.step = static_cast<WeatherStep>(r);
    const WeatherDecision d = decideWeather(AircraftState{}, p);
    const bool cut = std::isfinite(d.farM);
    const QString texts[] = {stepLabel(p.weather.step),
                             d.fogged ? numberText(d.visibilityM, 0) : tr("unlimited"),
                             d.fogged ? numberText(d.visibilityM / kNauticalMile, 2) : QString(),
                             numberText(d.density, 3),
                             cut ? numberText(d.farM, 0) : tr("no cut"),
                             cut ? ratioText(d.nearFarRatio) : QString()};
    for (int c = 0; c < steps_->columnCount(); ++c) {
      QTableWidgetItem& item = *steps_->item(r, c);
      item.setText(texts[c]);
      QFont text = font();
      text.setBold(p.weather.step == chosen);
      item.setFont(text);
    }
  }
}

void WeatherPanel::showFrame(const LiveFrame& frame) {
  frame_ = frame;
  any_ = true;
  throttle_.request();
}

void WeatherPanel::refresh() {
  if (!any_) return;
  const WeatherDecision& d = frame_.decision.weather;
  now_->setText(fallsText(d));
  QString why = QString::fromStdString(explain(d));
  if (d.farM < WeatherDecision::kUnlimited && frame_.decision.policy.moves(Lever::far_distance))
    why += tr("; rules multiply the far distance by %1")
               .arg(numberText(frame_.decision.policy[Lever::far_distance], 2));
  reason_->setText(why);
  visibility_->setText(distanceText(d.visibilityM));
  density_->setText(numberText(d.density, 3));
  // A policy may multiply what the weather decides, and the image shows the product.
  const double farM = frame_.levers ? frame_.levers->drawn.farM : d.farM;
  ratio_->setText(std::isfinite(farM) ? ratioText(draft_.active()->weather.defaultNear.value() / farM)
                                      : tr("no cut"));
  far_->setText(distanceText(farM));
  cut_->setText(tr("%1 of %2 tiles")
                    .arg(numberText(double(frame_.drawn().visible.beyondVisibility), 0),
                         numberText(double(frame_.drawn().tilesInCut), 0)));
  host_->setText(hostText(frame_.input.state));
}

}  // namespace trimtab::views
