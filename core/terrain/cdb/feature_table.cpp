#include "feature_table.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>

namespace trimtab::terrain {

namespace fs = std::filesystem;

namespace {

/// Keeps GDAL's messages of a thread from the terminal.
class QuietTable {
 public:
  QuietTable() {
    CPLPushErrorHandler(CPLQuietErrorHandler);
    CPLErrorReset();
  }
  ~QuietTable() { CPLPopErrorHandler(); }
  QuietTable(const QuietTable&) = delete;
  QuietTable& operator=(const QuietTable&) = delete;
  /// Returns what GDAL said, if it was an error.
  std::string error() const {
    return CPLGetLastErrorType() >= CE_Failure ? std::string(CPLGetLastErrorMsg()) : std::string();
  }
};

using CdbDataset = std::unique_ptr<GDALDataset, void (*)(GDALDataset*)>;

CdbDataset openTable(const fs::path& file) {
  GDALAllRegister();
  constexpr std::array<const char*, 2> kDriver{"ESRI Shapefile", nullptr};
  return {GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, kDriver.data()),
          [](GDALDataset* d) { GDALClose(d); }};
}

Finding unreadable(const fs::path& file, const std::string& why) {
  return {Severity::warning, file.string(), "", "a table of features that GDAL can read",
          why.empty() ? "something else" : why};
}

std::string upperCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

}  // namespace

const std::string& CdbRow::text(const std::string& name) const {
  static const std::string none;
  const auto found = values.find(name);
  return found == values.end() ? none : found->second;
}

Result<Done> readCdbTable(const fs::path& file, const std::function<void(const CdbRow&)>& visit) {
  const QuietTable quiet;
  const CdbDataset data = openTable(file);
  OGRLayer* const layer = data ? data->GetLayer(0) : nullptr;
  if (!layer) return unreadable(file, quiet.error());
  std::vector<std::string> names;
  const OGRFeatureDefn& columns = *layer->GetLayerDefn();
  for (int i = 0; i < columns.GetFieldCount(); ++i)
    names.push_back(upperCase(columns.GetFieldDefn(i)->GetNameRef()));
  const GIntBig count = layer->GetFeatureCount();
  GIntBig seen = 0;
  while (const OGRFeatureUniquePtr feature{layer->GetNextFeature()}) {
    ++seen;
    CdbRow row;
    row.number = static_cast<std::uint32_t>(feature->GetFID() + 1);
    if (const OGRGeometry* const shape = feature->GetGeometryRef();
        shape && wkbFlatten(shape->getGeometryType()) == wkbPoint && !shape->IsEmpty()) {
      const OGRPoint& point = *shape->toPoint();
      row.point = {point.getX(), point.getY(), point.getZ()};
    }
    for (std::size_t i = 0; i < names.size(); ++i)
      if (feature->IsFieldSetAndNotNull(static_cast<int>(i)))
        if (std::string text = feature->GetFieldAsString(static_cast<int>(i)); !text.empty())
          row.values[names[i]] = std::move(text);
    visit(row);
  }
  if (const std::string why = quiet.error(); !why.empty()) return unreadable(file, why);
  if (seen < count) return unreadable(file, std::to_string(seen) + " of " + std::to_string(count) + " rows");
  return Done{};
}

std::optional<std::size_t> cdbRowsIn(const fs::path& file) {
  const QuietTable quiet;
  const CdbDataset data = openTable(file);
  OGRLayer* const layer = data ? data->GetLayer(0) : nullptr;
  if (!layer) return {};
  return static_cast<std::size_t>(std::max<GIntBig>(0, layer->GetFeatureCount()));
}

}  // namespace trimtab::terrain
