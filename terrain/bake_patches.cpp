#include "trimtab/terrain/bake_patches.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <system_error>
#include <thread>

#include "trimtab/terrain/import.h"
#include "trimtab/terrain/page_file.h"
#include "trimtab/terrain/patch_store.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMeasuredKey = std::uint64_t{1} << 32;
/// A page's buffers while it is built: heights of its rectangle and its meshes, several times.
constexpr std::size_t kBytesAPage = std::size_t{96} << 20;

/// What a piece keeps of a patch until all are there.
struct Measured {
  Box bounds;
  std::array<float, PatchIndex::kVariants> errorM;
  std::array<std::uint16_t, PatchIndex::kVariants> triangles;
  PatchFacts facts;
  NormalCone cone;
};
// No byte of the file is left to chance.
static_assert(std::is_trivially_copyable_v<Measured> && sizeof(Measured) == 36 + sizeof(PatchFacts) + 4);

Finding wrong(const fs::path& file, std::string expected, std::string found) {
  return {Severity::error, file.string(), "", std::move(expected), std::move(found)};
}

/// Posts that a page looks at: what it takes to make.
std::uint64_t workOf(const PatchIndex& index, const PatchIndex::Page& page) {
  const std::uint64_t side = std::uint64_t{index.squareCells(page.pair)} * index.pageSquares();
  const auto along = [&](std::uint32_t block, std::uint32_t posts) {
    const std::uint64_t from = block * side;
    return from < posts ? std::min<std::uint64_t>(side, posts - from) : 0;
  };
  return along(page.row, index.rows) * along(page.column, index.columns) + 1;
}

}  // namespace

PatchBake::PatchBake(const WorkFolder& work, const PostGrid& posts, const PostGeometry& geometry,
                     double leafM, std::uint64_t mostFine)
    : work_(work),
      posts_(posts),
      geometry_(geometry),
      index_(makePatchIndex(posts, geometry, leafCellsOf(posts, mostFine))),
      tolerances_(patchTolerances(index_, leafM)) {
  constexpr std::uint64_t kLeafPage = std::uint64_t{PatchIndex::kLeafPageCells} * PatchIndex::kLeafPageCells;
  std::uint64_t open = 0, left = 0;
  for (const PatchIndex::Page& page : index_.pages) left += workOf(index_, page);
  for (std::uint32_t page = 0; page < index_.pages.size(); ++page) {
    if (open == 0) firstPage_.push_back(page);
    const std::uint64_t pageWork = workOf(index_, index_.pages[page]);
    open += pageWork;
    left -= pageWork;
    // The last ones are small, so that no core has a long one left when the others are done.
    if (open >= std::clamp(left / 32, kLeafPage, 8 * kLeafPage)) open = 0;
  }
  firstPage_.push_back(static_cast<std::uint32_t>(index_.pages.size()));
}

fs::path PatchBake::pieceFile(std::uint32_t piece) const {
  return work_.pieces() / (std::to_string(piece) + ".pages");
}

std::vector<std::uint8_t> PatchBake::finished() const {
  std::vector<std::uint8_t> all(pieces());
  for (std::uint32_t piece = 0; piece < pieces(); ++piece)
    if (const auto file = PageFile::open(pieceFile(piece)))
      all[piece] = (*file)->size() == firstPage_[piece + 1] - firstPage_[piece] + 1 ? 1 : 0;
  return all;
}

Result<Done> PatchBake::makePiece(const HeightSource& heights, std::uint32_t piece,
                                  const std::function<bool()>& carryOn) const {
  auto writer = PageFileWriter::create(pieceFile(piece));
  if (!writer) return writer.findings();
  std::vector<Measured> all;
  for (std::uint32_t page = firstPage_[piece]; page < firstPage_[piece + 1]; ++page) {
    const BuiltPage built = buildPage(index_, page, heights, geometry_, tolerances_, carryOn);
    if (!carryOn()) return cancelled("building patches");
    const std::vector<std::byte> blob = encodePage(built.meshes, geometry_);
    std::uint64_t vertices = 0;
    for (const PatchMesh& mesh : built.meshes.patches) vertices += mesh.vertices.size() + 1;
    for (std::size_t p = 0; p < built.meshes.patches.size(); ++p) {
      const PatchMesh& mesh = built.meshes.patches[p];
      Measured m{built.bounds[p], built.errorM[p], {}, built.facts[p], built.cones[p]};
      for (std::size_t v = 0; v < PatchIndex::kVariants; ++v)
        m.triangles[v] = static_cast<std::uint16_t>((mesh.firstIndex[v + 1] - mesh.firstIndex[v]) / 3);
      m.facts.vertices = static_cast<std::uint32_t>(mesh.vertices.size());
      // Patches of a page are packed together: its bytes by their vertices.
      m.facts.bytes = static_cast<std::uint32_t>(blob.size() * (mesh.vertices.size() + 1) / vertices);
      all.push_back(m);
    }
    if (auto added = (*writer)->add(page, blob); !added) return added;
  }
  if (heights.failed()) return unreadable("heights");
  if (auto added = (*writer)->add(kMeasuredKey, std::as_bytes(std::span(all))); !added) return added;
  return (*writer)->finish();
}

