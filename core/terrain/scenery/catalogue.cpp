#include "trimtab/terrain/scenery/catalogue.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "trimtab/terrain/grid/parallel.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

std::size_t bytesOf(const PlacedMesh& placed) {
  return placed.places.size() * 2 * sizeof(Vec3) +
         placed.mesh.triangles.size() * sizeof(SceneryMesh::Triangle);
}

Rectangle extentOf(const PlacedMesh& placed) {
  Rectangle extent = Rectangle::none();
  for (const SceneryMesh::Triangle& t : placed.mesh.triangles)
    for (const std::uint32_t v : t.vertex) extent.add(placed.places[v].x, placed.places[v].y);
  return extent;
}

void count(SceneryCounts& counts, const SceneryMesh& mesh) {
  ++(mesh.airport ? counts.airports : counts.tiles);
  counts.trianglesInFile += mesh.trianglesInFile;
  counts.degenerate += mesh.degenerate;
  counts.triangles += mesh.triangles.size();
}

}  // namespace

SceneryCounts countsOf(const Scenery& scenery) {
  SceneryCounts counts;
  for (const SceneryMesh& mesh : scenery.tiles) count(counts, mesh);
  counts.missing = scenery.missing;
  return counts;
}

SceneryCatalogue::SceneryCatalogue(std::vector<SceneryMesh> meshes) {
  for (SceneryMesh& mesh : meshes) add(std::move(mesh));
}

PlacedMesh SceneryCatalogue::placed(SceneryMesh mesh) const {
  PlacedMesh all{std::move(mesh), {}};
  all.places.reserve(all.mesh.vertices.size());
  for (const Vec3& v : all.mesh.vertices) {
    const GeodeticPosition p = toGeodetic(v);
    all.places.push_back({reference_ + std::remainder(p.longitude.value() - reference_, 360.0),
                          p.latitude.value(), p.height.value()});
  }
  return all;
}

void SceneryCatalogue::enter(fs::path file, std::function<SceneryMesh()> make, SceneryMesh mesh) {
  if (!hasReference_ && !mesh.triangles.empty()) {
    reference_ = toGeodetic(mesh.vertices[mesh.triangles[0].vertex[0]]).longitude.value();
    hasReference_ = true;
  }
  count(counts_, mesh);
  auto all = std::make_shared<PlacedMesh>(placed(std::move(mesh)));
  const bool stays = file.empty() && !make;
  tiles_.push_back({std::move(file), std::move(make), all->mesh.name, all->mesh.airport, extentOf(*all)});
  slots_.emplace_back();
  if (stays)
    slots_.back().mesh = std::move(all);
  else
    keep(tiles_.size() - 1, std::move(all));
}

