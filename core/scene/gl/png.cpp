#include <osg/Image>
#include <osgDB/Registry>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "trimtab/scene/offscreen.h"
#include "trimtab/preset/preset.h"

namespace trimtab::scene {

namespace {

Finding refusal(const std::string& where, const char* expected, const std::string& found) {
  return {Severity::error, where, "", expected, found};
}

osgDB::ReaderWriter* plugin() {
  return osgDB::Registry::instance()->getReaderWriterForExtension("png");
}

}  // namespace

Result<std::string> encodePng(std::span<const std::uint8_t> rgba, int width, int height) {
  if (width <= 0 || height <= 0 ||
      rgba.size() < static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4)
    return refusal("PNG", "a picture",
                   std::to_string(width) + " x " + std::to_string(height) + " in " +
                       std::to_string(rgba.size()) + " bytes");
  if (plugin() == nullptr) return refusal("PNG", "OpenSceneGraph's PNG plugin", "none installed");
  const osg::ref_ptr<osg::Image> image = new osg::Image;
  image->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
  std::copy_n(rgba.begin(), image->getTotalSizeInBytes(), image->data());
  std::ostringstream bytes;
  if (const auto written = plugin()->writeImage(*image, bytes); !written.success())
    return refusal("PNG", "a picture that can be encoded", written.message());
  return bytes.str();
}

Result<RgbaPicture> readPng(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return refusal(file.string(), "a PNG file", "it cannot be read");
  if (plugin() == nullptr) return refusal(file.string(), "OpenSceneGraph's PNG plugin", "none installed");
  auto read = plugin()->readImage(in);
  const osg::ref_ptr<osg::Image> image = read.getImage();
  if (!image || image->s() <= 0 || image->t() <= 0)
    return refusal(file.string(), "a PNG file", read.message().empty() ? "something else" : read.message());
  RgbaPicture picture{image->s(), image->t(), {}};
  picture.rgba.reserve(static_cast<std::size_t>(image->s()) * static_cast<std::size_t>(image->t()) * 4);
  for (int y = 0; y < image->t(); ++y)
    for (int x = 0; x < image->s(); ++x) {
      const osg::Vec4 colour = image->getColor(static_cast<unsigned>(x), static_cast<unsigned>(y));
      for (unsigned c = 0; c < 4; ++c)
        picture.rgba.push_back(static_cast<std::uint8_t>(colour[c] * 255 + 0.5f));
    }
  return picture;
}

Result<Done> writePng(const std::filesystem::path& file, std::span<const std::uint8_t> rgba, int width,
                      int height) {
  const Result<std::string> bytes = encodePng(rgba, width, height);
  if (!bytes) return refusal(file.string(), bytes.findings()[0].expected.c_str(), bytes.findings()[0].found);
  return writeAtomically(file, *bytes);
}

}  // namespace trimtab::scene
