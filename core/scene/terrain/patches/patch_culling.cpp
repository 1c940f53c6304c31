#include "patch_culling.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>

#include "page_budget.h"
#include "patch_layer.h"
#include "trimtab/culling/cut_rule.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab::scene {
namespace {

/// A frame may spend so much time on pages that arrived; it always receives one.
constexpr std::chrono::microseconds kShare{2000};
/// At most so many bytes are reserved on the GPU before they are needed.
constexpr double kMostReserved = 256e6;
/// The eye is looked for so many seconds ahead: several times what reading the pages of the way there needs.
constexpr double kAheadS = 5;
/// A page that is needed then is so much less urgent than one that is needed now.
constexpr float kAheadUrgency = 0.25f, kMostAheadPx = 1e6f;
/// Needs of then are found again when the eye of then has moved by so much of the way.
constexpr double kAheadStep = 0.08;

/// Holds what the cut depends on: what is asked for, and what of it is in memory.
struct PagedCutKey {
  CutKey cut;
  std::uint64_t budget = 0, heldNumber = 0;
  friend bool operator==(const PagedCutKey&, const PagedCutKey&) = default;
};

struct Bytes {
  std::vector<std::uint64_t> ofPage;  ///< on the GPU and, for who asks what hides what, as it was read
  std::uint64_t all = 0, vertices = 0, indices = 0;
};
Bytes bytesOf(const terrain::PatchTerrain& terrain) {
  const PatchIndex& index = terrain.index();
  Bytes bytes;
  bytes.ofPage.resize(index.pages.size());
  for (std::size_t patch = 0; patch < index.size(); ++patch) {
    std::size_t indices = 0;
    for (const std::uint16_t triangles : index.triangles[patch]) indices += 3u * triangles;
    const std::size_t vertices = terrain.facts()[patch].vertices;
    const std::uint64_t onGpu = PatchLayer::bytesOf(vertices, indices),
                        asRead = vertices * sizeof(terrain::PatchVertex) + indices * sizeof(std::uint16_t);
    bytes.ofPage[index.page[patch]] += onGpu + asRead;
    bytes.all += onGpu + asRead;
    bytes.vertices += PatchLayer::bytesOf(vertices, 0);
    bytes.indices += PatchLayer::bytesOf(0, indices);
  }
  return bytes;
}

std::uint64_t budgetOf(const FrameRequest& request) {
  return static_cast<std::uint64_t>(std::max(request.terrain.cache.value(), 0.0) * 1e6);
}

std::uint32_t rootPagesOf(const PatchIndex& index) {
  std::uint32_t count = 0;
  while (count < index.pages.size() && index.pages[count].pair == 0) ++count;
  return count;
}

}  // namespace

struct PatchCulling::Impl {
  std::shared_ptr<const terrain::PatchTerrain> terrain;
  std::unique_ptr<terrain::Pager> pager;
  Bytes bytes;
  PageBudget pages;
  std::uint64_t reservedFor = 0;           ///< largest budget that the layer has made room for
  std::uint64_t askedFor = 0;              ///< budget of the last frame
  std::uint64_t most = ~std::uint64_t{0};  ///< what the GPU was found to have memory for, in that budget
  std::vector<std::shared_ptr<const terrain::PatchPage>> meshes;  ///< of the pages that are held
  std::vector<std::uint32_t> roots;
  std::uint64_t heldNumber = 0, dropped = 0;  ///< changes of what is held; pages given up
  std::optional<PagedCutKey> key;
  CutNumber number;
  PatchCut later;  ///< where the eye will be
  std::optional<Vec3> laterEye;
  std::vector<PageWant> laterWants, missing;
  std::vector<std::uint32_t> mustHave;
  std::size_t waiting = 0;
  Defects defects;

  void drop(std::uint32_t page, PatchLayer& layer);
  void makeRoom(std::uint64_t coming, PatchLayer& layer);
  void letGo(std::uint32_t page);
  void takeIn(std::shared_ptr<const terrain::PatchPage> page, PatchLayer& layer);
  void takeArrivals(PatchLayer& layer);
  void takeAll(std::span<const std::uint32_t> wanted, PatchLayer& layer);
  void reserve(const FrameRequest& request, PatchLayer& layer);
  bool giveBack(const FrameRequest& request, PatchLayer& layer);
  void followLayer(PatchLayer& layer);
  std::optional<Vec3> eyeAhead(const FrameRequest& request, Vec3 eye) const;
  bool lookAhead(const FrameRequest& request, const CutKey& wanted);
  /// Returns whether the cut was selected anew.
  bool choose(const FrameRequest& request, const EyePose& eye, PatchCut& cut);
  void select(const CutKey& wanted, PatchCut& cut);
  void ask();
};

PatchCulling::PatchCulling() : impl_(std::make_unique<Impl>()) {}
PatchCulling::~PatchCulling() = default;

