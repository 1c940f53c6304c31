#include "regroup.h"

#include <algorithm>
#include <vector>

#include "tiles.h"

namespace trimtab::terrain {

namespace {

struct Grid {
  std::int32_t across, up;
};
Grid gridOf(const Triangulation& mesh, std::int32_t width, std::int32_t height) {
  std::int32_t right = 0, top = 0;
  for (const Triangulation::Vertex& v : mesh.vertices) {
    right = std::max(right, v.x);
    top = std::max(top, v.y);
  }
  return {(right + width / 2) / width + 1, (top + height / 2) / height + 1};
}

/// Closes the gaps that dead triangles leave, and those of vertices that have lost all of theirs.
std::vector<std::int32_t> closeGaps(Triangulation& mesh) {
  using Triangle = Triangulation::Triangle;
  std::vector<std::int32_t> to(mesh.triangles.size(), -1), was, vertexTo(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& one = mesh.triangles[t];
    if (one.corner[0] == Triangulation::kDead) continue;
    to[t] = static_cast<std::int32_t>(was.size());
    was.push_back(static_cast<std::int32_t>(t));
    for (const std::uint32_t v : one.corner) vertexTo[v] = 0;
  }
  std::size_t vertices = 0;
  for (std::size_t v = 0; v < vertexTo.size(); ++v) {
    if (vertexTo[v] < 0) continue;
    mesh.vertices[vertices] = mesh.vertices[v];
    vertexTo[v] = static_cast<std::int32_t>(vertices++);
  }
  mesh.vertices.resize(vertices);
  mesh.borderEdge.assign(vertices, -1);
  for (std::size_t t = 0; t < was.size(); ++t) {
    Triangle one = mesh.triangles[static_cast<std::size_t>(was[t])];
    for (int i = 0; i < 3; ++i) {
      const std::int32_t other = one.twin[i];
      one.corner[i] = static_cast<std::uint32_t>(vertexTo[one.corner[i]]);
      one.twin[i] = other < 0 ? ~static_cast<std::int32_t>(one.corner[i])
                              : 4 * to[static_cast<std::size_t>(other >> 2)] + (other & 3);
      if (other < 0) mesh.borderEdge[one.corner[i]] = 4 * static_cast<std::int32_t>(t) + i;
    }
    mesh.triangles[t] = one;
  }
  mesh.triangles.resize(was.size());
  return was;
}

}  // namespace

std::size_t partCount(const Triangulation& mesh, std::int32_t width, std::int32_t height) {
  const auto [across, up] = gridOf(mesh, width, height);
  return static_cast<std::size_t>(across) * static_cast<std::size_t>(up);
}

std::vector<std::int32_t> eachPart(Triangulation& mesh, std::int32_t width, std::int32_t height,
                                   unsigned threads, const std::function<void(const MeshPart&)>& work) {
  using Triangle = Triangulation::Triangle;
  const auto count = static_cast<std::int32_t>(mesh.triangles.size());
  const auto [across, up] = gridOf(mesh, width, height);

  // Triangles by part, those of a part in their order.
  std::vector<std::uint32_t> part(mesh.triangles.size()), first(static_cast<std::size_t>(across * up) + 1, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& one = mesh.triangles[t];
    std::int32_t x = 0, y = 0;
    for (const std::uint32_t v : one.corner) {
      x += mesh.vertices[v].x;
      y += mesh.vertices[v].y;
    }
    part[t] =
        static_cast<std::uint32_t>((y / 3 + height / 2) / height * across + (x / 3 + width / 2) / width);
    ++first[part[t] + 1];
  }
  for (std::size_t p = 0; p + 1 < first.size(); ++p) first[p + 1] += first[p];
  std::vector<std::int32_t> members(mesh.triangles.size()), localOf(mesh.triangles.size());
  {
    std::vector<std::uint32_t> used(first.begin(), first.end() - 1);
    for (std::int32_t t = 0; t < count; ++t) {
      const std::uint32_t p = part[static_cast<std::size_t>(t)];
      localOf[static_cast<std::size_t>(t)] = static_cast<std::int32_t>(used[p] - first[p]);
      members[used[p]++] = t;
    }
  }

  // Between parts half-edges move on both sides: where each went is known when all are done.
  struct Cut {
    std::int32_t was, twin, now;
  };
  std::vector<std::vector<Cut>> cuts(first.size() - 1);
  onThreads(threads, static_cast<std::uint32_t>(cuts.size()), [&](std::uint32_t p) {
    static thread_local std::vector<std::int32_t> vertexOf;
    static thread_local Triangulation local;
    static thread_local std::vector<std::uint32_t> vertices;
    vertexOf.resize(std::max(vertexOf.size(), mesh.vertices.size()), -1);
    local.vertices.clear();
    local.triangles.clear();
    vertices.clear();
    for (std::uint32_t k = first[p]; k < first[p + 1]; ++k) {
      Triangle one = mesh.triangles[static_cast<std::size_t>(members[k])];
      for (int i = 0; i < 3; ++i) {
        std::int32_t& v = vertexOf[one.corner[i]];
        if (v < 0) {
          v = static_cast<std::int32_t>(vertices.size());
          vertices.push_back(one.corner[i]);
          local.vertices.push_back(mesh.vertices[one.corner[i]]);
        }
        one.corner[i] = static_cast<std::uint32_t>(v);
        const std::int32_t other = one.twin[i];
        if (other >= 0 && part[static_cast<std::size_t>(other >> 2)] == p) {
          one.twin[i] = 4 * localOf[static_cast<std::size_t>(other >> 2)] + (other & 3);
        } else {
          one.twin[i] = ~static_cast<std::int32_t>(cuts[p].size());
          cuts[p].push_back({4 * members[k] + i, other, -1});
        }
      }
      local.triangles.push_back(one);
    }
    local.borderEdge.assign(cuts[p].size(), -1);
    for (std::size_t t = 0; t < local.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i)
        if (local.triangles[t].twin[i] < 0)
          local.borderEdge[static_cast<std::size_t>(~local.triangles[t].twin[i])] =
              4 * static_cast<std::int32_t>(t) + i;
    if (!local.triangles.empty())
      work({local, std::span(members).subspan(first[p], first[p + 1] - first[p]), p, first});
    for (std::uint32_t k = first[p] + static_cast<std::uint32_t>(local.triangles.size()); k < first[p + 1];
         ++k)
      mesh.triangles[static_cast<std::size_t>(members[k])].corner[0] = Triangulation::kDead;
    const auto toGlobal = [&](std::int32_t h) {
      return 4 * members[first[p] + static_cast<std::uint32_t>(h >> 2)] + (h & 3);
    };
    for (std::size_t t = 0; t < local.triangles.size(); ++t) {
      Triangle one = local.triangles[t];
      for (int i = 0; i < 3; ++i) {
        one.corner[i] = vertices[one.corner[i]];
        if (one.twin[i] >= 0) one.twin[i] = toGlobal(one.twin[i]);
      }
      mesh.triangles[static_cast<std::size_t>(members[first[p] + t])] = one;
    }
    for (std::size_t cut = 0; cut < cuts[p].size(); ++cut) cuts[p][cut].now = toGlobal(local.borderEdge[cut]);
    // Those on the border are others' too, and did not change.
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      if (!(local.vertices[v] == mesh.vertices[vertices[v]])) mesh.vertices[vertices[v]] = local.vertices[v];
      vertexOf[vertices[v]] = -1;
    }
  });
  std::vector<std::int32_t> now(4 * mesh.triangles.size());
  for (const std::vector<Cut>& of : cuts)
    for (const Cut& cut : of) now[static_cast<std::size_t>(cut.was)] = cut.now;
  for (const std::vector<Cut>& of : cuts)
    for (const Cut& cut : of)
      mesh.link(cut.now, cut.twin < 0 ? cut.twin : now[static_cast<std::size_t>(cut.twin)]);
  const bool gone = std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                                [](const Triangle& one) { return one.corner[0] == Triangulation::kDead; });
  return gone ? closeGaps(mesh) : std::vector<std::int32_t>{};
}

}  // namespace trimtab::terrain
