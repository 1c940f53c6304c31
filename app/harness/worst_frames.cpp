#include "worst_frames.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "heat_colour.h"
#include "trimtab/scene/offscreen.h"

namespace trimtab::harness {
namespace {

std::string plain(const std::string& name) {
  std::string text;
  for (const char c : name)
    text += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' ? c : '_';
  return text;
}

}  // namespace

std::vector<WorstFrame> worstFrames(const Unit& unit, std::size_t number, std::size_t most) {
  std::vector<WorstFrame> worst;
  for (const auto& [key, why] :
       {std::pair{"flip", "largest FLIP"}, std::pair{"geometric_max_px", "largest geometric error"},
        std::pair{"frame_ms", "longest frame"}}) {
    const Quantity& quantity = *quantityOf(key);
    std::size_t at = unit.frames.size();
    double largest = 0;
    for (std::size_t i = 0; i < unit.frames.size(); ++i)
      if (const double value = quantity.of(unit.frames[i]); value > largest) {
        at = i;
        largest = value;
      }
    if (at == unit.frames.size()) continue;
    const auto same =
        std::find_if(worst.begin(), worst.end(), [at](const WorstFrame& w) { return w.frame == at; });
    if (same != worst.end())
      same->why += std::string(", ") + why;
    else if (worst.size() < most)
      worst.push_back({at, why, {}, {}, {}});
  }
  for (WorstFrame& w : worst) namePictures(w, unit, number);
  return worst;
}

void namePictures(WorstFrame& worst, const Unit& unit, std::size_t number) {
  // Names that differ in their punctuation alone are told apart by the number.
  const std::string name = std::to_string(number) + '-' + plain(unit.name.flight) + '-' +
                           plain(unit.name.preset) + '-' + plain(unit.name.method) + '-' +
                           std::to_string(unit.frames[worst.frame].row);
  worst.reference = name + "-reference.png";
  worst.ours = name + "-ours.png";
  worst.difference = name + "-difference.png";
}

bool havePictures(const WorstFrame& worst, const std::filesystem::path& folder) {
  std::error_code absent;
  for (const std::string& name : {worst.reference, worst.ours, worst.difference})
    if (!std::filesystem::exists(folder / name, absent)) return false;
  return true;
}

Result<Done> writePictures(const WorstFrame& worst, const scene::ErrorPictures& pictures,
                           const std::filesystem::path& folder) {
  const auto write = [&](const std::string& name, std::span<const std::uint8_t> rgba) {
    return scene::writePng(folder / name, rgba, pictures.widthPx, pictures.heightPx);
  };
  if (auto done = write(worst.reference, pictures.reference); !done) return done;
  if (auto done = write(worst.ours, pictures.ours); !done) return done;
  return write(worst.difference, heatPixels(pictures.flip));
}

}  // namespace trimtab::harness
