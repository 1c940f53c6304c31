#pragma once

namespace trimtab {

/// Reaches from `low` to `high`, both included.
struct Range {
  double low = 0, high = 0;
};

}  // namespace trimtab
