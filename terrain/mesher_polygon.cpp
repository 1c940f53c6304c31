#include "trimtab/terrain/mesher_greedy.h"
#include "trimtab/terrain/mesher_order.h"

namespace trimtab::terrain {

struct PolygonMesher::Impl : GreedyMesh {
  TriangleOrder order;
};

PolygonMesher::PolygonMesher() : impl_(std::make_unique<Impl>()) {}
PolygonMesher::~PolygonMesher() = default;
PolygonMesher::PolygonMesher(PolygonMesher&&) noexcept = default;
PolygonMesher& PolygonMesher::operator=(PolygonMesher&&) noexcept = default;

void PolygonMesher::begin(const HeightField& field, std::span<const Point> border,
                          std::span<const float> borderZ) {
  impl_->begin(field, border, borderZ);
}
void PolygonMesher::refine(double tolerance, std::size_t mostVertices) {
  impl_->refine(tolerance, mostVertices);
}
const std::vector<PolygonMesher::Point>& PolygonMesher::vertices() const {
  return impl_->points();
}
void PolygonMesher::triangles(std::vector<std::uint32_t>& indices) const {
  const Triangulation& mesh = impl_->mesh();
  indices.clear();
  indices.reserve(mesh.triangles.size() * 3);
  for (const Triangulation::Triangle& t : mesh.triangles)
    indices.insert(indices.end(), t.corner, t.corner + 3);
}
void PolygonMesher::triangleStrips(std::vector<std::uint32_t>& indices) const {
  impl_->order.order(impl_->mesh(), indices);
}
double PolygonMesher::maxErrorM() const {
  return impl_->maxErrorM();
}
double PolygonMesher::rmsErrorM() const {
  return impl_->rmsErrorM();
}
std::uint32_t PolygonMesher::posts() const {
  return static_cast<std::uint32_t>(impl_->posts());
}

}  // namespace trimtab::terrain