void PatchCulling::setTerrain(std::shared_ptr<const terrain::PatchTerrain> terrain) {
  const Defects defects = impl_->defects;
  impl_ = std::make_unique<Impl>();
  impl_->defects = defects;
  cut_ = {};
  if (!terrain) return;
  Impl& m = *impl_;
  m.terrain = std::move(terrain);
  const std::uint32_t roots = rootPagesOf(m.terrain->index());
  m.bytes = bytesOf(*m.terrain);
  m.pages.reset(m.bytes.ofPage, roots);
  m.meshes.resize(m.terrain->index().pages.size());
  m.pager = terrain::Pager::start(m.terrain);
  for (std::uint32_t page = 0; page < roots; ++page) {
    m.roots.push_back(page);
    m.missing.push_back({page, std::numeric_limits<float>::infinity()});
  }
  m.pager->want(m.missing);
}

void PatchCulling::plant(const Defects& defects) {
  impl_->defects = defects;
  impl_->key.reset();
}

void PatchCulling::Impl::drop(std::uint32_t page, PatchLayer& layer) {
  layer.drop(page);
  letGo(page);
  ++dropped;
}

void PatchCulling::Impl::letGo(std::uint32_t page) {
  pages.drop(page);
  meshes[page].reset();
  ++heldNumber;
}

void PatchCulling::Impl::makeRoom(std::uint64_t coming, PatchLayer& layer) {
  while (const auto page = pages.toDrop(coming)) drop(*page, layer);
}

void PatchCulling::Impl::takeIn(std::shared_ptr<const terrain::PatchPage> page, PatchLayer& layer) {
  const std::uint32_t at = page->page;
  if (pages.holds(at)) return;
  makeRoom(pages.bytesOf(at), layer);
  if (!layer.add(*page)) {
    // A little less than what is there, as places of other sizes will be asked for.
    most = std::min(most, pages.bytes()) / 16 * 15;
    return;
  }
  pages.hold(at);
  meshes[at] = std::move(page);
  ++heldNumber;
}

void PatchCulling::Impl::takeArrivals(PatchLayer& layer) {
  const auto end = std::chrono::steady_clock::now() + kShare;
  do {
    const auto arrived = pager->takeArrived(1);
    if (arrived.empty()) return;
    for (const auto& page : arrived) takeIn(page, layer);
  } while (std::chrono::steady_clock::now() < end);
}

void PatchCulling::Impl::takeAll(std::span<const std::uint32_t> wanted, PatchLayer& layer) {
  pager->waitFor(wanted);
  for (const auto& page : pager->takeArrived(std::numeric_limits<std::size_t>::max())) takeIn(page, layer);
}

/// Reserves what the budget may hold of this terrain, at once, unless that is very much: growing later makes
/// a frame late.
void PatchCulling::Impl::reserve(const FrameRequest& request, PatchLayer& layer) {
  const std::uint64_t budget = budgetOf(request);
  // Another budget is another try.
  if (budget != askedFor) most = ~std::uint64_t{0};
  askedFor = budget;
  if (budget <= reservedFor || bytes.all == 0) return;
  reservedFor = budget;
  const double onGpu = static_cast<double>(bytes.vertices + bytes.indices);
  const double share =
      std::min({1.0, static_cast<double>(budget) / static_cast<double>(bytes.all), kMostReserved / onGpu});
  layer.reserve(static_cast<std::size_t>(share * static_cast<double>(bytes.vertices)),
                static_cast<std::size_t>(share * static_cast<double>(bytes.indices)));
}

/// Gives back the memory of before if the budget has shrunk a lot, and reports whether pages had to go.
bool PatchCulling::Impl::giveBack(const FrameRequest& request, PatchLayer& layer) {
  const std::uint64_t budget = budgetOf(request);
  if (budget >= reservedFor / 2) return false;
  reservedFor = budget;
  layer.setTerrain(&terrain->index());
  const std::vector<std::uint32_t> held(pages.held().begin(), pages.held().end());
  for (const std::uint32_t page : held)
    if (!layer.add(*meshes[page])) letGo(page);
  return pages.held().size() < held.size();
}

/// Begins again if the layer is of a new context, which has nothing.
void PatchCulling::Impl::followLayer(PatchLayer& layer) {
  if (!pages.held().empty() && !layer.has(pages.held().front())) {
    while (!pages.held().empty()) letGo(pages.held().front());
    reservedFor = askedFor = 0;
  }
  mustHave.clear();
  for (const std::uint32_t page : roots)
    if (!pages.holds(page) && !pager->hasFailed(page)) mustHave.push_back(page);
  if (!mustHave.empty()) takeAll(mustHave, layer);
}

