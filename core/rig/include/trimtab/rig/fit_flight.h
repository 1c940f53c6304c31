#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/frame/frame_request.h"
#include "trimtab/rig/ig_fit.h"

/// Flies a fit: draws each view of a flight with every lever neutral, and once for each setting of each
/// lever.
namespace trimtab {

class FitFlight {
 public:
  explicit FitFlight(IgProfile profile);
  FitFlight(const FitFlight&) = delete;  // settings point into the profile

  /// Sets the levers that the next image is to be drawn with: those of the preset, but the profile's are
  /// neutral and one of them at a setting. All steps of the chain before the last are neutral.
  void setLevers(FrameRequest& request) const;
  /// Reports whether the next image is to be of the same view as the last.
  bool staysInView() const { return inView_ > 0; }
  /// Reports whether the next image is one whose picture counts.
  bool wantsPicture() const;
  /// Takes the image that was drawn, RGBA8 in rows without gaps. Call it before finished(); it is ignored for
  /// images that do not count. Images of one view have one size.
  void picture(std::span<const std::uint8_t> rgba, int width, int height);
  /// Takes what the image with the levers of setLevers() cost. `load` is loadOf() of it.
  void finished(const FrameRequest& drawn, const FrameCost& cost, double load);

  /// Returns how many views are complete.
  std::size_t views() const { return neutral_.ms.size(); }
  /// Returns how many images one view takes.
  std::size_t imagesPerView() const;
  /// Returns what the complete views say. Refuses a flight without one, and one whose load or time nobody
  /// reported.
  Result<IgFit> result() const;

 private:
  /// What one setting did, view by view.
  struct Setting {
    const IgLever* lever = nullptr;  ///< null: all are neutral
    double value = 0;
    std::vector<double> ms, load, flip, shiftPx;
  };
  struct Seen {
    std::vector<std::uint8_t> rgba;
    int width = 0, height = 0;
  };
  struct Taken {
    double ms = 0, load = 0;
    Seen seen;
  };

  const Setting& settingAt(std::size_t turn) const;
  std::size_t numberAt(std::size_t turn) const;
  std::size_t perSetting() const;  ///< images
  void completeView();
  LoadShape shape() const;
  double neutralPx() const;

  IgProfile profile_;
  Setting neutral_;
  std::vector<Setting> settings_;
  std::vector<Taken> taken_;  ///< of this view: neutral, then by setting
  std::size_t inView_ = 0;    ///< images drawn of this view
  CostModel cost_;
};

}  // namespace trimtab
