#pragma once

#include <gtest/gtest.h>

#include "trimtab/rig/ig_profile.h"

namespace trimtab::test {

/// An image generator as others are: a LOD scale, and a far distance in kilometres.
inline constexpr const char* kViewer = R"({
  "format": "trimtab-ig-profile", "version": 1, "name": "viewer", "settle_images": 0,
  "levers": {
    "far_distance": {"key": "zFar", "unit": "km", "factor": 0.001, "from": 5, "to": 80, "neutral": 80},
    "lod_scale": {"key": "LODScale", "from": 1, "to": 8, "neutral": 1}
  }
})";

inline IgProfile viewer() {
  const Result<IgProfile> profile = parseIgProfile(kViewer, "viewer.json");
  EXPECT_TRUE(profile.ok()) << toString(profile.findings());
  return *profile;
}

}  // namespace trimtab::test
