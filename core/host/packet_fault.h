#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "trimtab/host/byte_order.h"
#include "trimtab/units/result.h"

namespace trimtab {

/// The first thing that is wrong with a packet.
struct PacketFault {
  std::size_t offset = 0;  ///< bytes from the start of the datagram
  std::string field, expected, found;
  std::string remedy{};  ///< what to do about it, where that does not follow from what was expected
};

/// "byte 16: latitude: expected -90..90 deg, found 123.4 deg"
std::string toString(const PacketFault& fault);
/// Returns the same as a warning about a sender, with the remedy after what was found.
Finding toFinding(const PacketFault& fault, const std::string& from);

/// Reads fields and keeps the first one that is not a number or out of range; reading goes on, with 0 in its
/// place.
class FieldReader {
 public:
  FieldReader(std::span<const std::byte> bytes, ByteOrder order) : bytes_(bytes), order_(order) {}

  template <class T>
  T raw(std::size_t offset) const {
    return wire::get<T>(bytes_, offset, order_);
  }
  /// A float or double that, times `scale`, must lie in lowest..highest `unit`; returns the scaled number.
  template <class T>
  double number(std::size_t offset, const char* field, double lowest, double highest, const char* unit,
                double scale = 1) {
    const double value = static_cast<double>(raw<T>(offset)) * scale;
    if (value >= lowest && value <= highest) return value;
    if (!fault_) refuse(offset, field, lowest, highest, unit, value);
    return 0;
  }
  const std::optional<PacketFault>& fault() const { return fault_; }

 private:
  void refuse(std::size_t offset, const char* field, double lowest, double highest, const char* unit,
              double value);

  std::span<const std::byte> bytes_;
  ByteOrder order_;
  std::optional<PacketFault> fault_;
};

}  // namespace trimtab
