#include <array>

#include "trimtab/terrain/georeference.h"
#include "trimtab/terrain/import.h"

namespace trimtab::terrain {

namespace {

/// Which band of a raster gives each of red, green, blue and alpha; 0: none.
std::array<int, 4> bandsOf(GDALDataset& data) {
  const int count = data.GetRasterCount();
  if (count >= 4) return {1, 2, 3, 4};
  if (count == 3) return {1, 2, 3, 0};
  return {1, 1, 1, 0};
}

}  // namespace

Result<std::vector<std::uint8_t>> readImagery(const std::filesystem::path& file, const PostGrid& posts,
                                              const Progress& progress) {
  useGdal();
  GdalErrors errors;
  auto opened = openRaster(file, errors);
  if (!opened) return opened.findings();
  Findings notes = opened.findings();
  GDALDataset& data = *opened->data;
  GDALRasterBand& first = *data.GetRasterBand(1);
  if (first.GetRasterDataType() != GDT_Byte)
    return about(Severity::error, file, "band 1", "bytes of red, green and blue",
                 GDALGetDataTypeName(first.GetRasterDataType()));
  if (progress && !progress(0, "reading " + file.filename().string())) return cancelled(file.string());

  // An alpha of its own, or one that says where the raster ends. Colours of a palette cannot be mixed.
  const GDALColorTable* palette = first.GetColorTable();
  const std::array<int, 4> bands = bandsOf(data);
  std::vector<std::string> options = {"-r", palette ? "near" : "bilinear", "-wm", "256"};
  if (bands[3] == 0) options.push_back("-dstalpha");
  const Dataset result = warped(data, opened->crs, posts, options);
  if (!result)
    return about(Severity::error, file, "", "an image that GDAL can warp to WGS84",
                 errors.last("GDAL gives no reason"));
  const int alpha = bands[3] != 0 ? bands[3] : result->GetRasterCount();

  std::vector<std::uint8_t> image(posts.size() * 4);
  const int columns = static_cast<int>(posts.columns), rows = static_cast<int>(posts.rows);
  const GSpacing line = static_cast<GSpacing>(columns) * 4;
  for (std::size_t k = 0; k < 4; ++k) {
    const int band = k < 3 ? bands[k] : alpha;
    std::uint8_t* last =
        image.data() + static_cast<std::size_t>(rows - 1) * static_cast<std::size_t>(line) + k;
    if (result->GetRasterBand(band)->RasterIO(GF_Read, 0, 0, columns, rows, last, columns, rows, GDT_Byte, 4,
                                              -line, nullptr) != CE_None)
      return about(Severity::error, file, "band " + std::to_string(band), "an image",
                   errors.last("GDAL gives no reason"));
  }
  std::size_t covered = 0;
  for (std::size_t i = 0; i < image.size(); i += 4) {
    if (palette != nullptr) {
      GDALColorEntry entry{};
      palette->GetColorEntryAsRGB(image[i], &entry);
      image[i] = static_cast<std::uint8_t>(entry.c1);
      image[i + 1] = static_cast<std::uint8_t>(entry.c2);
      image[i + 2] = static_cast<std::uint8_t>(entry.c3);
    }
    if (image[i + 3] < 128)
      image[i + 3] = 0;
    else
      ++covered;
  }
  errors.moveTo(notes, file.string(), Severity::warning);
  if (covered == 0)
    return about(Severity::error, file, "georeference", "an image over the terrain",
                 "none of its posts covered");
  if (covered < posts.size())
    notes.push_back(about(Severity::note, file, "georeference", "an image over the whole terrain",
                          std::to_string(posts.size() - covered) + " posts without"));
  return Result<std::vector<std::uint8_t>>(std::move(image), std::move(notes));
}

}  // namespace trimtab::terrain
