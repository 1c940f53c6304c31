#include "trimtab/culling/depth_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trimtab/frame/box_union.h"

namespace trimtab {
namespace {

constexpr std::size_t kLanes = depth::kLanes;
constexpr double kEarthRadius = 6.35e6;

std::array<float, 3> toFloat(Vec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Returns the largest distance, texels, from the centre of a pixel of the image to the centre of its texel,
/// along one axis.
double farthestPixel(int map, int picture) {
  double farthest = 0;
  for (int i = 0; i < picture; ++i) {
    const double at = (i + 0.5) * map / picture;
    farthest = std::max(farthest, std::abs(at - std::floor(at) - 0.5));
  }
  return farthest;
}

}  // namespace

void DepthMesh::setVertices(std::size_t count) {
  vertices = count;
  const std::size_t padded = (count + kLanes - 1) / kLanes * kLanes;
  for (auto* v : {&x, &y, &z, &slope}) v->resize(padded);
}

void DepthMesh::finishVertices() {
  for (std::size_t i = vertices; i < x.size(); ++i)
    setVertex(i, x[vertices - 1], y[vertices - 1], z[vertices - 1], slope[vertices - 1]);
}

void DepthMesh::setBoxes(std::span<const Box> parts) {
  const std::size_t padded = kLanes + (parts.size() + kLanes - 1) / kLanes * kLanes;
  Box whole = kNoBox;
  bool numbers = true;
  for (const Box& b : parts) {
    whole = united(whole, b);
    for (const float v : {b.minX, b.minY, b.minZ, b.maxX, b.maxY, b.maxZ})
      numbers = numbers && std::isfinite(v);
  }
  if (!numbers) whole.minX = std::numeric_limits<float>::quiet_NaN();
  for (auto& side : boxes) side.resize(padded);
  for (std::size_t i = 0; i < padded; ++i) {
    const Box& b = i < kLanes ? whole : parts[std::min(i - kLanes, parts.size() - 1)];
    const std::array<float, 6> values{b.minX, b.minY, b.minZ, b.maxX, b.maxY, b.maxZ};
    for (std::size_t side = 0; side < 6; ++side) boxes[side][i] = values[side];
  }
}

void DepthMap::setProjection(const EyePose& eye, const ViewShape& view) {
  const int width = settings_.width, height = settings_.height;
  eye_ = eye.position;
  depth::Projection& p = projection_;
  p = {};
  p.right = toFloat(eye.axes.row[0]);
  p.up = toFloat(eye.axes.row[1]);
  p.forward = toFloat(-eye.axes.row[2]);
  p.nearM = static_cast<float>(view.nearM);
  const double scaleX = width / (view.right - view.left), scaleY = height / (view.top - view.bottom);
  p.scaleX = static_cast<float>(scaleX);
  p.scaleY = static_cast<float>(scaleY);
  p.left = static_cast<float>(-view.left * scaleX);
  p.bottom = static_cast<float>(-view.bottom * scaleY);
  const auto pad = [](int map, int picture) {
    return static_cast<float>(0.05 + 0.1 * map / std::max(1, picture));
  };
  view_ = {width, height, pad(width, view.widthPx), pad(height, view.heightPx)};
}

depth::Projection DepthMap::projectionAt(Vec3 origin) const {
  depth::Projection p = projection_;
  p.offset = toFloat(origin - eye_);
  return p;
}

depth::Rectangles DepthMap::rectangles(const depth::Projection& projection, const DepthMesh& mesh,
                                       std::size_t first) const {
  depth::Boxes boxes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    boxes.low[axis] = mesh.boxes[axis].data() + first;
    boxes.high[axis] = mesh.boxes[axis + 3].data() + first;
  }
  depth::Rectangles r;
  depth::rectangles(projection, view_, boxes, r, settings_.level);
  return r;
}

DepthFate DepthMap::test(const DepthMesh& mesh) const {
  if (pyramid_.width() != view_.width || pyramid_.height() != view_.height || view_.width <= 0)
    return DepthFate::seen;
  const depth::Projection p = projectionAt(mesh.origin);
  DepthFate fate = DepthFate::outside;
  // The first group holds the box of the whole mesh.
  for (std::size_t first = 0; first < mesh.boxes[0].size(); first += kLanes) {
    const depth::Rectangles r = rectangles(p, mesh, first);
    for (std::size_t i = 0; i < (first == 0 ? 1 : kLanes); ++i) {
      if (r.x0[i] == depth::Rectangles::kOutside) {
        if (first == 0) return DepthFate::outside;
        continue;
      }
      const bool hidden = r.x0[i] >= 0 && pyramid_.covers(r.x0[i], r.y0[i], r.x1[i], r.y1[i], r.limit[i]);
      if (first == 0 && hidden) return DepthFate::hidden;
      if (first != 0 && !hidden) return DepthFate::seen;
      if (first != 0) fate = DepthFate::hidden;
    }
  }
  return mesh.boxes[0].size() <= kLanes ? DepthFate::seen : fate;
}

void DepthMap::begin(const EyePose& eye, const ViewShape& view, const Settings& settings) {
  settings_ = settings;
  settings_.width = std::max(settings.width, 0);
  settings_.height = std::max(settings.height, 0);
  const int width = settings_.width, height = settings_.height;
  setProjection(eye, view);
  nearM_ = view.nearM;
  triangles_ = 0;
  texels_ = {nullptr, depth::strideOf(width), width, height};
  cells_.assign(
      static_cast<std::size_t>(texels_.stride) * static_cast<std::size_t>(height + depth::kRowsBeyond), 0.0f);
  texels_.first = cells_.data();
  blocksAcross_ = (width + kBlock - 1) / kBlock;
  farthest_.assign(
      static_cast<std::size_t>(blocksAcross_) * static_cast<std::size_t>((height + kBlock - 1) / kBlock),
      0.0f);

  const auto off = [](auto& known, int map, int picture) {
    if (known.map != map || known.picture != picture) known = {map, picture, farthestPixel(map, picture)};
    return known.off + 0.02 + 0.1 * map / std::max(1, picture);
  };
  const Vec3 a = eye.axes.row[0] * (off(across_, width, view.widthPx) * (view.right - view.left) / width),
             b = eye.axes.row[1] * (off(upwards_, height, view.heightPx) * (view.top - view.bottom) / height);
  const std::array<Vec3, 2> diagonals{a + b, a - b};
  for (std::size_t i = 0; i < 2; ++i) {
    down_[i] = static_cast<float>(std::abs(diagonals[i].z));
    aside_[i] = static_cast<float>(std::hypot(diagonals[i].x, diagonals[i].y));
  }
}

bool DepthMap::covers(const Rectangle& r) {
  for (int by = r.y1 / kBlock; by >= r.y0 / kBlock; --by)
    for (int bx = r.x0 / kBlock; bx <= r.x1 / kBlock; ++bx) {
      float& farthest = farthest_[static_cast<std::size_t>(by * blocksAcross_ + bx)];
      if (farthest > r.limit) continue;
      const auto least = [&](int x0, int y0, int x1, int y1) {
        float low = std::numeric_limits<float>::max();
        for (int y = y0; y <= y1; ++y)
          for (int x = x0; x <= x1; ++x) low = std::min(low, texels_.first[y * texels_.stride + x]);
        return low;
      };
      const int x0 = bx * kBlock, y0 = by * kBlock, x1 = std::min(x0 + kBlock, settings_.width) - 1,
                y1 = std::min(y0 + kBlock, settings_.height) - 1;
      if (farthest < 0) {
        farthest = least(x0, y0, x1, y1);
        if (farthest > r.limit) continue;
      }
      if (!(least(std::max(x0, r.x0), std::max(y0, r.y0), std::min(x1, r.x1), std::min(y1, r.y1)) > r.limit))
        return false;
    }
  return true;
}

void DepthMap::touch(const depth::Touched& touched) {
  for (int by = touched.y0 / kBlock; by <= touched.y1 / kBlock; ++by)
    for (int bx = touched.x0 / kBlock; bx <= touched.x1 / kBlock; ++bx)
      farthest_[static_cast<std::size_t>(by * blocksAcross_ + bx)] = -1;
}

DepthFate DepthMap::draw(const DepthMesh& mesh, const depth::Triangles& triangles) {
  if (cells_.empty() || mesh.vertices == 0) return DepthFate::seen;
  depth::Projection p = projectionAt(mesh.origin);
  if (!mesh.boxes[0].empty()) {
    const depth::Rectangles r = rectangles(p, mesh, 0);
    if (r.x0[0] == depth::Rectangles::kOutside) return DepthFate::outside;
    if (r.x0[0] >= 0 && covers({r.x0[0], r.y0[0], r.x1[0], r.y1[0], r.limit[0]})) return DepthFate::hidden;
  }
  p.down = down_;
  p.aside = aside_;
  p.lowering = static_cast<float>(settings_.lowering);
  p.reach = mesh.reach;
  p.farReach = mesh.farReach;
  p.farSlope = mesh.farSlope;
  p.edge = mesh.edge;
  // Slopes are measured against the geodetic vertical, but vertices are lowered along the frame's z.
  p.tilt = static_cast<float>(
      (std::hypot(mesh.origin.x, mesh.origin.y) +
       std::hypot(std::max(std::abs(double{mesh.boxes[0][0]}), std::abs(double{mesh.boxes[3][0]})),
                  std::max(std::abs(double{mesh.boxes[1][0]}), std::abs(double{mesh.boxes[4][0]}))) +
       double{mesh.farReach} + double{mesh.edge}) *
      1.05 / kEarthRadius);
  depth::project(p, {mesh.x.data(), mesh.y.data(), mesh.z.data(), mesh.slope.data(), mesh.x.size()}, seen_,
                 settings_.level);
  depth::Touched touched;
  depth::draw(texels_, seen_, triangles, touched, settings_.level);
  if (seen_.anyKept) drawClipped(triangles, touched);
  if (touched.x0 <= touched.x1) touch(touched);
  triangles_ += triangles.count();
  return DepthFate::seen;
}

void DepthMap::drawClipped(const depth::Triangles& triangles, depth::Touched& touched) {
  struct Corner {
    double right, up, depth;
  };
  const depth::Projection& p = projection_;
  // The view's sides, a texel further out.
  const auto side = [](float scale, float from, double texel) {
    return (texel - double{from}) / double{scale};
  };
  const double left = side(p.scaleX, p.left, -1), right = side(p.scaleX, p.left, texels_.width + 1),
               bottom = side(p.scaleY, p.bottom, -1), top = side(p.scaleY, p.bottom, texels_.height + 1);
  const std::array<Corner, 5> planes{
      {{0, 0, 1}, {1, 0, -left}, {-1, 0, right}, {0, 1, -bottom}, {0, -1, top}}};
  const double nearest = nearM_ * 1.01;
  std::array<Corner, 12> polygon, next;
  for (std::size_t g = 0; g < triangles.groups(); ++g)
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::uint16_t* at = triangles.group(g) + lane;
      bool clip = false, drop = false;
      std::size_t count = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = at[k * kLanes];
        clip = clip || (seen_.kept[i] & depth::Seen::kClip) != 0;
        drop = drop || (seen_.kept[i] & depth::Seen::kDropped) != 0;
        polygon[count++] = {double{seen_.right[i]}, double{seen_.up[i]}, double{seen_.depth[i]}};
      }
      if (!clip || drop || at[0] == at[kLanes]) continue;
      for (const Corner& plane : planes) {
        const double offset = &plane == planes.data() ? nearest : 0;
        const auto inside = [&](const Corner& c) {
          return c.right * plane.right + c.up * plane.up + c.depth * plane.depth - offset;
        };
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count; ++i) {
          const Corner &a = polygon[i], &b = polygon[(i + 1) % count];
          const double ia = inside(a), ib = inside(b);
          if (ia >= 0) next[kept++] = a;
          if ((ia >= 0) == (ib >= 0)) continue;
          const double t = ia / (ia - ib);
          next[kept++] = {a.right + t * (b.right - a.right), a.up + t * (b.up - a.up),
                          a.depth + t * (b.depth - a.depth)};
        }
        std::swap(polygon, next);
        count = kept;
      }
      if (count < 3) continue;
      clipped_.resize(count);
      for (std::size_t i = 0; i < count; ++i) {
        const Corner& c = polygon[i];
        const double per = 1 / std::max(c.depth, nearest);
        clipped_.x[i] = static_cast<float>(c.right * per * double{p.scaleX} + double{p.left});
        clipped_.y[i] = static_cast<float>(c.up * per * double{p.scaleY} + double{p.bottom});
        clipped_.w[i] = static_cast<float>(nearM_ * per);
      }
      static const depth::Triangles kFan(
          std::array<std::uint16_t, 18>{0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 6, 0, 6, 7});
      for (std::size_t i = count; i < clipped_.x.size(); ++i)
        clipped_.x[i] = std::numeric_limits<float>::quiet_NaN();
      depth::draw(texels_, clipped_, kFan, touched, settings_.level);
    }
}

void DepthMap::finish() {
  pyramid_.build({cells_.data(), cells_.size()}, settings_.width, settings_.height, texels_.stride);
}

}  // namespace trimtab
