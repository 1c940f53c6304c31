#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "link.h"
#include "trimtab/host/terrain_query.h"

namespace trimtab::link {

/// Answers what a host asks about the terrain, on a thread of its own: a long line of sight, or a block that
/// comes from the disk, must not hold up the receiver. The thread starts with the first question.
class TerrainDesk {
 public:
  TerrainDesk() = default;
  ~TerrainDesk();
  TerrainDesk(const TerrainDesk&) = delete;
  TerrainDesk& operator=(const TerrainDesk&) = delete;

  void setGround(std::shared_ptr<const GroundHeights> ground);
  /// Counts the questions and, if `mayAnswer`, has them answered. One that is to be answered every few frames
  /// replaces the one of the same kind and number, or ends it.
  void ask(const std::vector<TerrainQuery>& queries, bool mayAnswer);
  /// Appends to `message`, which holds the Start of Frame of frame `igFrame`, the answers in byte order
  /// `order` that are ready, as many as fit into one frame of Ethernet. Those that are due again are asked
  /// again.
  void takeAnswers(std::vector<std::byte>& message, std::uint32_t igFrame, ByteOrder order);
  Questions questions() const;

 private:
  using Key = std::pair<TerrainQuery::Kind, std::uint16_t>;
  struct Repeated {
    TerrainQuery query;
    std::uint32_t dueAt = 0;  ///< frame
  };
  struct Answer {
    ByteOrder order;
    std::vector<std::byte> packet;
  };
  void queue(const TerrainQuery& query);
  void run();

  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::shared_ptr<const GroundHeights> ground_;
  std::deque<TerrainQuery> waiting_;
  std::deque<Answer> ready_;
  std::map<Key, Repeated> repeated_;
  Questions questions_;
  std::uint32_t igFrame_ = 0;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace trimtab::link
