#include "terrain_desk.h"

namespace trimtab::link {
namespace {

/// More questions at once are dropped and counted; at 60 Hz they would wait for seconds.
constexpr std::size_t kMostWaiting = 4096;
/// What one frame of Ethernet holds beside the headers of IP and UDP.
constexpr std::size_t kMostBytes = 1472;

}  // namespace

TerrainDesk::~TerrainDesk() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  news_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void TerrainDesk::setGround(std::shared_ptr<const GroundHeights> ground) {
  const std::lock_guard lock(mutex_);
  ground_ = std::move(ground);
}

/// Call it with the mutex held.
void TerrainDesk::queue(const TerrainQuery& query) {
  if (waiting_.size() + ready_.size() >= kMostWaiting) {
    ++questions_.dropped;
    return;
  }
  waiting_.push_back(query);
  if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
}

void TerrainDesk::ask(const std::vector<TerrainQuery>& queries, bool mayAnswer) {
  {
    const std::lock_guard lock(mutex_);
    questions_.asked += queries.size();
    if (!mayAnswer) return;
    for (const TerrainQuery& query : queries) {
      const Key key{query.kind, query.id};
      if (query.everyFrame == 0)
        repeated_.erase(key);
      else if (repeated_.size() < kMostWaiting || repeated_.contains(key))
        repeated_[key] = {query, igFrame_ + query.everyFrame};
      queue(query);
    }
  }
  news_.notify_one();
}

void TerrainDesk::takeAnswers(std::vector<std::byte>& message, std::uint32_t igFrame, ByteOrder order) {
  bool again = false;
  {
    const std::lock_guard lock(mutex_);
    igFrame_ = igFrame;
    for (; !ready_.empty() && message.size() + ready_.front().packet.size() <= kMostBytes;
         ready_.pop_front()) {
      const Answer& answer = ready_.front();
      // A host that changed its byte order has been replaced by another one, which did not ask.
      if (answer.order != order) continue;
      message.insert(message.end(), answer.packet.begin(), answer.packet.end());
      ++questions_.answered;
    }
    for (auto& [key, each] : repeated_) {
      if (static_cast<std::int32_t>(igFrame - each.dueAt) < 0) continue;
      each.dueAt = igFrame + each.query.everyFrame;
      queue(each.query);
      again = true;
    }
  }
  if (again) news_.notify_one();
}

Questions TerrainDesk::questions() const {
  const std::lock_guard lock(mutex_);
  return questions_;
}

void TerrainDesk::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    news_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (ends_) return;
    const TerrainQuery query = waiting_.front();
    waiting_.pop_front();
    const std::shared_ptr<const GroundHeights> ground = ground_;
    lock.unlock();
    Answer answer{query.order, answerOf(query, ground.get())};
    lock.lock();
    ready_.push_back(std::move(answer));
  }
}

}  // namespace trimtab::link