Result<std::unique_ptr<SceneryCatalogue>> SceneryCatalogue::open(std::span<const fs::path> sources,
                                                                 std::size_t memory,
                                                                 const Progress& progress) {
  auto all = std::make_unique<SceneryCatalogue>();
  all->memory_ = memory;
  Findings findings;
  std::vector<SceneryList::File> files;
  for (const fs::path& source : sources) {
    auto list = listScenery(source);
    findings.insert(findings.end(), list.findings().begin(), list.findings().end());
    if (!list) return findings;
    files.insert(files.end(), list->files.begin(), list->files.end());
    auto& missing = all->counts_.missing;
    missing.insert(missing.end(), list->missing.begin(), list->missing.end());
  }
  // A few at a time: what does not stay is gone before the next are read.
  constexpr std::size_t kTogether = 8;
  std::set<std::string> names;
  std::size_t broken = 0;
  for (std::size_t from = 0; from < files.size(); from += kTogether) {
    const std::size_t some = std::min(kTogether, files.size() - from);
    std::vector<Result<SceneryMesh>> read(some, Result<SceneryMesh>(Findings{}));
    const auto carryOn = [&](double part) {
      return !progress || progress((static_cast<double>(from) + part * static_cast<double>(some)) /
                                       static_cast<double>(files.size()),
                                   "reading scenery");
    };
    if (!forEachParallel(
            static_cast<std::uint32_t>(some),
            [&](std::uint32_t i) { read[i] = readBtg(files[from + i].path); }, carryOn))
      return cancelled("reading scenery");
    for (std::size_t i = 0; i < some; ++i) {
      // A tile that cannot be read leaves a gap, which is filled as one without a file is.
      for (Finding finding : read[i].findings()) {
        if (!read[i] && finding.severity == Severity::error && files.size() > 1) {
          finding.severity = Severity::warning;
          finding.found += ": this tile is left out, its ground is filled in from what is beside it";
        }
        findings.push_back(std::move(finding));
      }
      if (!read[i]) ++broken;
      if (!read[i] || !names.insert(read[i]->name).second) continue;
      SceneryMesh mesh = std::move(*read[i]);
      mesh.airport = files[from + i].airport;
      all->enter(files[from + i].path, {}, std::move(mesh));
    }
  }
  if (broken > 0 && broken == files.size()) {
    if (!hasError(findings))
      findings.push_back({Severity::error, "scenery", "tiles", "a tile that can be read", "none"});
    return findings;
  }
  return Result<std::unique_ptr<SceneryCatalogue>>(std::move(all), std::move(findings));
}

Rectangle SceneryCatalogue::extent() const {
  Rectangle whole = Rectangle::none();
  for (const Tile& tile : tiles_) whole.add(tile.extent);
  return whole;
}

double SceneryCatalogue::turnTo(double longitude) const {
  return 360 * std::round((longitude - reference_) / 360);
}

void SceneryCatalogue::keep(std::size_t tile, std::shared_ptr<PlacedMesh> mesh) const {
  const std::size_t bytes = bytesOf(*mesh);
  const std::lock_guard lock(mutex_);
  if (slots_[tile].mesh || bytes > memory_) return;
  while (bytes_ + bytes > memory_) {
    std::size_t oldest = slots_.size();
    for (std::size_t i = 0; i < slots_.size(); ++i)
      if (slots_[i].bytes > 0 && (oldest == slots_.size() || slots_[i].used < slots_[oldest].used))
        oldest = i;
    bytes_ -= slots_[oldest].bytes;
    slots_[oldest] = {};
  }
  bytes_ += bytes;
  slots_[tile] = {std::move(mesh), bytes, ++use_};
}

Result<SceneryMesh> SceneryCatalogue::again(const Tile& tile, bool withTexture) const {
  if (tile.make) return tile.make();
  auto read = readBtg(tile.file, withTexture);
  if (read) (*read).airport = tile.airport;
  return read;
}

Result<std::shared_ptr<const PlacedMesh>> SceneryCatalogue::mesh(std::size_t tile) const {
  {
    const std::lock_guard lock(mutex_);
    if (Slot& slot = slots_[tile]; slot.mesh) {
      slot.used = ++use_;
      return std::shared_ptr<const PlacedMesh>(slot.mesh);
    }
  }
  auto own = again(tiles_[tile]);
  if (!own) return own.findings();
  auto made = std::make_shared<PlacedMesh>(placed(std::move(own).value()));
  keep(tile, made);
  return std::shared_ptr<const PlacedMesh>(std::move(made));
}

Result<std::vector<SceneryMesh>> SceneryCatalogue::takeAll(bool withTexture) {
  std::vector<SceneryMesh> all;
  all.reserve(tiles_.size());
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    if (slots_[i].mesh && !(withTexture && !tiles_[i].file.empty())) {
      all.push_back(std::move(slots_[i].mesh->mesh));
      bytes_ -= slots_[i].bytes;
      slots_[i] = {};
      continue;
    }
    bytes_ -= slots_[i].bytes;
    slots_[i] = {};
    auto own = again(tiles_[i], withTexture);
    if (!own) return own.findings();
    all.push_back(std::move(own).value());
  }
  return all;
}

}  // namespace trimtab::terrain
