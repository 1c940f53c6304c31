#include "worst_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "trimtab/scene/offscreen.h"

namespace trimtab::harness {
namespace {

constexpr int kWidthsPx[]{640, 480, 320};
constexpr std::size_t kRoomBytes = 12'000'000;

/// Means of the pixels that each smaller one covers.
scene::RgbaPicture scaled(const scene::RgbaPicture& picture, int widthPx) {
  if (picture.widthPx <= widthPx) return picture;
  const int heightPx = std::max(
      1, static_cast<int>(std::lround(static_cast<double>(picture.heightPx) * widthPx / picture.widthPx)));
  scene::RgbaPicture out{widthPx, heightPx, {}};
  out.rgba.reserve(static_cast<std::size_t>(widthPx) * static_cast<std::size_t>(heightPx) * 4);
  const auto from = [](int i, int all, int of) {
    return static_cast<int>(static_cast<std::int64_t>(i) * of / all);
  };
  for (int y = 0; y < heightPx; ++y)
    for (int x = 0; x < widthPx; ++x) {
      const int x0 = from(x, widthPx, picture.widthPx), y0 = from(y, heightPx, picture.heightPx);
      const int x1 = std::max(x0 + 1, from(x + 1, widthPx, picture.widthPx));
      const int y1 = std::max(y0 + 1, from(y + 1, heightPx, picture.heightPx));
      for (int c = 0; c < 4; ++c) {
        int sum = 0;
        for (int v = y0; v < y1; ++v)
          for (int u = x0; u < x1; ++u)
            sum += picture.rgba[static_cast<std::size_t>((v * picture.widthPx + u) * 4 + c)];
        const int count = (x1 - x0) * (y1 - y0);
        out.rgba.push_back(static_cast<std::uint8_t>((sum + count / 2) / count));
      }
    }
  return out;
}

bool leadsAway(const std::filesystem::path& name) {
  return name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end();
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) -> std::uint32_t {
      return i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u;
    };
    const std::uint32_t three = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

WorstPictures::Picture load(const std::filesystem::path& folder, const std::string& name, int widthPx) {
  if (name.empty()) return {{}, "no picture was kept"};
  if (leadsAway(name)) return {{}, name + ": it is no file of this folder"};
  const auto picture = scene::readPng(folder / name);
  if (!picture) return {{}, name + ": " + picture.findings()[0].found};
  const scene::RgbaPicture small = scaled(*picture, widthPx);
  const auto png = scene::encodePng(small.rgba, small.widthPx, small.heightPx);
  if (!png) return {{}, name + ": " + png.findings()[0].found};
  return {base64(*png), {}, small.widthPx, small.heightPx};
}

}  // namespace

WorstPictures::WorstPictures(const Results& results, const std::filesystem::path& folder) {
  for (const int width : kWidthsPx) {
    widthPx_ = width;
    read(results, folder);
    if (bytes_ <= kRoomBytes) return;
  }
}

void WorstPictures::read(const Results& results, const std::filesystem::path& folder) {
  pictures_.clear();
  indices_.clear();
  bytes_ = 0;
  for (const Unit& unit : results.units)
    for (const WorstFrame& worst : unit.worst)
      for (const std::string& name : {worst.reference, worst.ours, worst.difference})
        if (!indices_.contains(name)) add(folder, name);
}

void WorstPictures::add(const std::filesystem::path& folder, const std::string& name) {
  Picture picture = load(folder, name, widthPx_);
  const auto twin = std::find_if(pictures_.begin(), pictures_.end(), [&](const Picture& other) {
    return other.base64 == picture.base64 && other.problem == picture.problem;
  });
  indices_[name] = static_cast<std::size_t>(twin - pictures_.begin());
  if (twin != pictures_.end()) return;
  bytes_ += picture.base64.size();
  pictures_.push_back(std::move(picture));
}

}  // namespace trimtab::harness
