#include <osg/Image>
#include <osgDB/Registry>
#include <sstream>
#include <system_error>

#include <fstream>

#include "trimtab/scene/offscreen.h"

namespace trimtab::scene {

Result<Done> writePng(const std::filesystem::path& file, std::span<const std::uint8_t> rgba, int width,
                      int height) {
  const auto refuse = [&file](const char* expected, const std::string& found) {
    return Finding{Severity::error, file.string(), "", expected, found};
  };
  if (width <= 0 || height <= 0 ||
      rgba.size() < static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4)
    return refuse("a picture", std::to_string(width) + " x " + std::to_string(height) + " in " +
                                   std::to_string(rgba.size()) + " bytes");
  osgDB::ReaderWriter* writer = osgDB::Registry::instance()->getReaderWriterForExtension("png");
  if (writer == nullptr) return refuse("OpenSceneGraph's PNG plugin", "none installed");

  const osg::ref_ptr<osg::Image> image = new osg::Image;
  image->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
  std::copy_n(rgba.begin(), image->getTotalSizeInBytes(), image->data());
  std::ostringstream bytes;
  if (const auto written = writer->writeImage(*image, bytes); !written.success())
    return refuse("a picture that can be encoded", written.message());

  std::filesystem::path temporary = file;
  temporary += ".part";
  std::error_code error;
  {
    std::ofstream out(temporary, std::ios::binary);
    const std::string text = bytes.str();
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) {
      std::filesystem::remove(temporary, error);
      return refuse("a place that can be written", "writing failed");
    }
  }
  std::filesystem::rename(temporary, file, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    return refuse("a place that can be written", error.message());
  }
  return Done{};
}

}  // namespace trimtab::scene
