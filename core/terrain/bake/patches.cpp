#include "patches.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>

#include "trimtab/terrain/format/page_file.h"
#include "trimtab/terrain/format/patch_bytes.h"
#include "trimtab/terrain/format/patch_layout.h"
#include "trimtab/terrain/format/patch_store.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMeasuredKey = std::uint64_t{1} << 32;
/// A page's buffers while it is built: heights of its rectangle and its meshes, several times.
constexpr std::size_t kBytesAPage = std::size_t{96} << 20;

/// Holds what a piece keeps of its patches until all are there.
struct Measured {
  std::vector<Box> bounds;
  VariantTable<float> errorM;
  VariantTable<std::uint16_t> triangles;
  std::vector<PatchFacts> facts;
  std::vector<NormalCone> cones;

  Measured(std::size_t variants, std::size_t patches)
      : bounds(patches),
        errorM(variants, patches),
        triangles(variants, patches),
        facts(patches),
        cones(patches) {}
  std::size_t bytes() const {
    return bounds.size() * (sizeof(Box) + sizeof(NormalCone) + factBytes(errorM.variants()) +
                            errorM.variants() * (sizeof(float) + sizeof(std::uint16_t)));
  }
  void write(PatchBytesWriter& out) const {
    out.add(std::span(bounds));
    out.add(errorM.values());
    out.add(triangles.values());
    out.add(facts, errorM.variants());
    out.add(std::span(cones));
  }
  void read(PatchBytesReader& in, std::size_t first, std::size_t patches) {
    in.take(std::span(bounds).subspan(first, patches));
    in.take(errorM.values(first, patches));
    in.take(triangles.values(first, patches));
    in.take(std::span(facts).subspan(first, patches), errorM.variants());
    in.take(std::span(cones).subspan(first, patches));
  }
};

Finding wrong(const fs::path& file, std::string expected, std::string found) {
  return {Severity::error, file.string(), "", std::move(expected), std::move(found)};
}

/// Counts the patches of all pages before one; of all pages if there is none of that number.
std::size_t patchesBefore(const PatchIndex& index, std::uint32_t page) {
  return page < index.pages.size() ? index.pages[page].firstPatch : index.size();
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
  Measured all(index_.variants(),
               patchesBefore(index_, firstPage_[piece + 1]) - patchesBefore(index_, firstPage_[piece]));
  std::size_t next = 0;
  for (std::uint32_t page = firstPage_[piece]; page < firstPage_[piece + 1]; ++page) {
    const BuiltPage built = buildPage(index_, page, heights, geometry_, tolerances_, carryOn);
    if (!carryOn()) return cancelled("building patches");
    const std::vector<std::byte> blob = encodePage(built.meshes, index_, geometry_);
    std::uint64_t vertices = 0;
    for (const PatchMesh& mesh : built.meshes.patches) vertices += mesh.vertices.size() + 1;
    for (std::size_t p = 0; p < built.meshes.patches.size(); ++p, ++next) {
      const PatchMesh& mesh = built.meshes.patches[p];
      all.bounds[next] = built.bounds[p];
      std::ranges::copy(built.errorM[p], all.errorM[next].begin());
      countTriangles(mesh, all.triangles[next]);
      all.facts[next] = built.facts[p];
      all.facts[next].vertices = static_cast<std::uint32_t>(mesh.vertices.size());
      // Patches of a page are packed together: its bytes by their vertices.
      all.facts[next].bytes = static_cast<std::uint32_t>(blob.size() * (mesh.vertices.size() + 1) / vertices);
      all.cones[next] = built.cones[p];
    }
    if (auto added = (*writer)->add(page, blob); !added) return added;
  }
  if (heights.failed()) return unreadable("heights");
  PatchBytesWriter measured(all.bytes());
  all.write(measured);
  if (auto added = (*writer)->add(kMeasuredKey, measured.bytes()); !added) return added;
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
    // Fewer threads can do it too.
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
  Measured all(index_.variants(), index_.size());
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
    PatchBytesReader in(*measured);
    const std::size_t first = patchesBefore(index_, firstPage_[piece]),
                      patches = patchesBefore(index_, firstPage_[piece + 1]) - first;
    all.read(in, first, patches);
    if (!in.isWhole())
      return damaged({wrong(pieceFile(piece), "what was measured of " + std::to_string(patches) + " patches",
                            std::to_string(measured->size()) + " bytes")});
  }
  finishPatchIndex(index_, std::move(all.bounds), std::move(all.errorM), std::move(all.triangles));
  index_.cones = std::move(all.cones);
  return finishPatchFile(**writer, posts_, index_, all.facts);
}

}  // namespace trimtab::terrain
