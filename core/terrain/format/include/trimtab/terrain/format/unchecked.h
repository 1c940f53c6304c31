#pragma once

#include <atomic>

namespace trimtab::terrain {

/// A database that is opened while one of these lives uses bytes without comparing them with their checksums,
/// so that a benchmark can measure what the comparison costs (tests/bench/trust_bench.cpp). No program and no
/// option makes one: damage would reach an image without a word.
class Unchecked {
 public:
  Unchecked() { ++living(); }
  ~Unchecked() { --living(); }
  Unchecked(const Unchecked&) = delete;
  Unchecked& operator=(const Unchecked&) = delete;
  static bool any() { return living().load(std::memory_order_relaxed) > 0; }

 private:
  static std::atomic<int>& living() {
    static std::atomic<int> count{0};
    return count;
  }
};

}  // namespace trimtab::terrain
