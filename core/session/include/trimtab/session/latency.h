#pragma once

#include <vector>

#include "trimtab/measure/statistics.h"

namespace trimtab {

/// Latencies of the newest packets and images, milliseconds.
struct Latency {
  SampleWindow decoded{4096};  ///< from the kernel's time stamp to the decoded state
  SampleWindow shown{
      4096};  ///< from the kernel's time stamp of the packet that an image shows, to that image
  /// As `shown`, also for packets that a newer one overtook: to the image that shows the newer one.
  SampleWindow every{4096};
  SampleWindow frame{4096};  ///< from the request of an image that shows a packet to its end
};

/// Follows packets from the kernel to the image that shows them. Times are seconds of one clock.
class LatencyMeter {
 public:
  void decoded(double kernelTime, double decodedTime) {
    latency_.decoded.add((decodedTime - kernelTime) * 1e3);
  }
  /// Remembers a packet that no image shows yet. A time that is not a number is a state that no packet
  /// brought.
  void arrived(double kernelTime);
  /// Notes that the image that is requested at `now` shows every packet so far.
  void requested(double now);
  void finished(double now);
  /// Notes that no image will show what has arrived.
  void dropped();
  const Latency& latency() const { return latency_; }

 private:
  Latency latency_;
  std::vector<double> waiting_,
      inPicture_;  ///< kernel times of packets that no image, or the requested one, shows
  double requestedAt_ = 0;
};

}  // namespace trimtab