std::optional<Vec3> PatchCulling::Impl::eyeAhead(const FrameRequest& request, Vec3 eye) const {
  // A request that must not depend on time does not look ahead.
  if (!request.velocity || request.frozenEye || request.waitForPages) return {};
  const Velocity& v = *request.velocity;
  const Mat3 axes = eastNorthUp(request.eye.latitude, request.eye.longitude);
  const Vec3 velocity =
      axes.row[0] * v.east.value() + axes.row[1] * v.north.value() - axes.row[2] * v.down.value();
  const Vec3 way = terrain->index().frame.ecefToLocal() * velocity * kAheadS;
  if (!(length(way) > 1)) return {};
  return eye + way;
}

/// Says whether what is needed later may have changed.
bool PatchCulling::Impl::lookAhead(const FrameRequest& request, const CutKey& wanted) {
  const std::optional<Vec3> ahead = eyeAhead(request, wanted.eye);
  if (!ahead) {
    const bool had = laterEye.has_value();
    laterEye.reset();
    laterWants.clear();
    return had;
  }
  if (laterEye && key && key->cut.rule == wanted.rule &&
      length(*ahead - *laterEye) <= kAheadStep * length(*ahead - wanted.eye))
    return false;
  laterEye = ahead;
  selectPatches(terrain->index(), {}, *ahead, wanted.rule, later);
  laterWants.clear();
  for (const PageWant& want : later.wants)
    laterWants.push_back({want.page, kAheadUrgency * std::min(want.errorPx, kMostAheadPx)});
  return true;
}

bool PatchCulling::Impl::choose(const FrameRequest& request, const EyePose& eye, PatchCut& cut) {
  const PagedCutKey wanted{cutKeyOf(request, eye.position, defects.statedErrorScale),
                           std::min(budgetOf(request), most), heldNumber};
  const bool newCut = key != wanted, newAim = lookAhead(request, wanted.cut),
             selected = newCut || !request.skips.sameCut;
  if (selected) select(wanted.cut, cut);
  if (newCut || newAim) {
    const bool wasShort = pages.isShort();
    pages.aim(cut.wants, laterWants, wanted.budget);
    // What may be drawn follows from what is wanted, and what is wanted from the eye alone.
    if (wasShort || pages.isShort()) {
      select(wanted.cut, cut);
      number.cut += !newCut;
    }
    ask();
  }
  number.errorOverDistance = wanted.cut.rule.errorOverDistance();
  number.cut += newCut;
  number.rule += !key || key->cut.rule != wanted.cut.rule;
  key = wanted;
  return selected;
}

void PatchCulling::Impl::select(const CutKey& wanted, PatchCut& cut) {
  selectPatches(terrain->index(), pages.drawable(), wanted.eye, wanted.rule, cut);
}

void PatchCulling::Impl::ask() {
  const bool asked = !missing.empty();
  missing.clear();
  for (const PageWant& want : pages.aims())
    if (!pages.holds(want.page)) missing.push_back(want);
  if (asked || !missing.empty()) pager->want(missing);
}

PatchCulling::Paged PatchCulling::page(const FrameRequest& request, const EyePose& eye, PatchLayer& layer) {
  Impl& m = *impl_;
  Paged done;
  if (!m.terrain) return done;
  m.followLayer(layer);
  m.reserve(request, layer);
  m.takeArrivals(layer);
  done.cutsSelected += m.choose(request, eye, cut_);
  if (request.waitForPages) {
    m.mustHave.clear();
    for (const PageWant& want : m.missing) m.mustHave.push_back(want.page);
    if (!m.mustHave.empty()) {
      m.takeAll(m.mustHave, layer);
      done.cutsSelected += m.choose(request, eye, cut_);
    }
  }
  m.makeRoom(0, layer);
  // Ground whose page has gone must not be assumed to hide anything.
  if (m.giveBack(request, layer)) done.cutsSelected += m.choose(request, eye, cut_);

  const terrain::Pager::Counters read = m.pager->counters();
  PagingFrame& paging = done.paging;
  paging.waiting = read.waiting;
  paging.heldBack = cut_.heldBack;
  paging.pagesRead = read.pagesRead;
  paging.bytesRead = read.bytesRead;
  paging.failed = read.failed;
  paging.longestReadMs = read.longestReadMs;
  paging.pagesDropped = m.dropped;
  paging.bytes = m.pages.bytes();
  paging.budgetBytes = m.key ? m.key->budget : 0;
  return done;
}

const terrain::PatchMesh* PatchCulling::meshOf(std::uint32_t patch) const {
  const PatchIndex& i = index();
  const auto& page = impl_->meshes[i.page[patch]];
  return page ? &page->patches[patch - i.pages[i.page[patch]].firstPatch] : nullptr;
}

const PatchIndex& PatchCulling::index() const {
  static const PatchIndex none;
  return impl_->terrain ? impl_->terrain->index() : none;
}

const CutNumber& PatchCulling::cutNumber() const {
  return impl_->number;
}

Findings PatchCulling::failures() const {
  return impl_->pager ? impl_->pager->failures() : Findings{};
}

}  // namespace trimtab::scene
