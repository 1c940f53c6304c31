#include "results.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "trimtab/measure/statistics.h"
#include "trimtab/units/not_finite.h"
#include "trimtab/units/number.h"

namespace trimtab::harness {
namespace {

template <auto Group, auto Field>
double fieldOf(const MeasuredFrame& frame) {
  return static_cast<double>(frame.*Group.*Field);
}
template <auto Group, auto Field>
void setField(MeasuredFrame& frame, double value) {
  auto& field = frame.*Group.*Field;
  field = static_cast<std::remove_reference_t<decltype(field)>>(value);
}

template <std::size_t I>
Quantity cost() {
  static constexpr CostStage kStage = kCostStages[I];
  static constexpr bool kFrame = kStage.kind == StageKind::total;
  return {.key = kFrame ? "frame_ms" : kStage.column,
          .label = kFrame ? "frame time" : kStage.name,
          .unit = "ms",
          .kind = Quantity::Kind::cost,
          .of = [](const MeasuredFrame& frame) { return frame.cost.*kStage.ms; },
          .set = [](MeasuredFrame& frame, double value) { frame.cost.*kStage.ms = value; },
          .stage = kStage.kind};
}
template <std::size_t... I>
std::vector<Quantity> costs(std::index_sequence<I...>) {
  std::vector<Quantity> all{cost<I>()...};
  std::stable_partition(all.begin(), all.end(),
                        [](const Quantity& q) { return q.stage == StageKind::total; });
  return all;
}
template <auto Field>
Quantity count(std::string_view key, std::string_view label, bool largerIsWorse = true) {
  return {.key = key,
          .label = label,
          .unit = {},
          .kind = Quantity::Kind::count,
          .of = fieldOf<&MeasuredFrame::counts, Field>,
          .set = setField<&MeasuredFrame::counts, Field>,
          .whole = true,
          .largerIsWorse = largerIsWorse};
}
template <auto Field>
Quantity error(std::string_view key, std::string_view label, std::string_view unit,
               bool largerIsWorse = true) {
  return {.key = key,
          .label = label,
          .unit = unit,
          .kind = Quantity::Kind::error,
          .of = fieldOf<&MeasuredFrame::error, Field>,
          .set = setField<&MeasuredFrame::error, Field>,
          .whole = std::is_same_v<decltype(FrameError{}.*Field), std::uint64_t&&>,
          .largerIsWorse = largerIsWorse};
}

const Unit* unitOf(const std::vector<Unit>& units, const UnitName& name) {
  const auto at =
      std::find_if(units.begin(), units.end(), [&](const Unit& unit) { return unit.name == name; });
  return at == units.end() ? nullptr : &*at;
}

/// Returns a cell that spreadsheets read as one.
std::string cellText(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string cellText(double value) {
  return std::isnan(value) ? std::string() : numberText(value);
}

}  // namespace

/// Returns the quantity of a row of kFrameLeverRows. An infinite lever has no limit, so it counts as not
/// measured.
template <std::size_t Row>
Quantity lever() {
  constexpr FrameLeverRow kRow = kFrameLeverRows[Row];
  static_assert(kRow.value != nullptr);
  Quantity q{.key = kRow.key, .label = kRow.label, .unit = kRow.unit, .kind = Quantity::Kind::lever};
  q.of = [](const MeasuredFrame& frame) {
    const double value = frame.levers.*kFrameLeverRows[Row].value;
    return std::isfinite(value) ? value : kNan;
  };
  q.set = [](MeasuredFrame& frame, double value) { frame.levers.*kFrameLeverRows[Row].value = value; };
  return q;
}

const std::vector<Quantity>& quantities() {
  static const std::vector<Quantity> all = [] {
    std::vector<Quantity> list = costs(std::make_index_sequence<kCostStages.size()>{});
    const Quantity others[] = {
        count<&TraceCounts::triangles>("triangles", "triangles"),
        count<&TraceCounts::vertices>("vertices", "vertices"),
        count<&TraceCounts::tilesDrawn>("tiles_drawn", "tiles drawn"),
        count<&TraceCounts::culledFrustum>("culled_frustum", "tiles outside the frustum", false),
        count<&TraceCounts::culledOccluded>("culled_occluded", "tiles hidden", false),
        count<&TraceCounts::culledBeyondVisibility>("culled_beyond_visibility", "tiles beyond the visibility",
                                                    false),
        count<&TraceCounts::culledBackFacing>("culled_back_facing", "tiles facing away", false),
        count<&TraceCounts::objectsDrawn>("objects_drawn", "objects drawn"),
        count<&TraceCounts::objectsOccluded>("objects_occluded", "objects hidden", false),
        error<&FrameError::wronglyCulledPixels>("wrongly_culled_px", "wrongly culled pixels", "px"),
        error<&FrameError::geometricMaxPx>("geometric_max_px", "geometric error, largest", "px"),
        error<&FrameError::geometricMeanPx>("geometric_mean_px", "geometric error, mean", "px"),
        error<&FrameError::psnrDb>("psnr_db", "PSNR", "dB", false),
        error<&FrameError::ssim>("ssim", "SSIM", "", false),
        error<&FrameError::flip>("flip", "FLIP", ""),
        error<&FrameError::pop>("pop", "temporal pop", "of 255"),
        error<&FrameError::hiddenDrawnShare>("hidden_drawn_share", "hidden tiles drawn", "of drawn"),
        lever<0>(),
        lever<1>(),
        lever<2>(),
        lever<3>(),
        lever<4>(),
        lever<5>(),
        lever<6>(),
        lever<7>(),
        lever<8>(),
        lever<9>(),
    };
    list.insert(list.end(), std::begin(others), std::end(others));
    return list;
  }();
  return all;
}

const Quantity* quantityOf(std::string_view key) {
  const auto& all = quantities();
  const auto at = std::find_if(all.begin(), all.end(), [&](const Quantity& q) { return q.key == key; });
  return at == all.end() ? nullptr : &*at;
}

Summary summarise(const Unit& unit, const Quantity& quantity) {
  std::vector<double> values;
  for (const MeasuredFrame& frame : unit.frames)
    if (const double value = quantity.of(frame); !std::isnan(value)) values.push_back(value);
  if (values.empty()) return {kNan, kNan, kNan, kNan, kNan};
  Summary summary;
  for (const double value : values) summary.mean += value / static_cast<double>(values.size());
  // The sign leads from the good end to the bad one.
  const double sign = quantity.largerIsWorse ? 1 : -1;
  for (double& value : values) value *= sign;
  summary.median = quantileOf(values, 0.5) * sign;
  summary.p95 = quantileOf(values, 0.95) * sign;
  summary.p99 = quantileOf(values, 0.99) * sign;
  summary.worst = quantileOf(values, 1) * sign;
  return summary;
}

std::vector<double> finiteOf(const Unit& unit, const Quantity& quantity) {
  std::vector<double> values;
  for (const MeasuredFrame& frame : unit.frames)
    if (const double value = quantity.of(frame); std::isfinite(value)) values.push_back(value);
  return values;
}

PairedRatio frameTimeRatio(const Unit& a, const Unit& b, double confidence) {
  std::vector<double> ones, ratios;
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    const MeasuredFrame& frame = a.frames[i];
    // Units of one run have the same rows.
    auto other = b.frames.begin() + static_cast<std::ptrdiff_t>(std::min(i, b.frames.size()));
    if (other == b.frames.end() || other->row != frame.row)
      other = std::find_if(b.frames.begin(), b.frames.end(),
                           [&](const MeasuredFrame& f) { return f.row == frame.row; });
    if (other == b.frames.end()) continue;
    const PairedRatio ratio = pairedRatio(frame.repeatsMs, other->repeatsMs);
    ones.push_back(1);
    ratios.push_back(ratio.median);
  }
  return pairedRatio(ones, ratios, confidence);
}

std::vector<Comparison> compareUnits(const std::vector<Unit>& units) {
  std::vector<Comparison> comparisons;
  const auto compare = [&](const Unit* a, const Unit& b) {
    if (a && a != &b) comparisons.push_back({a->name, b.name, frameTimeRatio(*a, b)});
  };
  for (const Unit& unit : units) {
    const auto first = std::find_if(units.begin(), units.end(), [&](const Unit& other) {
      return other.name.flight == unit.name.flight && other.name.method == unit.name.method;
    });
    compare(&*first, unit);
    compare(unitOf(units, {unit.name.flight, unit.name.preset, "view_frustum"}), unit);
  }
  return comparisons;
}

std::string toCsv(const Results& results) {
  std::string text = "flight,preset,case,row,time_s";
  for (const Quantity& quantity : quantities()) text += ',' + std::string(quantity.key);
  text += '\n';
  for (const Unit& unit : results.units)
    for (const MeasuredFrame& frame : unit.frames) {
      text += cellText(unit.name.flight) + ',' + cellText(unit.name.preset) + ',' +
              cellText(unit.name.method) + ',' + std::to_string(frame.row) + ',' + cellText(frame.timeS);
      for (const Quantity& quantity : quantities()) text += ',' + cellText(quantity.of(frame));
      text += '\n';
    }
  return text;
}

}  // namespace trimtab::harness
