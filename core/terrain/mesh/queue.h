#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace trimtab::terrain {

/// Orders triangles by falling error in eight buckets per octave, as lists through flat arrays. Within a
/// bucket the last one put comes first. Greedy insertion gives as good a mesh as with an exact order, and no
/// heap has to be kept.
class ErrorQueue {
 public:
  /// Empties the queue. Errors below `least` share the lowest bucket.
  void begin(double least) {
    base_ = keyOf(least);
    heads_.assign(kBuckets, -1);
    std::fill_n(links_.begin(), used_, Link{-1, -1, -1});
    used_ = 0;
    top_ = -1;
  }
  void put(std::int32_t t, double error) {
    if (static_cast<std::size_t>(t) >= links_.size()) links_.resize(grown(t), Link{-1, -1, -1});
    const std::int32_t bucket = std::clamp(keyOf(error) - base_, 0, kBuckets - 1);
    used_ = std::max(used_, t + 1);
    Link& link = links_[static_cast<std::size_t>(t)];
    std::int32_t& head = heads_[static_cast<std::size_t>(bucket)];
    link = {head, -1, bucket};
    if (head >= 0) links_[static_cast<std::size_t>(head)].before = t;
    head = t;
    top_ = std::max(top_, bucket);
  }
  /// Removes a triangle; does nothing if it is not in the queue.
  void remove(std::int32_t t) {
    if (static_cast<std::size_t>(t) >= links_.size()) return;
    Link& link = links_[static_cast<std::size_t>(t)];
    if (link.bucket < 0) return;
    if (link.before >= 0)
      links_[static_cast<std::size_t>(link.before)].next = link.next;
    else
      heads_[static_cast<std::size_t>(link.bucket)] = link.next;
    if (link.next >= 0) links_[static_cast<std::size_t>(link.next)].before = link.before;
    link.bucket = -1;
  }
  /// Returns a triangle of the worst bucket and keeps it; -1 if the queue is empty.
  std::int32_t top() {
    while (top_ >= 0 && heads_[static_cast<std::size_t>(top_)] < 0) --top_;
    return top_ < 0 ? -1 : heads_[static_cast<std::size_t>(top_)];
  }

 private:
  struct Link {
    std::int32_t next, before, bucket;
  };
  static constexpr int kBuckets = 512;  ///< 64 octaves above the least
  static std::int32_t keyOf(double error) {
    return static_cast<std::int32_t>(std::bit_cast<std::uint64_t>(error) >> 49);
  }
  std::size_t grown(std::int32_t t) const {
    return std::max<std::size_t>(static_cast<std::size_t>(t) + 1, links_.size() * 2 + 64);
  }
  std::int32_t base_ = 0, top_ = -1, used_ = 0;
  std::vector<std::int32_t> heads_;
  std::vector<Link> links_;
};

}  // namespace trimtab::terrain