Result<Done> PatchBake::make(const HeightSource& heights, std::uint32_t part, std::uint32_t parts,
                             std::size_t memory, const Progress& progress) const {
  const auto there = finished();
  std::vector<std::uint32_t> missing;
  std::uint64_t allWork = 0;
  const auto pieceWork = [&](std::uint32_t piece) {
    std::uint64_t sum = 0;
    for (std::uint32_t page = firstPage_[piece]; page < firstPage_[piece + 1]; ++page)
      sum += workOf(index_, index_.pages[page]);
    return sum;
  };
  for (std::uint32_t piece = part; piece < pieces(); piece += parts)
    if (!there[piece]) {
      missing.push_back(piece);
      allWork += pieceWork(piece);
    }
  const std::string what = "building patches";
  if (progress && !progress(0, what)) return cancelled(what);
  std::mutex mutex;
  std::condition_variable ended;
  Findings findings;
  std::size_t next = 0, working = 0;
  std::uint64_t doneWork = 0;
  std::atomic<bool> stop{false};
  const auto build = [&] {
    std::unique_lock lock(mutex);
    while (!stop && findings.empty() && next < missing.size()) {
      const std::uint32_t piece = missing[next++];
      lock.unlock();
      const auto made = [&]() -> Result<Done> {
        try {
          return makePiece(heights, piece, [&] { return !stop; });
        } catch (const std::exception& thrown) {
          return wrong(pieceFile(piece), "room in memory for " + what, thrown.what());
        }
      }();
      lock.lock();
      findings.insert(findings.end(), made.findings().begin(), made.findings().end());
      doneWork += pieceWork(piece);
    }
    --working;
    ended.notify_one();
  };
  const std::size_t threads = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1,
                                                      std::max<std::size_t>(1, memory / kBytesAPage));
  std::vector<std::thread> workers;
  workers.reserve(threads);
  try {
    while (workers.size() < threads) {
      {
        const std::lock_guard lock(mutex);
        ++working;
      }
      workers.emplace_back(build);
    }
  } catch (const std::system_error& thrown) {
    // Fewer threads do it too.
    const std::lock_guard lock(mutex);
    --working;
    if (workers.empty()) findings.push_back(wrong(work_.pieces(), "a thread for " + what, thrown.what()));
  }
  {
    std::unique_lock lock(mutex);
    while (working > 0) {
      ended.wait_for(lock, std::chrono::milliseconds(50));
      const double share = allWork > 0 ? static_cast<double>(doneWork) / static_cast<double>(allWork) : 1;
      lock.unlock();
      const bool goOn = !progress || progress(share, what);
      lock.lock();
      stop = stop || !goOn;
    }
  }
  for (std::thread& worker : workers) worker.join();
  if (stop) return cancelled(what);
  if (!findings.empty()) return findings;
  return Done{};
}

Result<Done> PatchBake::join(const fs::path& file, const Progress& progress) {
  auto writer = PageFileWriter::create(file);
  if (!writer) return writer.findings();
  std::vector<Box> bounds;
  std::vector<std::array<float, PatchIndex::kVariants>> errorM;
  std::vector<std::array<std::uint16_t, PatchIndex::kVariants>> triangles;
  std::vector<PatchFacts> facts;
  index_.cones.clear();
  for (std::uint32_t piece = 0; piece < pieces(); ++piece) {
    if (progress && !progress(static_cast<double>(piece) / pieces(), "joining patches"))
      return cancelled("joining patches");
    const auto made = PageFile::open(pieceFile(piece));
    if (!made) return made.findings();
    // A damaged piece is made again next time.
    const auto damaged = [&](Findings findings) {
      std::error_code ignored;
      fs::remove(pieceFile(piece), ignored);
      findings.push_back(wrong(pieceFile(piece), "a sound piece", "a damaged one, removed: bake again"));
      return findings;
    };
    for (std::uint32_t page = firstPage_[piece]; page < firstPage_[piece + 1]; ++page) {
      const auto blob = (*made)->read(page);
      if (!blob) return damaged(blob.findings());
      if (auto added = (*writer)->add(page, *blob); !added) return added;
    }
    const auto measured = (*made)->read(kMeasuredKey);
    if (!measured) return damaged(measured.findings());
    for (std::size_t at = 0; at + sizeof(Measured) <= measured->size(); at += sizeof(Measured)) {
      Measured m;
      std::memcpy(&m, measured->data() + at, sizeof m);
      bounds.push_back(m.bounds);
      errorM.push_back(m.errorM);
      triangles.push_back(m.triangles);
      facts.push_back(m.facts);
      index_.cones.push_back(m.cone);
    }
  }
  if (facts.size() != index_.size())
    return wrong(work_.pieces(), std::to_string(index_.size()) + " patches", std::to_string(facts.size()));
  finishPatchIndex(index_, bounds, errorM, triangles);
  return finishPatchFile(**writer, posts_, index_, facts);
}

}  // namespace trimtab::terrain
