#include <algorithm>

#include "greedy.h"

namespace trimtab::terrain {

struct PolygonMesher::Impl : GreedyMesh {};

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
void PolygonMesher::triangles(std::vector<std::uint32_t>& indices, std::vector<std::int32_t>* twins) const {
  const std::vector<Triangulation::Triangle>& all = impl_->mesh().triangles;
  indices.resize(all.size() * 3);
  for (std::size_t t = 0; t < all.size(); ++t) std::copy_n(all[t].corner, 3, &indices[3 * t]);
  if (twins == nullptr) return;
  twins->resize(all.size() * 3);
  for (std::size_t t = 0; t < all.size(); ++t) std::copy_n(all[t].twin, 3, &(*twins)[3 * t]);
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
