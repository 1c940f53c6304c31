#pragma once

#include <cstddef>
#include <span>

#include "cigi3.h"

namespace trimtab::cigi3 {

/// Reads the request at `at` (ICD 4.1.24 to 4.1.26), which has its full size. Points relative to the own
/// aircraft become places on earth; a request that means no place stays without one, so that its host is
/// told.
TerrainQuery readTerrainQuery(std::span<const std::byte> datagram, std::size_t at, const Message& message,
                              const Session& session, const Follow& follow);

}  // namespace trimtab::cigi3
