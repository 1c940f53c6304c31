#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace trimtab::terrain {

/// Triangles by falling error, eight buckets an octave: lists through flat arrays, no order within a bucket
/// but that of insertion, last first. Greedy insertion loses nothing by it and no heap has to be kept.
class ErrorQueue {
 public:
  /// Empties it for errors from `least` up; what is smaller shares the lowest bucket.
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
  /// Of a triangle that may not be there.
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
  /// One of the worst, which stays; -1: none is left.
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
