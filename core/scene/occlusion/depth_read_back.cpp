#include "depth_read_back.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/scene/gl/gl_api.h"
#include "frame_culling.h"

namespace trimtab::scene {
namespace {

/// A step of the eye that is no flight: it was put elsewhere.
constexpr double kLeapM = 200;

GLsync syncOf(void* fence) {
  return static_cast<GLsync>(fence);
}

}  // namespace

DepthReadBack::DepthReadBack() {
  for (Flight& flight : flights_) glGenBuffers(1, &flight.buffer);
}

DepthReadBack::~DepthReadBack() {
  for (Flight& flight : flights_) {
    if (flight.fence) glDeleteSync(syncOf(flight.fence));
    glDeleteBuffers(1, &flight.buffer);
  }
}

const char* DepthReadBack::lacks() {
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  return major * 10 + minor >= 32 ? "" : "fences (OpenGL 3.2)";
}

void DepthReadBack::setDatabase(std::shared_ptr<const terrain::Database> database) {
  database_ = database;
  meshes_.setDatabase(std::move(database));
  map_.reset();
  lastEye_.reset();
  speedM_ = 0;
  inCut_.assign(database_ ? database_->index().size() : 0, 0);
  // What is on its way is of the other terrain.
  for (Flight& flight : flights_) {
    if (flight.fence) glDeleteSync(syncOf(flight.fence));
    flight.fence = nullptr;
  }
}

bool DepthReadBack::arrived(const Flight& flight) const {
  if (!flight.fence) return false;
  if (forced_.lag == 0) {
    const GLenum state = glClientWaitSync(syncOf(flight.fence), 0, 0);
    return state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED;
  }
  if (flight.map.frame + static_cast<std::uint64_t>(forced_.lag) > frame_) return false;
  constexpr GLuint64 kSecond = 1'000'000'000;
  glClientWaitSync(syncOf(flight.fence), GL_SYNC_FLUSH_COMMANDS_BIT, kSecond);
  return true;
}

void DepthReadBack::land(Flight& flight) {
  glDeleteSync(syncOf(flight.fence));
  flight.fence = nullptr;
  if (map_ && flight.map.frame < map_->frame) return;
  const std::size_t texels =
      static_cast<std::size_t>(flight.map.width) * static_cast<std::size_t>(flight.map.height);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, flight.buffer);
  const void* from = glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0,
                                      static_cast<GLsizeiptr>(texels * sizeof(float)), GL_MAP_READ_BIT);
  if (from) {
    depths_.resize(texels);
    std::memcpy(depths_.data(), from, texels * sizeof(float));
    // False: the contents were lost while they were mapped.
    if (glUnmapBuffer(GL_PIXEL_PACK_BUFFER) == GL_TRUE) {
      map_ = flight.map;
      pyramid_.build(depths_, map_->width, map_->height);
      ++maps_;
    }
  }
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

void DepthReadBack::begin(const EyePose& eye, const LevelCut& cut) {
  ++frame_;
  meshes_.forgetOthers(cut);
  const double step = lastEye_ ? length(eye.position - *lastEye_) : 0;
  speedM_ = step < kLeapM ? step : 0;
  lastEye_ = eye.position;
  if (atOnce()) return;
  const std::uint64_t before = map_ ? map_->frame : 0;
  for (Flight& flight : flights_)
    if (arrived(flight)) land(flight);
  if (before != 0 && map_->frame != before)
    slowestFrames_ = std::clamp(static_cast<int>(frame_ - before), 1, 16);
  if (map_ && !forced_.keepsChanged) uncoverChanged(cut);
}

/// Until the map after the one that is drawn now is there, and a little faster than the eye was last.
double DepthReadBack::motionM() const {
  return 1.1 * speedM_ * std::max(slowestFrames_, forced_.lag + 1);
}

std::optional<double> DepthReadBack::motionForMap() const {
  if (atOnce()) return 0;
  if (std::none_of(flights_.begin(), flights_.end(), [](const Flight& f) { return !f.fence; })) return {};
  return forced_.motionScale * motionM();
}

