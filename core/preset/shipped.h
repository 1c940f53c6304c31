#pragma once

#include <array>
#include <string_view>

namespace trimtab {

struct ShippedPreset {
  std::string_view name, text;
};

/// The files of presets/, in the order people choose from.
extern const std::array<ShippedPreset, 7> kShippedPresets;

}  // namespace trimtab
