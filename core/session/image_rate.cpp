#include "trimtab/session/image_rate.h"

#include <algorithm>

namespace trimtab {

void ImageRate::add(double now) {
  const std::size_t size = times_.size();
  const auto ago = [&](std::size_t images) { return times_[(next_ + size - images) % size]; };
  if (count_ > 0 && !(now > ago(1))) count_ = 0;
  count_ = std::min(count_, size - 1);
  while (count_ > 0 && !(now - ago(count_) <= kWindowS)) --count_;
  times_[next_] = now;
  next_ = (next_ + 1) % size;
  ++count_;
}

std::optional<double> ImageRate::perS() const {
  if (count_ < 2) return std::nullopt;
  const std::size_t size = times_.size();
  const double newest = times_[(next_ + size - 1) % size], oldest = times_[(next_ + size - count_) % size];
  return static_cast<double>(count_ - 1) / (newest - oldest);
}

}  // namespace trimtab