void DepthReadBack::take(const OcclusionPass& pass, const EyePose& eye, const ViewShape& view,
                         std::span<const TileDraw> occluders) {
  Map map{eye, view, pass.width(), pass.height(), 0, {}, frame_};
  if (atOnce()) {
    pass.read(depths_);
    pyramid_.build(depths_, map.width, map.height);
    map_ = std::move(map);
    ++maps_;
    return;
  }
  const auto free = std::find_if(flights_.begin(), flights_.end(), [](const Flight& f) { return !f.fence; });
  if (free == flights_.end()) return;
  map.motionM = motionM();
  for (const TileDraw& tile : occluders) map.occluders.push_back(tile.node);
  const std::size_t bytes = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height) * 4;
  if (bytes > free->capacity) {
    glBindBuffer(GL_PIXEL_PACK_BUFFER, free->buffer);
    glBufferData(GL_PIXEL_PACK_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_READ);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    free->capacity = bytes;
  }
  pass.readTo(free->buffer);
  free->map = std::move(map);
  free->fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

void DepthReadBack::uncoverChanged(const LevelCut& cut) {
  for (const TileDraw& tile : cut.tiles) inCut_[tile.node] = 1;
  gone_.clear();
  std::erase_if(map_->occluders, [this](std::uint32_t node) {
    if (inCut_[node] != 0) return false;
    gone_.push_back(database_->index().bounds[node]);
    return true;
  });
  for (const TileDraw& tile : cut.tiles) inCut_[tile.node] = 0;
  if (gone_.empty()) return;
  // Where a texel's sample is over, from the map's eye.
  const Map& m = *map_;
  const Vec3 right = m.eye.axes.row[0], up = m.eye.axes.row[1], forward = -m.eye.axes.row[2];
  float* texel = depths_.data();
  for (int y = 0; y < m.height; ++y)
    for (int x = 0; x < m.width; ++x, ++texel) {
      if (!(*texel > 0)) continue;
      const double z = m.view.nearM / double{*texel};
      const Vec3 ray = forward + right * (m.view.left + (m.view.right - m.view.left) * (x + 0.5) / m.width) +
                       up * (m.view.bottom + (m.view.top - m.view.bottom) * (y + 0.5) / m.height);
      const double px = m.eye.position.x + ray.x * z, py = m.eye.position.y + ray.y * z;
      // Rounding of depths and vertices, and by as much as vertices may be off their texels.
      const double margin = 0.5 + 1e-4 * z;
      for (const Box& b : gone_)
        if (px >= b.minX - margin && px <= b.maxX + margin && py >= b.minY - margin &&
            py <= b.maxY + margin) {
          *texel = 0;
          break;
        }
    }
  pyramid_.build(depths_, m.width, m.height);
}

bool DepthReadBack::mayServe(const EyePose& eye, const ViewShape& view) const {
  if (!map_ || map_->view != view) return false;
  if (atOnce()) return map_->frame == frame_ && map_->eye == eye;
  // Said so that an eye that is not a number hides nothing.
  return length(eye.position - map_->eye.position) <= map_->motionM;
}

std::span<const std::uint8_t> DepthReadBack::hidden(std::span<const TileDraw> visible, const EyePose& eye,
                                                    const ViewShape& view) {
  age_ = -1;
  if (!mayServe(eye, view)) return {};
  age_ = static_cast<int>(frame_ - map_->frame);
  test_.begin(map_->eye, map_->view, map_->width, map_->height, !atOnce(), simdLevel());
  fates_.clear();
  for (const TileDraw& tile : visible)
    fates_.push_back(static_cast<std::uint8_t>(test_(meshes_.of(tile.node), pyramid_)));
  // What the old view does not show at all, the new one may.
  if (!atOnce())
    for (std::uint8_t& fate : fates_)
      if (fate == static_cast<std::uint8_t>(DepthFate::outside))
        fate = static_cast<std::uint8_t>(DepthFate::seen);
  return fates_;
}

Renderer::Grey DepthReadBack::picture() const {
  if (!map_) return {};
  return greyOf(pyramid_.depths(), pyramid_.width(), pyramid_.height(), map_->view.nearM);
}

}  // namespace trimtab::scene
