#include "trimtab/terrain/format/pager.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "trimtab/terrain/grid/background_thread.h"

namespace trimtab::terrain {
namespace {

/// Decoded pages that nobody has taken yet: reading waits beyond so many bytes.
constexpr std::size_t kMostAhead = 64u << 20;
constexpr std::size_t kMostFindings = 20;

class ThreadedPager final : public Pager {
 public:
  explicit ThreadedPager(std::shared_ptr<const PatchTerrain> terrain)
      : terrain_(std::move(terrain)), pages_(terrain_->index().pages.size()) {
    // Pictures need a core of their own.
    const unsigned count = std::thread::hardware_concurrency() > 2 ? 2 : 1;
    for (unsigned i = 0; i < count; ++i) threads_.emplace_back([this] { run(); });
  }
  ~ThreadedPager() override {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    work_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  void want(std::span<const PageWant> pages) override {
    std::vector<PageWant> sorted(pages.begin(), pages.end());
    std::sort(sorted.begin(), sorted.end(), [](const PageWant& a, const PageWant& b) {
      return a.errorPx != b.errorPx ? a.errorPx > b.errorPx : a.page < b.page;
    });
    std::vector<std::shared_ptr<const PatchPage>> unwanted;  // freed after the lock is
    {
      const std::lock_guard lock(mutex_);
      ++wantNumber_;
      for (const PageWant& want : sorted) pages_[want.page].wanted = wantNumber_;
      wanted_.swap(sorted);
      next_ = 0;
      std::erase_if(arrived_, [&](Arrived& a) {
        if (pages_[a.page->page].wanted == wantNumber_) return false;
        forget(a);
        unwanted.push_back(std::move(a.page));
        return true;
      });
    }
    work_.notify_all();
  }

  std::vector<std::shared_ptr<const PatchPage>> takeArrived(std::size_t mostBytes) override {
    std::vector<std::shared_ptr<const PatchPage>> taken;
    {
      const std::lock_guard lock(mutex_);
      std::size_t bytes = 0, count = 0;
      for (; count < arrived_.size(); ++count) {
        Arrived& a = arrived_[count];
        if (count > 0 && bytes + a.bytes > mostBytes) break;
        bytes += a.bytes;
        forget(a);
        pages_[a.page->page].wanted = 0;
        taken.push_back(std::move(a.page));
      }
      arrived_.erase(arrived_.begin(), arrived_.begin() + static_cast<std::ptrdiff_t>(count));
    }
    if (!taken.empty()) work_.notify_all();
    return taken;
  }

  void waitFor(std::span<const std::uint32_t> pages) override {
    std::unique_lock lock(mutex_);
    urgent_.assign(pages.begin(), pages.end());
    work_.notify_all();
    // A thread that waits may as well read.
    while (const auto page = nextUrgent()) read(*page, lock);
    done_.wait(lock, [&] {
      return std::none_of(pages.begin(), pages.end(),
                          [&](std::uint32_t page) { return pages_[page].state == State::reading; });
    });
    urgent_.clear();
  }

  Counters counters() const override {
    const std::lock_guard lock(mutex_);
    Counters counters = counters_;
    for (const PageWant& want : wanted_) {
      const Page& page = pages_[want.page];
      counters.waiting += page.wanted == wantNumber_ && page.state != State::failed;
    }
    return counters;
  }

  bool hasFailed(std::uint32_t page) const override {
    const std::lock_guard lock(mutex_);
    return pages_[page].state == State::failed;
  }

  Findings failures() const override {
    const std::lock_guard lock(mutex_);
    return failures_;
  }

 private:
  enum class State : std::uint8_t { idle, reading, arrived, failed };
  struct Page {
    State state = State::idle;
    std::uint32_t wanted = 0;  ///< number of the last call of `want` that named it; 0 once it was taken
  };
  struct Arrived {
    std::shared_ptr<const PatchPage> page;
    std::size_t bytes = 0;
  };

  void forget(const Arrived& arrived) {
    pages_[arrived.page->page].state = State::idle;
    aheadBytes_ -= arrived.bytes;
  }

  std::optional<std::uint32_t> nextUrgent() const {
    for (const std::uint32_t page : urgent_)
      if (pages_[page].state == State::idle) return page;
    return {};
  }
  std::optional<std::uint32_t> nextPage() {
    if (const auto page = nextUrgent()) return page;
    if (aheadBytes_ >= kMostAhead) return {};
    while (next_ < wanted_.size()) {
      const std::uint32_t page = wanted_[next_++].page;
      if (pages_[page].state == State::idle && pages_[page].wanted == wantNumber_) return page;
    }
    return {};
  }

  void run() {
    giveWayToPictures();
    std::unique_lock lock(mutex_);
    while (!stop_) {
      if (const auto page = nextPage())
        read(*page, lock);
      else
        work_.wait(lock);
    }
  }

  /// Unlocked while it waits for the disk.
  void read(std::uint32_t number, std::unique_lock<std::mutex>& lock) {
    pages_[number].state = State::reading;
    lock.unlock();
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    Result<PatchPage> result = readGuarded(number);
    std::shared_ptr<const PatchPage> page;
    std::size_t bytes = 0;
    if (result) {
      page = std::make_shared<const PatchPage>(std::move(result).value());
      bytes = page->bytes();
    }
    const double tookMs = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    const std::uint64_t fileBytes = terrain_->pageBytes(number);
    lock.lock();
    counters_.longestReadMs = std::max(counters_.longestReadMs, tookMs);
    Page& state = pages_[number];
    if (!page) {
      state.state = State::failed;
      ++counters_.failed;
      for (const Finding& finding : result.findings())
        if (failures_.size() < kMostFindings) failures_.push_back(finding);
    } else {
      ++counters_.pagesRead;
      counters_.bytesRead += fileBytes;
      const bool stillWanted =
          state.wanted == wantNumber_ || std::find(urgent_.begin(), urgent_.end(), number) != urgent_.end();
      state.state = stillWanted ? State::arrived : State::idle;
      if (stillWanted) {
        aheadBytes_ += bytes;
        arrived_.push_back({std::move(page), bytes});
      }
    }
    done_.notify_all();
  }

  Result<PatchPage> readGuarded(std::uint32_t number) const {
    const auto failed = [&](const char* what) {
      return Finding{Severity::error, "page " + std::to_string(number), "", "a page that can be read", what};
    };
    try {
      Result<PatchPage> page = terrain_->readPage(number);
      if (page && (page->page != number || page->patches.size() != terrain_->index().pages[number].patches))
        return failed("another page");
      return page;
    } catch (const std::exception& e) {
      return failed(e.what());
    }
  }

  const std::shared_ptr<const PatchTerrain> terrain_;
  mutable std::mutex mutex_;
  std::condition_variable work_, done_;
  std::vector<Page> pages_;
  std::vector<PageWant> wanted_;  ///< the most urgent first
  std::size_t next_ = 0;          ///< of wanted_: those before are not idle, or were not
  std::vector<std::uint32_t> urgent_;
  std::vector<Arrived> arrived_;
  std::size_t aheadBytes_ = 0;
  std::uint32_t wantNumber_ = 0;
  Counters counters_;
  Findings failures_;
  bool stop_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace

std::unique_ptr<Pager> Pager::start(std::shared_ptr<const PatchTerrain> terrain) {
  return std::make_unique<ThreadedPager>(std::move(terrain));
}

}  // namespace trimtab::terrain
